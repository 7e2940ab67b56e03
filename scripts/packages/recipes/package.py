# SPDX-License-Identifier: BSD-3-Clause
"""Spack: put this into packages/meshpipe/ of a repository of yours, then spack install meshpipe@main."""
import os

from spack.package import *


class Meshpipe(CMakePackage):
    """Unix filters that remesh triangulated surfaces."""

    git = os.environ.get("MESHPIPE_SOURCE", "file:///meshpipe")
    license("BSD-3-Clause")
    version("main", branch="main")

    depends_on("cxx", type="build")
    depends_on("cmake@3.20:", type="build")
    depends_on("python@3.8:", type="build")
    for library in ("eigen@3.4:", "cli11@2:", "nlohmann-json@3:", "boost+multiprecision", "libpng", "zlib-api", "pugixml",
                    "metis", "muparser"):
        depends_on(library)
    conflicts("platform=darwin")

    def cmake_args(self):
        return ["-DBUILD_TESTING=OFF", "-DMESHPIPE_ARCHIVES=OFF"]
