# SPDX-License-Identifier: BSD-3-Clause
"""Any file: shares of the statuses, times and rounds on many surfaces as they come.

usage: scripts/bench anyfile [options] [FILE ...]

Surfaces are made by number, each from its number alone: one of mshape's, a prism, a part from a lathe, a bundle of cones or
voxels (or one of the given files), to which up to three things are done: decimated, clustered, roughened, rounded to few digits, cut
by a plane, punctured, united with another, stretched, tilted, scaled, torn into a soup. One mremesh of each with its
defaults; where two were united, every other time with --resolve outer. One row for each that is not status 0 in the first
round within the time allowed, then the shares.

  --first I, --count N   the surfaces I to I + N - 1 (default 0, 200)
  --limit S              seconds until one is killed (default 60)
  --allowed S            seconds beyond which one is in the table (default 3, and 1 per 3000 triangles of the result)
  --keep DIR             the surfaces stay there
  --all                  a row for every surface
  --bin DIR              programs (default build/bin)
  --json FILE            all rows as JSON
"""
import collections
import math
import os
import random
import re
import subprocess
import tempfile

from benches import common

SHAPES = ["tube", "tube --closed", "sphere", "torus", "genus", "tree", "body --patches 22", "body --patches 60", "cube"]
MEAN = 3000  # triangles of a source


def read(path, work):
    """Points and triangles of a file, as mconvert understands it."""
    plain = os.path.join(work, "plain.off")
    subprocess.run(["mconvert", "-q", path, "-o", plain], check=True)
    with open(plain) as f:
        words = f.read().split()
    n, m = int(words[1]), int(words[2])
    numbers = list(map(float, words[4:4 + 3 * n]))
    rows = words[4 + 3 * n:]
    return [tuple(numbers[3 * i:3 * i + 3]) for i in range(n)], [tuple(map(int, rows[4 * i + 1:4 * i + 4])) for i in range(m)]


def write(path, points, triangles):
    with open(path, "w") as f:
        f.write(f"OFF\n{len(points)} {len(triangles)} 0\n")
        f.writelines("%.17g %.17g %.17g\n" % p for p in points)
        f.writelines("3 %d %d %d\n" % t for t in triangles)


def shape(rng, work):
    path = os.path.join(work, "shape.off")
    more = f" --slivers {rng.choice([0.01, 0.1])}" if rng.random() < 0.2 else ""
    more += f" --dirt {rng.choice([0.002, 0.02])}" if rng.random() < 0.1 else ""
    n = int(MEAN * 4 ** rng.uniform(-1, 1))
    subprocess.run(f"mshape -q {rng.choice(SHAPES)} --triangles {n} --seed {rng.randrange(1000)}{more} -o {path}", shell=True, check=True)
    return read(path, work)


def revolved(profile, m):
    """The profile (radius, height), both ends on the axis, revolved in m steps."""
    points = [(0.0, 0.0, profile[0][1])]
    for r, z in profile[1:-1]:
        points += [(r * math.cos(2 * math.pi * j / m), r * math.sin(2 * math.pi * j / m), z) for j in range(m)]
    points.append((0.0, 0.0, profile[-1][1]))
    last, triangles = len(points) - 1, []
    ring = len(profile) - 2
    for j in range(m):
        k = (j + 1) % m
        triangles += [(0, 1 + k, 1 + j), (last, 1 + (ring - 1) * m + j, 1 + (ring - 1) * m + k)]
        for i in range(ring - 1):
            a, b = 1 + i * m + j, 1 + i * m + k
            triangles += [(a, b, b + m), (a, b + m, a + m)]
    return points, triangles


def lathe(rng, _):
    """A part from a lathe: cylinders, cones, chamfers, grooves, some very narrow."""
    profile, r, z = [(0.0, 0.0)], rng.uniform(0.5, 1), 0.0
    profile.append((r, z))
    for _ in range(rng.randrange(1, 7)):
        z += 10 ** rng.uniform(-3, 0)
        profile.append((r, z))
        r = max(0.05, r + rng.choice([-1, 1]) * 10 ** rng.uniform(-3, -0.3))
        if rng.random() < 0.4:
            z += 10 ** rng.uniform(-3, -0.5)
        profile.append((r, z))
    return revolved([*profile, (0.0, z)], rng.choice([6, 16, 24, 48, 90]))


