# SPDX-License-Identifier: BSD-3-Clause
"""Maps of mparam: distortion by map, share of a whole run, growth with the size of a chart.

usage: scripts/bench maps [--bin DIR] [--json FILE] [--only TABLE] [--times N] [--largest N] [--figures DIR]
                          [FILE[:TRIANGLES] ...]

Surfaces are the FILEs, or made by mshape. Three tables: the charts of every surface by every map (worst chart of each);
seconds of CPU in mparam and its share of the whole chain, on one thread (best of N, default 3); and the time of one chart
from 10 000 triangles to --largest (default 1 000 000), with the exponent of its growth. --only TABLE makes only one of
distortion, share, growth and figures. --figures DIR (default here) writes two pictures, with a table of their distortion:
harmonic next to conformal charts of an arterial tree with nine ends and eta 28, and the same of a short tube.
"""
import json
import math
import os
import subprocess
import tempfile

from benches import common

MAPS = [
    ("conformal", []),
    ("least squares", ["--conformal", "least-squares"]),
    ("spectral", ["--conformal", "spectral"]),
    ("harmonic", ["--map", "harmonic"]),
    ("convex", ["--map", "convex"]),
    ("mean value", ["--map", "convex", "--weights", "mean-value"]),
]
STAGES = "mclean mtopo mfeature mcoarsen mpartition mmultiscale mparam msize mlines mmesh2d mlift mrelax mcheck".split()


def main(words):
    p = common.parser(__doc__)
    p.add_argument("--times", type=int, default=3)
    p.add_argument("--largest", type=int, default=1000000)
    p.add_argument("--figures")
    p.add_argument("--only", choices=["distortion", "share", "growth", "figures"])
    args = common.parse(p, words)
    found = {}
    with tempfile.TemporaryDirectory() as work:
        surfaces = []
        if args.only in (None, "distortion", "share"):
            surfaces = common.surfaces(args, work)
        for name, path, _ in surfaces:
            subprocess.run(["bash", "-c", f"set -o pipefail; mclean -q '{path}' | mtopo -q | mfeature -q | mpartition -q | "
                            f"mmultiscale -q -o {work}/{name}.parts.ply"], check=True)
        if args.only in (None, "distortion"):
            found["distortion"] = distortion(surfaces, work)
        if args.only in (None, "share"):
            found["share"] = [share(name, path, count, work, args.times) for name, path, count in surfaces]
            row = common.table(["surface", "charts", "mparam s", "whole s", "share %"])
            for r in found["share"]:
                row(r["surface"], r["charts"], f"{r['mparam']:.3f}", f"{r['whole']:.3f}", f"{100 * r['mparam'] / r['whole']:.1f}")
        if args.only in (None, "growth"):
            found["growth"] = growth(work, args.largest, args.times)
        if args.figures or args.only == "figures":
            found["figures"] = figures(work, args.figures or ".")
    common.save(args, found)
    return 0


def report_of(parts, options, work):
    """The report of mparam, or None where it fails."""
    run = common.run(["mparam", "-q", "-j", "1", *options, parts, "-o", f"{work}/charts.ply", "--json", f"{work}/report.json"])
    if run.status:
        print(run.text.strip())
        return None
    with open(f"{work}/report.json") as f:
        return {"cpu": run.cpu, **json.load(f)}


def distortion(surfaces, work):
    rows = []
    row = common.table(["surface", "map", "charts", "cut", "repaired", "other map", "median", "p99", "area scale", "mparam s"])
    for name, _, _ in surfaces:
        for label, options in MAPS:
            report = report_of(f"{work}/{name}.parts.ply", options, work)
            if report is None:
                continue
            charts = report["charts"]
            asked = "convex" if "convex" in options else "harmonic" if "harmonic" in options else "conformal"
            form = options[1] if "--conformal" in options else "boundary-first"

            def as_asked(chart, asked=asked, form=form):
                return chart["map"] == asked and (asked != "conformal" or chart["form"] == form)

            r = {
                "surface": name,
                "map": label,
                "charts": len(charts),
                "cut": report["cut"],
                "repaired": sum(as_asked(c) and (c["flips_before"] > 0 or not c["border_was_simple"]) for c in charts),
                "other": sum(not as_asked(c) for c in charts),
                "median": max(c["anisotropy_median"] for c in charts),
                "p99": max(c["anisotropy_p99"] for c in charts),
                "area_scale": max(c["area_scale"] for c in charts),
                "seconds": report["cpu"],
            }
            rows.append(r)
            row(name, label, r["charts"], r["cut"], r["repaired"], r["other"], f"{r['median']:.3f}", f"{r['p99']:.3f}",
                f"{r['area_scale']:.3g}", f"{r['seconds']:.3f}")
    return rows


