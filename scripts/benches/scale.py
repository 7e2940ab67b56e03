# SPDX-License-Identifier: BSD-3-Clause
"""Growth of time and memory with the number of triangles.

usage: scripts/bench scale [options]

Surfaces of mshape, each remeshed to as many triangles as it has by one pipe. A row a size: wall and CPU seconds, and the
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
import time

from benches import common

PAGE = os.sysconf("SC_PAGE_SIZE")


def resident(session):
    """Bytes of memory of all processes of a session: what is their own, and the largest of what is shared."""
    own, shared = 0, 0
    for pid in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{pid}/stat") as f:
                if int(f.read().rpartition(")")[2].split()[3]) != session:
                    continue
            with open(f"/proc/{pid}/statm") as f:
                pages = f.read().split()
        except (OSError, IndexError):
            continue  # it has ended
        own += int(pages[1]) - int(pages[2])
        shared = max(shared, int(pages[2]))
    return (own + shared) * PAGE


def watched(command):
    """Status, wall and CPU seconds of a command, and the largest sum of memory of its processes in bytes."""
    before = time.perf_counter()
    child = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
    most, pause = 0, 0.002
    while True:
        pid, status, usage = os.wait4(child.pid, os.WNOHANG)
        if pid:
            child.returncode = os.waitstatus_to_exitcode(status)
            break
        most = max(most, resident(child.pid))
        time.sleep(pause)
        pause = min(0.05, 1.05 * pause)
    return child.returncode, time.perf_counter() - before, usage.ru_utime + usage.ru_stime, most


def exponent(pairs):
    """Slope of log y over log x from 10^5 on."""
    large = [(math.log(x), math.log(y)) for x, y in pairs if x >= 0.9e5 and y > 0]
    points = large if len(large) > 1 else [(math.log(x), math.log(y)) for x, y in pairs if y > 0]
    if len(points) < 2:
        return math.nan
    mx, my = (sum(p[i] for p in points) / len(points) for i in (0, 1))
    return sum((x - mx) * (y - my) for x, y in points) / sum((x - mx) ** 2 for x, _ in points)


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
            status, wall, cpu, most = watched(["mremesh", "-q", "--triangles", str(count), *threads, path, "-o", out])
            rows.append({"input_triangles": triangles, "triangles": count, "status": status, "wall": wall, "cpu": cpu,
                         "megabytes": most / 2**20, "bytes_per_triangle": most / max(triangles, count)})
            row(triangles, count, status, f"{wall:.2f}", f"{cpu:.2f}", f"{most / 2**20:.0f}", f"{most / max(triangles, count):.0f}")
            if args.stages:
                for stage, run in common.stages(path, count, work, args.threads)[0]:
                    by_stage.setdefault(stage, []).append((triangles, run.cpu, run.megabytes))
        good = [r for r in rows if r["status"] == 0]
        slopes = {key: exponent([(r["input_triangles"], r[key]) for r in good]) for key in ("wall", "cpu", "megabytes")}
        row("exponent", "", "", *(f"{slopes[key]:.2f}" for key in ("wall", "cpu", "megabytes")), "")
    if by_stage:
        print()
        row = common.table(["stage", "exponent of CPU s", "of MB", "CPU s at the largest", "MB at the largest"])
        for stage, runs in by_stage.items():
            slopes[stage] = exponent([(n, cpu) for n, cpu, _ in runs])
            row(stage, f"{slopes[stage]:.2f}", f"{exponent([(n, mb) for n, _, mb in runs]):.2f}", f"{runs[-1][1]:.2f}", f"{runs[-1][2]:.0f}")
    common.save(args, {"rows": rows, "exponents": slopes})
    return 0
