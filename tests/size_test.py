#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The size field from each source, and how well the finished mesh obeys it: of edge length over field at the
edge the percentiles 5 and 95 are within 0.7 and 1.35, and the count is within 3 % of what was asked.
usage: tests/size_test.py BIN_DIR"""
import math
import os
import subprocess
import sys
import tempfile

BIN = os.path.abspath(sys.argv[1])
# small at one side of a torus of radii 1 and 0.35
FORMULA = "0.06 + 0.05 * abs(x - 1.2)"


def run(*words):
    subprocess.run([os.path.join(BIN, words[0]), "-q", *words[1:]], check=True)


def tables(path):
    """Tables of a stream: columns by name."""
    text = subprocess.run([os.path.join(BIN, "mconvert"), "-q", "--ascii", path, "-o", "-"],
                          check=True, capture_output=True, text=True).stdout.split("\n")
    elements, at = [], 0
    while text[at] != "end_header":
        word = text[at].split()
        if word[0] == "element":
            elements.append((word[1], int(word[2]), []))
        elif word[0] == "property":
            elements[-1][2].append(word[-1])
        at += 1
    at += 1
    found = {}
    for name, rows, columns in elements:
        found[name] = (columns, [line.split() for line in text[at:at + rows]])
        at += rows
    return found


def edges_over_field(path):
    found = tables(path)
    columns, rows = found["vertex"]
    k = columns.index("size")
    x = [tuple(map(float, r[:3])) for r in rows]
    h = [float(r[k]) for r in rows]
    triangles = [tuple(map(int, r[1:4])) for r in found["face"][1]]
    ratio = sorted(2 * math.dist(x[a], x[b]) / (h[a] + h[b])
                   for a, b in {tuple(sorted((t[i], t[(i + 1) % 3]))) for t in triangles for i in range(3)})
    wanted = [0.06 + 0.05 * abs(p[0] - 1.2) for p in x]
    off = sorted(abs(math.log(a / b)) for a, b in zip(h, wanted))
    return len(triangles), ratio[len(ratio) // 20], ratio[-len(ratio) // 20], off[int(0.99 * len(off))]


def check(name, source, options, field=True, count=0):
    run("mremesh", source, *options, "-o", "out.ply")
    n, low, high, off = edges_over_field("out.ply")
    print(f"{name}: {n} triangles, edge over field p5 {low:.3f} p95 {high:.3f}, field off by {off:.3f} (log, p99)")
    assert 0.7 <= low and high <= 1.35, name
    assert not field or off < 0.1, name
    assert not count or abs(n - count) <= 0.03 * count, name


with tempfile.TemporaryDirectory() as scratch:
    os.chdir(scratch)
    run("mshape", "torus", "--triangles", "6000", "-o", "in.ply")
    run("msize", "--expression", FORMULA, "in.ply", "-o", "sized.ply")
    for target in ("field.msh", "field.vtu", "field.mesh", "field.sol"):
        run("mconvert", "sized.ply", "-o", target)
    columns, rows = tables("sized.ply")["vertex"]
    with open("field.csv", "w") as out:
        out.write("x,y,z,h\n")
        for row in rows:
            out.write(",".join(row[:3] + [row[columns.index("size")]]) + "\n")

    check("expression", "in.ply", ["--expression", FORMULA])
    check("MSH node data", "in.ply", ["--field", "field.msh:size"])
    check("VTU array", "in.ply", ["--field", "field.vtu"])
    check(".sol", "in.ply", ["--field", "field.sol"])
    check("table", "in.ply", ["--field", "field.csv"])
    check("own data", "field.vtu", ["--data", "size"])
    check("curvature", "in.ply", ["--curvature", "25"], field=False)
    check("chord", "in.ply", ["--chord", "0.005"], field=False)
    check("curvature by formula", "in.ply", ["--expression", "0.25 / curvature"], field=False)
    check("count", "in.ply", ["--triangles", "3000", "--curvature", "25"], field=False, count=3000)
    run("mshape", "body", "-o", "body.ply")
    check("count between lines", "body.ply", ["--triangles", "2000"], field=False, count=2000)
    check("bounds", "in.ply", ["--size", "0.1", "--expression", FORMULA, "--min", "0.07", "--gradation", "0.2"],
          field=False)
