# SPDX-License-Identifier: BSD-3-Clause
"""Filling: whether volume meshers fill the closed results with tetrahedra, and find the names of the patches again.

usage: scripts/bench fill [options] [FILE ...]

Without files, surfaces made by mshape are used: open ones are capped first, by mcap --flatten --cap. Each is remeshed (with
the number of triangles of FILE:TRIANGLES, if given) and passed to tetgen -p -Y, gmsh -3 and Netgen, each a process of its
own, and left out where it is not installed. A row holds the triangles and patches of the result, the status of mremesh, and
per mesher the tetrahedra, the seconds of CPU time, and how many patches have their triangles back on the boundary of the
tetrahedra ("all" or k of n), or how it failed.

  --timeout S              seconds for one run of any program (default 300)
  --vessel                 remesh by mremesh --vessel, which smooths before it caps
  --bin DIR                programs (default build/bin)
  --json FILE              the same figures as JSON
"""
import collections
import os
import shutil
import subprocess
import tempfile

from benches import common

GENERATED = [
    ("tube", ["tube", "--aspect", "8", "--triangles", "6000"], 0),
    ("tree-3", ["tree", "--outlets", "3", "--triangles", "12000"], 0),
    ("tree-13", ["tree", "--outlets", "13", "--triangles", "30000"], 0),
    ("tree-147", ["tree", "--outlets", "147", "--triangles", "90000"], 0),
    ("genus-5", ["genus", "--genus", "5", "--triangles", "20000"], 0),
    ("body", ["body"], 10000),
    ("sphere", ["sphere", "--triangles", "3000"], 0),
]
GEO = 'Surface Loop(1) = Surface{:}; Volume(1) = {1}; Physical Volume("inside") = {1};\n'
PYTHON = "/usr/bin/python3"  # the system's, which has Debian's python3-netgen
# Netgen 6.2: points, then triangles by patch
NETGEN = """
import sys
from netgen.meshing import Element2D, FaceDescriptor, Mesh, MeshPoint, Pnt
mesh = Mesh()
lines = open(sys.argv[1]).read().split("\\n")
n, t = map(int, lines[0].split())
points = [mesh.Add(MeshPoint(Pnt(*map(float, line.split())))) for line in lines[1:n + 1]]
faces = {}
for line in lines[n + 1:n + t + 1]:
    a, b, c, patch = map(int, line.split())
    if patch not in faces:
        faces[patch] = mesh.Add(FaceDescriptor(surfnr=len(faces) + 1, domin=1, domout=0, bc=patch))
    mesh.Add(Element2D(faces[patch], [points[v] for v in (a, b, c)]))
mesh.GenerateVolumeMesh()
out = open(sys.argv[2], "w")
out.write("%d\\n" % len(mesh.Elements3D()))
number = {face: patch for patch, face in faces.items()}
for e in mesh.Elements2D():
    out.write("%d\\n" % number[e.index])
"""


def patches_of(poly):
    """Points, and (a, b, c, patch) of a surface in a .poly file, from 0."""
    with open(poly) as f:
        rows = [line.split() for line in f if line.strip() and not line.startswith("#")]
    n = int(rows[0][0])
    points = [row[1:4] for row in rows[1:n + 1]]
    at, triangles = n + 2, []
    for _ in range(int(rows[n + 1][0])):
        marker = int(rows[at][2])
        triangles.append([int(v) - 1 for v in rows[at + 1][1:4]] + [marker])
        at += 2
    return points, triangles


def tetgen(result, work, timeout):
    """(Run, tetrahedra, triangles per patch of their boundary)"""
    shutil.copy(result["poly"], os.path.join(work, "t.poly"))
    done = common.run(["tetgen", "-p", "-Y", "-Q", os.path.join(work, "t.poly")], timeout)
    found = collections.Counter()
    with open(os.path.join(work, "t.1.ele")) as f:
        tetrahedra = int(f.readline().split()[0])
    with open(os.path.join(work, "t.1.face")) as f:
        f.readline()
        for line in f:
            row = line.split()
            if len(row) > 4 and row[0] != "#":
                found[int(row[4])] += 1
    return done, tetrahedra, found


def gmsh(result, work, timeout):
    geo, out = os.path.join(work, "fill.geo"), os.path.join(work, "volume.msh")
    with open(geo, "w") as f:
        f.write(GEO)
    done = common.run(["gmsh", "-3", "-nt", "1", "-format", "msh22", result["msh"], geo, "-o", out], timeout)
    tetrahedra, found = 0, collections.Counter()
    with open(out) as f:
        names, inside = {}, ""
        for line in f:
            row = line.split()
            if line.startswith("$"):
                inside = row[0]
            elif inside == "$PhysicalNames" and len(row) > 2 and row[0] == "2":
                names[int(row[1])] = row[2].strip('"')
            elif inside == "$Elements" and len(row) > 5:
                tetrahedra += row[1] == "4"
                if row[1] == "2":
                    found[names.get(int(row[3]), int(row[3]))] += 1
    if any(word in done.text for word in ("Error   :", "No tetrahedra")):
        done.status = done.status or 1
    return done, tetrahedra, found


