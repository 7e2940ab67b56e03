# SPDX-License-Identifier: BSD-3-Clause
"""What the benchmarks share: running programs, generated surfaces, tables."""
import argparse
import gzip
import json
import math
import os
import shutil
import statistics
import subprocess
import tempfile
import time

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
GENERATED = [
    ("tube", ["tube", "--aspect", "25", "--triangles", "40000", "--noise", "0.1"], 20000),
    ("tree", ["tree", "--triangles", "60000"], 25000),
    ("airways", ["tree", "--outlets", "147", "--triangles", "90000"], 60000),
    ("genus-5", ["genus", "--genus", "5", "--triangles", "60000"], 25000),
    ("body", ["body"], 10000),
]


PAGE = os.sysconf("SC_PAGE_SIZE")


class Run:
    """Status, wall and CPU seconds, megabytes of memory and the text of a command."""

    def __init__(self, status, wall, cpu, megabytes, text):
        self.status, self.wall, self.cpu, self.megabytes, self.text = status, wall, cpu, megabytes, text


def run(command, timeout=None, output=None, watch=False):
    """Runs a command (a string: by the shell, with pipefail), its descendants included in CPU and memory. Its standard
    output goes to the file `output` if given; otherwise both outputs are in `text`. A timeout gives status -1. The memory
    is the largest sum of all processes that live at a time, known only with `watch`: it takes some CPU time to look at."""
    words = ["bash", "-c", "set -o pipefail; " + command] if isinstance(command, str) else command
    with tempfile.TemporaryFile() as log:
        sink = open(output, "wb") if output else log
        before = time.perf_counter()
        child = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=sink, stderr=log, start_new_session=True)
        usage, status, most = wait(child, timeout, watch)
        wall = time.perf_counter() - before
        if output:
            sink.close()
        log.seek(0)
        text = log.read().decode(errors="replace")
    return Run(status, wall, usage.ru_utime + usage.ru_stime, most / 2**20 if watch else math.nan, text)


def wait(child, timeout, watch):
    """Resource usage and exit status of `child` and what it has waited for, and if watched the most memory of its session;
    kills its process group after `timeout`."""
    end = time.perf_counter() + timeout if timeout else None
    most, pause = 0, 0.002
    while True:
        pid, status, usage = os.wait4(child.pid, os.WNOHANG if end or watch else 0)
        if pid:
            child.returncode = os.waitstatus_to_exitcode(status)
            return usage, child.returncode, most
        if end and time.perf_counter() > end:
            os.killpg(child.pid, 9)
            _, _, usage = os.wait4(child.pid, 0)
            child.returncode = -1
            return usage, -1, most
        if watch:
            most = max(most, resident(child.pid))
            pause = min(0.05, 1.05 * pause)
        time.sleep(pause if watch else 0.005)


def resident(session):
    """Bytes of memory of all processes of a session: what is their own, and the largest of what is shared."""
    own, shared = 0, 0
    for pid in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{pid}/stat") as f:
                if int(f.read().rpartition(")")[2].split()[3]) != session:
                    continue
            with open(f"/proc/{pid}/statm") as f:
                pages = f.read().split()
        except (OSError, IndexError):
            continue  # it has ended
        own += int(pages[1]) - int(pages[2])
        shared = max(shared, int(pages[2]))
    return (own + shared) * PAGE


def median(runs, key):
    return statistics.median(getattr(r, key) for r in runs)


def parser(doc):
    """An argument parser with what every benchmark takes; its help is the text `doc`."""
    p = argparse.ArgumentParser(usage=doc.replace("%", "%%"), add_help=False)
    p.add_argument("--bin", default=os.path.join(ROOT, "build", "bin"))
    p.add_argument("--json")
    p.add_argument("-h", "--help", action="store_true")
    p.add_argument("files", nargs="*")
    return p


def parse(p, words):
    """The arguments; the programs of --bin come first on PATH."""
    args = p.parse_args(words)
    if args.help:
        print(p.usage.replace("%%", "%"))
        raise SystemExit(0)
    if not os.access(os.path.join(args.bin, "mclean"), os.X_OK):
        raise SystemExit(f"--bin {args.bin}: no programs there")
    if args.json:  # refused now, not after the work
        try:
            save(args, [])
        except OSError as e:
            raise SystemExit(f"--json {e.filename}: {e.strerror}")
    os.environ["PATH"] = os.path.abspath(args.bin) + os.pathsep + os.environ["PATH"]
    return args


def surfaces(args, work, generated=None):
    """(name, path, count) for every given FILE[:TRIANGLES], or for surfaces made by mshape. FILE may be a .gz."""
    found = []
    for spec in args.files:
        path, _, count = spec.rpartition(":") if spec.rpartition(":")[2].isdigit() else (spec, "", "")
        name = os.path.basename(path).split(".")[0]
        if path.endswith(".gz"):
            packed, path = path, os.path.join(work, os.path.basename(path)[:-3])
            with gzip.open(packed) as source, open(path, "wb") as target:
                shutil.copyfileobj(source, target)
        found.append((name, path, int(count or 0)))
    if not found:
        for name, shape, count in generated or GENERATED:
            path = os.path.join(work, name + ".stl")
            subprocess.run(["mshape", *shape, "-q", "-o", path], check=True)
            found.append((name, path, count))
    return found


def table(columns):
    """Prints the head of a Markdown table; returns a function that prints a row."""
    print("| " + " | ".join(columns) + " |")
    print("|" + "---|" + "--:|" * (len(columns) - 1))

    def row(*cells):
        print("| " + " | ".join(str(c) for c in cells) + " |", flush=True)

    return row


def save(args, rows):
    if args.json:
        with open(args.json, "w") as f:
            json.dump(rows, f, indent=1)


def stages(path, count, work, threads=None):
    """Runs the chain of mremesh on a surface stage by stage through files: (stage, Run) for each, and the name of the
    result. Stops after a stage that fails."""
    out = os.path.join(work, "result.ply")
    keep = os.path.join(work, "stages")
    os.makedirs(keep, exist_ok=True)
    options = ["-q", "--triangles", str(count)] + (["-j", str(threads)] if threads else [])
    commands = subprocess.run(["mremesh", "-n", "--keep", keep, *options, path, "-o", out], check=True, capture_output=True, text=True)
    done = []
    for command in commands.stdout.splitlines():
        program = command.split()[0]
        report = os.path.join(work, program + ".json")
        done.append((program, run(f"{command} --json '{report}'", watch=True)))
        if done[-1][1].status:
            break
    return done, out


def count_triangles(path):
    """Triangles of a surface as the chain sees it: after mclean."""
    with tempfile.TemporaryDirectory() as work:
        report = os.path.join(work, "topology.json")
        done = run(f"mclean -q '{path}' | mtopo -q --json '{report}' -o '{os.path.join(work, 'surface.ply')}'")
        if done.status:
            raise SystemExit(f"{path}: {done.text.strip()}")
        with open(report) as f:
            return sum(p["faces"] for p in json.load(f)["components"])
