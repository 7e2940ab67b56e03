# SPDX-License-Identifier: BSD-3-Clause
"""Memory and time of stages in shards, as separate jobs.

usage: scripts/bench shards [options]

A surface of mshape is remeshed to as many triangles as it has. Each of mparam, mmesh2d, mrelax and mcheck is run at once, and in
shards one after the other, on one thread. Rows: CPU seconds of all commands, and how much more that is than at once; the memory
of the largest job, in MB and over that at once; the same of the commands that cut and join, which hold the stream; and whether
the result is the same, to the byte (of mcheck: the mesh that it passes on). The last rows are of the whole chain, which has the
stages between these as well: the time of the surface from its file to its verdict.

  --triangles N      of the surface (default 4000000, which takes 10 minutes of CPU)
  --shards LIST      numbers of shards (default 1,4,16)
  --programs LIST    of the four (default all)
  --runs N           of every command, of which the least time counts: that of the kernel varies by a third (default 3)
  --tile N           triangles of a tile of mrelax, and of a share of mcheck (default 250000)
  --shape WORDS      what mshape makes (default 'tree --outlets 40')
  --bin DIR          programs (default build/bin)
  --json FILE        the same figures as JSON
"""
import filecmp
import os
import shutil
import subprocess
import tempfile

from benches import common

STAGES = ["clean", "topo", "feature", "coarsen", "partition", "multiscale", "param", "size", "lines", "mesh2d", "lift", "relax", "check"]


class Steps:
    """Runs commands, and sums their time and memory up by job or other."""

    def __init__(self, folder, runs):
        self.folder, self.runs, self.cpu, self.job, self.other = folder, runs, 0, 0, 0

    def path(self, name):
        return os.path.join(self.folder, name)

    def call(self, *words, job=False):
        done = [common.run([*words, "-q", "-j", "1"], watch=True) for _ in range(self.runs)]
        for run in done:
            if run.status:
                raise SystemExit(f"{' '.join(words)}: {run.text.strip()}")
        self.cpu += min(run.cpu for run in done)
        megabytes = max(run.megabytes for run in done)
        if job:
            self.job = max(self.job, megabytes)
        else:
            self.other = max(self.other, megabytes)

    def work(self, cut, program):
        """Cuts by the command `cut`, and runs the program on each shard; returns where to."""
        into, out = self.path("in"), self.path("out")
        for folder in (into, out):
            shutil.rmtree(folder, ignore_errors=True)
        os.mkdir(out)
        self.call(*cut, "--into", into)
        shards = sorted(os.listdir(into)) if os.path.isdir(into) else []
        for shard in shards:
            self.call(*program, os.path.join(into, shard), "-o", os.path.join(out, shard), job=True)
            os.remove(os.path.join(into, shard))
        return out if shards else None

    def run(self, program, source, result, shards, tile):
        """Runs a program in shards."""
        count = ["--shards", str(shards)]
        if program in ("mparam", "mmesh2d"):
            out = self.work(["mshard", source, *count], [program])
            self.call(program, "--join", out, source, "-o", result)
            return
        command = [program, "--tile", tile]
        out = self.work([*command, source, *count], command)
        if out is None:
            raise SystemExit(f"{program}: too few triangles for tiles of {tile}")
        if program == "mrelax":
            first = self.path("first")
            shutil.rmtree(first, ignore_errors=True)
            os.rename(out, first)
            out = self.work([*command, "--join", first, source, *count], command)
            shutil.rmtree(first)
        self.call(*command, "--join", out, source, "-o", result)


def main(words):
    p = common.parser(__doc__)
    p.add_argument("--triangles", type=int, default=4000000)
    p.add_argument("--shards", default="1,4,16")
    p.add_argument("--programs", default="mparam,mmesh2d,mrelax,mcheck")
    p.add_argument("--runs", type=int, default=3)
    p.add_argument("--tile", default="250000")
    p.add_argument("--shape", default="tree --outlets 40")
    args = common.parse(p, words)
    rows, at_once, between = [], 0, 0
    with tempfile.TemporaryDirectory() as work:
        surface, keep = os.path.join(work, "in.ply"), os.path.join(work, "stages")
        subprocess.run(["mshape", *args.shape.split(), "--triangles", str(args.triangles), "-q", "-o", surface], check=True)
        row = common.table(["program", "shards", "CPU s", "more", "MB of a job", "share", "MB to cut and join", "same"])
        done = "clean"
        for program in args.programs.split(","):
            at = STAGES.index(program[1:])
            start = [] if done == "clean" else ["--from", done]
            if done != STAGES[at]:
                others = Steps(work, args.runs)
                others.call("mremesh", "--triangles", str(args.triangles), "--tile", args.tile, "--keep", keep, *start,
                            "--to", STAGES[at - 1], surface)
                between += others.cpu
            source, result = (os.path.join(keep, f"{i + 1:02}-{STAGES[i]}.ply") for i in (at - 1, at))
            tile = ["--tile", args.tile] if program == "mrelax" else []
            whole = Steps(work, args.runs)
            whole.call(program, *tile, source, "-o", result, job=True)
            at_once += whole.cpu
            row(program, "-", f"{whole.cpu:.1f}", "-", f"{whole.job:.0f}", "-", "-", "-")
            done = STAGES[at + 1] if at + 1 < len(STAGES) else ""
            for shards in map(int, args.shards.split(",")):
                steps, joined = Steps(work, args.runs), os.path.join(work, "result.ply")
                steps.run(program, source, joined, shards, args.tile)
                same = filecmp.cmp(result, joined, shallow=False)
                row(program, shards, f"{steps.cpu:.1f}", f"{100 * (steps.cpu / whole.cpu - 1):.0f} %", f"{steps.job:.0f}",
                    f"{steps.job / whole.job:.2f}", f"{steps.other:.0f}", "yes" if same else "NO")
                rows.append({"program": program, "shards": shards, "cpu": steps.cpu, "cpu_at_once": whole.cpu, "megabytes": steps.job,
                             "megabytes_at_once": whole.job, "megabytes_of_others": steps.other, "same": same})
        row("all stages", "-", f"{between + at_once:.1f}", "-", "-", "-", "-", "-")
        for shards in map(int, args.shards.split(",")):
            more = sum(r["cpu"] for r in rows if r["shards"] == shards) - at_once
            row("all stages", shards, f"{between + at_once + more:.1f}", f"{100 * more / (between + at_once):.0f} %", "-", "-", "-", "-")
    common.save(args, {"between": between, "rows": rows})
    return 0 if all(r["same"] for r in rows) else 1
