#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Other programs read what this project writes: VTK, meshio, MeshLab and Gmsh, each skipped with a message if missing.

usage: tests/interop_test.py BIN_DIR [FILE.ply ...]

Converts a small mesh to every format in both encodings, reads each back and compares the counts. All intermediates of
a pipe, and the streams given as further arguments, must open in VTK and MeshLab as they are.
"""
import os
import shutil
import subprocess
import sys
import tempfile

try:
    import vtk
except ImportError:
    vtk = None
try:
    import meshio
except ImportError:
    meshio = None

# two patches with names, one vertex no face uses: a stream with a table that foreign readers must skip
SAMPLE = """ply
format ascii 1.0
comment mply 1.0
comment name 2 1 inlet
comment name 2 5 outer%20wall
element vertex 7
property double x
property double y
property double z
property double size
element face 4
property list uchar int vertex_indices
property int patch
property int part
element part 2
property int genus
property double area
end_header
0 0 0 1
1 0 0 1
1 1 0 1
0 1 0 1
2 0 0.5 1
2 1 0.5 1
0.1 0.2 0.3 1
3 0 1 2 1 0
3 0 2 3 1 0
3 1 4 5 5 1
3 1 5 2 5 1
0 2
0 1
"""
VERTICES, FACES = 7, 4

# a line with a name along the first two triangles; without further data, which meshio 5.0 takes from files of one kind of
# elements only
LINES = """ply
format ascii 1.0
comment mply 1.0
comment name 2 1 inlet
comment name 1 3 crease
element vertex 4
property double x
property double y
property double z
element face 2
property list uchar int vertex_indices
property int patch
property uchar model
element line 1
property int kind
property int tag
property int first
property int count
property int closed
element line_vertex 3
property int vertex_a
property int vertex_b
property double t
end_header
0 0 0
1 0 0
1 1 0
0 1 0
3 0 1 2 1 2
3 0 2 3 1 2
1 3 0 3 0
1 1 0
2 2 0
3 3 0
"""

failures = []
checked = 0


def check(what, found, expected):
    global checked
    checked += 1
    if found != expected:
        failures.append(f"{what}: {found}, not {expected}")


def missing(tool):
    print(f"skipped: {tool} is not installed")


def header_counts(path):
    """Vertices and faces by the header of a PLY."""
    counts = {}
    with open(path, "rb") as file:
        for line in file:
            words = line.split()
            if words[:1] == [b"element"]:
                counts[words[1].decode()] = int(words[2])
            if words == [b"end_header"]:
                return counts["vertex"], counts["face"]
    raise ValueError(path)


VTK_READERS = {"ply": "vtkPLYReader", "stl": "vtkSTLReader", "obj": "vtkOBJReader", "vtu": "vtkXMLUnstructuredGridReader",
               "vtp": "vtkXMLPolyDataReader", "vtk": "vtkGenericDataObjectReader"}


def vtk_read(path):
    reader = getattr(vtk, VTK_READERS[path.rsplit(".", 1)[1].replace("mply", "ply")])()
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()


def vtk_checks(path):
    kind = path.rsplit(".", 1)[1].replace("mply", "ply")
    if kind not in VTK_READERS:
        return
    data = vtk_read(path)
    # the reader of STL merges equal points and drops unused ones
    points = VERTICES - 1 if kind == "stl" else VERTICES
    check(f"VTK, {path}", (data.GetNumberOfPoints(), data.GetNumberOfCells()), (points, FACES))
    if kind in ("vtu", "vtp", "vtk"):
        patch = data.GetCellData().GetArray("patch")
        check(f"VTK, patches of {path}", [patch.GetValue(i) for i in range(FACES)], [1, 1, 5, 5])
        tags = [data.GetFieldData().GetArray(name) for name in ("inlet", "outer wall")]
        check(f"VTK, names of {path}", [t and t.GetValue(0) for t in tags], [1, 5])
        check(f"VTK, sizes of {path}", data.GetPointData().GetArray("size").GetRange(), (1.0, 1.0))


def meshio_checks(path):
    kind = path.rsplit(".", 1)[1]
    if kind == "mply" or (kind == "ply" and "binary" in path):
        return  # meshio takes no further elements, and no column after the list in binary
    if kind in ("vtp", "gts", "poly", "smesh", "sol", "solb"):
        return
    by_name = {"msh4": "gmsh", "msh2": "gmsh"}
    mesh = meshio.read(path, file_format=by_name.get(kind))
    cells = sum(len(c.data) for c in mesh.cells if c.type == "triangle")
    points = len(mesh.points)
    if kind == "stl":
        points, expected = 0, 0  # merged or not by version
    else:
        expected = VERTICES
    check(f"meshio, {path}", (points, cells), (expected, FACES))
    if kind.startswith("msh"):
        check(f"meshio, tags of {path}", [int(t) for c in mesh.cell_data["gmsh:physical"] for t in c], [1, 1, 5, 5])
        check(f"meshio, names of {path}", {n: int(v[0]) for n, v in mesh.field_data.items()}, {"inlet": 1, "outer wall": 5})
        check(f"meshio, sizes of {path}", list(mesh.point_data["size"].ravel()), [1.0] * VERTICES)
    if kind in ("bdf", "mesh", "meshb"):
        tags = mesh.cell_data["nastran:ref" if kind == "bdf" else "medit:ref"]
        check(f"meshio, tags of {path}", [int(t) for c in tags for t in c], [1, 1, 5, 5])
    if kind == "inp":
        check(f"meshio, sets of {path}", sorted(mesh.cell_sets), ["inlet", "outer_wall"])
    if kind in ("vtu", "vtk"):
        check(f"meshio, patches of {path}", [int(t) for c in mesh.cell_data["patch"] for t in c], [1, 1, 5, 5])


def meshlab_checks(path, scratch):
    out = os.path.join(scratch, "meshlab.off")
    if os.path.exists(out):
        os.remove(out)
    run = ["xvfb-run", "-a", "meshlabserver", "-i", path, "-o", out]
    done = subprocess.run(run, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=120, check=False)
    if not os.path.exists(out):
        failures.append(f"MeshLab does not open {path}: {done.stdout.decode(errors='replace')[-300:]}")
        return
    with open(out) as file:
        words = file.read().split()
    return int(words[1]), int(words[2])


def gmsh_checks(path, scratch):
    out = os.path.join(scratch, "gmsh.msh2")
    done = subprocess.run(["gmsh", path, "-save_all", "-save", "-format", "msh2", "-o", out],
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=120, check=False)
    check(f"Gmsh, errors on {path}", [l for l in done.stdout.decode(errors="replace").splitlines() if "Error" in l], [])
    with open(out) as file:
        lines = file.read().split("\n")
    elements = lines[lines.index("$Elements") + 2:lines.index("$EndElements")]
    check(f"Gmsh, {path}", sum(e.split()[1] == "2" for e in elements), FACES)


def gmsh_types(path, scratch):
    """The types of the elements that Gmsh reads in a file, sorted."""
    out = os.path.join(scratch, "gmsh.msh2")
    subprocess.run(["gmsh", path, "-save_all", "-save", "-format", "msh2", "-o", out],
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=120, check=False)
    with open(out) as file:
        lines = file.read().split("\n")
    return sorted(e.split()[1] for e in lines[lines.index("$Elements") + 2:lines.index("$EndElements")])


def line_checks(mconvert, scratch):
    """Lines of the model and their names in the formats that hold them, as other programs read them."""
    sample = os.path.join(scratch, "lines.mply")
    with open(sample, "w") as file:
        file.write(LINES)
    for encoding in ("ascii", "binary"):
        for kind in ("msh2", "msh4", "mesh", "meshb"):
            path = os.path.join(scratch, f"lines-{encoding}.{kind}")
            subprocess.run([mconvert, f"--{encoding}", sample, "-o", path], check=True)
            back = subprocess.run([mconvert, "--ascii", path], stdout=subprocess.PIPE, check=True, text=True).stdout
            rows = [r for r in back.splitlines() if not r.startswith("comment")]
            check(f"mconvert on {path}", rows, [r for r in LINES.splitlines() if not r.startswith("comment")])
            if meshio:
                mesh = meshio.read(path, file_format="gmsh" if kind.startswith("msh") else None)
                tags = mesh.cell_data["gmsh:physical" if kind.startswith("msh") else "medit:ref"]
                found = {c.type: [int(t) for t in values] for c, values in zip(mesh.cells, tags)}
                check(f"meshio, lines of {path}", found, {"triangle": [1, 1], "line": [3, 3]})
                if kind.startswith("msh"):
                    check(f"meshio, names of {path}", {n: [int(x) for x in v] for n, v in mesh.field_data.items()},
                          {"inlet": [1, 2], "crease": [3, 1]})
            if shutil.which("gmsh") and kind != "meshb":  # which Debian's is built without
                check(f"Gmsh, lines of {path}", gmsh_types(path, scratch), ["1", "1", "2", "2"])


def second_order_checks(mconvert, scratch):
    """Triangles and lines of second order: their nodes, in the order of Gmsh and VTK."""
    sample = os.path.join(scratch, "second.mply")
    table = "element mid_vertex 5\nproperty int a\nproperty int b\n" + "".join(f"property double {x}\n" for x in "xyz")
    nodes = [(0, 1), (0, 2), (0, 3), (1, 2), (2, 3)]
    corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
    rows = "".join(f"{a} {b} {(corners[a][0] + corners[b][0]) / 2} {(corners[a][1] + corners[b][1]) / 2} 0.1\n" for a, b in nodes)
    with open(sample, "w") as file:
        file.write(LINES.replace("end_header\n", table + "end_header\n") + rows)
    number = {frozenset(e): 4 + i for i, e in enumerate(nodes)}
    expected = [[a, b, c] + [number[frozenset(e)] for e in ((a, b), (b, c), (c, a))] for a, b, c in ((0, 1, 2), (0, 2, 3))]
    lines = [[1, 2, 7], [2, 3, 8]]
    for encoding in ("ascii", "binary"):
        for kind in ("msh2", "msh4", "vtu"):
            path = os.path.join(scratch, f"second-{encoding}.{kind}")
            subprocess.run([mconvert, f"--{encoding}", sample, "-o", path], check=True)
            reads(mconvert, path, [1] * 8, "mconvert: read flat between their nodes: 2 curved elements of second order\n")
            if meshio:
                mesh = meshio.read(path, file_format="gmsh" if kind.startswith("msh") else None)
                found = {c.type: c.data.tolist() for c in mesh.cells}
                wanted = {"triangle6": expected} | ({"line3": lines} if kind != "vtu" else {})
                check(f"meshio, nodes of {path}", (len(mesh.points), found), (9, wanted))
            if vtk and kind == "vtu":
                grid = vtk_read(path)
                found = [[grid.GetCell(t).GetPointId(i) for i in range(6)] for t in range(grid.GetNumberOfCells())]
                check(f"VTK, nodes of {path}", ([grid.GetCellType(0)], found), ([22], expected))
            if shutil.which("gmsh") and kind != "vtu":
                check(f"Gmsh, types of {path}", gmsh_types(path, scratch), ["8", "8", "9", "9"])


def region_checks(programs, scratch):
    """The regions of a brick and of nested spheres, as TetGen and Gmsh fill them: labels and volumes."""
    def run(*command):
        subprocess.run(command, cwd=scratch, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=120, check=False)
    def volumes(points, tetrahedra):
        found = {}
        for label, corners in tetrahedra:
            p, q, r = ([points[v][i] - points[corners[3]][i] for i in range(3)] for v in corners[:3])
            det = sum(p[i] * (q[i - 2] * r[i - 1] - q[i - 1] * r[i - 2]) for i in range(3))
            found[label] = found.get(label, 0) + abs(det) / 6
        return {label: round(found[label], 9) for label in sorted(found)}
    mclean, mconvert, mshape = (os.path.join(programs, p) for p in ("mclean", "mconvert", "mshape"))
    for shape in (["--brick", "2x2x1"], ["--nested", "2"]):
        run(mshape, "regions", *shape, "--triangles", "400", "-o", "r.off")
        run(mclean, "--sheets", "keep", "r.off", "-o", "r.mply")
        for kind in ("poly", "smesh", "msh", "geo"):
            run(mconvert, "--ascii", "r.mply", "-o", f"r.{kind}")
        text = subprocess.run([mconvert, "--ascii", os.path.join(scratch, "r.mply")], stdout=subprocess.PIPE, check=True, text=True).stdout
        table = text.splitlines()[-int(text.split("element region ")[1].split()[0]):]
        expected = {int(row.split()[0]): round(float(row.split()[1]), 9) for row in table}
        if shutil.which("tetgen"):
            for facets in ("r.poly", "r.smesh"):
                run("tetgen", "-pAQ", facets)
                rows = {}
                for kind in ("node", "ele"):
                    with open(os.path.join(scratch, f"r.1.{kind}")) as file:
                        rows[kind] = [line.split() for line in file if not line.startswith("#")][1:]
                    os.remove(os.path.join(scratch, f"r.1.{kind}"))
                points = {row[0]: [float(x) for x in row[1:4]] for row in rows["node"]}
                check(f"TetGen, regions {shape}, {facets}", volumes(points, [(int(row[5]), row[1:5]) for row in rows["ele"]]), expected)
        if shutil.which("gmsh"):
            run("gmsh", "-3", "-format", "msh2", "r.msh", "r.geo", "-o", "volume.msh")
            with open(os.path.join(scratch, "volume.msh")) as file:
                text = file.read()
            nodes = [line.split() for line in text.split("$Nodes")[1].split("$End")[0].splitlines()[2:]]
            elements = [line.split() for line in text.split("$Elements")[1].split("$End")[0].splitlines()[2:]]
            points = {row[0]: [float(x) for x in row[1:4]] for row in nodes}
            check(f"Gmsh, regions {shape}", volumes(points, [(int(row[3]), row[-4:]) for row in elements if row[1] == "4"]), expected)


def vtk_written(scratch):
    """The sample as VTK itself writes it, in every encoding: pairs of a file and what its data are."""
    points = vtk.vtkPoints()
    points.SetDataTypeToDouble()
    for p in ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0, 0.5), (2, 1, 0.5)):
        points.InsertNextPoint(p)
    surface = vtk.vtkPolyData()
    surface.SetPoints(points)

    def cells(*rows):
        array = vtk.vtkCellArray()
        for row in rows:
            array.InsertNextCell(len(row))
            for v in row:
                array.InsertCellPoint(v)
        return array
    # a vertex and a line, which are left out; a quadrilateral; a strip
    surface.SetVerts(cells([0]))
    surface.SetLines(cells([0, 1]))
    surface.SetPolys(cells([0, 1, 2, 3]))
    surface.SetStrips(cells([1, 4, 2, 5]))
    patch = vtk.vtkIntArray()
    patch.SetName("patch")
    for tag in (8, 9, 1, 5):
        patch.InsertNextValue(tag)
    surface.GetCellData().AddArray(patch)
    speed = vtk.vtkFloatArray()
    speed.SetName("wall speed")
    speed.SetNumberOfComponents(3)
    for i in range(6):
        speed.InsertNextTuple3(i, 0.5, 2)
    surface.GetPointData().AddArray(speed)
    append = vtk.vtkAppendFilter()
    append.AddInputData(surface)
    append.Update()
    grid = append.GetOutput()
    for data, xml, legacy, kind in ((surface, vtk.vtkXMLPolyDataWriter, vtk.vtkPolyDataWriter, "vtp"),
                                    (grid, vtk.vtkXMLUnstructuredGridWriter, vtk.vtkUnstructuredGridWriter, "vtu")):
        def write(writer, name):
            path = os.path.join(scratch, name)
            writer.SetInputData(data)
            writer.SetFileName(path)
            writer.Write()
            return path
        for mode in ("Ascii", "Binary", "Appended"):
            for compressor in ("None", "ZLib"):
                for encoded, big, wide in ((0, 0, 0), (1, 0, 1), (0, 1, 1), (1, 1, 0)):
                    writer = xml()
                    getattr(writer, f"SetDataModeTo{mode}")()
                    getattr(writer, f"SetCompressorTypeTo{compressor}")()
                    writer.SetBlockSize(64)
                    writer.SetEncodeAppendedData(encoded)
                    writer.SetByteOrder(0 if big else 1)
                    writer.SetHeaderType(64 if wide else 32)
                    yield write(writer, f"vtk-{mode}-{compressor}-{encoded}-{big}-{wide}.{kind}")
        for version in (42, 51):
            for binary in (0, 1):
                writer = legacy()
                writer.SetFileVersion(version)
                writer.SetFileType(binary + 1)
                yield write(writer, f"vtk-{kind}-{version}-{binary}.vtk")


def gmsh_written(path, scratch):
    """The sample as Gmsh writes it, in every version it knows."""
    for kind, options in (("msh1", []), ("msh2", []), ("msh2", ["-bin"]), ("msh40", []), ("msh4", []),
                          ("msh4", ["-bin"]), ("mesh", [])):
        out = os.path.join(scratch, f"gmsh-{kind}{''.join(options)}.{kind}")
        subprocess.run(["gmsh", path, "-save", "-format", kind, *options, "-o", out], stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL, timeout=120, check=False)
        yield out


def reads(mconvert, path, expected, said=""):
    """What mconvert makes of another program's file, and says: rows of faces, without the vertex numbers."""
    done = subprocess.run([mconvert, "--surface", "--ascii", path], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          check=False, text=True)
    rows = done.stdout.split("end_header\n")[-1].splitlines()
    patches = sorted(int(r.split()[4]) for r in rows if r.startswith("3 ") and len(r.split()) == 5)
    check(f"mconvert on {path}", (done.stderr, patches), (said, expected))


