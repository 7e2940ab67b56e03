# SPDX-License-Identifier: BSD-3-Clause
"""Truths: radius, thickness and gaps of shapes where they are known, and what msmooth makes of their voxels.

usage: scripts/bench truths [options]

The first table has the largest and the median relative error of the columns that msize --around, --across and --gap measure:
on tubes, cones and tori, between concentric spheres, in plates. Edges of plates, within one thickness, are left out, and so
are the caps of closed tubes. The second one has, for voxels of shapes, the root mean square of the distances of the vertices
from the shape over the voxel before and after msmooth, their ratio, the change of volume, and the longest way of a vertex over
the bound. The section of a tube along an axis has the same voxels everywhere, whose center and area are not the tube's: its
distances are from the tube that has these, and its flat ends are left out. The third table has the mean error of the radius
over the area of tubes and trees of few voxels, with round ends; it is that of the voxels themselves for the most part. Exits
with 1 where an error is above 5 %, the ratio below 3, the volume changes by more than 0.1 %, or a vertex moves farther than the
bound.

  --only NAME              sizes, voxels or tubes
  --bin DIR                programs (default build/bin)
  --json FILE              the same figures as JSON
"""
import itertools
import json
import math
import operator
import os
import tempfile

from benches import common, sizes

# pieces of tubes with round ends: from, to, radius
SLANTED = [((0, 0, 0), (1.7, 3.1, 4.7), 0.5)]
TREE = [((0, 0, 0), (0.5, 0.3, 2.5), 0.5), ((0.5, 0.3, 2.5), (2, 0.9, 4.2), 0.4), ((0.5, 0.3, 2.5), (-0.9, -0.4, 4.4), 0.4),
        ((2, 0.9, 4.2), (2.4, 2.2, 5.6), 0.32), ((2, 0.9, 4.2), (3.6, 0.7, 5.1), 0.32),
        ((-0.9, -0.4, 4.4), (-1.2, -1.6, 5.7), 0.32), ((-0.9, -0.4, 4.4), (-2.3, 0.5, 5.5), 0.32)]
VOXELS = [("sphere", "", (0.15, 0.1, 0.05, 0.03)), ("torus", "--ratio 0.4", (0.1, 0.07, 0.04)),
          ("tube", "--aspect 6 --closed", (0.15, 0.1, 0.06, 0.04)), ("slanted tube", SLANTED, (0.2, 0.15, 0.1, 0.07)),
          ("tree", TREE, (0.15, 0.1, 0.07))]


def to_pieces(pieces, p):
    """Signed distance from tubes with round ends, negative inside (there at least as far as this)."""
    best = math.inf
    for a, b, r in pieces:
        d = [y - x for x, y in zip(a, b)]
        way = [x - y for x, y in zip(p, a)]
        s = max(0, min(1, sum(map(operator.mul, way, d)) / sum(x * x for x in d)))
        best = min(best, math.hypot(*(w - s * x for w, x in zip(way, d))) - r)
    return best


def distance(kind, p, held):
    """From the shape; None near the flat ends of a tube."""
    if kind == "sphere":
        return abs(math.hypot(*p) - 1)
    if kind == "torus":
        return abs(math.hypot(math.hypot(p[0], p[1]) - 1, p[2]) - 0.4)
    if kind == "tube":
        x, y, r = held
        return abs(math.hypot(p[0] - x, p[1] - y) - r) if 0.5 < p[2] < 5.5 else None
    return abs(to_pieces(SLANTED if kind == "slanted tube" else TREE, p))


def pieces_in_voxels(pieces, h):
    """The squares between voxels with their centers inside and outside, as points and triangles."""
    inside = set()
    for piece in pieces:
        a, b, r = piece
        low = [math.floor((min(x, y) - r) / h) for x, y in zip(a, b)]
        high = [math.ceil((max(x, y) + r) / h) for x, y in zip(a, b)]
        for cell in itertools.product(*(range(x, y) for x, y in zip(low, high))):
            if cell not in inside and to_pieces([piece], [h * (x + 0.5) for x in cell]) < 0:
                inside.add(cell)
    number, triangles = {}, []
    for cell in sorted(inside):
        for axis, side in itertools.product(range(3), (0, 1)):
            if tuple(x + (2 * side - 1) * (k == axis) for k, x in enumerate(cell)) in inside:
                continue
            corners = []
            for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)):
                place = list(cell)
                place[axis] += side
                place[(axis + 1) % 3] += u
                place[(axis + 2) % 3] += v
                corners.append(number.setdefault(tuple(place), len(number)))
            i, j, k, l = corners if side else corners[::-1]
            triangles += [(i, j, k), (i, k, l)]
    return [tuple(h * x for x in place) for place in number], triangles


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


