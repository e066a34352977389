// SPDX-License-Identifier: MIT
// Active edges: named cases, and generated meshes against brute force in extended precision.
#include "cooker/build/active_edges.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/active_edges_reference.h"
#include "tests/support/meshes.h"

namespace boxtree::cooker {
namespace {

using Bits = std::vector<std::uint8_t>;

SourceMesh mesh_of(const std::vector<std::array<float, 3>>& vertices,
                   const std::vector<Face>& faces) {
  SourceMesh mesh;
  for (const auto& v : vertices)
    mesh.positions.f32.insert(mesh.positions.f32.end(), v.begin(), v.end());
  mesh.faces = faces;
  return mesh;
}

Face triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  return {{a, b, c, kNoCorner}};
}

// Two triangles over the edge from 0 to 1, the second with its third corner at height z.
SourceMesh fold(float z) {
  return mesh_of({{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {1, 0, z}},
                 {triangle(0, 1, 2), triangle(1, 0, 3)});
}

TEST(ActiveEdges, AreThoseThatBendAwayByMoreThanTheAngle) {
  const float drop = std::tan(10 * std::numbers::pi_v<float> / 180);
  EXPECT_EQ(find_active_edges(fold(-drop), 9.99).of_face, (Bits{7, 7}));
  EXPECT_EQ(find_active_edges(fold(-drop), 10.01).of_face, (Bits{6, 6}));
  EXPECT_EQ(find_active_edges(fold(0), 0).of_face, (Bits{6, 6}));
  EXPECT_EQ(find_active_edges(fold(-1e-30F), 0).of_face, (Bits{7, 7}));  // exact
  EXPECT_EQ(find_active_edges(fold(1e-30F), 0).of_face, (Bits{6, 6}));
  EXPECT_EQ(find_active_edges(fold(3), 0).of_face, (Bits{6, 6}));  // a wall rises
  EXPECT_EQ(find_active_edges(fold(-100), 90).of_face, (Bits{6, 6}));
}

TEST(ActiveEdges, OfAFaceFoldedBackOnItsNeighbourAreActive) {
  const SourceMesh fin = mesh_of({{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {-1, 1, 0}},
                                 {triangle(0, 1, 2), triangle(1, 0, 3)});
  EXPECT_EQ(find_active_edges(fin, 5).of_face, (Bits{7, 7}));
}

TEST(ActiveEdges, OfMoreThanTwoFacesAreActive) {
  SourceMesh mesh = fold(0);
  mesh.positions.f32.insert(mesh.positions.f32.end(), {0, 0, 1});
  mesh.faces.push_back(triangle(0, 1, 4));
  EXPECT_EQ(find_active_edges(mesh, 5).of_face, (Bits{7, 7, 7}));
  EXPECT_FALSE(find_active_edges(mesh, 5).is_by_face);
}

TEST(ActiveEdges, OfCopiesAreThoseOfTheirOriginals) {
  SourceMesh mesh = fold(0);
  mesh.faces.push_back(mesh.faces[0]);
  EXPECT_EQ(find_active_edges(mesh, 5).of_face, (Bits{6, 6, 6}));
}

// Both layers of a floor that is hit from either side; where it bends, it rises on one side only.
TEST(ActiveEdges, OfFacesBackToBackAreThoseOfEachLayer) {
  for (const float z : {0.F, 1.F, -1.F}) {
    SourceMesh mesh = fold(z);
    mesh.faces.push_back(triangle(0, 2, 1));
    mesh.faces.push_back(triangle(1, 3, 0));
    const ActiveEdges found = find_active_edges(mesh, 5);
    EXPECT_EQ(found.is_by_face, z != 0);
    const std::uint8_t front = z < 0 ? 7 : 6, back = z > 0 ? 7 : 6;
    EXPECT_EQ(found.of_face[0], front);
    EXPECT_EQ(found.of_face[1], front);
    EXPECT_EQ(found.of_face[2] & 4, back == 7 ? 4 : 0);
    EXPECT_EQ(found.of_face[3] & 4, back == 7 ? 4 : 0);
  }
}

TEST(ActiveEdges, AreSeenFromTheFrontOfEachFace) {
  SourceMesh mesh = fold(-1);
  mesh.faces[1] = triangle(0, 1, 3);  // its front is below
  const ActiveEdges found = find_active_edges(mesh, 5);
  EXPECT_EQ(found.of_face, (Bits{7, 6}));
  EXPECT_TRUE(found.is_by_face);
}

TEST(ActiveEdges, FacesWithoutAreaAreNoNeighbours) {
  SourceMesh mesh = fold(0);
  mesh.faces.push_back(triangle(0, 1, 1));
  mesh.positions.f32.insert(mesh.positions.f32.end(), {0, 0.5F, 0});
  mesh.faces.push_back(triangle(0, 4, 1));
  EXPECT_EQ(find_active_edges(mesh, 5).of_face, (Bits{6, 6, 7, 7}));
}

TEST(ActiveEdges, VerticesAreOneIfTheirPositionsAre) {
  SourceMesh mesh = fold(0);
  mesh.positions.f32.insert(mesh.positions.f32.end(), {-0.F, -0.F, 0, 0, 1, -0.F});
  mesh.faces[1] = triangle(5, 4, 3);
  EXPECT_EQ(find_active_edges(mesh, 5).of_face, (Bits{6, 6}));
  mesh.positions.f32[3 * 5 + 1] = std::nextafter(1.F, 2.F);
  const ActiveEdges apart = find_active_edges(mesh, 5);
  EXPECT_EQ(apart.of_face, (Bits{7, 7}));
  EXPECT_EQ(apart.open.size(), 6u);
}

TEST(ActiveEdges, OfACubeAreAllOfThem) {
  const SourceMesh cube = mesh_of(
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}},
      {{{0, 3, 2, 1}},
       {{4, 5, 6, 7}},
       {{0, 1, 5, 4}},
       {{1, 2, 6, 5}},
       {{2, 3, 7, 6}},
       {{3, 0, 4, 7}}});
  EXPECT_EQ(find_active_edges(cube, 89).of_face, Bits(6, 15));
  SourceMesh room = cube;  // seen from inside
  for (Face& face : room.faces) std::swap(face.corner[1], face.corner[3]);
  EXPECT_EQ(find_active_edges(room, 0).of_face, Bits(6, 0));
}

TEST(ActiveEdges, AreThoseOfBruteForce) {
  for (const SourceMesh& mesh : test::all_kinds()) {
    for (const double degrees : {0.01, 1.0, 20.0, 89.0}) {
      const Bits found = find_active_edges(mesh, degrees).of_face;
      EXPECT_EQ(found, test::active_edges_by_brute_force(mesh, degrees))
          << mesh.name << ", " << degrees;
    }
  }
}

TEST(EdgeAngle, IsThatOfTheMathematicalLibrary) {
  for (double degrees = 0; degrees <= 90; degrees += 0.25) {
    const EdgeAngle angle = EdgeAngle::of_degrees(degrees);
    const double x = degrees * (std::numbers::pi / 180);
    EXPECT_NEAR(angle.cosine, std::cos(x), 0x1p-51);
    EXPECT_NEAR(angle.sine, std::sin(x), 0x1p-51);
  }
}

}  // namespace
}  // namespace boxtree::cooker
