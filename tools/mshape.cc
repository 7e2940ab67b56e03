// SPDX-License-Identifier: BSD-3-Clause
// mshape: make test surfaces.
#include <algorithm>
#include <numbers>

#include "lib/shape/shape.h"
#include "tools/common.h"

using namespace meshpipe;

namespace {

/// Times the triangles that were asked for from which more are reported: fewer come from rounding to whole
/// rows.
constexpr double most_over = 1.25;

struct Options {
  std::string kind;
  int triangles = 0;  // 0: the usual number of the kind
  double aspect = 0, ratio = 0, voxels = 0, noise = 0, slivers = 0, dirt = 0;
  int patches = 0;
  bool closed = false;
  int genus = 2, generations = 0, outlets = 0, seed = 1;
  std::string brick, within = "ball";
  int nested = 0, voronoi = 0;
  std::string image;
};

/// Reads "4x4x4", or "4" for the same.
std::array<int, 3> counts_in(const std::string& text) {
  std::array<int, 3> n{};
  int end = 0;
  if (std::sscanf(text.c_str(), "%3dx%3dx%3d%n", &n[0], &n[1], &n[2], &end) < 3) {
    if (std::sscanf(text.c_str(), "%3d%n", &n[0], &end) == 1) n[1] = n[2] = n[0];
  }
  if (end != (int)text.size() || *std::min_element(n.begin(), n.end()) < 1)
    throw BadUsage("--brick: expected NxMxK, each 1 to 999, found '" + text + "'");
  return n;
}

Mesh regions(const Options& o, int triangles) {
  if (o.nested > 0) return nested_spheres(o.nested, triangles);
  const bool ball = o.within == "ball";
  if (o.voronoi > 0 && !o.image.empty())
    return labeled_image(o.voronoi, ball, o.image == "blocks", triangles, o.seed);
  if (o.voronoi > 0) return voronoi(o.voronoi, ball, triangles, o.seed);
  return brick(counts_in(o.brick.empty() ? "2x1x1" : o.brick), triangles);
}

/// Returns the number of triangles with which a region is about ten edges across: with fewer, corners force
/// most of them to be bad.
int usual_of_regions(const Options& o) {
  constexpr int per_square = 250, per_region = 1500, per_region_of_image = 2500, per_smallest = 200;
  constexpr double most = 1e7;
  if (o.nested > 0) {
    const double n = o.nested, squares = n * (n + 1) * (2 * n + 1) / 6;  // areas relative to the smallest
    return (int)std::min(per_smallest * squares, most);
  }
  if (o.voronoi > 0) return (o.image.empty() ? per_region : per_region_of_image) * o.voronoi;
  const auto [a, b, c] = counts_in(o.brick.empty() ? "2x1x1" : o.brick);
  const double squares = (double)a * b * (c + 1) + (double)b * c * (a + 1) + (double)c * a * (b + 1);
  return (int)std::min(per_square * squares, most);
}

/// Returns the number of vertices around a tube of about n triangles.
int around(double aspect, bool closed, int n) {
  const double pi = std::numbers::pi, per_square = 4 * aspect / (std::sqrt(3) * pi) + (closed ? 1 / pi : 0);
  return std::max(3, (int)std::lround(std::sqrt(n / per_square)));
}

Body make(const Options& o) {
  auto triangles = [&](int usual) { return o.triangles > 0 ? o.triangles : usual; };
  auto ratio = [&](double usual) { return o.ratio > 0 ? o.ratio : usual; };
  if (o.kind == "cube") return cube(triangles(1200));
  if (o.kind == "body") {
    // two patches per square, and the six sides
    const int squares = o.patches > 0 ? std::max(1, (o.patches - 5) / 2) : 8;
    const int columns = o.patches > 0 ? (int)std::ceil(std::sqrt(squares)) : 4;
    const int rows = std::max(1, (squares + columns / 2) / columns);
    return cad_body(columns, rows, triangles(300 * squares) / (5 * columns * rows));
  }
  Body body;
  Mesh& mesh = body;
  if (o.kind == "tube") {
    const double aspect = o.aspect > 0 ? o.aspect : 10;
    mesh = tube(aspect, around(aspect, o.closed, triangles(10000)), o.closed);
  }
  if (o.kind == "sphere") mesh = sphere(triangles(5000));
  if (o.kind == "torus") mesh = torus(ratio(0.4), triangles(5000));
  if (o.kind == "genus") mesh = genus_surface(o.genus, triangles(10000));
  if (o.kind == "tree") {
    const int outlets = o.outlets == 0 && o.generations == 0 ? 13 : o.outlets;
    mesh = branching_tree(o.generations, outlets, ratio(0.8), triangles(25000), o.seed, o.aspect);
  }
  if (o.kind == "regions") mesh = regions(o, triangles(std::max(10000, usual_of_regions(o))));
  body.patch.assign(mesh.tris.size(), 0);
  return body;
}

Stream stream_of(Body&& shape) {
  Stream stream;
  Surface& s = stream.surface;
  static_cast<Mesh&>(s) = std::move(static_cast<Mesh&>(shape));
  s.vertex.rows = s.points.size();
  s.face.rows = s.tris.size();
  for (int& label : shape.patch) ++label;  // tag 0 means none to some formats
  s.face.set("patch", std::move(shape.patch));
  for (std::size_t i = 0; i < shape.names.size(); ++i)
    stream.names.push_back({2, (int)i + 1, shape.names[i]});
  return stream;
}

/// The options that only some kinds have.
constexpr std::pair<const char*, const char*> kinds_of[] = {
    {"--aspect", "tube or tree"}, {"--ratio", "tree or torus"}, {"--closed", "tube"},
    {"--patches", "body"},        {"--genus", "genus"},         {"--generations", "tree"},
    {"--outlets", "tree"},        {"--brick", "regions"},       {"--nested", "regions"},
    {"--voronoi", "regions"},     {"--within", "regions"},      {"--image", "regions"},
};

void expect_own_options(const CLI::App& app, const std::string& kind) {
  for (const auto& [option, kinds] : kinds_of)
    if (app.count(option) > 0 && (' ' + std::string(kinds) + ' ').find(' ' + kind + ' ') == std::string::npos)
      throw BadUsage(std::string(option) + " is an option of " + kinds + ", not of " + kind);
}

void add_region_options(CLI::App& app, Options& o) {
  auto* brick = app.add_option("--brick", o.brick, "regions: a brick of N x M x K unit cubes (default 2x1x1)")
                    ->type_name("NxMxK");
  auto* nested = app.add_option("--nested", o.nested, "regions: N nested spheres")
                     ->check(CLI::Range(1, 1000))
                     ->excludes(brick)
                     ->type_name("N");
  auto* voronoi = app.add_option("--voronoi", o.voronoi, "regions: Voronoi regions of N random points")
                      ->check(CLI::Range(1, 1000))
                      ->excludes(brick)
                      ->excludes(nested)
                      ->type_name("N");
  app.add_option("--within", o.within, "regions: extent of --voronoi, ball (default) or box")
      ->check(CLI::IsMember({"ball", "box"}))
      ->needs(voronoi);
  app.add_option("--image", o.image,
                 "regions: make --voronoi as a labeled image, by smooth surface nets or the faces of its "
                 "voxels (blocks)")
      ->check(CLI::IsMember({"smooth", "blocks"}))
      ->needs(voronoi);
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  CLI::Option* generations = nullptr;
  const CLI::App* parsed = nullptr;
  auto add_options = [&](CLI::App& app) {
    parsed = &app;
    app.add_option("KIND", o.kind, "tube, sphere, torus, genus, tree, body, cube or regions")
        ->required()
        ->check(CLI::IsMember({"tube", "sphere", "torus", "genus", "tree", "body", "cube", "regions"}))
        ->type_name("");
    app.add_option("--triangles", o.triangles, "approximate number of triangles")
        ->check(CLI::Range(1, 100000000));
    app.add_option("--aspect", o.aspect,
                   "tube: height over diameter (default 10); tree: aspect ratio of a tube with the same area")
        ->check(CLI::Range(0.01, 1e5));
    app.add_option("--patches", o.patches, "body: approximate number of faces, each a patch (default 22)")
        ->check(CLI::Range(8, 100000));
    app.add_flag("--closed", o.closed, "tube: close the ends by flat caps");
    app.add_option("--genus", o.genus, "genus: number of holes of the plate (default 2)")
        ->check(CLI::Range(0, 10000));
    generations = app.add_option("--generations", o.generations,
                                 "tree: number of bifurcations from the inlet to every outlet")
                      ->check(CLI::Range(1, 10));
    app.add_option("--outlets", o.outlets, "tree: number of open ends, including the inlet (default 13)")
        ->check(CLI::Range(2, 2000))
        ->excludes(generations);
    app.add_option("--ratio", o.ratio,
                   "tree: radius of a child over that of its parent (default 0.8); torus: radius of the tube "
                   "over that of the ring (default 0.4)")
        ->check(CLI::Range(0.05, 0.95));
    app.add_option(
           "--voxels", o.voxels,
           "make the shape from voxel faces, as in a segmentation, with this voxel size; ends are closed")
        ->check(positive_number());
    add_region_options(app, o);
    app.add_option("--noise", o.noise, "move vertices randomly by up to this share of the mean edge length")
        ->check(CLI::Range(0.0, 1.0));
    app.add_option("--slivers", o.slivers, "split this fraction of the edges close to one end")
        ->check(CLI::Range(0.0, 1.0));
    app.add_option("--dirt", o.dirt,
                   "add this fraction of each kind of bad triangle: duplicate, of zero area, inconsistently "
                   "oriented, "
                   "not welded")
        ->check(CLI::Range(0.0, 1.0));
    app.add_option("--seed", o.seed, "seed of the random numbers (default 1)");
    for (const auto& [option, kinds] : kinds_of) app.get_option(option)->group("Options of some kinds");
  };
  auto body = [&](Io& io) {
    expect_own_options(*parsed, o.kind);
    if (o.voxels > 0 && o.kind == "regions")
      throw BadUsage("--voxels takes one body, not regions; voxels of regions: --voronoi N --image blocks");
    Body shape = make(o);
    const bool more = o.triangles > 0 && o.voxels == 0 && shape.tris.size() > most_over * o.triangles;
    if (o.voxels > 0) {
      Body body{voxels(std::move(shape), o.voxels), {}, {}};
      body.patch.assign(body.tris.size(), 0);
      shape = std::move(body);
    }
    Stream stream = stream_of(std::move(shape));
    Surface& s = stream.surface;
    if (o.noise > 0) add_noise(s, o.noise, o.seed);
    if (o.slivers > 0) add_slivers(s, o.slivers, o.seed);
    if (o.dirt > 0) add_dirt(s, o.dirt, o.seed);
    io.say(std::to_string(s.points.size()) + " vertices, " + std::to_string(s.tris.size()) + " triangles" +
           (more ? ", more than asked for: the shape has no fewer" : ""));
    io.report["vertices"] = s.points.size();
    io.report["triangles"] = s.tris.size();
    io.write(stream);
  };
  return run_tool(argc, argv, "mshape",
                  "Make a test surface: a tube, sphere, torus, plate with holes (genus), branching tree of "
                  "tubes, CAD-like body, cube, or sheets between many regions.\n\nexamples:\n  mshape tree "
                  "-o tree.stl\n  mshape tree --outlets 147 --triangles "
                  "90000 -o airways.stl\n"
                  "  mshape body --patches 850 --triangles 1000000 -o gear.msh\n"
                  "  mshape regions --voronoi 50 --triangles 40000 -o foam.vtu\n"
                  "  mshape tube --aspect 100 --noise 0.1 | mclean | mtopo > tube.ply",
                  add_options, body, {.reads = false});
}
