# SPDX-License-Identifier: BSD-3-Clause
"""Whole runs: mremesh and other remeshers on the same surfaces, with as many triangles in the results.

usage: scripts/bench whole [options] [FILE[:TRIANGLES] ...]

Without files, surfaces made by mshape are used. Next to mremesh runs Gmsh, where it is installed, in its own way to remesh
an STL (ClassifySurfaces, CreateGeometry, Mesh 2), by its frontal mesher and by MeshAdapt; and every --peer. Their edge length
is searched first, so that they come within 2 % of the triangles mremesh made. Then all run whole, file to file, in turn,
several times; who takes longer than --slow is not run again after the search. The table shows median wall and CPU seconds,
their ratios to mremesh's, the memory (the largest sum of what all processes of a run hold at a time), and the figures of the
result by mcheck or another evaluator.

  --runs N                 runs of each program (default 5)
  --peer 'NAME=COMMAND'    another remesher: COMMAND with {in} (an OFF file), {out} (an OFF file), {h} (edge length), {n}
                           (triangles), as in 'CGAL=remesh_cgal {in} {h} 10 {out}'
  --gmsh COMMAND           Gmsh 4 (default gmsh; left out if it is not there)
  --no-gmsh                without Gmsh
  --evaluator COMMAND      prints key=value lines, called with INPUT RESULT, in place of mcheck
  --timeout S              seconds for one run (default 600)
  --slow S                 a program that takes longer is run once (default 30)
  --bin DIR                programs (default build/bin)
  --threads N              for mremesh (default all)
  --json FILE              the same figures as JSON
  --page FILE              a page in Markdown: CPU seconds and figures, and where each program is better than mremesh or worse
  --svg FILE               a picture: wall seconds against mean kappa, a color for each program, a mark for each surface
"""
import html
import json
import math
import os
import re
import shlex
import shutil
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
MESHERS = [("Gmsh frontal", 6), ("Gmsh MeshAdapt", 1)]
GEO = """Merge "{surface}";
ClassifySurfaces{{40 * Pi / 180, 1, 1, Pi}};
CreateGeometry;
Mesh.MeshSizeFromPoints = 0; Mesh.MeshSizeExtendFromBoundary = 0; Mesh.MeshSizeMin = {size!r}; Mesh.MeshSizeMax = {size!r};
Mesh.Algorithm = {algorithm}; Mesh.Binary = 1;
Mesh 2; Save "{result}";
"""


def judge(evaluator, reference, result, work):
    """Figures of a result: by the evaluator, or by mcheck; None if that could not read it."""
    if evaluator:
        text = subprocess.run(f"{evaluator} '{reference}' '{result}'", shell=True, capture_output=True, text=True).stdout
        figures = dict(line.split("=", 1) for line in text.splitlines() if "=" in line)
        figures["hausdorff"] = figures.get("hausdorff_sym", "nan")
        figures = {k: float(v) if v not in ("NA", "") else math.nan for k, v in figures.items()}
        figures["topology_same"] = "same" if figures.get("topology_same") == 1 else "CHANGED"
        figures["self_intersections"] = int(figures.get("self_intersections", -1))
        if "kappa_mean" not in figures:
            raise SystemExit(f"--evaluator {evaluator}: no figures of {result}")
        return figures
    report = os.path.join(work, "check.json")
    if os.path.exists(report):
        os.remove(report)
    common.run(["mcheck", result, "--reference", reference, "--json", report, "-q", "--accept", "-o", os.devnull])
    if not os.path.exists(report):
        return None
    with open(report) as f:
        figures = json.load(f)
    figures["topology_same"] = "same" if figures["topology_same"] else "CHANGED"
    return figures


def reference_of(path, work):
    """The cleaned surface as OFF, its number of triangles and its area."""
    clean, report = os.path.join(work, "reference.off"), os.path.join(work, "topology.json")
    done = common.run(f"mclean -q '{path}' | mtopo -q --json '{report}' | mconvert -q - -o '{clean}'")
    if done.status:
        raise SystemExit(f"{path}: {done.text.strip()}")
    with open(report) as f:
        parts = json.load(f)["components"]
    return clean, sum(p["faces"] for p in parts), sum(p["area"] for p in parts)


