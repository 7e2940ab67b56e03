# SPDX-License-Identifier: BSD-3-Clause
"""Cross-patch remeshing (the paper's section 5.3, Figs. 16 to 18): patches before and after they are merged.

With the histogram of kappa near 0 of the input, of the mesh that keeps all patches, and of the one that merges them.

usage: scripts/bench patches [options] [FILE[:TRIANGLES] ...]

Without files, the paper's landing gear in scale: a body of mshape of a million triangles and about 850 patches, which a
file of groups makes about 290. Files are merged by the groups of --groups, or by --merge-auto without.

  --groups FILE            as mfeature --merge takes it
  --patches N              of the body (default 850)
  --triangles N            of the body and of its mesh (default 1000000)
  --bin DIR                programs (default build/bin)
  --json FILE              the same figures as JSON
"""
import json
import os
import re
import tempfile

from benches import common


def gear(patches, triangles, work):
    """The body, and groups: each boss with its bore and cap, and two of three drilled holes with the plate's top."""
    path, groups = os.path.join(work, "gear.msh"), os.path.join(work, "groups.txt")
    made = common.run(["mshape", "body", "--patches", str(patches), "--triangles", str(triangles), "-q", "-o", path])
    if made.status:
        raise SystemExit(made.text.strip())
    listed = common.run(f"mconvert -q --ascii '{path}' | grep -a '^comment name'").text
    numbers = re.findall(r" boss(\d+)", listed)
    holes = re.findall(r" (hole\d+)", listed)
    with open(groups, "w") as f:
        for n in numbers:
            f.write(f"fitting{n} = boss{n} bore{n} cap{n}\n")
        f.write(" ".join(["top", *(h for i, h in enumerate(holes) if i % 3)]) + "\n")
    return path, groups


def remesh(path, count, options, work):
    """The report of a run, its Run, and what mfeature says of the patches."""
    out, report = os.path.join(work, "out.ply"), os.path.join(work, "out.json")
    if os.path.exists(report):
        os.remove(report)
    size = ["--triangles", str(count)] if count else []
    done = common.run(["mremesh", "-j", "1", *size, *options, "--report", report, path, "-o", out], watch=True)
    figures = {}
    if os.path.exists(report):
        with open(report) as f:
            figures = json.load(f)
    merged = re.search(r"(\d+) patches merged to (\d+)", done.text)
    return figures, done, merged and (int(merged[1]), int(merged[2]))


def main(words):
    p = common.parser(__doc__)
    p.add_argument("--groups")
    p.add_argument("--patches", type=int, default=850)
    p.add_argument("--triangles", type=int, default=1000000)
    args = common.parse(p, words)
    rows = []
    row = common.table(["surface", "mesh", "patches", "triangles", "kappa min", "mean", "0-.02", "-.04", "-.06", "-.08", "-.1",
                        "seconds", "MB"])
    with tempfile.TemporaryDirectory() as work:
        if args.files:
            merge = ["--merge", args.groups] if args.groups else ["--merge-auto"]
            cases = [(name, path, count, merge) for name, path, count in common.surfaces(args, work)]
        else:
            path, groups = gear(args.patches, args.triangles, work)
            cases = [("gear", path, args.triangles, ["--merge", groups])]
        for name, path, count, merge in cases:
            kept = remesh(path, count, [], work)
            merged = remesh(path, count, merge, work)
            before, after = merged[2] or ("-", "-")
            shown = [("input", before, (kept[0] or merged[0]).get("reference"), None), ("all patches", before, *kept[:2]),
                     ("merged", after, *merged[:2])]
            for mesh, patches, figures, done in shown:
                if not figures:
                    row(name, mesh, patches, f"failed, status {done.status}" if done else "-", *["-"] * 9)
                    rows.append({"surface": name, "mesh": mesh, "failed": done.status if done else None})
                    continue
                low = figures["kappa_histogram"][:5]
                cost = (f"{done.cpu:.1f}", f"{done.megabytes:.0f}") if done else ("-", "-")
                row(name, mesh, patches, figures["triangles"], f"{figures['kappa_min']:.4f}", f"{figures['kappa_mean']:.4f}", *low,
                    *cost)
                rows.append({"surface": name, "mesh": mesh, "patches": patches, "triangles": figures["triangles"],
                             "kappa_min": figures["kappa_min"], "kappa_mean": figures["kappa_mean"], "low_bins": low,
                             "seconds": done.cpu if done else None, "megabytes": done.megabytes if done else None,
                             "status": done.status if done else None})
    common.save(args, rows)
    return 0
