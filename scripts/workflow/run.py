# SPDX-License-Identifier: BSD-3-Clause
"""Remeshes one surface of a cohort and records how it ended.

usage: run.py NAME SURFACE RECORD.json FORMAT [options of mremesh]

Next to RECORD.json come page.html and NAME.FORMAT, which is there also where the contract is missed. Statuses 2 to 6 are
results: the record has them, and this ends with 0. Any other status, of a job that was killed or could not write, is passed on,
and left in failed.json for the summary.
"""
import json
import os
import subprocess
import sys


def note(record, status, message=""):
    """Leaves next to the record how a job has failed, or removes that of an earlier one."""
    path = os.path.join(os.path.dirname(record), "failed.json")
    if status:
        with open(path, "w", encoding="utf-8") as f:
            json.dump({"status": status, "message": message}, f)
    elif os.path.exists(path):
        os.remove(path)


def main(name, surface, record, extension, *options, more=()):
    folder = os.path.dirname(record)
    os.makedirs(folder, exist_ok=True)
    report = os.path.join(folder, "report.json")
    mesh = os.path.join(folder, f"{name}.{extension}")
    for old in (report, mesh, os.path.join(folder, "page.html")):
        if os.path.exists(old):
            os.remove(old)
    command = ["mremesh", "-q", *options, *more, "--accept", "--report", report, "--html", os.path.join(folder, "page.html"),
               "-o", mesh, "--", surface]
    done = subprocess.run(command, stdin=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, errors="replace", check=False)
    sys.stderr.write(done.stderr)
    message = done.stderr.strip().split("\n")[-1] if done.returncode else ""
    if done.returncode not in (0, 2, 3, 4, 5, 6):
        status = done.returncode if done.returncode > 0 else 128 - done.returncode
        note(record, status, message)
        return status
    found = {"name": name, "surface": surface, "options": list(options), "status": done.returncode, "message": message, "figures": {}}
    if os.path.exists(report):
        with open(report, encoding="utf-8") as f:
            found["figures"] = {k: v for k, v in json.load(f).items() if isinstance(v, (int, float, bool))}
    with open(record + ".part", "w", encoding="utf-8") as f:
        json.dump(found, f, indent=1)
    os.replace(record + ".part", record)
    note(record, 0)
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]) if len(sys.argv) > 4 else __doc__)
