# SPDX-License-Identifier: BSD-3-Clause
"""Regions: surfaces with inner sheets, remeshed as a whole, and what is the same afterwards.

usage: scripts/bench regions [options] [FILE ...]

Without files, surfaces made by mshape regions are used: two boxes with a common side, three spheres within each other, 50
Voronoi regions of a ball, a brick of 4 x 4 x 4 cubes, and labeled images, as smooth sheets and as blocks that msmooth smooths
first. Each is remeshed with the default options (or with about FILE:TRIANGLES). A row holds the status of mremesh, then

  graph        lines where sheets meet and points where these end, = if the input has the same, by their sheets
  regions      the number, = if the input has as many
  crossings    pairs of triangles that intersect, by exact predicates
  volume       largest difference of a region's volume from the input's, in percent of it
  kappa        mean, and smallest away from corners that force less
  divisions    edges of lines where sheets meet, relative to what the size field asks for, in percent; each line has at
               least one edge
  spread       largest difference of one of these edges from the mean of its line, in sizes, in percent
  tetgen, gmsh regions that come back with their labels when these fill the result (tetgen -pYA, gmsh -3), if installed
  solids       = if every triangle of one region's STL file is on the outside or, digit by digit, in another's, reversed

  --smooth                 pass files through msmooth first
  --timeout S              seconds for one run of any program (default 300)
  --bin DIR                programs (default build/bin)
  --json FILE              the same figures as JSON
"""
import collections
import json
import math
import os
import shutil
import tempfile

from benches import common

GENERATED = [
    ("boxes", ["--brick", "2x1x1"], False),
    ("nested", ["--nested", "3"], False),
    ("voronoi-50", ["--voronoi", "50"], False),
    ("brick-64", ["--brick", "4x4x4"], False),
    ("image-2", ["--voronoi", "2", "--image", "smooth"], False),
    ("image-8", ["--voronoi", "8", "--image", "smooth"], False),
    ("image-box-8", ["--voronoi", "8", "--within", "box", "--image", "smooth"], False),
    ("blocks-2", ["--voronoi", "2", "--image", "blocks"], True),
    ("blocks-8", ["--voronoi", "8", "--image", "blocks"], True),
]


def table_of(path, element):
    """Rows of an element of a text stream, as words, and its columns."""
    with open(path) as f:
        elements, line = [], ""
        while line != "end_header":
            line = f.readline().strip()
            words = line.split()
            if words[:1] == ["element"]:
                elements.append((words[1], int(words[2]), []))
            elif words[:1] == ["property"]:
                elements[-1][2].append(words[-1])
        for name, rows, columns in elements:
            found = [f.readline().split() for _ in range(rows)]
            if name == element:
                return found, columns
    return [], []


def junction_lines(path):
    """Per line where sheets meet: its edges as (length, length over the size)."""
    rows, columns = table_of(path, "vertex")
    at = columns.index("size")
    places, number, points = [], {}, []
    for row in rows:
        key = tuple(row[:3])
        if key not in number:
            number[key] = len(points)
            points.append([float(x) for x in (*key, row[at])])
        places.append(number[key])
    uses = collections.defaultdict(list)
    faces, columns = table_of(path, "face")
    patch = columns.index("patch")
    for row in faces:
        t = [places[int(v)] for v in row[1:4]]
        label = row[3 + patch]
        for i in range(3):
            uses[tuple(sorted((t[i], t[(i + 1) % 3])))].append(label)
    edges = {e: tuple(sorted(labels)) for e, labels in uses.items() if len(labels) > 2}
    around = collections.defaultdict(list)
    for e in edges:
        for v in e:
            around[v].append(e)
    inner = {v: es for v, es in around.items() if len(es) == 2 and edges[es[0]] == edges[es[1]]}
    lines, seen = [], set()
    for first in edges:
        if first in seen:
            continue
        line, todo = [], [first]
        while todo:
            e = todo.pop()
            if e in seen:
                continue
            seen.add(e)
            line.append(e)
            for v in e:
                todo += inner.get(v, [])
        lines.append(line)
    measured = []
    for line in lines:
        measured.append([])
        for a, b in line:
            length = math.dist(points[a][:3], points[b][:3])
            measured[-1].append((length, 2 * length / (points[a][3] + points[b][3])))
    return measured


def divisions(lines):
    """Edges over what the sizes ask for, less 1; the largest difference of an edge from its line's mean, in sizes."""
    if not lines:
        return 0.0, 0.0
    asked = sum(max(1, round(sum(s for _, s in line))) for line in lines)
    spread = 0
    for line in lines:
        mean = sum(s for _, s in line) / len(line)
        spread = max(spread, max(abs(s - mean) for _, s in line))
    return sum(map(len, lines)) / asked - 1, spread


def tetgen_labels(work, result, timeout):
    poly = os.path.join(work, "t.poly")
    common.run(["mconvert", "-q", result, "-o", poly], timeout)
    common.run(["tetgen", "-pYAQ", poly], timeout)
    with open(os.path.join(work, "t.1.ele")) as f:
        f.readline()
        return {int(float(row[-1])) for row in map(str.split, f) if row and row[0] != "#"}


