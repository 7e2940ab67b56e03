#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Model edges of the input are in the result, on a cube, a body of slivers, and CAD models of MESHPIPE_CORPUS if it is set.

usage: tests/features_test.py BIN_DIR

Every vertex of a result's line lies on the model's within 1e-9 of the diagonal; junctions and ends are there bit by bit; a
chain of the result is a chain of the model; no chord leaves its arc by more than a tenth more than h^2 / 8 R.
"""
import gzip
import math
import os
import subprocess
import sys
import tempfile

CASES = [("cube", ["mshape", "cube", "--triangles", "300"], 3000), ("body", ["mshape", "body"], 6000),
         ("cad_linkrods.msh", None, 20000), ("gmsh_mobilette_class.msh", None, 20000), ("of_flange.stl.gz", None, 20000)]


def read(path):
    """Points and model edges, border included, of an ASCII stream."""
    lines = subprocess.run(["mconvert", "-q", "--ascii", path], stdout=subprocess.PIPE, check=True, text=True).stdout.split("\n")
    tables, at = [], lines.index("end_header") + 1
    for line in lines[:at]:
        words = line.split()
        if words[:1] == ["element"]:
            tables.append((words[1], int(words[2]), []))
        elif words[:1] == ["property"]:
            tables[-1][2].append(words[-1])
    (_, n_points, _), (_, n_faces, columns) = tables[:2]
    points = [tuple(map(float, line.split()[:3])) for line in lines[at:at + n_points]]
    model, uses = columns.index("model") + 3, {}
    for line in lines[at + n_points:at + n_points + n_faces]:
        words = line.split()
        corners, bits = list(map(int, words[1:4])), int(words[model])
        for i in range(3):
            edge = tuple(sorted((corners[i], corners[(i + 1) % 3])))
            count, marked = uses.get(edge, (0, 0))
            uses[edge] = (count + 1, marked | bits >> i & 1)
    return points, [e for e, (count, marked) in uses.items() if count == 1 or marked]


def chains_of(edges, joints):
    """Chains of vertices between joints, and closed ones, whose first vertex is repeated."""
    around = {}
    for a, b in edges:
        around.setdefault(a, []).append(b)
        around.setdefault(b, []).append(a)
    left, chains = set(edges), []

    def follow(a, b):
        chain = [a, b]
        left.discard(tuple(sorted((a, b))))
        while b not in joints and b != chain[0]:
            a, b = b, next(v for v in around[b] if v != a)
            left.discard(tuple(sorted((a, b))))
            chain.append(b)
        chains.append(chain)
    for v in sorted(joints):
        for w in around.get(v, []):
            if tuple(sorted((v, w))) in left:
                follow(v, w)
    while left:
        follow(*min(left))
    return chains


def minus(a, b):
    return tuple(x - y for x, y in zip(a, b))


def project(p, polyline):
    """Distance of a point to a polyline, and the arc length there."""
    best, along = (math.inf, 0.0), 0.0
    for a, b in zip(polyline, polyline[1:]):
        d = minus(b, a)
        length = math.hypot(*d)
        t = sum(x * y for x, y in zip(minus(p, a), d)) / length**2 if length else 0
        t = min(1.0, max(0.0, t))
        best = min(best, (math.dist(p, tuple(x + t * y for x, y in zip(a, d))), along + t * length))
        along += length
    return best


def angle(u, v):
    c = sum(x * y for x, y in zip(u, v)) / (math.hypot(*u) * math.hypot(*v) or 1)
    return math.acos(max(-1.0, min(1.0, c)))


def worst_sag(model, result):
    """The largest ratio of the distance between an arc and its chord to what the arc's turning and length allow."""
    at, total = [0.0], 0.0
    for a, b in zip(model, model[1:]):
        total += math.dist(a, b)
        at.append(total)
    turn = [0.0] + [angle(minus(b, a), minus(c, b)) for a, b, c in zip(model, model[1:], model[2:])] + [0.0]
    where, worst = [project(p, model)[1] for p in result], 0.0
    for i, (p, q) in enumerate(zip(result, result[1:])):
        low, high = sorted((where[i], where[i + 1]))
        if model[0] == model[-1] and high - low > total / 2:
            continue  # across the first point of a loop
        inside = [k for k in range(len(at)) if low < at[k] < high]
        if not inside:
            continue
        bend = sum(turn[max(0, inside[0] - 1):inside[-1] + 2])
        kinks = sum(turn[k] > 0.05 * bend for k in inside)  # the line goes straight on at other vertices
        allowed = (high - low) * bend / (8 if kinks > 2 else 4)  # one kink or two are no arc
        sag = max(project(model[k], [p, q])[0] for k in inside)
        worst = max(worst, sag / max(allowed, 1e-9 * total))
    return worst


