# SPDX-License-Identifier: BSD-3-Clause
"""Remeshes a surface of a cohort; a large one in steps, with maps, plane meshes, tiles of mrelax and measurements of mcheck made in
shards as separate jobs.

usage: shards.py STEP NAME SURFACE RECORD.json FORMAT SHARDS [options of mremesh]

The steps are begin, map-1 ... map-SHARDS, middle, plane-1 ... plane-SHARDS, lift, relax-1 ... relax-SHARDS, seams, repair-1 ...
repair-SHARDS, relaxed, check-1 ... check-SHARDS and end; with 0 SHARDS only end. Each leaves a file of its name in the folder
`shards` next to RECORD.json. `end` leaves what run.py does, the result to the byte, and removes the intermediates. Where the
result is too small for tiles of mrelax, there is nothing to do from `relax-1` to `check-SHARDS`.
If a step fails, the later ones do nothing, and `end` remeshes the surface at once: the outcome and its reason are those of mremesh.
"""
import glob
import os
import shlex
import shutil
import subprocess
import sys

import run

FAILURES = (2, 3, 4, 5, 6)  # results, as in run.py; anything else is tried again


class Failed(Exception):
    """A program has failed with one of these."""


def call(*command):
    status = subprocess.run(command, stdin=subprocess.DEVNULL, check=False).returncode
    if status in FAILURES:
        raise Failed
    if status:
        sys.exit(status if status > 0 else 128 - status)


class Steps:
    def __init__(self, name, surface, record, extension, shards, options):
        self.name, self.surface, self.record, self.extension = name, surface, record, extension
        self.shards, self.options = shards, options
        self.folder = os.path.join(os.path.dirname(record), "shards")
        self.stages = os.path.join(self.folder, "stages")

    def stage(self, name):
        """Returns the file of a stage that has run, as mremesh --keep names it."""
        return glob.glob(os.path.join(self.stages, f"[0-9][0-9]-{name}.ply"))[0]

    def program(self, name):
        """Returns a stage's command, without its input and output, and the file that its result has in the chain."""
        shown = subprocess.run(["mremesh", "-n", "-q", *self.options, "--keep", self.stages, "-o", "-", "--", self.surface],
                               capture_output=True, text=True, check=True).stdout
        line = next(shlex.split(line) for line in shown.splitlines() if line.startswith(name + " "))
        return line[:line.index("-o") - 1], line[line.index("-o") + 1]

    def chain(self, *stages):
        call("mremesh", "-q", *self.options, "--keep", self.stages, *stages, "--", self.surface)

    def cut(self, kind, command, source):
        for folder in (kind, kind + "-done"):
            shutil.rmtree(os.path.join(self.folder, folder), ignore_errors=True)
            os.makedirs(os.path.join(self.folder, folder))
        call(*command, "--shards", str(self.shards), "--into", os.path.join(self.folder, kind), source)

    def has_tiles(self):
        return os.path.exists(os.path.join(self.folder, "relax", "1.ply"))

    def rest(self):
        """Returns the options of mremesh for what is left."""
        checked = os.path.join(self.folder, "check-done")
        return ["--keep", self.stages, "--from", "check" if self.has_tiles() else "relax",
                *(["--checked", checked] if os.path.exists(os.path.join(checked, "1.ply")) else [])]

    def join(self, stage, kind, program):
        command, result = self.program(program)
        call(*command, "--join", os.path.join(self.folder, kind + "-done"), self.stage(stage), "-o", result)

    def work(self, kind, program, number):
        shard = os.path.join(self.folder, kind, number + ".ply")
        if os.path.exists(shard):  # there may be fewer parts than shards
            call(*self.program(program)[0], shard, "-o", os.path.join(self.folder, kind + "-done", number + ".ply"))

    def run(self, step):
        kind, _, number = step.partition("-")
        if step == "begin":
            shutil.rmtree(self.stages, ignore_errors=True)
            self.chain("--to", "multiscale")
            self.cut("map", ["mshard", "-q"], self.stage("multiscale"))
        elif kind == "map":
            self.work(kind, "mparam", number)
        elif step == "middle":
            self.join("multiscale", "map", "mparam")
            self.chain("--from", "size", "--to", "lines")
            self.cut("plane", ["mshard", "-q"], self.stage("lines"))
        elif kind == "plane":
            self.work(kind, "mmesh2d", number)
        elif step == "lift":
            self.join("lines", "plane", "mmesh2d")
            self.chain("--from", "lift", "--to", "lift")
            self.cut("relax", self.program("mrelax")[0], self.stage("lift"))
        elif kind in ("relax", "repair"):
            self.work(kind, "mrelax", number)
        elif step == "seams" and self.has_tiles():
            command = [*self.program("mrelax")[0], "--join", os.path.join(self.folder, "relax-done")]
            self.cut("repair", command, self.stage("lift"))
        elif step == "relaxed" and self.has_tiles():
            command, result = self.program("mrelax")
            call(*command, "--accept", "--join", os.path.join(self.folder, "repair-done"), self.stage("lift"), "-o", result)
            tile = command[command.index("--tile"):][:2] if "--tile" in command else []
            self.cut("check", [*self.program("mcheck")[0], *tile], result)
        elif kind == "check":
            self.work(kind, "mcheck", number)
        elif step not in ("seams", "relaxed"):
            sys.exit(__doc__)


def main(step, *arguments):
    name, surface, record, extension, shards, *options = arguments
    if shards == "0":
        return run.main(name, surface, record, extension, *options)
    steps = Steps(name, surface, record, extension, int(shards), options)
    os.makedirs(steps.folder, exist_ok=True)
    failed = os.path.join(steps.folder, "failed")
    if step == "begin" and os.path.exists(failed):
        os.remove(failed)
    try:
        if not os.path.exists(failed) and step != "end":
            steps.run(step)
    except SystemExit as end:
        run.note(record, end.code)
        raise
    except Failed:
        open(failed, "w", encoding="utf-8").close()
    if step != "end":
        open(os.path.join(steps.folder, step), "w", encoding="utf-8").close()
        return 0
    rest = [] if os.path.exists(failed) else steps.rest()
    status = run.main(name, surface, record, extension, *options, more=rest)
    if status == 0:
        for folder in ("stages", *(kind + done for kind in ("map", "plane", "relax", "repair", "check") for done in ("", "-done"))):
            shutil.rmtree(os.path.join(steps.folder, folder), ignore_errors=True)
    return status


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]) if len(sys.argv) > 6 else __doc__)
