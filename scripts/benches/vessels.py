# SPDX-License-Identifier: BSD-3-Clause
"""Vessels: ends capped and meshed, their caps, rims and names, and the growth of time with the number of ends.

usage: scripts/bench vessels [options] [FILE ...]

Without files, trees of mshape with 2 to 147 open ends are used, each with as many triangles per end. Each is meshed by
mclean | msmooth | mcap --cap | mremesh, or with --driver by mremesh --vessel. A row holds the open ends, how many of their
caps are flat, the status, the triangles and patches of the result, "yes" if it is closed and its patches are the wall and
a cap of each name, the largest distance of a flat cap's vertex from its plane over the diagonal, the smallest kappa of a
triangle at a rim, the smallest number of edges of a rim, and the CPU seconds of mcap and of all. The last row has the
exponents of both: the slope of the logarithm over that of the ends, from 10 ends on. Exits with 1 if a status is not 0, a
name is missing, a flat cap is farther from its plane than 1e-9, or kappa at a rim is below 0.5.

  --ends N[,N] or N-N      numbers of open ends (default 2,5,10,20,50,100,147)
  --per-end T              triangles per end (default 700; 0: 25,000 in all)
  --driver                 run mremesh --vessel
  --options WORDS          options of mremesh, such as '--around 10'
  --cap WORDS              options of mcap, such as '--trim 0.5r --extend 2'
  --timeout S              seconds for one run (default 300)
  --bin DIR                programs (default build/bin)
  --json FILE              the same figures as JSON
"""
import json
import math
import os
import subprocess
import tempfile

from benches import common, scale

PLANE, KAPPA = 1e-9, 0.5


def numbers(text):
    if "-" in text:
        first, last = map(int, text.split("-"))
        return list(range(first, last + 1))
    return [int(n) for n in text.split(",")]