def netgen(result, work, timeout):
    source, out = os.path.join(work, "netgen.txt"), os.path.join(work, "netgen.out")
    with open(source, "w") as f:
        f.write(f"{len(result['points'])} {len(result['triangles'])}\n")
        f.writelines(" ".join(p) + "\n" for p in result["points"])
        f.writelines(" ".join(map(str, t)) + "\n" for t in result["triangles"])
    script = os.path.join(work, "fill_netgen.py")
    with open(script, "w") as f:
        f.write(NETGEN)
    done = common.run([PYTHON, script, source, out], timeout)
    with open(out) as f:
        rows = f.read().split()
    return done, int(rows[0]), collections.Counter(map(int, rows[1:]))


def meshers():
    found = {}
    if shutil.which("tetgen"):
        found["tetgen"] = tetgen
    if shutil.which("gmsh"):
        found["gmsh"] = gmsh
    if subprocess.run([PYTHON, "-c", "import netgen.meshing"], capture_output=True).returncode == 0:
        found["netgen"] = netgen
    return found


def fill(mesher, result, work, timeout):
    """What a mesher makes of a result: a dictionary, and the words of the table."""
    with tempfile.TemporaryDirectory(dir=work) as scratch:
        try:
            done, tetrahedra, found = mesher(result, scratch, timeout)
        except (OSError, ValueError, IndexError):
            return {"filled": False}, "failed"
    expected = collections.Counter(t[3] for t in result["triangles"])
    named = collections.Counter({result["names"].get(p, p): n for p, n in expected.items()})
    back = sum(found[p] == n for p, n in expected.items()) or sum(found[p] == n for p, n in named.items())
    row = {"filled": done.status == 0 and tetrahedra > 0, "tetrahedra": tetrahedra, "seconds": done.cpu, "patches_back": back}
    if not row["filled"]:
        return row, "timeout" if done.status == -1 else f"failed ({done.status})"
    return row, f"{tetrahedra}, {done.cpu:.1f} s, {'all' if back == len(expected) else f'{back} of {len(expected)}'}"


def remesh(path, count, work, args):
    """Status, and the result in the formats of the meshers."""
    out = os.path.join(work, "result.ply")
    goal = f"--triangles {count}" if count else ""
    if args.vessel:
        command = f"mremesh -q --vessel {goal} '{path}' -o '{out}'"
    else:
        command = f"mclean -q '{path}' | mcap -q --flatten --cap | mremesh -q {goal} - -o '{out}'"
    done = common.run(command, args.timeout)
    if done.status:
        return done, None
    result = {}
    for kind in ("poly", "msh"):
        result[kind] = os.path.join(work, "result." + kind)
        common.run(["mconvert", "-q", out, "-o", result[kind]], args.timeout)
    result["points"], result["triangles"] = patches_of(result["poly"])
    result["names"] = {}
    with open(out, "rb") as f:
        for line in f:
            row = line.decode(errors="replace").split()
            if row[:3] == ["comment", "name", "2"]:
                result["names"][int(row[3])] = row[4]
            if row[:1] == ["end_header"]:
                break
    return done, result


def main(words):
    p = common.parser(__doc__)
    p.add_argument("--timeout", type=float, default=300)
    p.add_argument("--vessel", action="store_true")
    args = common.parse(p, words)
    programs = meshers()
    if not programs:
        raise SystemExit("neither tetgen nor gmsh nor Netgen is installed")
    rows = []
    with tempfile.TemporaryDirectory() as work:
        row = common.table(["surface", "triangles", "patches", "status", *programs])
        for name, path, count in common.surfaces(args, work, GENERATED):
            done, result = remesh(path, count, work, args)
            if result is None:
                row(name, "", "", done.status, *([""] * len(programs)))
                rows.append({"surface": name, "status": done.status, "why": done.text.strip()})
                continue
            figures, words = {}, []
            for program, mesher in programs.items():
                figures[program], text = fill(mesher, result, work, args.timeout)
                words.append(text)
            patches = len({t[3] for t in result["triangles"]})
            row(name, len(result["triangles"]), patches, done.status, *words)
            rows.append({"surface": name, "status": 0, "triangles": len(result["triangles"]), "patches": patches, **figures})
    common.save(args, rows)
    return 0 if all(r["status"] == 0 and all(r[m]["filled"] for m in programs) for r in rows) else 1