def triangles_of(path):
    """Triangles of an OFF file or a binary STL; 0 if it is not there."""
    if not os.path.exists(path):
        return 0
    if path.endswith(".stl"):
        return (os.path.getsize(path) - 84) // 50
    with open(path) as f:
        head = f.read(1000).split()
    return int(head[2]) if len(head) > 2 and head[2].isdigit() else 0


class Program:
    """A remesher: `command(h)` makes `result` with edges of length h, which mremesh does not look at."""

    def __init__(self, name, result, command):
        self.name, self.result, self.command = name, result, command
        self.runs, self.memory, self.made = [], 0, 0

    def run(self, size, timeout, watch=False):
        if os.path.exists(self.result):
            os.remove(self.result)
        done = common.run(self.command(size), timeout, watch=watch)
        self.made = triangles_of(self.result)
        if done.status == 0 and self.made == 0:
            done.status = "no result"
        return done

    def search(self, size, count, timeout):
        """The run that counts for memory, and the edge length whose result has `count` triangles within 2 %, if given."""
        for _ in range(8):
            self.size = size
            first = self.run(size, timeout, watch=True)
            self.runs, self.memory = [first], first.megabytes
            if first.status or not count or abs(self.made - count) <= 0.02 * count:
                break
            size *= math.sqrt(self.made / count)


def gmsh(args, algorithm, surface, work):
    result, script = os.path.join(work, f"gmsh-{algorithm}.stl"), os.path.join(work, f"{algorithm}.geo")

    def command(size):
        with open(script, "w") as f:
            f.write(GEO.format(surface=surface, size=size, algorithm=algorithm, result=result))
        return [args.gmsh, script, "-", "-nopopup", "-nt", "1"]

    return result, command


def programs(args, path, count, clean, work):
    """mremesh, and who runs next to it."""
    out = os.path.join(work, "mremesh.off")
    threads = f"-j {args.threads}" if args.threads else ""
    found = [Program("mremesh", out, lambda _: f"mremesh -q --triangles {count} '{path}' -o '{out}' {threads}")]
    for i, peer in enumerate(args.peer):
        name, words = peer.split("=", 1)
        result = os.path.join(work, f"peer-{i}.off")
        found.append(Program(name, result, lambda size, words=words, result=result:
                             words.format(**{"in": f"'{clean}'", "out": f"'{result}'", "h": repr(size), "n": count})))
    if not args.no_gmsh and shutil.which(args.gmsh):
        surface = os.path.join(work, "reference.stl")
        common.run(["mconvert", "-q", clean, "--binary", "-o", surface])
        for name, algorithm in MESHERS:
            found.append(Program(name, *gmsh(args, algorithm, surface, work)))
    return found


def measure(args, found, size):
    """Searches the edge lengths, then runs all in turn; whoever fails or is slow not again."""
    ours = found[0]
    ours.search(size, None, args.timeout)
    for p in found[1:]:
        p.search(size, ours.made, args.timeout)
    again = [p for p in found if p.runs[0].status == 0 and p.runs[0].wall <= args.slow]
    for p in again:
        p.runs = []
    for _ in range(args.runs):
        for p in again:
            p.runs.append(p.run(p.size, args.timeout))


COLORS = ["#d62728", "#1f77b4", "#2ca02c", "#9467bd", "#ff7f0e", "#8c564b", "#17becf", "#7f7f7f"]


