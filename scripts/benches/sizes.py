# SPDX-License-Identifier: BSD-3-Clause
"""Sizes: how well finished meshes obey fields of eight kinds on eight surfaces, and numbers of triangles.

usage: scripts/bench sizes [options] [FILE ...]

Every field goes through mremesh as a user would give it; the table shows, of edge length over the size at the edge (the
mean of the column `size` of the result at its ends), the percentiles 5 and 95. Exits with 1 where they leave 0.7 or 1.35.
The field "distance" grows far beyond the radius of tubes, where msize lowers it; on the body, where lines of the model are
0.12 apart, it ends at 0.2, since no edge across can be longer than that.
With files, the table shows instead how many triangles meshes of them have that were asked for from 2000 to 100000, and
exits with 1 where one is off by more than 3 %.

  --shapes NAME[,NAME]     only these surfaces
  --fields NAME[,NAME]     only these fields
  --counts N[,N]           these numbers of triangles (default 2000,3000,5000,6500,10000,20000,50000,100000)
  --bin DIR                programs (default build/bin)
  --json FILE              the same figures as JSON
"""
import math
import os
import tempfile

from benches import common

LOW, HIGH = 0.7, 1.35
# and the triangles that a uniform mesh with the fields' mean size would have
SHAPES = {
    "tube": (["tube", "--aspect", "10"], 6000),
    "capsule": (["tube", "--aspect", "3", "--closed", "--noise", "0.1"], 6000),
    "sphere": (["sphere"], 4000),
    "torus": (["torus"], 6000),
    "genus": (["genus", "--genus", "3"], 8000),
    "tree": (["tree"], 20000),
    "body": (["body"], 8000),
    "cube": (["cube"], 4000),
}
FIELDS = ["linear", "distance", "step", "wave", "curvature", "chord", "table", "node data"]


def rows_of(text, table):
    """Rows of a table of an ASCII stream, as words; the names of its columns."""
    lines = text.split("\n")
    elements, at = [], 0
    while lines[at] != "end_header":
        word = lines[at].split()
        if word[0] == "element":
            elements.append((word[1], int(word[2]), []))
        elif word[0] == "property":
            elements[-1][2].append(word[-1])
        at += 1
    at += 1
    for name, count, columns in elements:
        if name == table:
            return columns, [line.split() for line in lines[at:at + count]]
        at += count
    raise SystemExit(f"no table {table} in the result")


def stream_of(command):
    done = common.run(command)
    if done.status:
        raise SystemExit(f"{command}: {done.text.strip()}")
    return done.text


def edges_over_size(text):
    """Percentiles 5 and 95, and the number of triangles."""
    columns, rows = rows_of(text, "vertex")
    k = columns.index("size")
    x = [tuple(map(float, r[:3])) for r in rows]
    h = [float(r[k]) for r in rows]
    triangles = [tuple(map(int, r[1:4])) for r in rows_of(text, "face")[1]]
    pairs = {(min(a, b), max(a, b)) for t in triangles for a, b in ((t[0], t[1]), (t[1], t[2]), (t[2], t[0]))}
    ratio = sorted(2 * math.dist(x[a], x[b]) / (h[a] + h[b]) for a, b in pairs)
    return ratio[len(ratio) // 20], ratio[-len(ratio) // 20], len(triangles)


def fields_of(surface, count, work):
    """The options of mremesh for every field, in the surface's own measures."""
    text = stream_of(f"mclean -q '{surface}' | mconvert -q --ascii -")
    x = [tuple(map(float, r[:3])) for r in rows_of(text, "vertex")[1]]
    area = 0
    for r in rows_of(text, "face")[1]:
        a, b, c = (x[int(v)] for v in r[1:4])
        u, v = [q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)]
        area += 0.5 * math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
    h = math.sqrt(4 * area / (math.sqrt(3) * count))
    low, high = [min(p[i] for p in x) for i in range(3)], [max(p[i] for p in x) for i in range(3)]
    i = max(range(3), key=lambda i: high[i] - low[i])
    axis, start, extent = "xyz"[i], low[i], high[i] - low[i]
    along = f"({axis} - ({start!r})) / {extent!r}"
    corner = min(x)
    away = "sqrt(" + " + ".join(f"({w} - ({c!r}))^2" for w, c in zip("xyz", corner)) + ")"

    fields = {
        "linear": ["--expression", f"{h!r} * (0.5 + 2 * {along})"],
        "distance": ["--expression", f"{0.4 * h!r} + 0.25 * {away}"],
        "step": ["--expression", f"{along} < 0.5 ? {0.6 * h!r} : {3 * h!r}"],
        "wave": ["--expression", f"{h!r} * (1 + 0.5 * sin(18 * {along}))"],
        "curvature": ["--curvature", "14", "--max", repr(2 * h), "--min", repr(0.3 * h)],
        "chord": ["--chord", repr(h / 30), "--min", repr(0.3 * h)],
    }
    if "bore" in text:
        fields["distance"] += ["--max", "0.2"]
    table, data = os.path.join(work, "table.csv"), os.path.join(work, "data.msh")
    with open(table, "w") as f:
        for p in x:
            print(*p, h * (0.6 + 1.5 * abs((p[i] - start) / extent - 0.4)), sep=",", file=f)
    stream_of(f"msize -q --expression '{h!r} * (0.6 + 3 * ({along} - 0.7)^2)' '{surface}' | mconvert -q - -o '{data}'")
    fields["table"] = ["--field", table]
    fields["node data"] = ["--field", data + ":size"]
    return fields


