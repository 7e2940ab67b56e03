#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Completions: Tab in a real bash; zsh and fish at least parse theirs, where they are installed; every option is there.

usage: tests/completion_test.py BUILD_DIR
"""
import os
import pty
import re
import select
import shutil
import subprocess
import sys
import tempfile
import time

faults = 0


def expect(what, holds):
    global faults
    if not holds:
        faults += 1
        print("failed:", what)


class Bash:
    """An interactive bash on a terminal of its own, in a folder."""

    def __init__(self, folder, programs):
        pid, self.fd = pty.fork()
        if pid == 0:
            os.chdir(folder)
            os.environ.update(PS1="$ ", TERM="dumb", PATH=programs + ":/usr/bin:/bin", INPUTRC="/dev/null")
            os.execvp("bash", ["bash", "--norc", "--noprofile", "-i"])
        self.type("bind 'set enable-bracketed-paste off'; bind 'set show-all-if-ambiguous on'\n")

    def type(self, keys):
        """Types keys and returns what is printed until nothing comes for a while."""
        os.write(self.fd, keys.encode())
        out, last = b"", time.time()
        while time.time() < last + 0.7:
            if select.select([self.fd], [], [], 0.1)[0]:
                out += os.read(self.fd, 65536)
                last = time.time()
        return out.decode(errors="replace").replace("\a", "")

    def complete(self, line):
        """Types a line and Tab; returns what is printed, and clears the line."""
        out = self.type(line + "\t")
        self.type("\x15")
        return out


def options_of(program):
    text = subprocess.run([program, "--help"], capture_output=True, text=True, check=True).stdout
    lines = [x for x in text.splitlines() if x.startswith("  -")]
    return {o for x in lines for o in re.findall(r"(?<![\w-])--[a-z][a-z-]*", x.strip().split("   ")[0])}


def test_bash(build):
    with tempfile.TemporaryDirectory() as folder:
        for name in ("surface.stl", "a folder"):
            os.mkdir(os.path.join(folder, name)) if " " in name else open(os.path.join(folder, name), "w").close()
        bash = Bash(folder, os.path.join(build, "bin"))
        bash.type(f"for f in {build}/completions/bash/*; do . $f; done\n")
        for line, expected in (("mcheck --refe", "mcheck --reference "), ("mremesh --keep-b", "mremesh --keep-boundary "),
                               ("mremesh --mesher del", "mremesh --mesher delaunay "), ("mremesh --from mes", "mremesh --from mesh2d "),
                               ("mremesh --size 1 sur", "mremesh --size 1 surface.stl "),
                               ("mremesh -o sur", "mremesh -o surface.stl "), ("mremesh --keep a", "mremesh --keep a\\ folder/"),
                               ("mremesh --si", "mremesh --size ")):
            found = bash.complete(line)
            expect(f"'{line}' is completed to '{expected}', found {found!r}", expected in found)
        found = bash.complete("mremesh --resolve ")
        expect(f"values of --resolve are shown, found {found!r}", all(w in found for w in ("none", "outer", "all")))
        os.close(bash.fd)


def main(build):
    programs = [p for p in os.listdir(os.path.join(build, "bin")) if re.fullmatch(r"m[a-z0-9]+", p)]
    for p in programs:
        with open(os.path.join(build, "completions", "bash", p), encoding="utf-8") as f:
            text = f.read()
        missing = {o for o in options_of(os.path.join(build, "bin", p)) if not re.search(re.escape(o) + r"[ ']", text)}
        expect(f"{p}: completions have {missing}", not missing)
        for shell, file in (("zsh", "zsh/_" + p), ("fish", f"fish/{p}.fish")):
            if shutil.which(shell):
                done = subprocess.run([shell, "-n", os.path.join(build, "completions", file)], capture_output=True, text=True)
                expect(f"{file}: {done.stderr}", done.returncode == 0 and not done.stderr)
    test_bash(build)
    print(f"completions of {len(programs)} programs: {faults} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(os.path.abspath(sys.argv[1])))