def share(name, path, count, work, times):
    """CPU seconds of mparam and of all stages, each the best of several."""
    best = {}
    for _ in range(times):
        at = path
        for stage in STAGES:
            extra = ["--triangles", str(count)] if stage == "msize" and count else ["--accept"] if stage == "mcheck" else []
            run = common.run([stage, "-q", "-j", "1", *extra, at, "-o", f"{work}/{stage}.ply"])
            if run.status not in (0, 6):
                print(f"{name}: {stage} ends with {run.status}: {run.text.strip()}")
            at = f"{work}/{stage}.ply"
            best[stage] = min(best.get(stage, math.inf), run.cpu)
    with open(f"{work}/mparam.ply", "rb") as f:
        head = f.read(4096).decode(errors="replace")
    charts = int(head.split("element part ")[1].split()[0])
    return {"surface": name, "charts": charts, "mparam": best["mparam"], "whole": sum(best.values()), "stages": best}


def growth(work, largest, times):
    rows = []
    row = common.table(["triangles", "mparam s", "us a triangle"])
    n = 10000
    while n <= largest:
        parts = f"{work}/growth.ply"
        subprocess.run(["bash", "-c", f"set -o pipefail; mshape tube --aspect 2 --triangles {n} --noise 0.2 -q | mclean -q | "
                        f"mtopo -q | mpartition -q --max-faces 100000000 -o {parts}"], check=True)
        best = None
        for _ in range(times):
            report = report_of(parts, [], work)
            if report is None:
                raise SystemExit(f"no maps of {n} triangles")
            if best is None or report["cpu"] < best["cpu"]:
                best = {"triangles": sum(c["triangles"] for c in report["charts"]), "cpu": report["cpu"]}
        rows.append(best)
        row(best["triangles"], f"{best['cpu']:.3f}", f"{1e6 * best['cpu'] / best['triangles']:.2f}")
        n = 3 * n if str(n)[0] == "1" else 10 * n // 3
    if len(rows) > 1:
        x = [math.log(r["triangles"]) for r in rows]
        y = [math.log(r["cpu"]) for r in rows]
        mx, my = sum(x) / len(x), sum(y) / len(y)
        exponent = sum((a - mx) * (b - my) for a, b in zip(x, y)) / sum((a - mx) ** 2 for a in x)
        print(f"\nCPU time grows with the power {exponent:.3f} of the triangles of a chart\n")
        rows.append({"exponent": exponent})
    return rows


def figures(work, folder):
    """The paper's Figs. 8 and 1: harmonic (left) next to conformal (right), with their distortion."""
    os.makedirs(folder, exist_ok=True)
    rows = []
    row = common.table(["figure", "eta", "N_B", "map", "charts", "median", "p99", "area scale"])
    for name, shape in [("tree", "tree --outlets 9 --aspect 28 --triangles 12000"), ("tube", "tube --aspect 2 --triangles 4000")]:
        parts = f"{work}/figure.ply"
        subprocess.run(["bash", "-c", f"set -o pipefail; mshape {shape} -q | mclean -q | mtopo -q --json {work}/topology.json | "
                        f"mpartition -q | mmultiscale -q -o {parts}"], check=True)
        with open(f"{work}/topology.json") as f:
            whole = json.load(f)["components"][0]
        pictures = []
        for kind in ("harmonic", "conformal"):
            report = report_of(parts, ["--map", kind, "--svg", f"{work}/{kind}.svg"], work)
            charts = report["charts"]
            r = {"figure": name, "eta": whole["eta_cyl"], "loops": whole["loops"], "map": kind, "charts": len(charts)}
            r.update({k: max(c[k] for c in charts) for k in ("anisotropy_median", "anisotropy_p99", "area_scale")})
            rows.append(r)
            row(name, f"{r['eta']:.1f}", r["loops"], kind, r["charts"], f"{r['anisotropy_median']:.3f}",
                f"{r['anisotropy_p99']:.3f}", f"{r['area_scale']:.3g}")
            with open(f"{work}/{kind}.svg") as f:
                pictures.append(f.read())
        height = max(float(p.split('height="', 1)[1].split('"', 1)[0]) for p in pictures)
        width = float(pictures[0].split('width="', 1)[1].split('"', 1)[0])
        with open(os.path.join(folder, name + ".svg"), "w") as f:
            f.write(f'<svg xmlns="http://www.w3.org/2000/svg" width="{2 * width:g}" height="{height:g}">\n')
            for i, picture in enumerate(pictures):
                f.write(picture.replace("<svg ", f'<svg x="{i * width:g}" ', 1))
            f.write("</svg>\n")
    return rows
