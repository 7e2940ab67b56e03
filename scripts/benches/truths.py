# SPDX-License-Identifier: BSD-3-Clause
"""Truths: radius, thickness and gaps of shapes where they are known, and what msmooth makes of their voxels.

usage: scripts/bench truths [options]

The first table has the largest and the median relative error of the columns that msize --around, --across and --gap measure:
on tubes, cones and tori, between concentric spheres, in plates. Edges of plates, within one thickness, are left out, and so
are the caps of closed tubes. The second one has, for voxels of shapes, the root mean square of the distances of the vertices
from the shape over the voxel, except near flat ends, before and after msmooth, their ratio, the change of volume, and the
longest way of a vertex over the bound; the third the mean radius of tubes of few voxels, away from their ends. Exits with 1
where an error is above 5 %, the ratio below 3 (2 on tubes, whose stairs are long waves since they run along the axes of the
voxels), the volume changes by more than 0.1 %, or a vertex moves farther than the bound.

  --only NAME              sizes, voxels or tubes
  --bin DIR                programs (default build/bin)
  --json FILE              the same figures as JSON
"""
import json
import math
import os
import tempfile

from benches import common, sizes

VOXELS = [("sphere", "", (0.15, 0.1, 0.05, 0.03)), ("torus", "--ratio 0.4", (0.1, 0.07, 0.04)),
          ("tube", "--aspect 6 --closed", (0.15, 0.1, 0.06, 0.04))]


def distance(kind, p):
    """From the shape; None near the flat ends of a tube."""
    if kind == "sphere":
        return abs(math.hypot(*p) - 1)
    if kind == "torus":
        return abs(math.hypot(math.hypot(p[0], p[1]) - 1, p[2]) - 0.4)
    return abs(math.hypot(p[0], p[1]) - 0.5) if 0.5 < p[2] < 5.5 else None


def shape(words):
    """Points and triangles of a shape of mshape."""
    text = sizes.stream_of(f"mshape {words} -q --ascii -o - | mclean -q --ascii -")
    points = [tuple(map(float, r[:3])) for r in sizes.rows_of(text, "vertex")[1]]
    return points, [tuple(map(int, r[1:4])) for r in sizes.rows_of(text, "face")[1]]


def join(*parts):
    """One mesh of several, each (points, triangles, factor, inverted)."""
    points, triangles = [], []
    for p, t, factor, inverted in parts:
        first = len(points)
        points += [tuple(factor * x for x in v) for v in p]
        triangles += [tuple(first + v for v in (reversed(c) if inverted else c)) for c in t]
    return points, triangles


def write_off(path, mesh):
    points, triangles = mesh
    with open(path, "w") as f:
        f.write(f"OFF\n{len(points)} {len(triangles)} 0\n")
        f.writelines("%r %r %r\n" % p for p in points)
        f.writelines("3 %d %d %d\n" % t for t in triangles)


def surfaces():
    """(name, mesh, option of msize, column, true value at a point or None)"""
    for n in (600, 2000, 20000):
        yield f"tube, {n} triangles", shape(f"tube --aspect 5 --triangles {n}"), "around", "radius", lambda p: 0.5
    closed = shape("tube --aspect 5 --closed --triangles 8000")
    yield "closed tube", closed, "around", "radius", lambda p: 0.5 if 0.01 < p[2] < 4.99 else None
    points, triangles = shape("tube --aspect 6 --triangles 8000")
    cone = [((1 - 0.1 * z) * x, (1 - 0.1 * z) * y, z) for x, y, z in points]
    yield "cone", (cone, triangles), "around", "radius", lambda p: 0.5 - 0.05 * p[2]
    for r in (0.1, 0.3, 0.5):
        yield f"torus of {r}", shape(f"torus --ratio {r} --triangles 20000"), "around", "radius", lambda p, r=r: r
    ball, small = shape("sphere --triangles 20000"), shape("sphere --triangles 12000")
    for inner in (0.7, 0.9, 0.97):
        hollow = join((*ball, 1, False), (*small, inner, True))
        yield f"shell of {1 - inner:.2f}", hollow, "across", "thickness", lambda p, d=1 - inner: d
    nested = join((*ball, 1, False), (*small, 1.3, True), (*small, 2, False))
    yield "gap of 0.3", nested, "gap", "gap", lambda p: 0.3 if math.hypot(*p) < 1.5 else None
    points, triangles = shape("cube --triangles 10000")
    for t in (0.2, 0.05, 0.01):
        def inner(p, t=t):
            return t if all(t < x < 1 - t for x in p[:2]) else None
        yield f"plate of {t}", ([(x, y, t * z) for x, y, z in points], triangles), "across", "thickness", inner


