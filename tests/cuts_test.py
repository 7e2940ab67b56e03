#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Cuts are what they should be: checked on the streams that mpartition and mmultiscale write, by nothing of the library.

usage: tests/cuts_test.py BIN_DIR [corpus]

The parts together are the input's surface: every vertex in place, every triangle the sum of its pieces, which keep its
patch. Every part is in one piece, touches itself nowhere, has genus 0 and a boundary, and is not too long. There are as
few parts as the surface allows: the faces that model edges bound, and few more. Away from creases, nine in ten vertices of the cuts turn by 25 degrees at most on the
surface. Between a cut and a crease or border lies no sliver of a region. Of generated surfaces; with `corpus`, of those
in the directory $MESHPIPE_CORPUS instead; exits 77 (skipped) without it.
"""
import gzip
import math
import os
import subprocess
import sys
import tempfile

from charts_test import read_stream

# arguments of mshape; most parts, beyond the faces where there are several
GENERATED = {
    "tube-25": ("tube --aspect 25 --triangles 16750 --noise 0.1", 2),
    "tube-100": ("tube --aspect 100 --triangles 20000 --noise 0.1 --slivers 0.05", 2),
    "aorta": ("tree --outlets 13 --triangles 30000", 2),
    "airways": ("tree --outlets 147 --triangles 88000", 2),
    "torus": ("genus --genus 1 --triangles 4000", 2),
    "genus-3": ("genus --genus 3 --triangles 10000 --noise 0.2 --slivers 0.05", 5),
    "genus-8": ("genus --genus 8 --triangles 20000", 10),
    "body": ("body", 10),
}
CORPUS = {
    "airway_ct_subject002_90k.stl": 3,
    "aorta_medlib.stl": 2,
    "botijo.off": 7,
    "bunny_stanford.obj": 2,
    "cad_linkrods.msh": 4,
    "cgal_cheese.off": 135,
    "feline_50k.obj": 4,
    "gmsh_AORTA_msh40.msh": 2,
    "gmsh_aorta2.stl": 2,
    "gmsh_bypass.stl": 3,
    "gmsh_cerebral.stl": 2,
    "gmsh_king_ascii.stl.gz": 18,
    "gmsh_mob.stl": 4,
    "gmsh_mobilette_class.msh": 4,
    "gmsh_pelvisHEMI.stl.gz": 3,
    "gmsh_skullU.stl": 4,
    "of_flange.stl.gz": 6,
    "pelvis_genus8.stl": 10,
    "plane_holes.obj": 2,
    "torus.obj": 2,
}
SHARP = math.radians(40)
failed = 0


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def norm(a):
    return math.sqrt(dot(a, a))


def angle(a, b):
    return math.atan2(norm(cross(a, b)), dot(a, b))


class Surface:
    def __init__(self, path):
        tables = read_stream(path)
        self.words = [row.split()[:3] for row in tables["vertex"]]
        self.points = [tuple(map(float, w)) for w in self.words]
        self.tris, self.face = [], {c: [] for c in tables["face columns"] if c not in "abc"}
        for row in tables["face"]:
            w = row.split()
            self.tris.append((int(w[1]), int(w[2]), int(w[3])))
            for values, word in zip(self.face.values(), w[4:]):
                values.append(int(word))
        self.parts = [dict(zip(tables.get("part columns", ()), row.split())) for row in tables.get("part", ())]
        self.triangle = {(t[i], t[(i + 1) % 3]): (k, i) for k, t in enumerate(self.tris) for i in range(3)}

    def area_vector(self, k):
        a, b, c = (self.points[v] for v in self.tris[k])
        return cross(sub(b, a), sub(c, a))

    def length(self, a, b):
        return norm(sub(self.points[b], self.points[a]))

    def is_model(self, k, i):
        return "model" in self.face and self.face["model"][k] >> i & 1


def union_faults(before, after):
    """What differs between a surface and the pieces it was cut into."""
    n = len(before.words)
    if after.words[:n] != before.words:
        yield "vertices have moved"
    gap = [norm(before.area_vector(k)) for k in range(len(before.tris))]
    total = sum(gap)
    for k, origin in enumerate(after.face["origin"]):
        gap[origin] -= norm(after.area_vector(k))
        if dot(after.area_vector(k), before.area_vector(origin)) < 0:
            yield f"triangle {k} is inverted"
        if "patch" in after.face and after.face["patch"][k] != before.face["patch"][origin]:
            yield f"triangle {k} has patch {after.face['patch'][k]}, not {before.face['patch'][origin]}"
    if sum(map(abs, gap)) > 1e-12 * total:
        yield f"the areas differ by {sum(map(abs, gap)) / total:.3g}"


def part_faults(s):
    """What is wrong with the parts."""
    part, members = s.face["part"], {}
    for k, p in enumerate(part):
        members.setdefault(p, []).append(k)
    if sorted(members) != list(range(len(s.parts))):
        yield f"parts {sorted(members)}, {len(s.parts)} rows"
        return
    for p, ks in members.items():
        seen, stack = {ks[0]}, [ks[0]]
        edges, border, vertices = 0, {}, set()
        while stack:
            k = stack.pop()
            vertices.update(s.tris[k])
            for i in range(3):
                a, b = s.tris[k][i], s.tris[k][(i + 1) % 3]
                other = s.triangle.get((b, a), (None, 0))[0]
                if other is None or part[other] != p:
                    edges += 2
                    if a in border:
                        yield f"part {p} touches itself at vertex {a}"
                        return
                    border[a] = b
                else:
                    edges += 1
                    if other not in seen:
                        seen.add(other)
                        stack.append(other)
        loops, left = 0, dict(border)
        while left:
            loops += 1
            v = next(iter(left))
            while v in left:
                v = left.pop(v)
        genus = (2 - (len(vertices) - edges // 2 + len(seen)) - loops) / 2
        eta = float(s.parts[p]["eta_geo"])
        if len(seen) != len(ks) or genus != 0 or loops < 1 or eta > 4:
            yield f"part {p}: {len(ks) - len(seen)} triangles apart, genus {genus}, {loops} loops, aspect ratio {eta}"


def turning_angle(s):
    """The 90 % quantile of the angles by which the cuts turn on the surface, away from creases, in degrees."""
    part, on_crease, at = s.face["part"], set(), {}
    for (a, b), (k, i) in s.triangle.items():
        other = s.triangle.get((b, a))
        if other and part[k] != part[other[0]]:
            at.setdefault(a, []).append((a, b))
            if s.is_model(k, i) or angle(s.area_vector(k), s.area_vector(other[0])) > SHARP:
                on_crease.update((a, b))
    turning = []
    for v, leaving in at.items():
        if len(leaving) != 2 or v in on_crease:
            continue
        sides, side, edge = [0, 0], 0, leaving[0]
        for _ in range(1000):
            k, i = s.triangle[edge]
            a, b, c = (s.points[s.tris[k][(i + j) % 3]] for j in range(3))
            sides[side] += angle(sub(b, a), sub(c, a))
            edge = (v, s.tris[k][(i + 2) % 3])
            side |= edge == leaving[1]
            if edge not in s.triangle or edge == leaving[0]:
                break
        if edge == leaving[0]:
            turning.append(math.pi * abs(sides[0] - sides[1]) / sum(sides))
    turning.sort()
    return math.degrees(turning[len(turning) * 9 // 10]) if turning else 0


def regions(s, label):
    """Regions bounded by creases, borders and changes of label: (area, perimeter, triangles) each."""
    seen = set()
    for start in range(len(s.tris)):
        if start in seen:
            continue
        seen.add(start)
        stack, area, perimeter, ks = [start], 0, 0, []
        while stack:
            k = stack.pop()
            ks.append(k)
            area += norm(s.area_vector(k)) / 2
            for i in range(3):
                a, b = s.tris[k][i], s.tris[k][(i + 1) % 3]
                other = s.triangle.get((b, a), (None, 0))[0]
                if other is None or s.is_model(k, i) or label[other] != label[k]:
                    perimeter += s.length(a, b)
                elif other not in seen:
                    seen.add(other)
                    stack.append(other)
        yield area, perimeter, ks


def slivers(before, after):
    """Regions thinner than a third of the input's triangles there, between a cut and what else bounds them: their width,
    as a share of the mean height of those, and number of triangles."""

    def height(k):
        edges = [before.length(before.tris[k][i - 1], before.tris[k][i]) for i in range(3)]
        return norm(before.area_vector(k)) / max(edges)

    whole = {}  # of the triangles of the input: the area of their region
    for area, _, ks in regions(before, [0] * len(before.tris)):
        whole.update((k, area) for k in ks)
    for area, perimeter, ks in regions(after, after.face["part"]):
        origins = {after.face["origin"][k] for k in ks}
        if area > 0.999 * whole[next(iter(origins))]:
            continue  # bounded by creases alone
        width = 2 * area / perimeter / (sum(map(height, origins)) / len(origins))
        if width < 0.33:
            yield width, len(ks)


def check(name, path, most):
    global failed
    work = os.path.dirname(path)
    at = {k: os.path.join(work, k) for k in ("clean.ply", "parts.ply", "cut.ply")}
    chain = f"""mclean -q '{path}' | mtopo -q | mfeature -q -o {at['clean.ply']} && mpartition -q {at['clean.ply']} -o {at['parts.ply']} &&
        mmultiscale -q {at['parts.ply']} -o {at['cut.ply']}"""
    done = subprocess.run(["bash", "-o", "pipefail", "-c", chain], capture_output=True, text=True)
    if done.returncode:
        print(f"FAILED: {name}: {done.stderr.strip()}")
        failed += 1
        return
    before, after = Surface(at["clean.ply"]), Surface(at["cut.ply"])
    faults = [*union_faults(before, after), *part_faults(after)]
    turning = turning_angle(after)
    faces = len(list(regions(before, [0] * len(before.tris))))
    if len(after.parts) > (most if faces == 1 else faces + most):
        faults.append(f"{len(after.parts)} parts, {faces} faces, {most} more than those would do")
    if turning > 25:
        faults.append(f"the cuts turn by {turning:.1f} degrees")
    faults += [f"a region of {n} triangles next to a cut, {width:.3f} of theirs wide" for width, n in slivers(before, after)]
    for fault in faults[:5]:
        print(f"FAILED: {name}: {fault}")
    failed += len(faults)
    print(f"{name}: {len(after.parts)} parts of {len(after.tris)} triangles, turning {turning:.1f}", flush=True)


def main():
    os.environ["PATH"] = os.path.abspath(sys.argv[1]) + os.pathsep + os.environ["PATH"]
    with tempfile.TemporaryDirectory() as work:
        path = os.path.join(work, "in")
        if sys.argv[2:] == ["corpus"]:
            corpus = os.environ.get("MESHPIPE_CORPUS")
            if not corpus:
                print("skipped: set MESHPIPE_CORPUS to a directory of surfaces")
                return 77
            for name, most in CORPUS.items():
                source = os.path.join(corpus, name)
                if not os.path.exists(source):
                    continue
                with (gzip.open if name.endswith(".gz") else open)(source, "rb") as f, open(path, "wb") as g:
                    g.write(f.read())
                check(name, path, most)
        else:
            for name, (shape, most) in GENERATED.items():
                subprocess.run(["mshape", *shape.split(), "-q", "-o", path + ".ply"], check=True)
                check(name, path + ".ply", most)
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