def prism(rng, _):
    """A star-shaped profile with teeth or steps, extruded; the long triangles of CAD."""
    n, outline = rng.randrange(3, 40), []
    teeth, flat = rng.random() < 0.5, 10 ** rng.uniform(-3, -0.3)
    for i in range(n):
        a, r = 2 * math.pi * i / n, rng.uniform(0.6, 1)
        outline.append((r * math.cos(a), r * math.sin(a)))
        if teeth:
            b = a + 2 * math.pi / n * flat
            outline.append((r * math.cos(b), r * math.sin(b)))
    height, k = 10 ** rng.uniform(-2.5, 0.7), len(outline)
    points = [(x, y, z) for z in (0.0, height) for x, y in outline] + [(0.0, 0.0, 0.0), (0.0, 0.0, height)]
    triangles = []
    for i in range(k):
        j = (i + 1) % k
        triangles += [(i, j, k + j), (i, k + j, k + i), (2 * k, j, i), (2 * k + 1, k + i, k + j)]
    return points, triangles


def cones(rng, _):
    """Thin cones from one place: they cross near the apex."""
    meshes = []
    for _ in range(rng.randrange(2, 6)):
        thick = 10 ** rng.uniform(-1.5, -0.3)
        meshes.append(tilted(revolved([(0.0, 0.0), (thick, 1.0), (0.0, 1.0)], rng.choice([5, 12, 32])), rng))
    return joined(meshes)


def voxels(rng, _):
    """A random blob of voxels with its inner edges and corners, some of more than two sides."""
    n = rng.randrange(3, 9)
    cells = {(i, j, k) for i in range(n) for j in range(n) for k in range(n) if rng.random() < 0.3 + 0.5 * (abs(i - n / 2) < n / 4)}
    cells = cells or {(0, 0, 0)}
    number, points, triangles = {}, [], []
    for c in sorted(cells):
        for axis in range(3):
            for side in (0, 1):
                if tuple(v + (2 * side - 1) * (a == axis) for a, v in enumerate(c)) in cells:
                    continue
                corners = []
                for p, q in ((0, 0), (1, 0), (1, 1), (0, 1)):
                    at = list(c)
                    at[axis] += side
                    at[(axis + 1) % 3] += p
                    at[(axis + 2) % 3] += q
                    if tuple(at) not in number:
                        number[tuple(at)] = len(points)
                        points.append(tuple(map(float, at)))
                    corners.append(number[tuple(at)])
                a, b, c2, d = corners if side else corners[::-1]
                triangles += [(a, b, c2), (a, c2, d)]
    return points, triangles


def joined(meshes):
    points, triangles = [], []
    for p, t in meshes:
        triangles += [tuple(v + len(points) for v in x) for x in t]
        points += p
    return points, triangles


def box(points):
    low = [min(p[a] for p in points) for a in range(3)]
    high = [max(p[a] for p in points) for a in range(3)]
    return low, high, math.dist(low, high)


def mean_edge(mesh):
    points, triangles = mesh
    return sum(math.dist(points[t[0]], points[t[1]]) for t in triangles) / max(1, len(triangles))


