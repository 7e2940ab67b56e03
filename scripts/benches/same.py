# SPDX-License-Identifier: BSD-3-Clause
"""The same bytes every time: mremesh again and again, on one thread and on more, by a pipe and through files.

usage: scripts/bench same [options] [FILE[:TRIANGLES] ...]

Without files, surfaces made by mshape are used. One row per surface: the exit status, the size of the result, and how many
different results there were (1 is right; a failure's result is its status). Exits 1 if there was more than one anywhere.

  --runs N        runs of each surface (default 10): in turn -j1 by a pipe, -j2 by a pipe, -j1 through files, -j2 through files
  --bin DIR       programs (default build/bin)
  --json FILE     the same figures as JSON
"""
import hashlib
import os
import shutil
import tempfile

from benches import common


def main(words):
    p = common.parser(__doc__)
    p.add_argument("--runs", type=int, default=10)
    args = common.parse(p, words)
    rows = []
    with tempfile.TemporaryDirectory() as work:
        row = common.table(["surface", "status", "bytes", "runs", "different results", "CPU s of a run"])
        out, keep = os.path.join(work, "result.ply"), os.path.join(work, "stages")
        for name, path, count in common.surfaces(args, work):
            found, cpu, size = [], [], 0
            for i in range(args.runs):
                command = ["mremesh", "-q", f"-j{1 + i % 2}", path, "-o", out]
                command += ["--triangles", str(count)] if count else []
                command += ["--keep", keep] if i % 4 >= 2 else []
                done = common.run(command)
                cpu.append(done)
                digest = ""
                if os.path.exists(out):
                    size = os.path.getsize(out)
                    with open(out, "rb") as f:
                        digest = hashlib.sha256(f.read()).hexdigest()
                    os.remove(out)
                shutil.rmtree(keep, ignore_errors=True)
                found.append((done.status, digest))
            figures = {"surface": name, "status": found[0][0], "bytes": size, "runs": args.runs, "different": len(set(found)),
                       "cpu": common.median(cpu, "cpu")}
            row(name, figures["status"], size, args.runs, figures["different"], f"{figures['cpu']:.2f}")
            rows.append(figures)
    common.save(args, rows)
    return 0 if all(r["different"] == 1 for r in rows) else 1
