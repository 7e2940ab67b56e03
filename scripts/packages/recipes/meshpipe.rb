# SPDX-License-Identifier: BSD-3-Clause
# Homebrew formula (Linux): brew install --build-from-source --HEAD ./meshpipe.rb, `head` set to where the sources are
class Meshpipe < Formula
  desc "Unix filters that remesh triangulated surfaces"
  license "BSD-3-Clause"
  head ENV.fetch("MESHPIPE_SOURCE", "file:///meshpipe"), using: :git, branch: "main"

  depends_on "boost" => :build
  depends_on "cli11" => :build
  depends_on "cmake" => :build
  depends_on "eigen" => :build
  depends_on "nlohmann-json" => :build
  depends_on "bash"
  depends_on "libpng"
  depends_on :linux
  depends_on "metis"
  depends_on "muparser"
  depends_on "pugixml"
  depends_on "zlib"

  def install
    system "cmake", "-S", ".", "-B", "build", "-DBUILD_TESTING=OFF", "-DMESHPIPE_ARCHIVES=OFF", *std_cmake_args
    system "cmake", "--build", "build"
    system "cmake", "--install", "build"
  end

  test do
    system bin/"mshape", "tree", "--triangles", "2000", "-q", "-o", "tree.stl"
    system bin/"mremesh", "-q", "--triangles", "2000", "tree.stl", "-o", "mesh.vtu"
    assert_predicate testpath/"mesh.vtu", :exist?
  end
end
