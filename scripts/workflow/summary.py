# SPDX-License-Identifier: BSD-3-Clause
"""Collects the records of a cohort into a table for MultiQC (custom content) and a tab-separated one.

usage: summary.py TABLE_mqc.json TABLE.tsv RECORD.json...

Where there is no RECORD.json, the job has failed: how, is in failed.json next to it, if it has lived to say so.
"""
import html
import json
import os
import sys

VERDICTS = {0: "passed", 2: "wrong option", 3: "unreadable", 4: "not admissible", 5: "goal not reached", 6: "contract missed"}
# key of mcheck's report -> title, what it is, further settings of the column
FIGURES = {
    "triangles": ("Triangles", "of the result", {"format": "{:,.0f}"}),
    "kappa_min": ("Kappa min", "smallest shape measure", {"min": 0, "max": 1, "format": "{:.3f}"}),
    "kappa_mean": ("Kappa mean", "mean shape measure", {"min": 0.8, "max": 1, "format": "{:.3f}"}),
    "min_angle": ("Angle min", "smallest angle", {"min": 0, "max": 60, "suffix": "°", "format": "{:.1f}"}),
    "hausdorff_bound": ("Distance", "two-sided, at most, over the diagonal", {"format": "{:.2e}"}),
    "deviation": ("Distance in sizes", "largest, over the local size", {"min": 0, "max": 1, "format": "{:.2f}"}),
    "edge_deviation": ("Edge deviation", "of edges from the size", {"min": 0, "format": "{:.3f}"}),
}


def read(path):
    """Returns a record, or that of a job that has failed."""
    folder = os.path.dirname(path)
    failed = os.path.join(folder, "failed.json")
    record = {"name": os.path.basename(folder), "status": "-", "message": "", "figures": {}}
    for place in (path, failed):
        if os.path.exists(place):
            with open(place, encoding="utf-8") as f:
                record.update(json.load(f))
            break
    if not os.path.exists(path):
        said = f"status {record['status']}" if os.path.exists(failed) else "killed, or not run"
        record["message"] = f"failed, {said}, see {folder}.log" + (": " + record["message"] if record["message"] else "")
    return record


def shown(text):
    """Returns a text for a table of MultiQC, which takes it for HTML, and commas for those of a number."""
    return html.escape(text).replace(",", "&#44;")


def main(table, sheet, *paths):
    records = [read(path) for path in paths]
    passed = sum(r["status"] == 0 for r in records)
    headers = {"verdict": {"title": "Verdict", "description": "how mremesh ended", "scale": False}}
    for key, (title, what, more) in FIGURES.items():
        headers[key] = {"title": title, "description": what, **more}
    headers["message"] = {"title": "Reason", "description": "the message of what has not passed", "scale": False}
    data = {}
    for r in records:
        row = {"verdict": VERDICTS.get(r["status"], "failed"), **{k: r["figures"][k] for k in FIGURES if k in r["figures"]}}
        data[r["name"]] = {**row, **({"message": shown(r["message"])} if r["message"] else {})}
    content = {"id": "meshpipe", "section_name": "Remeshed surfaces",
               "description": f"{passed} passed, {len(records) - passed} not, with reasons.",
               "plot_type": "table", "pconfig": {"id": "meshpipe_table", "title": "Remeshed surfaces", "no_violin": False},
               "headers": headers, "data": data}
    with open(table, "w", encoding="utf-8") as f:
        json.dump(content, f, indent=1)
    with open(sheet, "w", encoding="utf-8") as f:
        f.write("\t".join(["name", "status", "verdict", *FIGURES, "message"]) + "\n")
        for r in records:
            fields = [r["name"], r["status"], VERDICTS.get(r["status"], "failed"), *(r["figures"].get(k, "-") for k in FIGURES),
                     r["message"].replace("\t", " ") or "-"]
            f.write("\t".join(map(str, fields)) + "\n")
    print(f"{passed} passed, {len(records) - passed} not")


if __name__ == "__main__":
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
