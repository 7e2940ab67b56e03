# SPDX-License-Identifier: BSD-3-Clause
"""Time and memory of every stage of mremesh, run one after the other through files.

usage: scripts/bench stages [options] [FILE[:TRIANGLES] ...]

Without files, surfaces made by mshape are used. One row per program: median wall and CPU seconds (reading and writing
included), its share of the chain's wall time, the largest resident size, and that in bytes per triangle of the input or
the result, whichever has more.

  --runs N        runs of the chain (default 3)
  --threads N     threads (default all)
  --bin DIR       programs (default build/bin)
  --json FILE     the same figures as JSON
"""
import statistics
import tempfile

from benches import common


def main(words):
    p = common.parser(__doc__)
    p.add_argument("--runs", type=int, default=3)
    p.add_argument("--threads", type=int)
    args = common.parse(p, words)
    rows = []
    with tempfile.TemporaryDirectory() as work:
        row = common.table(["surface", "in", "out", "stage", "s", "share", "CPU s", "MB", "bytes a triangle"])
        for name, path, count in common.surfaces(args, work):
            triangles = common.count_triangles(path)
            count = count or triangles
            chains = [common.stages(path, count, work, args.threads)[0] for _ in range(args.runs)]
            whole = statistics.median(sum(r.wall for _, r in chain) for chain in chains)
            for i, (stage, first) in enumerate(chains[0]):
                runs = [chain[i][1] for chain in chains if i < len(chain)]
                figures = {"surface": name, "input_triangles": triangles, "triangles": count, "stage": stage, "status": first.status}
                for key in ("wall", "cpu", "megabytes"):
                    figures[key] = common.median(runs, key)
                figures["bytes_per_triangle"] = figures["megabytes"] * 2**20 / max(triangles, count)
                row(name, triangles, count, stage if first.status == 0 else f"{stage}: failed, status {first.status}",
                    f"{figures['wall']:.3f}", f"{100 * figures['wall'] / whole:.0f} %", f"{figures['cpu']:.3f}",
                    f"{figures['megabytes']:.0f}", f"{figures['bytes_per_triangle']:.0f}")
                rows.append(figures)
            row(name, triangles, count, "all", f"{whole:.3f}", "100 %",
                f"{sum(f['cpu'] for f in rows if f['surface'] == name):.3f}", "", "")
    common.save(args, rows)
    return 0