def check(name, path, count, scratch):
    keep = os.path.join(scratch, name + ".stages")
    subprocess.run(["mremesh", "-q", "--keep", keep, "--triangles", str(count), path, "-o", os.path.join(scratch, "out.ply")],
                   check=True)
    model_points, model_edges = read(os.path.join(keep, "03-feature.ply"))
    points, edges = read(os.path.join(keep, "12-relax.ply"))
    diagonal = math.dist(*(tuple(f(c) for c in zip(*model_points)) for f in (min, max)))
    place = {p: v for v, p in enumerate(points)}

    def joints_of(of):
        valence = {}
        for e in of:
            for v in e:
                valence[v] = valence.get(v, 0) + 1
        return {v for v, n in valence.items() if n != 2}
    joints, found = joints_of(model_edges), joints_of(edges)
    lost = [model_points[v] for v in joints if model_points[v] not in place]
    more = [points[v] for v in found if points[v] not in {model_points[w] for w in joints}]
    wrong = []
    if lost or more:
        wrong.append(f"{len(lost)} junctions and ends are lost, {len(more)} are new: {(lost + more)[0]}")
    model, result = chains_of(model_edges, joints), chains_of(edges, found)
    if len(model) != len(result):
        wrong.append(f"{len(result)} chains, the model has {len(model)}")
    farthest, most = 0.0, 0.0
    lines = [[model_points[v] for v in c] for c in model]
    boxes = [[(min(x), max(x)) for x in zip(*line)] for line in lines]
    for chain in result:
        line = [points[v] for v in chain]
        # the model's chain by its ends, or where the middle lies, which no other may hold
        near = [i for i, b in enumerate(boxes)
                if all(low - 1e-6 * diagonal <= x <= high + 1e-6 * diagonal for x, (low, high) in zip(line[len(line) // 2], b))
                and (chain[0] == chain[-1] or {line[0], line[-1]} == {lines[i][0], lines[i][-1]})]
        if len(line) == 2:  # the middle of a single segment is off an arc
            near = [i for i in range(len(lines)) if {line[0], line[-1]} == {lines[i][0], lines[i][-1]}]
        if not near:
            wrong.append(f"the chain from {line[0]} to {line[-1]} is none of the model")
            continue
        distance, i = min((max(project(p, lines[i])[0] for p in line[::max(1, len(line) // 8)]), i) for i in near)
        distance = max(project(p, lines[i])[0] for p in line)
        farthest, most = max(farthest, distance / diagonal), max(most, worst_sag(lines[i], line))
    if farthest > 1e-9:
        wrong.append(f"a vertex is {farthest:.3g} diagonals off its line")
    if most > 1.1:
        wrong.append(f"a chord is {most:.3f} times as far from its arc as it may be")
    print(f"{name}: {len(result)} chains, {len(found)} junctions, off by {farthest:.1e}, sag {most:.3f}")
    return [f"{name}: {w}" for w in wrong]


def main():
    os.environ["PATH"] = os.path.abspath(sys.argv[1]) + os.pathsep + os.environ["PATH"]
    corpus, wrong = os.environ.get("MESHPIPE_CORPUS"), []
    with tempfile.TemporaryDirectory() as scratch:
        for name, shape, count in CASES:
            path = os.path.join(scratch, name + ".msh") if shape else os.path.join(corpus or "", name)
            if shape:
                subprocess.run([*shape, "-q", "-o", path], check=True)
            elif not corpus or not os.path.exists(path):
                print(f"skipped: {name}, which MESHPIPE_CORPUS does not hold")
                continue
            elif path.endswith(".gz"):
                with gzip.open(path) as packed, open(os.path.join(scratch, name[:-3]), "wb") as plain:
                    plain.write(packed.read())
                path = plain.name
            wrong += check(name, path, count, scratch)
    print("\n".join(wrong))
    return 1 if wrong else 0


sys.exit(main())