def tilted(mesh, rng):
    q = [rng.gauss(0, 1) for _ in range(4)]
    w, x, y, z = (v / math.hypot(*q) for v in q)
    m = ((1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
         (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
         (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)))
    return [tuple(sum(r[a] * p[a] for a in range(3)) for r in m) for p in mesh[0]], mesh[1]


def stretched(mesh, rng):
    s = [10 ** rng.uniform(-0.7, 0.7) for _ in range(3)]
    return [tuple(a * b for a, b in zip(p, s)) for p in mesh[0]], mesh[1]


def scaled(mesh, rng):
    s, o = 10 ** rng.uniform(-4, 4), 10 ** rng.uniform(-1, 3)
    return [tuple(s * (c + o) for c in p) for p in mesh[0]], mesh[1]


def roughened(mesh, rng):
    """Noise as a scanner makes it, or on few points only."""
    e, share = mean_edge(mesh) * 10 ** rng.uniform(-4, -0.7), rng.choice([1, 1, 0.01])
    return [tuple(c + rng.uniform(-e, e) for c in p) if rng.random() < share else p for p in mesh[0]], mesh[1]


def rounded(mesh, rng):
    digits = rng.choice([2, 3, 4, 6])
    return [tuple(float(f"%.{digits}g" % c) for c in p) for p in mesh[0]], mesh[1]


def clustered(mesh, rng):
    """Points in a cube of a grid become the first of them; sheets may meet."""
    side, first = mean_edge(mesh) * rng.uniform(0.3, 2), {}
    image = [first.setdefault(tuple(math.floor(c / side) for c in p), v) for v, p in enumerate(mesh[0])]
    triangles = [tuple(image[v] for v in t) for t in mesh[1]]
    return mesh[0], [t for t in triangles if len(set(t)) == 3] or mesh[1]


def decimated(mesh, rng):
    """Random edges are collapsed into one of their ends, where the topology stays; no other point moves."""
    triangles = dict(enumerate(mesh[1]))
    star = [set() for _ in mesh[0]]
    for i, t in triangles.items():
        for v in t:
            star[v].add(i)
    edges = sorted({(t[i], t[j]) for t in mesh[1] for i, j in ((0, 1), (1, 2), (2, 0))})
    least = len(triangles) * rng.choice([0.5, 0.2, 0.1])
    for a, b in rng.sample(edges, len(edges)):
        if len(triangles) <= least:
            break
        common = star[a] & star[b]
        ring = [{v for i in star[x] for v in triangles[i]} - {a, b} for x in (a, b)]
        if not common or len(ring[0] & ring[1]) != len(common) or len(star[b]) == len(common) or len(star[a]) < 4 or len(star[b]) < 4:
            continue
        for i in common:
            for v in triangles.pop(i):
                star[v].discard(i)
        for i in star[b]:
            triangles[i] = tuple(a if v == b else v for v in triangles[i])
        star[a] |= star[b]
        star[b] = set()
    return mesh[0], list(triangles.values())


def cut(mesh, rng):
    """What is on one side of a plane, with all the slivers that this makes."""
    points, triangles = list(mesh[0]), []
    low, high, _ = box(points)
    normal = [rng.gauss(0, 1) for _ in range(3)]
    middle = [a + (b - a) * rng.uniform(0.3, 0.7) for a, b in zip(low, high)]
    height = [sum(n * (c - m) for n, c, m in zip(normal, p, middle)) for p in points]
    between = {}

    def crossing(a, b):
        a, b = min(a, b), max(a, b)
        if (a, b) not in between:
            t = height[a] / (height[a] - height[b])
            between[a, b] = len(points)
            points.append(tuple((1 - t) * x + t * y for x, y in zip(points[a], points[b])))
        return between[a, b]

    for t in mesh[1]:
        ring = []
        for i in range(3):
            a, b = t[i], t[(i + 1) % 3]
            if height[a] > 0:
                ring.append(a)
            if (height[a] > 0) != (height[b] > 0):
                ring.append(crossing(a, b))
        triangles += [(ring[0], ring[i], ring[i + 1]) for i in range(1, len(ring) - 1)]
    return (points, triangles) if triangles else mesh


def punctured(mesh, rng):
    low, high, diagonal = box(mesh[0])
    balls = [(rng.choice(mesh[0]), diagonal * 10 ** rng.uniform(-2, -0.7)) for _ in range(rng.randrange(1, 5))]
    left = [t for t in mesh[1] if all(math.dist(mesh[0][t[0]], c) > r for c, r in balls)]
    return mesh[0], left or mesh[1]


def torn(mesh, rng):
    """Every triangle with points of its own, in another order, some reversed."""
    points, triangles, flips = [], [], rng.choice([0, 0, 0.1])
    for t in rng.sample(mesh[1], len(mesh[1])):
        n = len(points)
        points += [mesh[0][v] for v in t]
        triangles.append((n, n + 2, n + 1) if rng.random() < flips else (n, n + 1, n + 2))
    return points, triangles


def united(mesh, rng, work):
    """With another, about as large, that it meets."""
    other = source(rng, work)
    low, high, diagonal = box(mesh[0])
    low2, high2, diagonal2 = box(other[0])
    s = diagonal / diagonal2 * rng.uniform(0.3, 1)
    move = [a + (b - a) * rng.uniform(0, 1) for a, b in zip(low, high)]
    middle = [(a + b) / 2 for a, b in zip(low2, high2)]
    return joined([mesh, ([tuple(m + s * (c - d) for c, d, m in zip(p, middle, move)) for p in other[0]], other[1])])


def source(rng, work):
    return rng.choice([shape, shape, shape, lathe, prism, cones, voxels])(rng, work)


def make(number, files, work):
    """Surface `number`, the words that say what it is, and the options it is remeshed with."""
    rng = random.Random(number)
    if files:
        path = files[number % len(files)]
        mesh, what = read(path, work), [os.path.basename(path)]
    else:
        made = rng.choice([shape, shape, shape, lathe, prism, cones, voxels])
        mesh, what = made(rng, work), [made.__name__]
    options = ""
    done = rng.sample([decimated, clustered, roughened, rounded, cut, punctured, united, stretched, tilted, scaled, torn], rng.randrange(files != [], 4))
    for do in sorted(done, key=lambda f: f is torn):
        what.append(do.__name__)
        mesh = do(mesh, rng, work) if do is united else do(mesh, rng)
        if do is united and rng.random() < 0.5:
            options = " --resolve outer"
    return mesh, what, options


def main(words):
    p = common.parser(__doc__)
    p.add_argument("--first", type=int, default=0)
    p.add_argument("--count", type=int, default=200)
    p.add_argument("--limit", type=float, default=60)
    p.add_argument("--allowed", type=float, default=3)
    p.add_argument("--keep")
    p.add_argument("--all", action="store_true")
    args = common.parse(p, words)
    rows, statuses = [], collections.Counter()
    with tempfile.TemporaryDirectory() as work:
        row = common.table(["surface", "what", "in", "out", "status", "rounds", "s", "message"])
        for number in range(args.first, args.first + args.count):
            mesh, what, options = make(number, args.files, work)
            os.makedirs(args.keep or work, exist_ok=True)
            path = os.path.join(args.keep or work, f"{number}.off")
            write(path, *mesh)
            out = os.path.join(work, "out.off")
            run = common.run(f"mremesh -j1{options} '{path}' -o '{out}'", timeout=args.limit)
            errors = re.findall(r"^.*error: (.*)$", run.text, re.M)
            found = re.findall(r"(\d+) triangles, kappa mean", run.text)
            figures = {"surface": number, "what": " ".join(what) + options, "in": len(mesh[1]), "out": int(found[-1]) if found else 0,
                       "status": run.status, "rounds": 1 + len(re.findall(r"^mremesh: round", run.text, re.M)),
                       "seconds": run.cpu, "message": errors[-1] if errors else ""}
            figures["late"] = run.cpu > args.allowed + figures["out"] / 3000
            statuses[run.status] += 1
            rows.append(figures)
            if args.all or run.status or figures["rounds"] > 1 or figures["late"]:
                row(number, figures["what"], figures["in"], figures["out"], run.status, figures["rounds"], f"{run.cpu:.1f}", figures["message"][:200])
    n = len(rows)
    share = lambda k: f"{k} ({100 * k / max(1, n):.0f} %)"
    print(f"\n{n} surfaces; " + ", ".join(f"{'killed' if s < 0 else f'status {s}'}: {share(k)}" for s, k in sorted(statuses.items())))
    print(f"first round: {share(sum(r['rounds'] == 1 and r['status'] == 0 for r in rows))}; late: {share(sum(r['late'] for r in rows))}; "
          f"{sum(r['seconds'] for r in rows):.0f} s of CPU, {max((r['seconds'] for r in rows), default=0):.1f} at most")
    common.save(args, rows)
    return 0
