# SPDX-License-Identifier: BSD-3-Clause
"""The tables of the paper's section 5, with this project's figures next to the published ones.

usage: scripts/bench paper [options] [NAME=FILE ...]

The paper: E. Marchandise, C. Carton de Wiart, W. G. Vos, C. Geuzaine, J.-F. Remacle, High quality surface remeshing using
harmonic maps, Part II (Int. J. Numer. Meth. Engng, 2011). Published figures are repeated from it, with the machine where
it names one; its own sources for those of others are in brackets as there. NAME is pelvis, bunny or feline: the models of
its figures 9, 11 and 12. A model that is not given is replaced by a surface of mshape of the same kind (genus, borders,
number of triangles), and the table says so: its figures then compare in kind only.

  --runs N        runs of the chain; times are medians (default 1)
  --scale F       triangles asked for over the paper's, and those of stand-ins (default 1; less for a quick look)
  --threads N     threads (default all)
  --bin DIR       programs (default build/bin)
  --json FILE     this project's figures as JSON
"""
import json
import os
import statistics
import subprocess
import tempfile

from benches import common

# name: what stands in, what it is, triangles asked for, counts for the table of means
MODELS = {
    "pelvis": (["genus", "--genus", "8", "--triangles", "25836"], "plate with 8 holes", 26313),
    "bunny": (["tree", "--outlets", "5", "--triangles", "70000"], "tree with 5 open ends", 25000),
    "feline": (["genus", "--genus", "2", "--triangles", "99732"], "plate with 2 holes", 25892),
}
STEPS = [
    ("partition mesh (1-2)", "under 20 %", ("mtopo", "mpartition", "mmultiscale")),
    ("parametrize (3)", "5 %", ("mparam",)),
    ("remesh lines (4)", "in the rest", ("mlines",)),
    ("remesh partitions (5)", "most of it", ("mmesh2d", "mlift")),
    ("not in the paper: clean, features, coarse surface, size, relax, check", "-", ("mclean", "mfeature", "mcoarsen", "msize", "mrelax", "mcheck")),
]


def report(work, program):
    with open(os.path.join(work, program + ".json")) as f:
        return json.load(f)


def chain(path, count, work, args):
    """Figures of one model at one count: mcheck's, seconds of every stage, parts."""
    runs = []
    for _ in range(args.runs):
        done, _ = common.stages(path, count, work, args.threads)
        if done[-1][1].status:
            raise SystemExit(f"{path}: {done[-1][0]} failed: {done[-1][1].text.strip()}")
        runs.append({stage: run.wall for stage, run in done})
    figures = report(work, "mcheck")
    figures["stages"] = {stage: statistics.median(r[stage] for r in runs) for stage in runs[0]}
    figures["seconds"] = sum(figures["stages"].values())
    figures["parts"] = report(work, "mparam")["parts"]
    return figures


def seconds(figures, *programs):
    return sum(figures["stages"][p] for p in programs)


def print_pelvis(f, label):
    print("\n## Figures 9 and 10: pelvis, genus 8\n")
    row = common.table(["", "triangles in", "out", "kappa mean", "kappa min", "s"])
    row("paper (2.4 GHz)", 25836, 26313, 0.94, 0.62, 9)
    row(label, f["reference"]["triangles"], f["triangles"], f"{f['kappa_mean']:.3f}", f"{f['kappa_min']:.3f}", f"{f['seconds']:.2f}")
    print()
    row = common.table(["step (section 4)", "paper", label, "s"])
    for step, published, programs in STEPS:
        row(step, published, f"{100 * seconds(f, *programs) / f['seconds']:.0f} %", f"{seconds(f, *programs):.3f}")


def print_bunny(f, label):
    print("\n## Table I: bunny, 70 k triangles to 25 k\n")
    row = common.table(["", "partitions", "partition s", "parametrization s", "total s"])
    row("LSCM, Levy [7] (1.3 GHz)", 23, 30, 95, "-")
    row("Eck [3] (1.3 GHz)", 88, "-", "-", 33.5)
    row("ABF++, Zayer [22]", 2, "-", 13, "-")
    row("LinABF, Zayer [22]", 2, "-", 2, "-")
    row("paper, laplacian partitioner (2.4 GHz)", 2, 16.7, 1.4, 25)
    row("paper, multilevel partitioner (2.4 GHz)", 10, 7, 1.4, 14)
    row(label, f["parts"], f"{seconds(f, *STEPS[0][2]):.2f}", f"{seconds(f, 'mparam'):.2f}", f"{f['seconds']:.2f}")


def print_feline(f, label):
    print("\n## Table II: feline, 50 k vertices\n")
    row = common.table(["", "vertices", "min angle", "mean angle", "Hausdorff error", "s"])
    row("original in [23, 24]", 49864, 3.8, 40, "-", "-")
    row("remeshed in [23, 24]", 10825, 7.4, 48.3, "0.64 %", 74)
    row("remeshed in [25]", 256, "-", "-", "-", 900)
    row("paper (2.4 GHz)", 12946, 11.6, 48.7, "0.53 %", 19)
    r = f["reference"]
    row("original, as measured here", r["vertices"], f"{r['min_angle']:.1f}", f"{r['mean_min_angle']:.1f}", "-", "-")
    row(label, f["vertices"], f"{f['min_angle']:.1f}", f"{f['mean_min_angle']:.1f}", f"{100 * f['hausdorff']:.2f} %", f"{f['seconds']:.2f}")


def main(words):
    p = common.parser(__doc__)
    p.add_argument("--runs", type=int, default=1)
    p.add_argument("--scale", type=float, default=1)
    p.add_argument("--threads", type=int)
    args = common.parse(p, words)
    given = {}
    for item in args.files:
        name, equals, path = item.partition("=")
        if not equals or name not in MODELS:
            raise SystemExit(f"'{item}' is not NAME=FILE with NAME one of {', '.join(MODELS)}")
        given[name] = path
    rows, means = {}, {}
    with tempfile.TemporaryDirectory() as work:
        for name, (shape, kind, count) in MODELS.items():
            path, label, count = given.get(name), "this project", round(args.scale * count)
            if not path:
                path, label = os.path.join(work, name + ".stl"), f"this project, on a stand-in ({kind})"
                shape = [*shape[:-1], str(round(args.scale * int(shape[-1])))]
                subprocess.run(["mshape", *shape, "-q", "-o", path], check=True)
            rows[name] = chain(path, count, work, args)
            {"pelvis": print_pelvis, "bunny": print_bunny, "feline": print_feline}[name](rows[name], label)
            means[name] = [(count, rows[name]["kappa_mean"])]
            for factor in (0.5, 2):
                means[name].append((round(factor * count), chain(path, round(factor * count), work, args)["kappa_mean"]))
    print("\n## Mean kappa over models and sizes (paper: constant within 2 %)\n")
    row = common.table(["triangles over those above", *(f"{factor:g}" for factor in (0.5, 1, 2))])
    for name, values in means.items():
        row(name, *(f"{k:.4f}" for _, k in sorted(values)))
    every = [k for values in means.values() for _, k in values]
    middle = (max(every) + min(every)) / 2
    print(f"\nbetween {min(every):.4f} and {max(every):.4f}: within {100 * (max(every) - middle) / middle:.1f} % of {middle:.4f}")
    common.save(args, {"models": rows, "kappa_mean": means})
    return 0
