#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Charts are one-to-one: checked on the streams that mparam writes, in integers, by nothing of the library.

usage: tests/charts_test.py BIN_DIR [corpus]

Every chart triangle has positive area and the loops of every chart are simple polygons that do not meet, one of them
counter-clockwise; of generated parts with slivers, noise, holes, all scales, and of surfaces through the whole chain, for
all three maps. With `corpus`, of the surfaces in the directory $MESHPIPE_CORPUS instead; exits 77 (skipped) without it.
"""
import gzip
import math
import os
import random
import subprocess
import sys
import tempfile

MAPS = ["conformal", "harmonic", "convex"]
failed = 0


def fail(text):
    global failed
    failed += 1
    print("FAILED:", text, flush=True)


def read_stream(path):
    """Tables of an mply file in text: name -> rows of words."""
    text = subprocess.run(["mconvert", "-q", "--ascii", path, "-o", "-"], check=True, capture_output=True, text=True).stdout
    head, _, body = text.partition("end_header\n")
    rows, tables, at = body.split("\n"), {}, 0
    for line in head.split("\n"):
        words = line.split()
        if words[:1] == ["element"]:
            n = int(words[2])
            tables[words[1]] = rows[at : at + n]
            at += n
            columns = tables.setdefault(words[1] + " columns", [])
        elif words[:1] == ["property"]:
            columns.extend(["a", "b", "c"] if words[1] == "list" else [words[-1]])
    return tables


def integers(values):
    """Floats as exact multiples of one power of two."""
    pairs = [v.as_integer_ratio() for v in values]
    shift = max((den.bit_length() for _, den in pairs), default=1)
    return [num << (shift - den.bit_length()) for num, den in pairs]


def turn(a, b, c):
    d = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    return (d > 0) - (d < 0)


def between(a, b, p):
    return min(a[0], b[0]) <= p[0] <= max(a[0], b[0]) and min(a[1], b[1]) <= p[1] <= max(a[1], b[1])


def meet(s, t, uv):
    """Whether two border edges meet elsewhere than at a common end."""
    common = {s[0], s[1]} & {t[0], t[1]}
    a, b, c, d = (uv[v] for v in (*s, *t))
    if len(common) == 2:
        return True
    if len(common) == 1:
        o = common.pop()
        p, q = uv[s[0] + s[1] - o], uv[t[0] + t[1] - o]
        o = uv[o]
        along = (p[0] - o[0]) * (q[0] - o[0]) + (p[1] - o[1]) * (q[1] - o[1])
        return turn(o, p, q) == 0 and along > 0
    if turn(a, b, c) * turn(a, b, d) < 0 and turn(c, d, a) * turn(c, d, b) < 0:
        return True
    return any(
        turn(p, q, r) == 0 and between(p, q, r) for p, q, r in ((a, b, c), (a, b, d), (c, d, a), (c, d, b))
    )


def chart_faults(tris, uv):
    """What is wrong with one chart: triangles of vertices, uv: vertex -> (integer, integer)."""
    bad = sum(turn(uv[a], uv[b], uv[c]) <= 0 for a, b, c in tris)
    if bad:
        return f"{bad} of {len(tris)} triangles inverted or flat"
    edges = {e for a, b, c in tris for e in ((a, b), (b, c), (c, a))}
    border = [(a, b) for a, b in edges if (b, a) not in edges]
    follow = dict(border)
    if len(follow) != len(border):
        return "the border is pinched"
    loops, left = [], set(follow)
    while left:
        loop = [left.pop()]
        while follow[loop[-1]] != loop[0]:
            loop.append(follow[loop[-1]])
            left.discard(loop[-1])
        loops.append(loop)
    area = [sum(uv[p][0] * uv[q][1] - uv[p][1] * uv[q][0] for p, q in zip(l, l[1:] + l[:1])) for l in loops]
    if sum(a > 0 for a in area) != 1:
        return f"{sum(a > 0 for a in area)} of {len(loops)} loops counter-clockwise"
    boxes = sorted(
        (min(uv[a][0], uv[b][0]), max(uv[a][0], uv[b][0]), min(uv[a][1], uv[b][1]), max(uv[a][1], uv[b][1]), a, b)
        for a, b in border
    )
    active = []
    for box in boxes:
        active = [o for o in active if o[1] >= box[0]]
        for o in active:
            if o[2] <= box[3] and o[3] >= box[2] and meet(box[4:], o[4:], uv):
                return f"border edges {box[4:]} and {o[4:]} meet"
        active.append(box)
    return None


def check(path, name):
    """Checks every chart of a stream; returns (charts, triangles)."""
    tables = read_stream(path)
    part = tables["face columns"].index("part") + 1
    tris = {}
    for row in tables["face"]:
        words = row.split()
        tris.setdefault(int(words[part]), []).append((int(words[1]), int(words[2]), int(words[3])))
    uv = {}
    columns = tables["chart_vertex columns"]
    p, v, x, y = (columns.index(c) for c in ("part", "vertex", "u", "v"))
    for row in tables["chart_vertex"]:
        words = row.split()
        uv.setdefault(int(words[p]), []).append((int(words[v]), float(words[x]), float(words[y])))
    if set(uv) != set(tris) or len(tables["part"]) != len(tris):
        fail(f"{name}: {len(tris)} parts, {len(uv)} charts, {len(tables['part'])} rows")
        return 0, 0
    for k in sorted(tris):
        numbers = integers([c for r in uv[k] for c in r[1:]])
        places = {r[0]: (numbers[2 * i], numbers[2 * i + 1]) for i, r in enumerate(uv[k])}
        if set(places) != {w for t in tris[k] for w in t}:
            fail(f"{name}: chart {k} has other vertices than its part")
            continue
        fault = chart_faults(tris[k], places)
        if fault:
            fail(f"{name}: chart {k}: {fault}")
    return len(tris), sum(map(len, tris.values()))


def one_part(rng):
    """A curved sheet or a tube (eta up to 4, one end closed or none) with holes, noise and slivers, at any scale."""
    tube = rng.random() < 0.5
    n, m = rng.randint(8, 14), rng.randint(6, 14)
    eta, closed = rng.uniform(0.3, 4), rng.random() < 0.5
    if tube:
        m = max(4, min(20, int(n * eta / math.pi)))
    points, tris = [], []
    columns = n if tube else n + 1
    bend = rng.uniform(0, 2.5)
    for j in range(m + 1):
        for i in range(columns):
            s, t = i / n, j / m
            if tube:
                a = -2 * math.pi * s
                points.append([0.5 * math.cos(a), 0.5 * math.sin(a), eta * t])
            else:
                points.append([math.sin(bend * s) / max(bend, 0.1), t, (1 - math.cos(bend * s)) / max(bend, 0.1)])
    for j in range(m):
        for i in range(n):
            a, b = j * columns + i, j * columns + (i + 1) % columns
            c, d = b + columns, a + columns
            tris += [(a, b, c), (a, c, d)] if (i + j) % 2 else [(a, b, d), (b, c, d)]
    if tube and closed:
        points.append([0, 0, eta])
        tris += [(m * columns + i, m * columns + (i + 1) % n, len(points) - 1) for i in range(n)]
    edge = 1.0 / n
    noise = rng.uniform(0, 0.35) * edge
    for p in points:
        for k in range(3):
            p[k] += rng.uniform(-noise, noise)
    # holes: the stars of inner vertices that share no vertex
    star = {}
    for t in tris:
        for v in t:
            star.setdefault(v, []).append(t)
    edges = {e for a, b, c in tris for e in ((a, b), (b, c), (c, a))}
    taken = {a for a, b in edges if (b, a) not in edges} | {b for a, b in edges if (b, a) not in edges}
    gone, holes = set(), rng.randint(0, 30)
    for v in rng.sample(sorted(star), len(star)):
        ring = {w for t in star[v] for w in t}
        if len(gone) >= holes or ring & taken:
            continue
        gone.add(v)
        taken |= ring
    tris = [t for t in tris if not gone & set(t)]
    # slivers: a quarter of the edges split close to one end
    owner = {}
    for k, (a, b, c) in enumerate(tris):
        owner[a, b], owner[b, c], owner[c, a] = k, k, k
    touched = set()
    pairs = [e for e in owner if e[0] < e[1] and (e[1], e[0]) in owner]
    rng.shuffle(pairs)
    for a, b in pairs[: len(pairs) // 4]:
        k, l = owner[a, b], owner[b, a]
        if {k, l} & touched:
            continue
        touched |= {k, l}
        c = next(v for v in tris[k] if v not in (a, b))
        d = next(v for v in tris[l] if v not in (a, b))
        x = 10 ** rng.uniform(-4, -1)
        points.append([(1 - x) * p + x * q for p, q in zip(points[a], points[b])])
        p = len(points) - 1
        tris[k], tris[l] = (a, p, c), (b, p, d)
        tris += [(p, b, c), (p, a, d)]
    scale = 10 ** rng.uniform(-7, 6)
    used = {v: i for i, v in enumerate(sorted({v for t in tris for v in t}))}
    return [[scale * x for x in points[v]] for v in used], [tuple(used[v] for v in t) for t in tris]


def strip(rng):
    """One row of triangles, all of them ears or with two vertices between ears, with coordinates of all magnitudes."""
    n = rng.randint(3, 250)
    points = [[x * 10 ** rng.uniform(-6, 0) for x in (0.5 * i, i % 2, rng.uniform(0, 0.3))] for i in range(n)]
    return points, [(i + i % 2, i + 1 - i % 2, i + 2) for i in range(n - 2)]


def write_parts(path, count, seed, make=one_part):
    rng = random.Random(seed)
    points, faces = [], []
    for part in range(count):
        p, t = make(rng)
        faces += [f"3 {a + len(points)} {b + len(points)} {c + len(points)} {part}" for a, b, c in t]
        points += p
    with open(path, "w") as f:
        f.write("ply\nformat ascii 1.0\ncomment mply 1.0\n")
        f.write(f"element vertex {len(points)}\nproperty double x\nproperty double y\nproperty double z\n")
        f.write(f"element face {len(faces)}\nproperty list uchar int vertex_indices\nproperty int part\nend_header\n")
        f.writelines(f"{p[0]!r} {p[1]!r} {p[2]!r}\n" for p in points)
        f.write("\n".join(faces) + "\n")


def all_maps(parts, name, work, more={}):
    """mparam with every map, and the check of its result."""
    for kind in MAPS:
        for options in [[], *more.get(kind, [])]:
            out = os.path.join(work, "charts.ply")
            label = " ".join([name, kind, *options])
            run = subprocess.run(["mparam", "-q", "--map", kind, *options, parts, "-o", out], capture_output=True, text=True)
            if run.returncode:
                fail(f"{label}: status {run.returncode}: {run.stderr.strip()}")
                continue
            charts, triangles = check(out, label)
            print(f"{label}: {charts} charts, {triangles} triangles", flush=True)


def through_chain(source, parts):
    clean = os.path.join(os.path.dirname(parts), "clean.ply")
    command = (
        f"set -o pipefail; (mclean -q {source} -o {clean} 2>/dev/null || mclean -q --drop-nonorientable {source} -o {clean}) &&"
        f" mtopo -q {clean} | mfeature -q | mpartition -q | mmultiscale -q -o {parts}"
    )
    return subprocess.run(["bash", "-c", command], capture_output=True, text=True)


def generated(work):
    parts = os.path.join(work, "parts.ply")
    write_parts(parts, 500, 1)
    more = {
        "conformal": [["--optimize", "3"], ["--conformal", "least-squares"], ["--conformal", "spectral"]],
        "harmonic": [["--boundary", "neumann"]],
        "convex": [["--weights", "uniform"], ["--weights", "mean-value"]],
    }
    all_maps(parts, "500 parts", work, more)
    write_parts(parts, 60, 2, strip)
    all_maps(parts, "60 strips", work)
    for name, shape in [
        ("tree", "tree --triangles 4000 --slivers 0.25"),
        ("body", "body --triangles 1200"),
        ("genus 3", "genus --genus 3 --triangles 3000 --noise 0.2"),
    ]:
        source = os.path.join(work, "shape.ply")
        subprocess.run(["mshape", *shape.split(), "-q", "-o", source], check=True)
        run = through_chain(source, parts)
        if run.returncode:
            fail(f"{name}: {run.stderr.strip()}")
        else:
            all_maps(parts, name, work)
    # the paper's Fig. 2: the single harmonic map of a long jittered tube is not one-to-one, and is refused
    source = os.path.join(work, "tube.ply")
    subprocess.run("mshape tube --aspect 25 --triangles 8000 --noise 0.2 -q".split() + ["-o", source], check=True)
    subprocess.run(f"mclean -q {source} | mtopo -q | mpartition -q -o {parts}", shell=True, check=True)
    strict = ["mparam", "--strict", "--map", "harmonic", parts, "-o", os.path.join(work, "none.ply")]
    run = subprocess.run(strict, capture_output=True, text=True)
    print(run.stderr.strip())
    words = run.stderr.split("not one-to-one: ")
    if run.returncode != 5 or len(words) != 2 or int(words[1].split()[0]) < 100:
        fail(f"status {run.returncode} for the harmonic map of a long tube: {run.stderr.strip()}")
    if os.path.exists(os.path.join(work, "none.ply")):
        fail("a refused map was written")


def corpus(work):
    folder = os.environ.get("MESHPIPE_CORPUS", "")
    if not os.path.isdir(folder):
        print("skipped: set MESHPIPE_CORPUS to a directory of surfaces")
        sys.exit(77)
    for name in sorted(os.listdir(folder)):
        if name.rsplit(".", 1)[-1] not in ("stl", "obj", "off", "ply", "msh", "gz"):
            continue
        source, parts = os.path.join(work, "source"), os.path.join(work, "parts.ply")
        data = open(os.path.join(folder, name), "rb").read()
        with open(source, "wb") as f:
            f.write(gzip.decompress(data) if name.endswith(".gz") else data)
        run = through_chain(source, parts)
        if run.returncode:
            print(f"{name}: not admitted: {run.stderr.strip()}")
        else:
            all_maps(parts, name, work)


def main():
    os.environ["PATH"] = os.path.abspath(sys.argv[1]) + os.pathsep + os.environ["PATH"]
    with tempfile.TemporaryDirectory() as work:
        corpus(work) if sys.argv[2:] == ["corpus"] else generated(work)
    print(f"{failed} failed")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
