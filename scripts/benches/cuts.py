# SPDX-License-Identifier: BSD-3-Clause
"""Cuts: how many parts a surface is cut into before it is mapped, along which lines, and how fast.

usage: scripts/bench cuts [options] [FILE ...]

Without files, surfaces made by mshape are used. A row holds the surface's genus G, boundary loops N_B and geodesic aspect
ratio (0: closed); the parts after mpartition, after mmultiscale and after mparam; the interfaces' length over the diagonal
and their turning angle on the surface, away from creases (90 % quantile and largest), after mmultiscale; the CPU seconds
of mpartition and mmultiscale together, on one thread, best of --runs. Next to it, where Gmsh is there and succeeds: the
patches that it makes of the surface so that they can be parametrized, by its log, and its CPU seconds of splitting and of
creating the geometry.

  --runs N                 runs of mpartition and mmultiscale (default 3)
  --timeout S              seconds for one run of any program (default 120)
  --no-gmsh                without Gmsh
  --bin DIR                programs (default build/bin)
  --json FILE              the same figures as JSON
"""
import json
import os
import re
import shutil
import tempfile

from benches import common

GENERATED = [
    *((f"tube-{h}", ["tube", "--aspect", str(h), "--triangles", str(670 * h), "--noise", "0.1"], 0) for h in (25, 100, 400)),
    ("aorta", ["tree", "--outlets", "13", "--triangles", "60000"], 0),
    ("airways", ["tree", "--outlets", "147", "--triangles", "88000"], 0),
    *((f"genus-{g}", ["genus", "--genus", str(g), "--triangles", "40000"], 0) for g in (1, 2, 5, 16)),
    ("genus-3-1M", ["genus", "--genus", "3", "--triangles", "1000000"], 0),
    ("body", ["body"], 0),
]
GEO = 'Merge "{}";\nClassifySurfaces{{Pi, 1, 1, Pi}};\nCreateGeometry;\n'


def gmsh(stl, work, timeout):
    """(patches, seconds of splitting, seconds of creating the geometry), or None if Gmsh fails."""
    geo = os.path.join(work, "surface.geo")
    with open(geo, "w") as f:
        f.write(GEO.format(stl))
    done = common.run(["gmsh", geo, "-0", "-nopopup", "-nt", "1", "-o", os.path.join(work, "surface.geo_unrolled")], timeout)
    patches = re.search(r"Found (\d+) model surfaces", done.text)
    split = re.search(r"Done classifying surfaces \(Wall [^,]*, CPU ([\d.e+-]+)s", done.text)
    create = re.search(r"Done creating geometry of discrete surfaces \(Wall [^,]*, CPU ([\d.e+-]+)s", done.text)
    if done.status or not (patches and split and create):
        return None
    return int(patches[1]), float(split[1]), float(create[1])


def load(path):
    with open(path) as f:
        return json.load(f)


def cut(name, path, work, args):
    """The figures of a row, or what failed."""
    at = {k: os.path.join(work, k) for k in ("clean.ply", "topology", "parts.ply", "partition", "cut.ply", "cut", "maps")}
    done = common.run(f"mclean -q '{path}' | mtopo -q --json {at['topology']} | mfeature -q -o {at['clean.ply']}", args.timeout)
    if done.status:
        return done.text.strip().splitlines()[-1:] or ["timeout"]
    topology = load(at["topology"])["components"]
    row = {
        "surface": name,
        "triangles": sum(c["faces"] for c in topology),
        "genus": sum(c["genus"] for c in topology),
        "loops": sum(c["loops"] for c in topology),
        "eta": max(c["eta_geo"] for c in topology),
    }
    row["seconds"] = float("inf")
    for _ in range(args.runs):
        first = common.run(["mpartition", "-q", "-j", "1", at["clean.ply"], "--json", at["partition"], "-o", at["parts.ply"]], args.timeout)
        then = common.run(["mmultiscale", "-q", "-j", "1", at["parts.ply"], "--json", at["cut"], "-o", at["cut.ply"]], args.timeout)
        if first.status or then.status:
            return (first.text + then.text).strip().splitlines()[-1:] or ["timeout"]
        row["seconds"] = min(row["seconds"], first.cpu + then.cpu)
    report = load(at["cut"])
    row["partition"] = load(at["partition"])["parts"]
    row["parts"] = report["parts"]
    for key in ("cut_length", "turning_angle", "largest_angle"):
        row[key] = report[key]
    mapped = common.run(["mparam", "-q", "-j", "1", at["cut.ply"], "--json", at["maps"], "-o", os.devnull], args.timeout)
    row["charts"] = load(at["maps"])["parts"] if mapped.status == 0 else None
    return row


def main(words):
    p = common.parser(__doc__)
    p.add_argument("--runs", type=int, default=3)
    p.add_argument("--timeout", type=float, default=120)
    p.add_argument("--no-gmsh", action="store_true")
    args = common.parse(p, words)
    with_gmsh = not args.no_gmsh and shutil.which("gmsh")
    rows = []
    with tempfile.TemporaryDirectory() as work:
        columns = ["surface", "triangles", "G", "N_B", "eta", "mpartition", "mmultiscale", "mparam", "cut", "turn p90", "max", "CPU s"]
        line = common.table(columns + (["Gmsh patches", "split CPU s", "create CPU s"] if with_gmsh else []))
        for name, path, _ in common.surfaces(args, work, GENERATED):
            row = cut(name, path, work, args)
            if not isinstance(row, dict):
                line(name, row[0], *[""] * (len(columns) - 2 + (3 if with_gmsh else 0)))
                rows.append({"surface": name, "failed": row[0]})
                continue
            cells = [name, row["triangles"], row["genus"], row["loops"], f"{row['eta']:.1f}", row["partition"], row["parts"],
                     row["charts"] or "failed", f"{row['cut_length']:.2f}", f"{row['turning_angle']:.1f}", f"{row['largest_angle']:.0f}",
                     f"{row['seconds']:.2f}"]
            if with_gmsh:
                stl = os.path.join(work, "surface.stl")
                made = common.run(f"mconvert -q {os.path.join(work, 'clean.ply')} -o {stl}", args.timeout)
                figures = None if made.status else gmsh(stl, work, args.timeout)
                if figures:
                    row["gmsh"] = dict(zip(("patches", "split", "create"), figures))
                cells += [figures[0], f"{figures[1]:.2f}", f"{figures[2]:.2f}"] if figures else ["failed", "-", "-"]
            line(*cells)
            rows.append(row)
    common.save(args, rows)
    return 0