def picture(rows, width=640, height=420):
    """SVG text: wall seconds, by a logarithmic scale, against the mean kappa of each run that has a result; runs of a surface
    are joined by a line. A run that changed the topology is an open circle."""
    rows = [r for r in rows if r.get("status") == 0 and "kappa_mean" in r and r["wall"] > 0]
    if not rows:
        return f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}"/>\n'
    names = list(dict.fromkeys(r["program"] for r in rows))
    low = math.floor(math.log10(min(r["wall"] for r in rows)))
    high = max(low + 1, math.ceil(math.log10(max(r["wall"] for r in rows))))
    least = math.floor(20 * min(r["kappa_mean"] for r in rows)) / 20

    def x(r):
        return 60 + (math.log10(r["wall"]) - low) / (high - low) * (width - 210)

    def y(kappa):
        return 20 + (1 - kappa) / (1 - least) * (height - 70)

    text = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" font-size="12">',
            f'<title>Time against quality of {len(names)} remeshers</title>', '<rect width="100%" height="100%" fill="#fff"/>']
    for e in range(low, high + 1):
        at = x({"wall": 10.0**e})
        text.append(f'<path d="M{at:.1f} 20V{height - 50}" stroke="#ddd"/><text x="{at:.1f}" y="{height - 34}" text-anchor="middle">{10.0**e:g}</text>')
    for i in range(6):
        k = least + (1 - least) * i / 5
        text.append(f'<path d="M60 {y(k):.1f}H{width - 150}" stroke="#ddd"/><text x="54" y="{y(k) + 4:.1f}" text-anchor="end">{k:.2f}</text>')
    text.append(f'<text x="{(width - 90) / 2}" y="{height - 12}" text-anchor="middle">wall seconds</text><text x="10" y="14">mean kappa</text>')
    for surface in dict.fromkeys(r["surface"] for r in rows):
        points = " ".join(f"{x(r):.1f},{y(r['kappa_mean']):.1f}" for r in rows if r["surface"] == surface)
        text.append(f'<polyline points="{points}" fill="none" stroke="#bbb" stroke-dasharray="2 3"/>')
    for r in rows:
        color = COLORS[names.index(r["program"]) % len(COLORS)]
        fill = color if r.get("topology_same") in ("same", True) else "#fff"
        text.append(f'<circle cx="{x(r):.1f}" cy="{y(r["kappa_mean"]):.1f}" r="5" fill="{fill}" stroke="{color}" stroke-width="2">'
                    f'<title>{html.escape(r["program"])}, {html.escape(r["surface"])}: {r["wall"]:.2f} s, kappa {r["kappa_mean"]:.4f}</title></circle>')
    for i, name in enumerate(names):
        text.append(f'<circle cx="{width - 132}" cy="{30 + 20 * i}" r="5" fill="{COLORS[i % len(COLORS)]}"/>'
                    f'<text x="{width - 120}" y="{34 + 20 * i}">{html.escape(name)}</text>')
    return "\n".join([*text, "</svg>\n"])


PAGE = """# Next to other remeshers

`{command}` has made this page.

Every program got the same cleaned surface, and the edge length by which it comes nearest to the number of triangles that `mremesh`
made. kappa is the shape measure of a triangle (1: equilateral, 0: degenerate), the distance is the two-sided Hausdorff distance
over the diagonal; `mcheck` measures all of them. {runs}, on {machine}.{load}

`mremesh` cleans and checks, which the others do not, and its time has both in it. It finds model edges and keeps them, as Gmsh
does here with those above 40 degrees; further programs are given none. On the other hand CGAL is a library that can be called
in place, and Gmsh meshes CAD itself, volumes, and elements of any order: where these are needed, they are the better choice.

{summary}
{table}"""
# figure, title, format, whether more is better
PAGE_COLUMNS = [("cpu", "CPU s", "{:.1f}", False), ("kappa_mean", "mean kappa", "{:.3f}", True), ("kappa_min", "least", "{:.3f}", True),
                ("min_angle", "least angle", "{:.1f}", True), ("hausdorff", "distance", "{:.1e}", False),
                ("self_intersections", "crossings", "{:.0f}", False), ("megabytes", "MB", "{:.0f}", False)]


def summary(rows):
    """Returns a line per program: on how many surfaces it is better or worse than mremesh, in what."""
    ours = {r["surface"]: r for r in rows if r["program"] == "mremesh"}
    lines = []
    for name in dict.fromkeys(r["program"] for r in rows if r["program"] != "mremesh"):
        theirs = [r for r in rows if r["program"] == name]
        good = [r for r in theirs if "kappa_mean" in r]
        words = []
        for key, title, _, more in PAGE_COLUMNS:
            pairs = [(r[key], ours[r["surface"]].get(key, math.nan)) for r in good if key in r]
            better = sum(a > b if more else a < b for a, b in pairs)
            worse = sum(a < b if more else a > b for a, b in pairs)
            words.append(f"{title} {better} better, {worse} worse")
        changed = sum(r.get("topology_same") not in ("same", True, 1) for r in good)
        words += [f"{changed} with another topology"] * bool(changed)
        words += [f"{len(theirs) - len(good)} without a result"] * (len(theirs) > len(good))
        lines.append(f"- {name}, {len(theirs)} surfaces: {'; '.join(words)}.\n")
    return "".join(lines)


