# SPDX-License-Identifier: BSD-3-Clause
"""Remeshes triangulated surfaces through the programs of meshpipe.

    result = meshpipe.remesh(points, faces, size=0.05)
    result.points, result.faces, result.cell_data["patch"], result.report["kappa_min"]

Points and faces are arrays of shape (n, 3); meshes of meshio and PyVista are taken in place of both.
"""
import json
import os
import re
import shutil
import subprocess
import tempfile
from dataclasses import dataclass, field
from urllib.parse import unquote

import numpy as np

__all__ = ["remesh", "Result", "Error", "InternalError", "UsageError", "InputError", "NotAdmissible", "GoalMissed",
           "ContractMissed", "OutputError"]


class Error(RuntimeError):
    """A program that failed: its exit status, and its report where there is one."""
    status = 1

    def __init__(self, message, report=None):
        super().__init__(message)
        self.report = report or {}


class InternalError(Error):
    """Status 1: an error in meshpipe, or a program that was killed."""


class UsageError(Error, ValueError):
    """Status 2: an option that does not exist or a value that is not possible."""
    status = 2


class InputError(Error, ValueError):
    """Status 3: points or faces that are malformed."""
    status = 3


class NotAdmissible(Error):
    """Status 4: a surface that has to be repaired first; the message says how."""
    status = 4


class GoalMissed(Error):
    """Status 5: a stage that could not reach its goal."""
    status = 5


class ContractMissed(Error):
    """Status 6: the result misses its contract."""
    status = 6


class OutputError(Error, OSError):
    """Status 7: no place for intermediates."""
    status = 7


@dataclass
class Result:
    """A mesh: points (n, 3), faces (m, 3), columns of both, the names of patches, and the report of mcheck."""
    points: np.ndarray
    faces: np.ndarray
    point_data: dict = field(default_factory=dict)
    cell_data: dict = field(default_factory=dict)
    patch_names: dict = field(default_factory=dict)
    report: dict = field(default_factory=dict)


def remesh(points, faces=None, *, size=None, patch=None, **options):
    """Remeshes a surface and returns a Result, or raises the exception of the exit status.

    size: a length, or one for each point. patch: an integer for each face. Options are those of mremesh, with _ for -:
    triangles=5000, keep_boundary=True, max_error=1e-3, accept=True.
    """
    points, faces = _arrays(points, faces)
    columns = {}
    if size is not None and np.ndim(size):
        columns["asked_size"] = np.asarray(size, float)
        if columns["asked_size"].shape != (len(points),):
            raise UsageError(f"size has {np.size(size)} values, expected one or {len(points)}")
        options = {"data": "asked_size", **options}
    elif size is not None:
        options = {"size": size, **options}
    if no := sorted({"output", "dry_run", "help", "version", "order"} & set(options)):
        raise UsageError(f"{no[0]}: not from Python, which returns points and triangles")
    command = [_program(), "-", "-o", "-"]
    for name, value in options.items():
        if value is None or value is False:
            continue
        command.append("--" + name.replace("_", "-"))
        if value is not True:
            command.append(str(value))
    with tempfile.TemporaryDirectory() as folder:
        report = os.path.join(folder, "report.json")
        done = subprocess.run([*command, "-q", "--report", report], input=_ply(points, faces, columns, patch),
                              capture_output=True, check=False)
        found = {}
        if os.path.exists(report) and os.path.getsize(report):
            with open(report, encoding="utf-8") as f:
                found = json.load(f)
    if done.returncode and not (done.returncode == 6 and done.stdout.startswith(b"ply")):
        raise _error(done.returncode, done.stderr.decode(errors="replace"), found)
    return _result(done.stdout, found)


def _program():
    own = os.path.join(os.path.dirname(__file__), "bin", "mremesh")
    path = own if os.path.exists(own) else shutil.which("mremesh")
    if not path:
        raise InternalError("there is no program mremesh, neither in the package nor on the PATH")
    return path


