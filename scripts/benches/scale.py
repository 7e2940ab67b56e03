# SPDX-License-Identifier: BSD-3-Clause
"""Growth of time and memory with the number of triangles.

usage: scripts/bench scale [options]

Surfaces of mshape, each remeshed to as many triangles as it has by one pipe. One row per size: wall and CPU seconds, and the
largest sum of resident memory of all live programs of the pipe (pages that only one has, and once those that they share),
in MB and in bytes per triangle. The last row has the exponents: the slope of the logarithm over that of the triangles, by
least squares over the sizes from 10^5 on (or all, if there are less than two).

  --from E        smallest size 10^E (default 4)
  --to E          largest size 10^E (default 6; 7 takes 24 GiB and minutes)
  --per-decade N  sizes a decade (default 2)
  --shape WORDS   what mshape makes (default 'torus')
  --out F         triangles out over triangles in (default 1)
  --stages        exponents of every stage, run through files, as well
  --threads N     threads (default all)
  --bin DIR       programs (default build/bin)
  --json FILE     the same figures as JSON
"""
import math
import os
import subprocess
import tempfile

from benches import common

def exponent(pairs):
    """Slope of log y over log x from 10^5 on; None if there are no two points."""
    large = [(math.log(x), math.log(y)) for x, y in pairs if x >= 0.9e5 and y > 0]
    points = large if len(large) > 1 else [(math.log(x), math.log(y)) for x, y in pairs if y > 0]
    if len(points) < 2:
        return None
    mx, my = (sum(p[i] for p in points) / len(points) for i in (0, 1))
    return sum((x - mx) * (y - my) for x, y in points) / sum((x - mx) ** 2 for x, _ in points)


def show(slope):
    return "-" if slope is None else f"{slope:.2f}"


def main(words):
    p = common.parser(__doc__)
    p.add_argument("--from", type=float, default=4, dest="low")
    p.add_argument("--to", type=float, default=6)
    p.add_argument("--per-decade", type=int, default=2)
    p.add_argument("--shape", default="torus")
    p.add_argument("--out", type=float, default=1)
    p.add_argument("--stages", action="store_true")
    p.add_argument("--threads", type=int)
    args = common.parse(p, words)
    threads = ["-j", str(args.threads)] if args.threads else []
    rows, by_stage = [], {}
    steps = round((args.to - args.low) * args.per_decade)
    with tempfile.TemporaryDirectory() as work:
        row = common.table([args.shape, "out", "status", "s", "CPU s", "MB", "bytes a triangle"])
        for i in range(steps + 1):
            triangles = round(10 ** (args.low + i / args.per_decade))
            path, out = os.path.join(work, "in.ply"), os.path.join(work, "out.ply")
            subprocess.run(["mshape", *args.shape.split(), "--triangles", str(triangles), "-q", "-o", path], check=True)
            count = round(triangles * args.out)
            run = common.run(["mremesh", "-q", "--triangles", str(count), *threads, path, "-o", out], watch=True)
            a_triangle = run.megabytes * 2**20 / max(triangles, count)
            rows.append({"input_triangles": triangles, "triangles": count, "status": run.status, "wall": run.wall, "cpu": run.cpu,
                         "megabytes": run.megabytes, "bytes_per_triangle": a_triangle})
            row(triangles, count, run.status, f"{run.wall:.2f}", f"{run.cpu:.2f}", f"{run.megabytes:.0f}", f"{a_triangle:.0f}")
            if args.stages:
                for stage, run in common.stages(path, count, work, args.threads)[0]:
                    by_stage.setdefault(stage, []).append((triangles, run.cpu, run.megabytes))
        good = [r for r in rows if r["status"] == 0]
        slopes = {key: exponent([(r["input_triangles"], r[key]) for r in good]) for key in ("wall", "cpu", "megabytes")}
        row("exponent", "", "", *(show(slopes[key]) for key in ("wall", "cpu", "megabytes")), "")
    if by_stage:
        print()
        row = common.table(["stage", "exponent of CPU s", "of MB", "CPU s at the largest", "MB at the largest"])
        for stage, runs in by_stage.items():
            slopes[stage] = exponent([(n, cpu) for n, cpu, _ in runs])
            row(stage, show(slopes[stage]), show(exponent([(n, mb) for n, _, mb in runs])), f"{runs[-1][1]:.2f}",
                f"{runs[-1][2]:.0f}")
    common.save(args, {"rows": rows, "exponents": slopes})
    return 0