def intermediates(programs, scratch):
    """The streams between the stages of the remeshing of a small tree."""
    stages = "mshape mclean mtopo mfeature mcoarsen mpartition mmultiscale mparam msize mlines mmesh2d mlift mrelax mcheck mremesh"
    absent = [p for p in stages.split() if not os.path.exists(os.path.join(programs, p))]
    if absent:
        print(f"skipped: the pipe, without {', '.join(absent)}")
        return []
    env = dict(os.environ, PATH=programs + os.pathsep + os.environ["PATH"])
    tree, keep = os.path.join(scratch, "tree.stl"), os.path.join(scratch, "keep")
    subprocess.run(["mshape", "tree", "--triangles", "3000", "-q", "-o", tree], env=env, check=True)
    done = subprocess.run(["mremesh", "-q", "--keep", keep, tree, "-o", os.path.join(scratch, "mesh.vtu")], env=env,
                          stderr=subprocess.PIPE, check=False)
    check("mremesh on a small tree", (done.returncode, done.stderr.decode()), (0, ""))
    return sorted(os.path.join(keep, name) for name in os.listdir(keep) if name.endswith(".ply"))


def main():
    programs, streams = os.path.abspath(sys.argv[1]), sys.argv[2:]
    mconvert = os.path.join(programs, "mconvert")
    display = shutil.which("meshlabserver") and shutil.which("xvfb-run")
    for tool, found in (("python3-vtk9", vtk), ("meshio", meshio), ("meshlabserver with xvfb-run", display),
                        ("gmsh", shutil.which("gmsh"))):
        if not found:
            missing(tool)
    with tempfile.TemporaryDirectory() as scratch:
        sample = os.path.join(scratch, "sample.mply")
        with open(sample, "w") as file:
            file.write(SAMPLE)
        for encoding in ("ascii", "binary"):
            for kind in ("mply", "ply", "stl", "obj", "off", "msh", "msh2", "msh4", "vtu", "vtp", "vtk", "mesh", "meshb", "sol",
                         "solb", "gts", "bdf", "inp", "poly", "smesh"):
                path = os.path.join(scratch, f"{encoding}.{kind}")
                subprocess.run([mconvert, f"--{encoding}", sample, "-o", path], check=True)
                if vtk:
                    vtk_checks(path)
                if meshio:
                    meshio_checks(path)
            if shutil.which("gmsh"):
                for kind in ("msh", "msh4", "vtk", "mesh", "bdf", "stl"):
                    gmsh_checks(os.path.join(scratch, f"{encoding}.{kind}"), scratch)
        if vtk:
            for path in vtk_written(scratch):
                reads(mconvert, path, [1, 1, 5, 5])
            subprocess.run([mconvert, "--polydata", sample, "-o", os.path.join(scratch, "polydata.vtk")], check=True)
            vtk_checks(os.path.join(scratch, "polydata.vtk"))
        if shutil.which("gmsh"):
            for path in gmsh_written(os.path.join(scratch, "ascii.msh"), scratch):
                reads(mconvert, path, [1, 1, 5, 5])
        line_checks(mconvert, scratch)
        second_order_checks(mconvert, scratch)
        region_checks(programs, scratch)
        colored = os.path.join(scratch, "colored.ply")
        subprocess.run([mconvert, "--color", "part", sample, "-o", colored], check=True)
        if vtk:
            colors = vtk_read(colored).GetCellData().GetArray("RGB")
            check("VTK, colors", colors and [colors.GetTuple(0) == colors.GetTuple(i) for i in range(FACES)],
                  [True, True, False, False])
        streams = streams + intermediates(programs, scratch)
        streams += [os.path.join(scratch, f"{encoding}.{kind}") for encoding in ("ascii", "binary")
                    for kind in ("mply", "ply")]
        for path in streams:
            expected = header_counts(path)
            # these programs go by the extension
            as_ply = os.path.join(scratch, "stream.ply")
            shutil.copy(path, as_ply)
            if vtk:
                data = vtk_read(as_ply)
                check(f"VTK, {path}", (data.GetNumberOfPoints(), data.GetNumberOfCells()), expected)
            if display:
                check(f"MeshLab, {path}", meshlab_checks(as_ply, scratch), expected)
    for failure in failures:
        print(f"failed: {failure}")
    print(f"{checked} checks, {len(failures)} failed")
    return 1 if failures else 0


sys.exit(main())
