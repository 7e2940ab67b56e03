// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <numbers>

#include "lib/cap/steps.h"
#include "lib/core/error.h"
#include "lib/core/number.h"
#include "lib/core/segments.h"
#include "lib/core/topology.h"
#include "lib/core/union_find.h"

namespace meshpipe {
namespace {

/// Cosine between the normals of two loops from which they may be the two borders of a wall.
constexpr double opposite_normals = -0.8;

/// Share of the diagonal by which vertices of a plane cap may be off its plane: the rounding of doubles.
constexpr double plane_share = 1e-9;

/// Sums over the segments of a loop, relative to `origin`.
struct Sums {
  Vec3 moment, area;  ///< of the length; half the cross products
  double length = 0;
  void add(const std::vector<Vec3>& points, const std::vector<int>& rim, Vec3 origin) {
    for (std::size_t i = 0; i < rim.size(); ++i) {
      const Vec3 a = points[rim[i]] - origin, b = points[rim[(i + 1) % rim.size()]] - origin;
      const double l = norm(b - a);
      moment = moment + (0.5 * l) * (a + b);
      area = area + 0.5 * cross(a, b);
      length += l;
    }
  }
};

Plane plane_of(const End& end) { return {end.center, end.normal}; }

/// Is the loop of `inner` within that of `outer`, in nearly the same place along its axis, and seen from the
/// other side? Then the surface between them is missing, not two caps.
bool encloses(const Mesh& mesh, const End& outer, const End& inner) {
  const Vec3 way = inner.center - outer.center;
  if (dot(outer.normal, inner.normal) > opposite_normals || norm(way) > 2 * outer.radius ||
      std::abs(dot(way, outer.normal)) > outer.radius - inner.radius)
    return false;
  const PlaneView flat(plane_of(outer));
  const std::vector<int>& rim = outer.rims[0];
  return std::all_of(inner.rims[0].begin(), inner.rims[0].end(), [&](int v) {
    const Vec2 p = flat(mesh.points[v]);
    int turns = 0;
    for (std::size_t i = 0; i < rim.size(); ++i)
      turns += ray_crossing(p, flat(mesh.points[rim[i]]), flat(mesh.points[rim[(i + 1) % rim.size()]]));
    return turns != 0;
  });
}

/// Joins loops that lie within others with these.
void join_nested(const Mesh& mesh, std::vector<End>& ends) {
  std::vector<char> gone(ends.size(), 0);
  for (std::size_t i = 0; i < ends.size(); ++i) {
    if (gone[i]) continue;
    for (std::size_t j = i + 1; j < ends.size(); ++j)
      if (!gone[j] && ends[i].rims.size() == 1 && encloses(mesh, ends[i], ends[j])) {
        ends[i].rims.push_back(ends[j].rims[0]);
        gone[j] = 1;
        measure(mesh, ends[i]);
      }
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < ends.size(); ++i)
    if (!gone[i]) std::swap(ends[kept++], ends[i]);
  ends.resize(kept);
}

void sort_by_area(std::vector<End>& ends) {
  std::stable_sort(ends.begin(), ends.end(), [](const End& a, const End& b) { return a.area > b.area; });
}

}  // namespace

PlaneView::PlaneView(const Plane& plane) : origin(plane.point) {
  const Vec3 n = plane.normal;
  const Vec3 axis = std::abs(n.x) > 0.5 ? Vec3{0, 1, 0} : Vec3{1, 0, 0};
  right = normalized(cross(axis, n));
  up = cross(n, right);
}

void measure(const Mesh& mesh, End& end) {
  const Vec3 origin = mesh.points[end.rims[0][0]];
  Sums outer;
  outer.add(mesh.points, end.rims[0], origin);
  Sums all = outer;
  for (std::size_t k = 1; k < end.rims.size(); ++k) all.add(mesh.points, end.rims[k], origin);
  end.center = origin + (all.length > 0 ? 1 / all.length : 0) * all.moment;
  end.normal = normalized(all.area);
  end.area = norm(all.area);
  const double disk = norm(outer.area), pi = std::numbers::pi;
  end.radius = std::sqrt(disk / pi);
  end.roundness = outer.length > 0 ? 4 * pi * disk / (outer.length * outer.length) : 0;
  end.planarity = 0;
  for (const std::vector<int>& rim : end.rims)
    for (int v : rim) end.planarity = std::max(end.planarity, std::abs(plane_of(end).height(mesh.points[v])));
}

End end_of(const Mesh& mesh, std::vector<int> rim) {
  End end;
  end.rims.push_back(std::move(rim));
  measure(mesh, end);
  return end;
}

std::vector<std::vector<int>> rims_of(const Connectivity& c) {
  std::vector<std::vector<int>> rims;
  for (const std::vector<int>& loop : boundary_loops(c.opposite)) {
    // as in a cap, against the half-edges of the border
    std::vector<int>& rim = rims.emplace_back();
    for (auto h = loop.rbegin(); h != loop.rend(); ++h) rim.push_back(c.to(*h));
  }
  return rims;
}

int orient_outward(Surface& surface) {
  if (surface.tris.empty()) return 0;
  std::vector<int> component, of(surface.points.size(), 0);
  const int n = components(opposite_halfedges(surface), component);
  for (std::size_t t = 0; t < component.size(); ++t)
    for (int v : surface.tris[t]) of[v] = component[t];
  const std::vector<End> ends = find_ends(surface);
  UnionFind sets(n);
  for (const End& end : ends)  // a wall has two surfaces
    for (const std::vector<int>& rim : end.rims) sets.join(of[rim[0]], of[end.rims[0][0]]);
  std::vector<char> has_end(n, 0);
  for (const End& end : ends) has_end[sets.find(of[end.rims[0][0]])] = 1;
  const auto n_sets = std::count(has_end.begin(), has_end.end(), 1);
  for (int c = 1; c < n && n_sets < 2; ++c) sets.join(c, 0);
  const Vec3 origin = surface.points[surface.tris[0][0]];
  auto corner = [&](int v) { return surface.points[v] - origin; };
  std::vector<double> volume(n, 0);
  for (int t = 0; t < (int)surface.tris.size(); ++t)
    volume[sets.find(component[t])] += volume6(surface, t, origin);
  for (const End& end : ends)
    for (const std::vector<int>& rim : end.rims)
      for (std::size_t i = 0; i < rim.size(); ++i)
        volume[sets.find(of[rim[0]])] +=
            dot(end.center - origin, cross(corner(rim[i]), corner(rim[(i + 1) % rim.size()])));
  auto is_inverted = [&](int c) { return volume[c] < 0 && (n_sets < 2 || has_end[c]); };
  int reversed = 0;
  for (int c = 0; c < n; ++c) reversed += sets.find(c) == c && is_inverted(c);
  std::vector<std::uint8_t>* model =
      surface.face.has("model") ? &surface.face.get<std::uint8_t>("model") : nullptr;
  for (std::size_t t = 0; t < surface.tris.size() && reversed > 0; ++t) {
    if (!is_inverted(sets.find(component[t]))) continue;
    std::swap(surface.tris[t][1], surface.tris[t][2]);
    if (!model) continue;
    std::uint8_t& bits = (*model)[t];
    bits = (std::uint8_t)((bits & 2) | (bits & 1) << 2 | (bits >> 2 & 1));
  }
  return reversed;
}

std::vector<End> find_ends(const Mesh& mesh) {
  const std::vector<int> opposite = opposite_halfedges(mesh);
  const Connectivity c{mesh, opposite};
  if (const int v = find_pinched_vertex(c); v >= 0)
    throw NotAdmissible("vertex " + std::to_string(v) + " joins two fans of triangles; run mclean first");
  std::vector<End> ends;
  for (std::vector<int>& rim : rims_of(c)) ends.push_back(end_of(mesh, std::move(rim)));
  sort_by_area(ends);
  join_nested(mesh, ends);
  sort_by_area(ends);
  for (std::size_t i = 0; i < ends.size(); ++i)
    ends[i].name = i == 0 ? "inlet" : "outlet_" + std::to_string(i);
  return ends;
}

void name_ends(std::vector<End>& ends, const std::vector<EndName>& names) {
  const int n = (int)ends.size();
  if ((int)names.size() > n)
    throw NotAdmissible(std::to_string(names.size()) + " names for " + std::to_string(n) +
                        (n == 1 ? " end" : " ends"));
  std::vector<std::string> given(n);
  for (const EndName& name : names) {
    if (!name.placed || n == 0) continue;
    auto distance = [&](const End& e) { return norm(e.center - name.place); };
    const auto nearest = std::min_element(
        ends.begin(), ends.end(), [&](const End& a, const End& b) { return distance(a) < distance(b); });
    const int i = (int)(nearest - ends.begin());
    if (!given[i].empty())
      throw NotAdmissible(title_of(ends, i) + ", is the nearest to both '" + given[i] + "' and '" +
                          name.text + "'");
    given[i] = name.text;
  }
  int at = 0;
  for (const EndName& name : names) {
    if (name.placed) continue;
    while (!given[at].empty()) ++at;
    given[at] = name.text;
  }
  auto taken = [&](const std::string& text) { return std::count(given.begin(), given.end(), text) > 0; };
  for (int i = 0; i < n; ++i) {
    if (!given[i].empty()) continue;
    if (taken(ends[i].name))
      for (int k = n; taken(ends[i].name); ++k) ends[i].name = "outlet_" + std::to_string(k);
    given[i] = ends[i].name;
  }
  for (int i = 0; i < n; ++i) ends[i].name = given[i];
}

std::vector<char> ends_in(const std::vector<End>& ends, const std::string& list) {
  std::vector<char> found(ends.size(), 0);
  for (std::size_t from = 0; from <= list.size();) {
    const std::size_t to = std::min(list.find(',', from), list.size());
    const std::string word = list.substr(from, to - from);
    std::size_t i = 0;
    while (i < ends.size() && ends[i].name != word) ++i;
    if (i == ends.size())
      for (i = 0; i < ends.size() && std::to_string(i + 1) != word;) ++i;
    if (i == ends.size())
      throw NotAdmissible("there is no end '" + word + "' among the " + std::to_string(ends.size()) +
                          "; mcap --list shows their numbers and names");
    found[i] = 1;
    from = to + 1;
  }
  return found;
}

std::string remark_of(const CapPatches& patches) {
  return "capped " + std::to_string(patches.first) + ' ' + std::to_string(patches.last);
}

CapPatches parse_caps(const std::string& remark) {
  CapPatches patches;
  if (std::sscanf(remark.c_str(), "capped %d %d", &patches.first, &patches.last) != 2) return {};
  return patches;
}

std::vector<char> plane_triangles(const Surface& surface, const CapPatches& patches) {
  const auto& patch = surface.face.get<int>("patch");
  const int n = std::max(0, patches.last - patches.first + 1);
  auto row = [&](std::size_t t) {
    return patch[t] < patches.first || patch[t] > patches.last ? -1 : patch[t] - patches.first;
  };
  std::vector<Vec3> area(n), point(n);
  for (std::size_t t = 0; t < patch.size(); ++t)
    if (const int k = row(t); k >= 0) {
      area[k] = area[k] + area_vector(surface, (int)t);
      point[k] = surface.points[surface.tris[t][0]];
    }
  const double most = plane_share * diagonal(surface);
  std::vector<char> plane(n, 1), flags(patch.size(), 0);
  for (std::size_t t = 0; t < patch.size(); ++t)
    if (const int k = row(t); k >= 0)
      for (int v : surface.tris[t])
        if (std::abs(dot(surface.points[v] - point[k], normalized(area[k]))) > most) plane[k] = 0;
  for (std::size_t t = 0; t < patch.size(); ++t)
    if (const int k = row(t); k >= 0) flags[t] = plane[k];
  return flags;
}

std::string title_of(const std::vector<End>& ends, int i) {
  return "end " + std::to_string(i + 1) + ", " + ends[i].name + ", at " + shown(ends[i].center);
}

void refuse(const std::vector<End>& ends, int i, const std::string& why) {
  throw NotAdmissible(title_of(ends, i) + ": " + why);
}

void refuse_all(const std::vector<End>& ends, const std::vector<std::string>& why, const std::string& advice,
                const std::vector<char>* kept) {
  const int n = (int)ends.size();
  std::string list;
  int first = -1, count = 0, listed = 0;
  for (int i = n - 1; i >= 0; --i) {
    if (!why[i].empty()) first = i, ++count;
    if (!kept || (why[i].empty() && (kept->empty() || !(*kept)[i]))) continue;
    const bool is_word = ends[i].name.find(',') == std::string::npos;
    list = (is_word ? ends[i].name : std::to_string(i + 1)) + (list.empty() ? "" : ",") + list;
    ++listed;
  }
  if (first < 0) return;
  const std::string others = count > 1 ? "; the same for " + std::to_string(count - 1) + " more" : "";
  refuse(ends, first,
         why[first] + others + "; " + advice +
             (kept && listed < n ? ", or try --except " + list : std::string()));
}

std::optional<Vec3> crossing_of(const Mesh& mesh, const End& end) {
  const PlaneView flat(plane_of(end));
  std::vector<Segment> segments;
  for (const std::vector<int>& rim : end.rims)
    for (std::size_t k = 0; k < rim.size(); ++k) {
      const int a = rim[k], b = rim[(k + 1) % rim.size()];
      segments.push_back({flat(mesh.points[a]), flat(mesh.points[b]), a, b});
    }
  const auto crossing = SegmentTree(segments).crossings();
  if (crossing.empty()) return {};
  const Segment& s = segments[crossing[0][0]];
  return lerp(mesh.points[s.from], mesh.points[s.to], 0.5);
}

std::string crossing_at(const Mesh& mesh, const End& end) {
  const std::optional<Vec3> place = crossing_of(mesh, end);
  if (!place) return "";
  return std::string(end.rims.size() > 1 ? "its rims cross" : "its rim crosses itself") +
         ", seen along its normal, near " + shown(*place);
}

}  // namespace meshpipe