def size_errors(work, row, rows):
    path = os.path.join(work, "in.off")
    for name, mesh, option, column, truth in surfaces():
        write_off(path, mesh)
        text = sizes.stream_of(f"msize -q --ascii --{option} 4 '{path}'")
        columns, vertices = sizes.rows_of(text, "vertex")
        k = columns.index(column)
        errors = []
        for v in vertices:
            p = tuple(map(float, v))
            if truth(p) is not None:
                errors.append(abs(p[k] / truth(p) - 1))
        errors.sort()
        row(name, option, f"{100 * errors[-1]:.2f} %", f"{100 * errors[len(errors) // 2]:.2f} %")
        rows.append({"surface": name, "option": option, "largest": errors[-1], "good": errors[-1] < 0.05})


def rms(kind, path):
    text = sizes.stream_of(f"mconvert -q --ascii '{path}'")
    far = [distance(kind, tuple(map(float, r[:3]))) for r in sizes.rows_of(text, "vertex")[1]]
    far = [d for d in far if d is not None]
    return math.sqrt(sum(d * d for d in far) / len(far))


def voxel_errors(work, row, rows):
    stairs, smooth, report = (os.path.join(work, n) for n in ("v.ply", "s.ply", "s.json"))
    for kind, words, steps in VOXELS:
        for h in steps:
            sizes.stream_of(f"mshape {kind} {words} --triangles 20000 --voxels {h} -q -o - | mclean -q -o '{stairs}'")
            sizes.stream_of(f"msmooth -q --json '{report}' '{stairs}' -o '{smooth}'")
            with open(report) as f:
                r = json.load(f)
            before, after = rms(kind, stairs), rms(kind, smooth)
            change = abs(r["volume_change"] / r["volume"])
            reach = r["farthest"] / r["within"]
            row(kind, h, f"{before / h:.3f}", f"{after / h:.3f}", f"{before / after:.1f}", f"{100 * change:.4f} %", f"{reach:.2f}")
            good = before >= (2 if kind == "tube" else 3) * after and change < 1e-3 and reach <= 1
            rows.append({"surface": kind, "voxel": h, "before": before, "after": after, "volume": change, "reach": reach, "good": good})


def tube_errors(work, row, rows):
    for across in (3, 4, 6, 10):
        text = sizes.stream_of(f"mshape tube --aspect 12 --closed --voxels {1 / across} -q -o - | mclean -q | msmooth -q --ascii")
        points = [tuple(map(float, r[:3])) for r in sizes.rows_of(text, "vertex")[1]]
        low, high = min(p[2] for p in points), max(p[2] for p in points)
        radii = [math.hypot(*p[:2]) for p in points if low + 1 < p[2] < high - 1]
        radius = sum(radii) / len(radii)
        error = abs(radius / 0.5 - 1)
        row(f"tube {across} voxels across", f"{radius:.4f}", f"{100 * error:.2f} %")
        rows.append({"surface": "tube", "across": across, "radius": radius, "good": error < 0.05})


def main(words):
    p = common.parser(__doc__)
    p.add_argument("--only", choices=["sizes", "voxels", "tubes"])
    args = common.parse(p, words)
    rows = []
    with tempfile.TemporaryDirectory() as work:
        if args.only in (None, "sizes"):
            size_errors(work, common.table(["surface", "option", "largest error", "median"]), rows)
        if args.only in (None, "voxels"):
            print()
            head = ["voxels of", "voxel", "rms before", "after", "ratio", "volume", "way over bound"]
            voxel_errors(work, common.table(head), rows)
        if args.only in (None, "tubes"):
            print()
            tube_errors(work, common.table(["smoothed", "radius", "off 0.5 by"]), rows)
    common.save(args, rows)
    return 0 if all(r["good"] for r in rows) else 1