def _arrays(mesh, faces):
    """Returns points and faces as arrays: of two arrays, or of a mesh of meshio or PyVista."""
    if faces is None:
        if hasattr(mesh, "cells_dict"):  # meshio
            cells = {"triangle": np.empty((0, 3), int), "quad": np.empty((0, 4), int), **mesh.cells_dict}
            if no := sorted(set(cells) - {"vertex", "line", "triangle", "quad"}):
                raise InputError(f"expected triangles and quads of meshio, found {', '.join(no)}")
            quads = np.asarray(cells["quad"])
            faces = np.vstack([cells["triangle"], quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
        elif hasattr(mesh, "n_faces_strict") or hasattr(mesh, "triangulate"):  # PyVista: 3 a b c 3 a b c ...
            mesh = mesh.triangulate()
            faces = np.asarray(mesh.faces).reshape(-1, 4)[:, 1:]
        else:
            raise UsageError(f"expected points and faces, or a mesh of meshio or PyVista, found {type(mesh).__name__}")
        mesh = mesh.points
    points, faces = np.asarray(mesh, float), np.asarray(faces)
    for name, array in (("points", points), ("faces", faces)):
        if array.ndim != 2 or array.shape[1] != 3:
            raise InputError(f"{name}: expected shape (n, 3), found {array.shape}")
    if faces.size and not np.issubdtype(faces.dtype, np.integer):
        raise InputError(f"faces: expected integers, found {faces.dtype}")
    if faces.size and (faces.min() < 0 or faces.max() >= len(points)):
        raise InputError(f"faces use points {faces.min()} to {faces.max()}, but there are {len(points)}")
    return points, faces.astype("<i4")


def _ply(points, faces, columns, patch):
    """Returns a binary PLY, as the programs read it."""
    head = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n"
    head += "".join(f"property double {n}\n" for n in ["x", "y", "z", *columns])
    head += f"element face {len(faces)}\nproperty list uchar int vertex_indices\n"
    row = [("n", "u1"), ("v", "<i4", 3)]
    if patch is not None:
        if np.shape(patch) != (len(faces),):
            raise InputError(f"patch: expected {len(faces)} values, found {np.size(patch)}")
        head += "property int patch\n"
        row.append(("patch", "<i4"))
    rows = np.zeros(len(faces), row)
    rows["n"], rows["v"] = 3, faces
    if patch is not None:
        rows["patch"] = patch
    vertices = np.column_stack([points, *columns.values()]).astype("<f8")
    return (head + "end_header\n").encode() + vertices.tobytes() + rows.tobytes()


def _result(stream, report):
    """Reads vertex and face of a binary stream."""
    head, body = stream.split(b"end_header\n", 1)
    types = {"double": "<f8", "int": "<i4", "uchar": "u1"}
    tables, names = [], {}
    for words in map(str.split, head.decode().splitlines()):
        if words[0] == "element":
            tables.append((words[1], int(words[2]), []))
        elif words[:2] == ["property", "list"]:
            tables[-1][2].extend([("", "u1"), ("corners", "<i4", 3)])
        elif words[0] == "property":
            tables[-1][2].append((words[2], types[words[1]]))
        elif words[:3] == ["comment", "name", "2"]:
            names[int(words[3])] = unquote(words[4])
    data, at = {}, 0
    for name, rows, row in tables[:2]:
        data[name] = np.frombuffer(body, np.dtype(row), rows, at)
        at += data[name].nbytes
    vertex, face = data["vertex"], data["face"]
    return Result(np.column_stack([vertex[c] for c in "xyz"]), face["corners"].copy(),
                  {n: vertex[n].copy() for n in vertex.dtype.names[3:]},
                  {n: face[n].copy() for n in face.dtype.names if n not in ("corners", "f0")}, names, report)


def _error(status, text, report):
    """Returns the exception of an exit status, with the program's message."""
    lines = [x for x in text.splitlines() if x.strip()] or [f"mremesh ended with status {status}"]
    message = re.sub(r"^(m[a-z0-9]+): error: ", r"\1: ", lines[-1])
    kinds = {c.status: c for c in (UsageError, InputError, NotAdmissible, GoalMissed, ContractMissed, OutputError)}
    return kinds.get(status, InternalError)(message, report)
