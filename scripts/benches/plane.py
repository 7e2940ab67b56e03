# SPDX-License-Identifier: BSD-3-Clause
"""The plane meshers: what each makes of the same lines before mrelax, and its rate, next to Gmsh's.

usage: scripts/bench plane [options] [FILE[:TRIANGLES] ...]

Without files, surfaces made by mshape are used. The rate is triangles per second of a core, for meshing in the plane alone:
the rate that mmesh2d -v reports, and the CPU time that Gmsh prints for "meshing 2D" of the same surface by the same algorithm at the
same edge length (its map of the surface is not counted, as ours is not). Edge lengths are over the size asked for.

  --runs N                 runs of each mesher; the median rate is shown (default 3, Gmsh once)
  --gmsh COMMAND           Gmsh 4 (default gmsh; left out if it is not there)
  --evaluator COMMAND      prints key=value lines, called with INPUT RESULT, in place of mcheck
  --timeout S              seconds for one run of Gmsh (default 300)
  --bin DIR                programs (default build/bin)
  --json FILE              the same figures as JSON
"""
import math
import os
import re
import shutil
import statistics
import struct
import tempfile

from benches import common, whole

MESHERS = [("frontal", 6), ("delaunay", 5), ("meshadapt", 1)]  # and Gmsh's number
STEPS = "mtopo mfeature mpartition mmultiscale mparam msize mlines"
GEO = """Merge "{surface}";
ClassifySurfaces{{Pi, 1, 1, Pi}};
CreateGeometry;
Mesh.MeshSizeFromPoints = 0; Mesh.MeshSizeExtendFromBoundary = 0; Mesh.MeshSizeMin = {size!r}; Mesh.MeshSizeMax = {size!r};
Mesh.Algorithm = {algorithm}; Mesh.Binary = 1;
Mesh 2; Save "{result}";
"""


def edges(path, size):
    """Mean and deviation of the edge lengths of an OFF file over the size."""
    with open(path) as f:
        words = f.read().split()
    points, triangles = int(words[1]), int(words[2])
    x = list(map(float, words[4:4 + 3 * points]))
    corner = list(map(int, words[4 + 3 * points:]))
    pairs = set()
    for t in range(0, 4 * triangles, 4):
        a, b, c = corner[t + 1:t + 4]
        pairs.update(((min(a, b), max(a, b)), (min(b, c), max(b, c)), (min(c, a), max(c, a))))
    lengths = [math.dist(x[3 * a:3 * a + 3], x[3 * b:3 * b + 3]) / size for a, b in pairs]
    return statistics.fmean(lengths), statistics.pstdev(lengths)


def lines_of(path, count, work):
    """The stream with its lines divided, and the size that N triangles ask for."""
    clean, triangles, area = whole.reference_of(path, work)
    count = count or triangles
    stream = os.path.join(work, "lines.ply")
    options = {"mfeature": f"--triangles {count}", "msize": f"--triangles {count}"}
    chain = " | ".join(f"{step} -q {options.get(step, '')}" for step in STEPS.split())
    done = common.run(f"mclean -q '{path}' | {chain} -o '{stream}'")
    if done.status:
        raise SystemExit(f"{path}: {done.text.strip()}")
    return clean, stream, count, math.sqrt(4 * area / (math.sqrt(3) * count))


def ours(mesher, stream, args, work):
    """The lifted mesh and the median rate; or None and why there is none."""
    plane, lifted = os.path.join(work, "plane.ply"), os.path.join(work, "lifted.off")
    rates = []
    if os.path.exists(lifted):
        os.remove(lifted)
    for _ in range(args.runs):
        done = common.run(["mmesh2d", "-v", "-j", "1", "--mesher", mesher, stream, "-o", plane])
        if done.status:
            return None, done.text.strip()
        rates.append(int(re.search(r"(\d+) triangles per second", done.text)[1]))
    done = common.run(f"mlift -q '{plane}' | mconvert -q - -o '{lifted}'")
    if done.status:
        return None, done.text.strip()
    return lifted, statistics.median(rates)


def gmsh(algorithm, path, size, args, work):
    """The same of Gmsh's mesh."""
    surface, script, result, lifted = (os.path.join(work, n) for n in ("input.stl", "a.geo", "gmsh.stl", "gmsh.off"))
    for old in (result, lifted):
        if os.path.exists(old):
            os.remove(old)
    common.run(["mconvert", "-q", path, "-o", surface])
    with open(script, "w") as f:
        f.write(GEO.format(surface=surface, result=result, size=size, algorithm=algorithm))
    done = common.run([args.gmsh, script, "-", "-v", "5", "-nopopup", "-nt", "1"], args.timeout)
    seconds = re.search(r"Done meshing 2D \(Wall [\d.]+s, CPU ([\d.]+)s\)", done.text)
    if not seconds or not os.path.exists(result):
        return None, "time-out" if done.status == -1 else f"failed, status {done.status}"
    with open(result, "rb") as f:
        triangles = struct.unpack("<I", f.read(84)[80:])[0]
    common.run(f"mclean -q '{result}' | mconvert -q - -o '{lifted}'")
    return lifted, triangles / max(0.01, float(seconds[1]))


def main(words):
    p = common.parser(__doc__)
    p.add_argument("--runs", type=int, default=3)
    p.add_argument("--gmsh", default="gmsh")
    p.add_argument("--evaluator")
    p.add_argument("--timeout", type=float, default=300)
    args = common.parse(p, words)
    rows = []
    with tempfile.TemporaryDirectory() as work:
        row = common.table(["surface", "mesher", "asked", "triangles", "kappa mean", "min", "edge mean", "deviation",
                            "topology", "triangles per core-second"])
        for name, path, count in common.surfaces(args, work):
            clean, stream, count, size = lines_of(path, count, work)
            meshers = [(m, lambda m=m: ours(m, stream, args, work)) for m, _ in MESHERS]
            if shutil.which(args.gmsh):
                meshers += [(f"{m} (Gmsh)", lambda n=n: gmsh(n, clean, size, args, work)) for m, n in MESHERS]
            for mesher, make in meshers:
                made, rate = make()
                if not made:
                    row(name, mesher, count, rate, *["-"] * 6)
                    rows.append({"surface": name, "mesher": mesher, "asked": count, "failed": rate})
                    continue
                figures = whole.judge(args.evaluator, clean, made, work)
                if not figures:
                    raise SystemExit(f"{name}, {mesher}: the mesh cannot be judged")
                triangles = int(figures.get("n_triangles", figures.get("triangles")))
                mean, deviation = edges(made, size)
                row(name, mesher, count, triangles, f"{figures['kappa_mean']:.4f}", f"{figures['kappa_min']:.3f}",
                    f"{mean:.3f}", f"{deviation:.3f}", figures["topology_same"], f"{rate:.0f}")
                rows.append({"surface": name, "mesher": mesher, "asked": count, "triangles": triangles,
                             "kappa_mean": figures["kappa_mean"], "kappa_min": figures["kappa_min"], "edge_mean": mean,
                             "edge_deviation": deviation, "topology_same": figures["topology_same"], "rate": rate})
    common.save(args, rows)
    return 0
