// SPDX-License-Identifier: MIT
// Meshes far from the origin for their size: what f32 takes is measured, and doubles of a PLY file
// are kept where every bit is wanted.
#include "cooker/import/f32_digits.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "gltf_text.h"
#include "temp_files.h"

namespace boxtree::cooker {
namespace {

using F32DigitsTest = ImportTest;

constexpr const char* kTriangle = "f 1 2 3\n";

// A right triangle with legs of 0.1 at (459123.4321, 5412345.6789, 0), where f32 counts in steps of
// 1/32 and 1/2.
constexpr const char* kFar =
    "v 459123.4321 5412345.6789 0\nv 459123.5321 5412345.6789 0\nv 459123.4321 5412345.7789 0\n";

TEST_F(F32DigitsTest, MeasuresWhatF32MovesFarFromTheOrigin) {
  const Imported far = load("far.obj", std::string(kFar) + kTriangle);
  const auto off = [](double x) { return std::abs(x - double{static_cast<float>(x)}); };
  const double farthest = std::max({std::hypot(off(459123.4321), off(5412345.6789)),
                                    std::hypot(off(459123.5321), off(5412345.6789)),
                                    std::hypot(off(459123.4321), off(5412345.7789))});
  EXPECT_GT(farthest, 0.2);
  EXPECT_DOUBLE_EQ(far.report.moved_by_f32, farthest);
  EXPECT_EQ(far.mesh.moved_by_f32, far.report.moved_by_f32);
}

TEST_F(F32DigitsTest, SaysNothingWhereDigitsSufficeOrNoneAreLost) {
  const std::string small = "v 0.1 0 0\nv 1.1 0 0\nv 0.1 1 0\n";
  EXPECT_EQ(load("near.obj", small + kTriangle).report.moved_by_f32, 0);
  // f32 has these numbers.
  const std::string even = "v 4000000 0 0\nv 4000001 0 0\nv 4000000 1 0\n";
  EXPECT_EQ(load("even.obj", even + kTriangle).report.moved_by_f32, 0);
  // f32 has x and y, and moves z, but by little.
  const std::string flat = "v 4000000 0 1e-9\nv 4000001 0 0\nv 4000000 1 0\n";
  EXPECT_EQ(load("flat.obj", flat + kTriangle).report.moved_by_f32, 0);
  ImportOptions options;
  options.precision = Precision::kF64;
  EXPECT_EQ(load("far.obj", std::string(kFar) + kTriangle, options).report.moved_by_f32, 0);
}

// A triangle with legs of 0.5 that a node places at (487123.25, 5884352, 0), where f32 counts in
// steps of 1/32 and 1/2.
TEST_F(F32DigitsTest, MeasuresWhatF32MovesOfMeshesThatNodesPlace) {
  GltfText gltf;
  gltf.add_mesh("tile", {{{0, 0.25f, 0, 0.5f, 0.25f, 0, 0, 0.625f, 0.01f}}});
  const auto load_placed = [&](const char* translation, Precision precision) {
    ImportOptions options;
    options.precision = precision;
    return load("placed.gltf",
                gltf.text(fmt::format(R"({{"mesh":0,"translation":{}}})", translation)), options);
  };
  const std::string far = "[487123.25, 5884352, 0]";
  const Imported placed = load_placed(far.c_str(), Precision::kF32);
  EXPECT_EQ(placed.report.moved_by_f32, 0.25);
  EXPECT_EQ(placed.mesh.moved_by_f32, 0.25);
  EXPECT_EQ(placed.report.f32_loss, F32Loss::kNodes);
  EXPECT_TRUE(check_moved_by_f32(placed.mesh, "placed.gltf", 0.25).ok());
  EXPECT_EQ(check_moved_by_f32(placed.mesh, "placed.gltf", 0.2).code(), Errc::kMeshUnsupported);
  EXPECT_EQ(load_placed(far.c_str(), Precision::kF64).report.moved_by_f32, 0);
  EXPECT_EQ(load_placed("[4, 8, 0]", Precision::kF32).report.moved_by_f32, 0);
}

// Found by an oracle: a mesh of a thousand metres kept a tolerance of 10^-6 without having it.
TEST_F(F32DigitsTest, CountsWhatIsTooLittleToTell) {
  const auto long_edge = std::string("v 0 0 0\nv 999.9999 0 0\nv 0 1 0\n") + kTriangle;
  const double lost = std::abs(999.9999 - double{999.9999f});
  ImportOptions counting;
  counting.count_moves = true;
  const Imported counted = load("long.obj", long_edge, counting);
  EXPECT_EQ(counted.mesh.moved_by_f32, lost);
  EXPECT_EQ(counted.report.moved_by_f32, 0);
  EXPECT_EQ(load("long.obj", long_edge).mesh.moved_by_f32, 0);
  EXPECT_EQ(check_moved_by_f32(counted.mesh, "long.obj", 1e-6).code(), Errc::kMeshUnsupported);

  GltfText gltf;
  gltf.add_mesh("tile", {{{0, 0, 0, 1000, 0, 0, 0, 1, 0}}});
  const auto placed = [&](const ImportOptions& options) {
    return load("placed.gltf", gltf.text(R"({"mesh":0,"translation":[0.1,0,0]})"), options);
  };
  // And at most what any number of the text lost, here 0.1.
  const double moved = placed(counting).mesh.moved_by_f32, at_least = 1000.1 - double{1000.1f};
  EXPECT_GE(moved, std::abs(at_least));
  EXPECT_LE(moved, std::abs(at_least) + 1e-8);
  EXPECT_EQ(placed(counting).report.moved_by_f32, 0);
  EXPECT_EQ(placed({}).mesh.moved_by_f32, 0);
}

TEST_F(F32DigitsTest, ReadsTheDigitsOfTextStl) {
  const auto stl = [](const char* x) {
    return fmt::format(
        "solid t\nfacet normal 0 0 1\nouter loop\nvertex {0} 5884352 0\n"
        "vertex {0} 5884353 0\nvertex 487124 5884352 0\nendloop\nendfacet\n"
        "endsolid t\n",
        x);
  };
  const Imported rounded = load("far.stl", stl("487123.253"));
  EXPECT_EQ(rounded.report.moved_by_f32, 487123.253 - 487123.25);
  EXPECT_EQ(rounded.report.f32_loss, F32Loss::kDigits);
  ImportOptions options;
  options.precision = Precision::kF64;
  const Imported whole = load("far.stl", stl("487123.253"), options);
  EXPECT_EQ(whole.mesh.positions[0][0], 487123.253);
  EXPECT_EQ(whole.report.moved_by_f32, 0);
  EXPECT_FALSE(whole.report.has_f32_alone);
  EXPECT_EQ(load("even.stl", stl("487123.25")).report.moved_by_f32, 0);
}

// Found by a newcomer: that a mesh became a point, or that f32 has few digits for numbers so small,
// was no move.
TEST_F(F32DigitsTest, MeasuresWhatUnderflowMoves) {
  const auto tiny = [](const char* length) {
    return fmt::format("v 0 0 0\nv {0} 0 0\nv 0 {0} 0\n{1}", length, kTriangle);
  };
  const Imported point = load("point.obj", tiny("1e-50"));
  EXPECT_DOUBLE_EQ(point.report.moved_by_f32, 1e-50);
  EXPECT_EQ(point.mesh.moved_by_f32, point.report.moved_by_f32);
  EXPECT_EQ(check_moved_by_f32(point.mesh, "point.obj", 1e-51).code(), Errc::kMeshUnsupported);
  EXPECT_TRUE(check_moved_by_f32(point.mesh, "point.obj", 1e-49).ok());
  // 21 of the smallest number, 2^-149, are 2.94e-44.
  const Imported few = load("few.obj", tiny("3e-44"));
  EXPECT_DOUBLE_EQ(few.report.moved_by_f32, 3e-44 - 21 * 0x1p-149);
  // All digits that count are there from 2^-133 on: half of 2^-149 is 2^-17 of that.
  EXPECT_EQ(load("all.obj", tiny("1.1e-40")).report.moved_by_f32, 0);
  ImportOptions options;
  options.precision = Precision::kF64;
  EXPECT_EQ(load("whole.obj", tiny("1e-50"), options).report.moved_by_f32, 0);
  EXPECT_EQ(load("zero.obj", tiny("0")).report.moved_by_f32, 0);
}

std::string collada(const char* x) {
  return fmt::format(
      R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" )"
      R"(version="1.4.1"><library_geometries><geometry id="g"><mesh><source id="s">)"
      R"(<float_array id="a" count="9">{} 5884352 0 487124 5884352 0 487124 5884353 0)"
      R"(</float_array><technique_common><accessor source="#a" count="3" stride="3">)"
      R"(<param name="X" type="float"/><param name="Y" type="float"/>)"
      R"(<param name="Z" type="float"/></accessor></technique_common></source>)"
      R"(<vertices id="v"><input semantic="POSITION" source="#s"/></vertices>)"
      R"(<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p>)"
      R"(</triangles></mesh></geometry></library_geometries><library_visual_scenes>)"
      R"(<visual_scene id="w"><node id="n"><instance_geometry url="#g"/></node></visual_scene>)"
      R"(</library_visual_scenes><scene><instance_visual_scene url="#w"/></scene></COLLADA>)",
      x);
}

// Assimp's reader of the text has f32 alone: the warning is of it, whatever the precision.
TEST_F(F32DigitsTest, MeasuresWhatAReaderOfTextLoses) {
  for (const Precision precision : {Precision::kF32, Precision::kF64}) {
    ImportOptions options;
    options.precision = precision;
    const Imported far = load("far.dae", collada("487123.253"), options);
    EXPECT_GE(far.report.moved_by_f32, 487123.253 - 487123.25);
    EXPECT_LT(far.report.moved_by_f32, 0.006);  // of each coordinate no more than any number lost
    EXPECT_EQ(far.report.f32_loss, F32Loss::kReader);
    EXPECT_EQ(far.mesh.f32_loss, F32Loss::kReader);
    EXPECT_EQ(load("even.dae", collada("487123.25"), options).report.moved_by_f32, 0);
  }
  EXPECT_EQ(loss_in_text("<a b='0.5'>1 16777217 -3.5e-1x</a> 2026-11-26"), 1);
}

TEST_F(F32DigitsTest, KnowsWhereF64KeepsNoMore) {
  ImportOptions options;
  options.precision = Precision::kF64;
  std::string stl(84, '\0');
  stl[80] = 1;
  for (const float x : {0.f, 0.f, 1.f, 0.1f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f}) {
    stl.append(reinterpret_cast<const char*>(&x), sizeof(x));
  }
  stl.append(2, '\0');
  EXPECT_TRUE(load("a.stl", stl, options).report.has_f32_alone);
  EXPECT_FALSE(load("a.stl", stl).report.has_f32_alone);
  GltfText gltf;
  gltf.add_mesh("tile", {{{0, 0.25f, 0, 0.5f, 0.25f, 0, 0, 0.625f, 0.01f}}});
  EXPECT_TRUE(load("a.gltf", gltf.text(R"({"mesh":0})"), options).report.has_f32_alone);
  const std::string placed = gltf.text(R"({"mesh":0,"translation":[487123.25,5884352,0]})");
  EXPECT_FALSE(load("b.gltf", placed, options).report.has_f32_alone);
}

TEST_F(F32DigitsTest, LooksAgainWhereF32CountsInStepsOf16BitsOfTheExtent) {
  const auto at = [](float x) {
    Positions positions;
    positions.f32 = {x, 0, 0, x + 1, 0, 0, x, 1, 0};
    return positions;
  };
  // Up to 2^7 and up to that times an extent of 1, half of the last digit is 2^-24 times that.
  EXPECT_EQ(unnoticed_move(at(1)), 0x1p-17);
  EXPECT_FALSE(may_have_moved(at(126)));
  EXPECT_TRUE(may_have_moved(at(128)));
  EXPECT_FALSE(may_have_moved({}));
}

std::string ply_of_doubles(const std::string& vertices) {
  return "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\n"
         "property double z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n" +
         vertices + "3 0 1 2\n";
}

TEST_F(F32DigitsTest, KeepsDoublesOfPlyThatF32DoesNotHold) {
  ImportOptions options;
  options.keep_doubles = true;
  const Imported kept = load("d.ply", ply_of_doubles("0.1 0 0\n1 0 0\n0 1 0\n"), options);
  EXPECT_EQ(kept.mesh.positions.precision, Precision::kF64);
  EXPECT_EQ(kept.mesh.positions[0][0], 0.1);
  // f32 holds all of these.
  const Imported even = load("e.ply", ply_of_doubles("0.25 0 0\n1 0 0\n0 1 0\n"), options);
  EXPECT_EQ(even.mesh.positions.precision, Precision::kF32);
  EXPECT_EQ(even.mesh.positions[0][0], 0.25);
  options.keep_doubles = false;
  const Imported rounded = load("r.ply", ply_of_doubles("0.1 0 0\n1 0 0\n0 1 0\n"), options);
  EXPECT_EQ(rounded.mesh.positions[0][0], double{0.1f});
}

TEST_F(F32DigitsTest, NamesF64WhereANumberIsBeyondF32) {
  const std::string file = "v 1e39 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const Error error = fail("big.obj", file);
  EXPECT_EQ(error.code, Errc::kMeshNotFinite);
  EXPECT_TRUE(has(error.detail, "f32 ends at 3.4e38, --f64 at 1.8e308"));
  ImportOptions options;
  options.precision = Precision::kF64;
  EXPECT_EQ(load("big.obj", file, options).mesh.positions[0][0], 1e39);
}

}  // namespace
}  // namespace boxtree::cooker