def mesh_in(path):
    text = sizes.stream_of(f"mconvert -q --ascii '{path}'")
    points = [tuple(map(float, r[:3])) for r in sizes.rows_of(text, "vertex")[1]]
    return points, [tuple(map(int, r[1:4])) for r in sizes.rows_of(text, "face")[1]]


def tube_held_by(points, triangles):
    """Center and radius of the sections of a body along z of constant section."""
    volume, moment = 0, [0, 0]
    for t in triangles:
        a, b, c = (points[v] for v in t)
        v = (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6
        volume += v
        moment = [m + v * (a[k] + b[k] + c[k]) / 4 for k, m in enumerate(moment)]
    length = max(p[2] for p in points) - min(p[2] for p in points)
    return moment[0] / volume, moment[1] / volume, math.sqrt(volume / length / math.pi)


def rms(kind, points, held):
    far = [d for d in (distance(kind, p, held) for p in points) if d is not None]
    return math.sqrt(sum(d * d for d in far) / len(far))


def voxels_of(work, words, h):
    """Voxels of a shape as a file, and smoothed as another one; the report of msmooth."""
    raw, stairs, smooth, report = (os.path.join(work, n) for n in ("v.off", "v.ply", "s.ply", "s.json"))
    if isinstance(words, str):
        sizes.stream_of(f"mshape {words} --triangles 20000 --voxels {h} -q -o '{raw}'")
    else:
        write_off(raw, pieces_in_voxels(words, h))
    sizes.stream_of(f"mclean -q '{raw}' -o '{stairs}' && msmooth -q --json '{report}' '{stairs}' -o '{smooth}'")
    with open(report) as f:
        return stairs, smooth, json.load(f)


def voxel_errors(work, row, rows):
    for kind, words, steps in VOXELS:
        for h in steps:
            stairs, smooth, r = voxels_of(work, f"{kind} {words}" if isinstance(words, str) else words, h)
            mesh = mesh_in(stairs)
            held = tube_held_by(*mesh)
            before, after = rms(kind, mesh[0], held), rms(kind, mesh_in(smooth)[0], held)
            change = abs(r["volume_change"] / r["volume"])
            reach = r["farthest"] / r["within"]
            row(kind, h, f"{before / h:.3f}", f"{after / h:.3f}", f"{before / after:.1f}", f"{100 * change:.4f} %", f"{reach:.2f}")
            good = before >= 3 * after and change < 1e-3 and reach <= 1
            rows.append({"surface": kind, "voxel": h, "before": before, "after": after, "volume": change, "reach": reach, "good": good})


def mean_distance(pieces, points, triangles):
    """Signed, over the area."""
    total = areas = 0
    for t in triangles:
        a, b, c = (points[v] for v in t)
        u, v = ([y - x for x, y in zip(a, p)] for p in (b, c))
        area = math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        total += area * to_pieces(pieces, [sum(x) / 3 for x in zip(a, b, c)])
        areas += area
    return total / areas


def tube_errors(work, row, rows):
    for kind, pieces in (("slanted tube", SLANTED), ("tree", TREE)):
        for across in (3, 4, 6):
            stairs, smooth, _ = voxels_of(work, pieces, 1 / across)
            before, after = (mean_distance(pieces, *mesh_in(path)) / 0.5 for path in (stairs, smooth))
            row(f"{kind}, {across} voxels across", f"{100 * before:+.2f} %", f"{100 * after:+.2f} %")
            rows.append({"surface": kind, "across": across, "before": before, "after": after, "good": abs(after) < 0.05})


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
            tube_errors(work, common.table(["radius of", "off by, voxels", "smoothed"]), rows)
    common.save(args, rows)
    return 0 if all(r["good"] for r in rows) else 1
