# SPDX-License-Identifier: BSD-3-Clause
"""Reading: binary STL with welding and topology, and text against a bare loop over its numbers, next to Gmsh.

usage: scripts/bench read [options]

Makes a sphere as a binary STL. The first table has the CPU time of one core, the rate over the file's bytes and the
largest resident memory of one process, over the file's size too: for mtopo on the file (which reads, welds and reports the
topology), for mclean | mtopo, for Gmsh (reads it and makes its topology) and for every peer.
The second table has a tenth of the triangles as text: the CPU time of mconvert, that of it without what the same surface
as a stream costs (process, columns and output: what is left is the parsing), and its rate against that of std::from_chars
in a loop over the same bytes.

  --triangles N            of the binary file (default 10000000)
  --runs N                 runs of each program; the median is shown (default 3, Gmsh and peers once)
  --peer 'NAME=COMMAND'    another program that reads and orients the file: COMMAND with {in}
  --gmsh COMMAND           Gmsh 4 (default gmsh; left out if it is not there)
  --timeout S              seconds for one run of another program (default 300)
  --bin DIR                programs (default build/bin)
  --json FILE              the same figures as JSON
"""
import os
import shutil
import subprocess
import tempfile

from benches import common

GEO = 'Merge "{}";\nCreateTopology;\n'


def measure(command, times, timeout=None):
    return [common.run(command, timeout, watch=True) for _ in range(times)]


def binary(args, work, rows):
    path = os.path.join(work, "sphere.stl")
    subprocess.run(["mshape", "sphere", "--triangles", str(args.triangles), "--binary", "-q", "-o", path], check=True)
    size = os.path.getsize(path) / 1e6
    programs = [("mtopo", f"mtopo -q -j1 '{path}' -o /dev/null", args.runs, None),
                ("mclean, mtopo", f"mclean -q -j1 '{path}' | mtopo -q -j1 -o /dev/null", args.runs, None)]
    if shutil.which(args.gmsh):
        script = os.path.join(work, "read.geo")
        with open(script, "w") as f:
            f.write(GEO.format(path))
        programs.append(("Gmsh", f"{args.gmsh} -nt 1 -parse_and_exit '{script}'", 1, args.timeout))
    for peer in args.peer:
        name, command = peer.split("=", 1)
        programs.append((name, command.replace("{in}", f"'{path}'"), 1, args.timeout))
    print(f"binary STL of {args.triangles} triangles, {size:.0f} MB\n")
    row = common.table(["program", "CPU s", "MB/s", "memory MB", "of the file"])
    for name, command, times, timeout in programs:
        runs = measure(command, times, timeout)
        cpu, memory, status = common.median(runs, "cpu"), common.median(runs, "megabytes"), runs[-1].status
        rows.append({"file": "binary stl", "megabytes": size, "program": name, "status": status, "cpu_seconds": cpu,
                     "memory_megabytes": memory})
        if status != 0:
            row(name, f"longer than {timeout:.0f}" if status == -1 else f"failed, status {status}", "-", "-", "-")
        else:
            row(name, f"{cpu:.2f}", f"{size / cpu:.0f}", f"{memory:.0f}", f"{memory * 1.048576 / size:.1f}")
    os.remove(path)


def text(args, work, rows):
    loop = os.path.join(work, "numbers")
    source = os.path.join(os.path.dirname(os.path.abspath(__file__)), "numbers.cc")
    compiler = shutil.which("c++")
    if compiler:
        subprocess.run([compiler, "-std=c++20", "-O3", source, "-o", loop], check=True)
    sphere = os.path.join(work, "sphere.mply")
    subprocess.run(f"mshape sphere --triangles {args.triangles // 10} -q --binary -o '{sphere}'", shell=True, check=True)
    print(f"\ntext of {args.triangles // 10} triangles\n")
    row = common.table(["format", "MB", "mconvert, CPU s", "parsing s", "MB/s", "bare loop, MB/s", "ratio"])
    rest = common.median(measure(f"mconvert -q -j1 --binary '{sphere}' > /dev/null", args.runs), "cpu")
    for kind in ("stl", "obj", "off", "ply"):
        path = os.path.join(work, "sphere." + kind)
        subprocess.run(["mconvert", "-q", "--ascii", sphere, "-o", path], check=True)
        size = os.path.getsize(path) / 1e6
        cpu = common.median(measure(f"mconvert -q -j1 --binary '{path}' > /dev/null", args.runs), "cpu")
        parsing = max(cpu - rest, 1e-3)
        figures = {"file": "text " + kind, "megabytes": size, "program": "mconvert", "cpu_seconds": cpu,
                   "parsing_seconds": parsing}
        cells = ["-", "-"]
        if compiler:
            bare = sorted(float(common.run([loop, path]).text) for _ in range(args.runs))[args.runs // 2]
            figures["bare_seconds"] = bare
            cells = [f"{size / bare:.0f}", f"{bare / parsing:.2f}"]
        rows.append(figures)
        row(kind, f"{size:.0f}", f"{cpu:.2f}", f"{parsing:.2f}", f"{size / parsing:.0f}", *cells)
        os.remove(path)


def main(words):
    p = common.parser(__doc__)
    p.add_argument("--triangles", type=int, default=10000000)
    p.add_argument("--runs", type=int, default=3)
    p.add_argument("--peer", action="append", default=[])
    p.add_argument("--gmsh", default="gmsh")
    p.add_argument("--timeout", type=float, default=300)
    args = common.parse(p, words)
    rows = []
    with tempfile.TemporaryDirectory() as work:
        binary(args, work, rows)
        text(args, work, rows)
    common.save(args, rows)
    return 0