def gmsh_labels(work, result, timeout):
    msh, geo, out = (os.path.join(work, name) for name in ("g.msh", "g.geo", "g3.msh"))
    common.run(["mconvert", "-q", result, "-o", msh], timeout)
    common.run(["mconvert", "-q", result, "-o", geo], timeout)
    common.run(["gmsh", "-3", "-nt", "1", "-format", "msh22", msh, geo, "-o", out], timeout)
    labels, inside = set(), False
    with open(out) as f:
        for line in f:
            if line.startswith("$"):
                inside = line.startswith("$Elements")
            elif inside:
                row = line.split()
                if len(row) > 4 and row[1] == "4":
                    labels.add(int(row[3]))
    return labels


def solids_fit(work, result, labels):
    """Whether every triangle of an STL file of a region is on the outside, or reversed in exactly one other."""
    sides = collections.Counter()
    for label in labels:
        stl = os.path.join(work, "solid.stl")
        if common.run(["mconvert", "-q", "--ascii", result, "--regions", str(label), "-o", stl]).status:
            return False
        with open(stl) as f:
            points = [line.split(None, 1)[1] for line in f if line.lstrip().startswith("vertex")]
        for i in range(0, len(points), 3):
            corners = points[i:i + 3]
            first = corners.index(min(corners))
            sides[tuple(corners[first:] + corners[:first])] += 1
    edges = collections.Counter()  # of what has no other side: a surface around all
    for (a, b, c), n in sides.items():
        if n != 1:
            return False
        if (a, c, b) not in sides:
            for edge in ((a, b), (b, c), (c, a)):
                edges[edge] += 1
    return all(edges[(b, a)] == n for (a, b), n in edges.items())


def measure(name, path, count, smooth, work, args):
    """The figures of a surface, and the words of its row."""
    out, verdict = os.path.join(work, "result.mply"), os.path.join(work, "verdict.json")
    before = f"mclean -q '{path}' | msmooth -q | " if smooth else ""
    goal = f"--triangles {count}" if count else ""
    done = common.run(f"{before}mremesh -q {goal} --report '{verdict}' {'-' if smooth else repr(path)} -o '{out}'", args.timeout)
    figures = {"surface": name, "status": done.status, "seconds": done.cpu, "why": done.text.strip()}
    if done.status:
        return figures, [name, "", done.status, figures["why"][:120]]
    with open(verdict) as f:
        v = json.load(f)
    figures.update({k: v.get(k) for k in ("triangles", "regions", "junction_lines", "junction_corners", "self_intersections",
                                          "volume_error", "kappa_mean", "kappa_min", "kappa_off_wedges")})
    same = {k: v.get(k) == v["reference"].get(k) for k in ("regions", "junction_lines", "junction_corners")}
    figures["same_graph"] = same["junction_lines"] and same["junction_corners"]
    text = os.path.join(work, "text.mply")
    common.run(["mconvert", "-q", "--ascii", out, "-o", text])
    figures["divisions"], figures["spread"] = divisions(junction_lines(text))
    labels = {region["label"] for region in v["region_volumes"]}
    back = {}
    for program, find in (("tetgen", tetgen_labels), ("gmsh", gmsh_labels)):
        if shutil.which(program):
            try:
                found = find(work, out, args.timeout)
                back[program] = "all" if found == labels else f"{len(found & labels)} of {len(labels)}"
            except (OSError, ValueError, IndexError):
                back[program] = "failed"
        else:
            back[program] = "-"
    figures.update(back)
    figures["solids"] = solids_fit(work, out, labels)
    equal = "=" if figures["same_graph"] else "differs"
    return figures, [
        name, v["triangles"], done.status, f"{v['junction_lines']} + {v['junction_corners']} {equal}",
        f"{v['regions']} {'=' if same['regions'] else 'differs'}", v["self_intersections"], f"{100 * v['volume_error']:.2g} %",
        f"{v['kappa_mean']:.4f}", f"{v['kappa_off_wedges']:.3f}", f"{100 * figures['divisions']:+.1f} %",
        f"{100 * figures['spread']:.0f} %", back["tetgen"], back["gmsh"], "=" if figures["solids"] else "differ"]


def main(words):
    p = common.parser(__doc__)
    p.add_argument("--timeout", type=float, default=300)
    p.add_argument("--smooth", action="store_true")
    args = common.parse(p, words)
    rows = []
    with tempfile.TemporaryDirectory() as work:
        if args.files:
            jobs = [(name, path, count, args.smooth) for name, path, count in common.surfaces(args, work)]
        else:
            jobs = []
            for name, shape, smooth in GENERATED:
                path = os.path.join(work, name + ".off")
                common.run(["mshape", "regions", *shape, "-q", "-o", path])
                jobs.append((name, path, 0, smooth))
        row = common.table(["surface", "triangles", "status", "graph", "regions", "crossings", "volume", "kappa mean",
                            "kappa min", "divisions", "spread", "tetgen", "gmsh", "solids"])
        for job in jobs:
            figures, cells = measure(*job, work, args)
            rows.append(figures)
            row(*cells)
    common.save(args, rows)
    return 0 if all(r["status"] == 0 for r in rows) else 1
