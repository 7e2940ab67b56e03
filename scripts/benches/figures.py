# SPDX-License-Identifier: BSD-3-Clause
"""Quality of results, next to the cuts and at model edges: no trace of the parts, and what CAD leaves room for.

usage: scripts/bench figures [options] [FILE[:TRIANGLES] ...]

Without files, surfaces made by mshape are used. One mremesh of each, judged by mcheck: smallest kappa, the smallest off
sharp corners (two triangles away from model edges that meet at less than 40 degrees), smallest angle; mean kappa of the
triangles within an edge of a former interface, of all others, and the difference (positive: the cuts show; the goal is no
more than 0.003); Hausdorff distance and that of borders and model edges, over the diagonal.

  --threads N     threads (default all)
  --bin DIR       programs (default build/bin)
  --json FILE     the same figures as JSON
"""
import json
import math
import os
import tempfile

from benches import common

COLUMNS = [
    ("kappa_mean", "kappa mean", "{:.4f}"),
    ("kappa_min", "min", "{:.3f}"),
    ("kappa_off_wedges", "off wedges", "{:.3f}"),
    ("min_angle", "angle", "{:.1f}"),
    ("kappa_by_cuts", "by the cuts", "{:.4f}"),
    ("kappa_elsewhere", "elsewhere", "{:.4f}"),
    ("trace", "difference", "{:+.4f}"),
    ("hausdorff", "H", "{:.5f}"),
    ("feature_distance", "features", "{:.5f}"),
]


def main(words):
    p = common.parser(__doc__)
    p.add_argument("--threads", type=int)
    args = common.parse(p, words)
    rows = []
    with tempfile.TemporaryDirectory() as work:
        row = common.table(["surface", "out", "status", *(c[1] for c in COLUMNS), "s"])
        for name, path, count in common.surfaces(args, work):
            report = os.path.join(work, "report.json")
            asked = f"--triangles {count}" if count else ""
            threads = f"-j {args.threads}" if args.threads else ""
            run = common.run(f"mremesh -q --accept {asked} {threads} --report '{report}' '{path}' -o '{os.path.join(work, 'out.ply')}'")
            figures = {"surface": name, "status": run.status, "wall": run.wall}
            if run.status in (0, 6):
                with open(report) as f:
                    figures.update(json.load(f))
                figures["trace"] = figures.get("kappa_elsewhere", math.nan) - figures.get("kappa_by_cuts", math.nan)
            row(name, figures.get("triangles", "-"), run.status,
                *("-" if math.isnan(v := figures.get(key, math.nan)) else form.format(v) for key, _, form in COLUMNS), f"{run.wall:.2f}")
            rows.append(figures)
            if os.path.exists(report):
                os.remove(report)
    common.save(args, rows)
    return 0