def count_triangles(files, counts, args, work):
    """The table of numbers of triangles; how many missed."""
    found, missed = [], 0
    result = os.path.join(work, "out.off")
    row = common.table(["surface"] + [str(n) for n in counts])
    for name, path, _ in files:
        cells = []
        for n in counts:
            done = common.run(["mremesh", "-q", "--triangles", str(n), path, "-o", result])
            if done.status:
                cells.append(f"status {done.status}")
                missed += 1
                continue
            with open(result) as f:
                made = int(f.read(100).split()[2])
            off = made / n - 1
            missed += abs(off) > 0.03
            cells.append(f"{100 * off:+.1f} %" + (" MISSED" if abs(off) > 0.03 else ""))
            found.append({"surface": name, "asked": n, "triangles": made})
        row(name, *cells)
    common.save(args, found)
    return missed


def chosen(words, known):
    names = words.split(",") if words else list(known)
    for name in names:
        if name not in known:
            raise SystemExit(f"{name} is none of {', '.join(known)}")
    return names


def main(words):
    p = common.parser(__doc__)
    p.add_argument("--shapes")
    p.add_argument("--fields")
    p.add_argument("--counts", default="2000,3000,5000,6500,10000,20000,50000,100000")
    args = common.parse(p, words)
    if args.files:
        with tempfile.TemporaryDirectory() as work:
            counts = [int(n) for n in args.counts.split(",")]
            return 1 if count_triangles(common.surfaces(args, work), counts, args, work) else 0
    fields = chosen(args.fields, FIELDS)
    found, missed = [], 0
    row = common.table(["surface", "field", "triangles", "p5", "p95", ""])
    with tempfile.TemporaryDirectory() as work:
        for shape in chosen(args.shapes, SHAPES):
            words, count = SHAPES[shape]
            surface, result = os.path.join(work, "in.ply"), os.path.join(work, "out.ply")
            stream_of(["mshape", "-q", *words, "-o", surface])
            for field, options in fields_of(surface, count, work).items():
                if field not in fields:
                    continue
                done = common.run(["mremesh", surface, *options, "-o", result])
                if done.status:
                    row(shape, field, "-", "-", "-", done.text.strip().split("\n")[-1])
                    missed += 1
                    continue
                low, high, n = edges_over_size(stream_of(f"mconvert -q --ascii '{result}'"))
                held = low >= LOW and high <= HIGH
                missed += not held
                found.append({"surface": shape, "field": field, "triangles": n, "p5": low, "p95": high})
                row(shape, field, n, f"{low:.3f}", f"{high:.3f}", "" if held else "MISSED")
        common.save(args, found)
    return 1 if missed else 0
