// SPDX-License-Identifier: BSD-3-Clause
#include "lib/check/shares.h"

#include <gtest/gtest.h>

#include "formats/stream/check_tables.h"
#include "lib/check/check.h"
#include "lib/core/error.h"
#include "lib/shape/shape.h"

using namespace meshpipe;

namespace {

/// A torus that has been spoiled: a vertex through the other side, a fold, and a dent.
Surface spoiled() {
  Surface s = surface_of(torus(0.4, 3000));
  s.points[5] = s.points[5] + 40 * (s.points[6] - s.points[5]);
  s.points[700] = s.points[700] + 2.2 * (s.points[s.tris[0][0]] - s.points[700]);
  const Tri t = s.tris[2000];
  s.points[t[0]] =
      s.points[t[1]] + 0.7 * (s.points[t[2]] - s.points[t[1]]) + 0.4 * (s.points[t[1]] - s.points[t[0]]);
  return s;
}

std::vector<ShareFindings> measured(const Surface& result, const Surface& reference, int triangles) {
  std::vector<ShareFindings> found;
  cut_examination(result, reference, triangles, 10000, 0.01,
                  [&](const CheckShare& share, int number, int all) {
                    EXPECT_EQ(number, (int)found.size());
                    EXPECT_LT(number, all);
                    found.push_back(measure(share));
                  });
  return found;
}

void expect_same(const Surface& result, const Surface& reference) {
  const Findings whole = examine(result, reference, nullptr, 10000, 0.01);
  for (int triangles : {200, 1000, 100000}) {
    const std::vector<ShareFindings> shares = measured(result, reference, triangles);
    const Findings f = examine(result, reference, nullptr, 10000, 0.01, false, 0, &shares);
    EXPECT_EQ(f.intersections, whole.intersections);
    EXPECT_EQ(f.new_intersections, whole.new_intersections);
    EXPECT_EQ(f.edges.folds, whole.edges.folds);
    EXPECT_NEAR(f.off[f.farthest], whole.off[whole.farthest], 1e-9);
    const Distance &a = f.distance, &b = whole.distance;
    EXPECT_LE(a.hausdorff, b.hausdorff + b.bound);
    EXPECT_LE(b.hausdorff, a.hausdorff + a.bound);
    EXPECT_EQ(a.deviation.worst > 1, b.deviation.worst > 1);
    EXPECT_EQ(a.deviation.allowed, b.deviation.allowed);
    EXPECT_NEAR(a.mean, b.mean, 0.05 * b.mean + 1e-9);
    for (std::size_t t = 0; t < a.deviation.ratio.size(); ++t)
      EXPECT_EQ(a.deviation.ratio[t] > 1, b.deviation.ratio[t] > 1) << t;
    const Contract contract = parse_contract(default_contract);
    std::vector<std::string> names[2];
    for (const Failure& x : judge(contract, f, result)) names[0].push_back(x.requirement);
    for (const Failure& x : judge(contract, whole, result)) names[1].push_back(x.requirement);
    EXPECT_EQ(names[0], names[1]);
  }
}

}  // namespace

TEST(Shares, OfASoundResultFindWhatTheWholeDoes) {
  expect_same(surface_of(torus(0.4, 3000)), surface_of(torus(0.4, 8000)));
}

TEST(Shares, OfASpoiledResultFindWhatTheWholeDoes) {
  const Surface s = spoiled();
  const Findings f = examine(s, surface_of(torus(0.4, 8000)), nullptr, 10000, 0.01);
  EXPECT_FALSE(f.new_intersections.empty());
  EXPECT_GT(f.distance.deviation.worst, 1);
  expect_same(s, surface_of(torus(0.4, 8000)));
}

// triangles of the reference are much larger than shares
TEST(Shares, HalveLargeTrianglesOfTheReference) { expect_same(surface_of(cube(6000)), surface_of(cube(12))); }

// a part of the reference that nothing of the result is near to
TEST(Shares, FindWhatTheResultLacks) {
  Surface reference = surface_of(cube(600));
  const Body far = cube(600);
  const int first = (int)reference.points.size();
  for (Vec3 p : far.points) reference.points.push_back(p + Vec3{40, 0, 0});
  for (const auto& [a, b, c] : far.tris) reference.tris.push_back({a + first, b + first, c + first});
  const Surface result = surface_of(cube(600));
  const std::vector<ShareFindings> shares = measured(result, surface_of(reference), 200);
  const Findings f = examine(result, surface_of(reference), nullptr, 10000, 0.01, false, 0, &shares);
  EXPECT_GT(f.distance.hausdorff, 0.9);
  bool failed = false;
  for (const Failure& x : judge(parse_contract("deviation=0.5"), f, result))
    failed |= x.requirement == "deviation";
  EXPECT_TRUE(failed);
}

TEST(Shares, AreStreams) {
  const Surface result = spoiled(), reference = surface_of(torus(0.4, 8000));
  Stream whole;
  whole.surface = result;
  Table faces{"ref_face", 0, {}};
  faces.set("a", std::vector<int>(reference.tris.size()));
  whole.set(std::move(faces));
  std::vector<Stream> files;
  const auto read = [&](const std::string& name, const auto& take) { take(files.at(std::stoi(name))); };
  std::vector<std::string> names;
  std::vector<ShareFindings> direct;
  cut_examination(result, reference, 1000, 10000, 0.01, [&](const CheckShare& share, int number, int all) {
    direct.push_back(measure(share));
    const Stream s = stream_of({number, all, share});
    const CheckJob job = take_share(read_stream(write_stream(s, true), "share"));
    EXPECT_EQ(job.number, number);
    Stream out = stream_of(number, job.all, measure(job.share));
    out.history = {{"mcheck", "1", "--accept"}};
    names.push_back(std::to_string(files.size()));
    files.push_back(out);
  });
  const auto joined = join_checks(whole, {"mcheck", "", ""}, names, read);
  ASSERT_EQ(joined.size(), direct.size());
  for (std::size_t i = 0; i < joined.size(); ++i) {
    EXPECT_EQ(joined[i].intersections, direct[i].intersections);
    EXPECT_EQ(joined[i].folds, direct[i].folds);
    EXPECT_EQ(joined[i].off, direct[i].off);
    for (int side : {0, 1}) EXPECT_EQ(joined[i].distance[side].largest, direct[i].distance[side].largest);
  }
  EXPECT_THROW(join_checks(whole, {"mcheck", "", "--require=kappa"}, names, read), BadInput);
  names.pop_back();
  EXPECT_THROW(join_checks(whole, {"mcheck", "", ""}, names, read), BadInput);
  names.push_back("0");
  EXPECT_THROW(join_checks(whole, {"mcheck", "", ""}, names, read), BadInput);
  whole.surface.tris.resize(10);
  names.back() = std::to_string(files.size() - 1);
  EXPECT_THROW(join_checks(whole, {"mcheck", "", ""}, names, read), BadInput);
}