def page(args, words, rows):
    """Returns the text of --page; of paths, only the names of files are in it."""
    bare = [re.sub(r"[^ ='\"]*/", "", w) for w in words if w not in ("--page", args.page, "--bin", args.bin, "--json", args.json)]
    with open("/proc/cpuinfo", encoding="ascii", errors="replace") as f:
        model = next((line.split(":")[1].strip() for line in f if line.startswith("model name")), "an unknown processor")
    table = "| surface | in | program | out | " + " | ".join(c[1] for c in PAGE_COLUMNS) + " |\n"
    table += "|---|--:|---|--:|" + "--:|" * len(PAGE_COLUMNS) + "\n"
    for r in rows:
        cells = [form.format(r[key]) if key in r and "kappa_mean" in r else "-" for key, _, form, _ in PAGE_COLUMNS]
        made = r["triangles"] if "kappa_mean" in r else f"over {args.timeout:.0f} s" if r["status"] == -1 else "failed"
        table += f"| {r['surface']} | {r['input_triangles']} | {r['program']} | {made} | {' | '.join(cells)} |\n"
    busy = args.load > 0.5
    return PAGE.format(command=shlex.join(["scripts/bench", "whole", *bare, "--page", "FILE"]),
                       runs="One run" if args.runs == 1 else f"Median of {args.runs} runs", machine=model, summary=summary(rows), table=table,
                       load=" The machine had other work, so that times may be off by half." if busy else "")


def main(words):
    p = common.parser(__doc__)
    p.add_argument("--runs", type=int, default=5)
    p.add_argument("--peer", action="append", default=[])
    p.add_argument("--gmsh", default="gmsh")
    p.add_argument("--no-gmsh", action="store_true")
    p.add_argument("--evaluator")
    p.add_argument("--svg")
    p.add_argument("--page")
    p.add_argument("--timeout", type=float, default=600)
    p.add_argument("--slow", type=float, default=30)
    p.add_argument("--threads", type=int)
    args = common.parse(p, words)
    if args.runs < 1:
        raise SystemExit("--runs: at least 1")
    for peer in args.peer:
        if "=" not in peer:
            raise SystemExit(f"--peer {peer}: not NAME=COMMAND")
    rows = []
    args.load = os.getloadavg()[0]  # of others
    with tempfile.TemporaryDirectory() as work:
        row = common.table(["surface", "in", "program", "out", *(c[1] for c in COLUMNS), "s", "ratio", "CPU s", "ratio", "MB", "ratio"])
        for name, path, count in common.surfaces(args, work):
            clean, triangles, area = reference_of(path, work)
            count = count or triangles
            found = programs(args, path, count, clean, work)
            measure(args, found, math.sqrt(4 * area / (math.sqrt(3) * count)))
            ours = [common.median(found[0].runs, "wall"), common.median(found[0].runs, "cpu"), found[0].memory]
            for program in found:
                cost = [common.median(program.runs, "wall"), common.median(program.runs, "cpu"), program.memory]
                ratio = [a / b for a, b in zip(cost, ours)]
                status = next((r.status for r in program.runs if r.status), 0)
                figures = {"surface": name, "input_triangles": triangles, "program": program.name, "status": status,
                           "edge_length": program.size, "triangles": program.made, "runs": len(program.runs)}
                for key, a, b in zip(("wall", "cpu", "megabytes"), cost, ratio):
                    figures[key], figures[key + "_ratio"] = a, b
                cells, made = ["-"] * len(COLUMNS), f"failed: {status if isinstance(status, str) else 'status %d' % status}"
                if status == -1:
                    made = f"longer than {args.timeout:.0f} s"
                judged = judge(args.evaluator, clean, program.result, work) if status == 0 else None
                if status == 0 and judged is None:
                    made = "failed: no mesh"
                if judged:
                    figures = {**judged, **figures}
                    made = program.made
                    cells = [form.format(figures.get(key, math.nan)) for key, _, form in COLUMNS]
                row(name, triangles, program.name, made, *cells, f"{cost[0]:.2f}", f"{ratio[0]:.2f}", f"{cost[1]:.2f}",
                    f"{ratio[1]:.2f}", f"{cost[2]:.0f}", f"{ratio[2]:.2f}")
                rows.append(figures)
    common.save(args, rows)
    if args.page:
        with open(args.page, "w", encoding="utf-8") as f:
            f.write(page(args, words, rows))
    if args.svg:
        with open(args.svg, "w") as f:
            f.write(picture(rows))
    return 0
