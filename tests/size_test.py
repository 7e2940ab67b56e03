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

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "scripts"))
from benches.sizes import edges_over_size, rows_of  # noqa: E402

BIN = os.path.abspath(sys.argv[1])
# small at one side of a torus of radii 1 and 0.35
FORMULA = "0.06 + 0.05 * abs(x - 1.2)"


def run(*words):
    subprocess.run([os.path.join(BIN, words[0]), "-q", *words[1:]], check=True)


def text_of(path):
    return subprocess.run([os.path.join(BIN, "mconvert"), "-q", "--ascii", path, "-o", "-"],
                          check=True, capture_output=True, text=True).stdout


def off_field(text):
    """How far the sizes are from the formula's, as a logarithm, at 99 of 100 vertices."""
    columns, rows = rows_of(text, "vertex")
    k = columns.index("size")
    off = sorted(abs(math.log(float(r[k]) / (0.06 + 0.05 * abs(float(r[0]) - 1.2)))) for r in rows)
    return off[int(0.99 * len(off))]


def check(name, source, options, field=True, count=0):
    run("mremesh", source, *options, "-o", "out.ply")
    text = text_of("out.ply")
    low, high, n = edges_over_size(text)
    off = off_field(text)
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
    columns, rows = rows_of(text_of("sized.ply"), "vertex")
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
