# SPDX-License-Identifier: BSD-3-Clause
"""Whole runs: mremesh and any peer on the same surfaces at the same size.

usage: scripts/bench whole [options] [FILE[:TRIANGLES] ...]

Without files, surfaces made by mshape are used. Each program is run whole, file to file, the programs in turn, several
times; the table shows median wall and CPU seconds and memory, the ratio of wall time to mremesh's, and the figures of the
result by mcheck or another evaluator.

  --runs N                 runs of each program (default 3)
  --peer 'NAME=COMMAND'    another remesher: COMMAND with {in} (an OFF file), {out} (an OFF file), {h} (edge length), {n}
  --evaluator COMMAND      prints key=value lines, called with INPUT RESULT, in place of mcheck
  --timeout S              seconds for one run (default 600)
  --bin DIR                programs (default build/bin)
  --threads N              for mremesh (default all)
  --json FILE              the same figures as JSON
"""
import json
import math
import os
import subprocess
import tempfile

from benches import common

COLUMNS = [
    ("kappa_mean", "kappa mean", "{:.4f}"),
    ("kappa_min", "min", "{:.3f}"),
    ("min_angle", "angle", "{:.1f}"),
    ("hausdorff", "H", "{:.5f}"),
    ("topology_same", "topology", "{}"),
    ("self_intersections", "crossings", "{}"),
]


def judge(evaluator, reference, result, work):
    """Figures of a result: by the evaluator, or by mcheck."""
    if evaluator:
        text = subprocess.run(f"{evaluator} {reference} {result}", shell=True, capture_output=True, text=True).stdout
        figures = dict(line.split("=", 1) for line in text.splitlines() if "=" in line)
        figures["hausdorff"] = figures.get("hausdorff_sym", "nan")
        figures = {k: float(v) if v not in ("NA", "") else math.nan for k, v in figures.items()}
        figures["topology_same"] = "same" if figures.get("topology_same") == 1 else "CHANGED"
        figures["self_intersections"] = int(figures.get("self_intersections", -1))
        return figures
    report = os.path.join(work, "check.json")
    common.run(["mcheck", result, "--reference", reference, "--json", report, "-q", "--accept", "-o", os.devnull])
    with open(report) as f:
        figures = json.load(f)
    figures["topology_same"] = "same" if figures["topology_same"] else "CHANGED"
    return figures


def reference_of(path, work):
    """The cleaned surface as OFF, its number of triangles and its area."""
    clean, report = os.path.join(work, "reference.off"), os.path.join(work, "topology.json")
    done = common.run(f"mclean -q '{path}' | mtopo -q --json '{report}' | mconvert - -o '{clean}'")
    if done.status:
        raise SystemExit(f"{path}: {done.text.strip()}")
    with open(report) as f:
        parts = json.load(f)["components"]
    return clean, sum(p["faces"] for p in parts), sum(p["area"] for p in parts)


def main(words):
    p = common.parser(__doc__)
    p.add_argument("--runs", type=int, default=3)
    p.add_argument("--peer", action="append", default=[])
    p.add_argument("--evaluator")
    p.add_argument("--timeout", type=float, default=600)
    p.add_argument("--threads", type=int)
    args = common.parse(p, words)
    rows = []
    with tempfile.TemporaryDirectory() as work:
        row = common.table(["surface", "in", "program", "out", *(c[1] for c in COLUMNS), "s", "ratio", "CPU s", "MB"])
        for name, path, count in common.surfaces(args, work):
            clean, triangles, area = reference_of(path, work)
            count = count or triangles
            size = math.sqrt(4 * area / (math.sqrt(3) * count))
            out = {program: os.path.join(work, program + ".off") for program in ["mremesh", *(p.split("=")[0] for p in args.peer)]}
            threads = f"-j {args.threads}" if args.threads else ""
            commands = {"mremesh": f"mremesh -q --triangles {count} '{path}' -o '{out['mremesh']}' {threads}"}
            for peer in args.peer:
                program, command = peer.split("=", 1)
                commands[program] = command.format(**{"in": clean, "out": out[program], "h": size, "n": count})
            for result in out.values():
                if os.path.exists(result):
                    os.remove(result)
            runs = common.interleaved(commands, args.runs, args.timeout)
            for program in commands:
                figures = {"surface": name, "input_triangles": triangles, "program": program, "status": runs[program][0].status}
                for key in ("wall", "cpu", "megabytes"):
                    figures[key] = common.median(runs[program], key)
                figures["ratio"] = figures["wall"] / common.median(runs["mremesh"], "wall")
                cells, made = ["-"] * len(COLUMNS), "failed, status %d" % figures["status"]
                if figures["status"] == 0 and os.path.exists(out[program]):
                    figures.update(judge(args.evaluator, clean, out[program], work))
                    with open(out[program]) as f:
                        made = f.read(1000).split()[2]
                    cells = [form.format(figures.get(key, math.nan)) for key, _, form in COLUMNS]
                row(name, triangles, program, made, *cells, f"{figures['wall']:.2f}", f"{figures['ratio']:.2f}",
                    f"{figures['cpu']:.2f}", f"{figures['megabytes']:.0f}")
                rows.append(figures)
    common.save(args, rows)
    return 0