def sub(a, b):
    return [x - y for x, y in zip(a, b)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def mesh_of(path):
    """Points, (a, b, c, patch) and the names of patches of a result."""
    text = common.run(["mconvert", "-q", "--ascii", path]).text
    names, elements = {}, []
    lines = iter(text.split("\n"))
    for line in lines:
        word = line.split()
        if word[:3] == ["comment", "name", "2"]:
            names[int(word[3])] = word[4]
        elif word[:1] == ["element"]:
            elements.append((word[1], int(word[2]), []))
        elif word[:1] == ["property"]:
            elements[-1][2].append(word[-1])
        elif word[:1] == ["end_header"]:
            break
    rows = {}
    for name, count, columns in elements:
        rows[name] = columns, [next(lines).split() for _ in range(count)]
    points = [list(map(float, r[:3])) for r in rows["vertex"][1]]
    columns, faces = rows["face"]
    at = columns.index("patch") + 3  # after the count and three corners instead of one list
    return points, [tuple(map(int, r[1:4] + [r[at]])) for r in faces], names


def planarity(points, triangles):
    """Largest distance of a vertex of a cap from the plane along its area and through its middle."""
    corners = sorted({v for t in triangles for v in t[:3]})
    middle = [sum(points[v][k] for v in corners) / len(corners) for k in range(3)]
    area = [0, 0, 0]
    for a, b, c, _ in triangles:
        area = [x + y for x, y in zip(area, cross(sub(points[b], points[a]), sub(points[c], points[a])))]
    length = math.sqrt(dot(area, area)) or 1
    return max(abs(dot(sub(points[v], middle), area)) / length for v in corners)


def kappa(a, b, c):
    """2 r / R of a triangle: 1 if it is equilateral."""
    x, y, z = (math.dist(*e) for e in ((a, b), (b, c), (c, a)))
    n = cross(sub(b, a), sub(c, a))
    return 4 * dot(n, n) / ((x + y + z) * x * y * z) if min(x, y, z) > 0 else 0


def caps_of(path, flat):
    """What a row says of a result with caps of these names, each flat or not."""
    points, triangles, names = mesh_of(path)
    of, patches_at, uses = {}, {}, {}
    for t in triangles:
        of.setdefault(names.get(t[3], ""), []).append(t)
        for i in range(3):
            patches_at.setdefault(t[i], set()).add(t[3])
            uses.setdefault(tuple(sorted((t[i], t[(i + 1) % 3]))), []).append(names.get(t[3], ""))
    expected = {"wall", *flat} | {name for name in of if name.endswith("_extension") and name[:-10] in flat}
    at_rims = [t for t in triangles if any(len(patches_at[v]) > 1 for v in t[:3])]
    around = {name: sum(name in u and u != [name, name] for u in uses.values()) for name in flat if name in of}
    lo, hi = ([f(p[k] for p in points) for k in range(3)] for f in (min, max))
    return {
        "triangles": len(triangles), "patches": len(of),
        "names": set(of) == expected and all(len(u) == 2 for u in uses.values()),
        "planarity": max((planarity(points, of[n]) for n in flat if flat[n] and n in of), default=0) / math.dist(lo, hi),
        "kappa": min((kappa(*(points[v] for v in t[:3])) for t in at_rims), default=1),
        "around": min(around.values(), default=0),
    }


def measure(path, work, args):
    cleaned, smooth, capped, out, report = (os.path.join(work, n) for n in ("a.ply", "b.ply", "c.ply", "d.ply", "e.json"))
    cap = ("--flatten " if args.driver else "") + args.cap
    first = common.run(f"mclean -q '{path}' -o '{cleaned}' && msmooth -q '{cleaned}' -o '{smooth}'", args.timeout)
    done = second = common.run(f"mcap -q --cap {cap} --json '{report}' '{smooth}' -o '{capped}'", args.timeout)
    seconds = first.cpu + second.cpu
    flat = {}
    if second.status == 0:
        with open(report) as f:
            flat = {end["name"]: end["flat"] for end in json.load(f)["ends"]}
        source = f"--vessel {args.cap} '{path}'" if args.driver else f"'{capped}'"
        done = common.run(f"mremesh -q -j 1 {args.options} {source} -o '{out}'", args.timeout)
        seconds = done.cpu if args.driver else seconds + done.cpu
    figures = {"ends": len(flat), "flat": sum(flat.values()), "status": done.status, "mcap": second.cpu, "seconds": seconds}
    figures.update(caps_of(out, flat) if done.status == 0 else {"why": done.text.strip()})
    return figures


def is_good(r):
    return r["status"] == 0 and r["names"] and r["planarity"] <= PLANE and r["kappa"] >= KAPPA


def main(words):
    p = common.parser(__doc__)
    p.add_argument("--ends", type=numbers, default=[2, 5, 10, 20, 50, 100, 147])
    p.add_argument("--per-end", type=int, default=700)
    p.add_argument("--driver", action="store_true")
    p.add_argument("--options", default="")
    p.add_argument("--cap", default="")
    p.add_argument("--timeout", type=float, default=300)
    args = common.parse(p, words)
    rows = []
    with tempfile.TemporaryDirectory() as work:
        row = common.table(["surface", "ends", "flat", "status", "triangles", "patches", "named", "out of plane", "kappa at rims",
                            "edges of a rim", "mcap s", "all s"])
        surfaces = common.surfaces(args, work) if args.files else [(f"tree-{n}", n, 0) for n in args.ends]
        for name, path, _ in surfaces:
            if not args.files:
                count = ["--triangles", str(args.per_end * path)] if args.per_end else []
                words = ["mshape", "tree", "-q", "--outlets", str(path), *count, "-o", os.path.join(work, "tree.ply")]
                subprocess.run(words, check=True)
                path = words[-1]
            r = measure(path, work, args)
            rows.append({"surface": name, **r})
            shown = [""] * 6
            if r["status"] == 0:
                named = "yes" if r["names"] else "no"
                shown = [r["triangles"], r["patches"], named, f"{r['planarity']:.1e}", f"{r['kappa']:.3f}", r["around"]]
            row(name, r["ends"], r["flat"], r["status"], *shown, f"{r['mcap']:.2f}", f"{r['seconds']:.2f}")
        many = [r for r in rows if r["ends"] >= 10 and r["status"] == 0]
        row("exponent", *[""] * 9, *(scale.show(scale.exponent([(r["ends"], r[k]) for r in many])) for k in ("mcap", "seconds")))
    for r in rows:
        if not is_good(r):
            print(f"{r['surface']}: {r.get('why') or 'a cap, a rim or a name is not as asked for'}")
    common.save(args, rows)
    return 0 if all(map(is_good, rows)) else 1
