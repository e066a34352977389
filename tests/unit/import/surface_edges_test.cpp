// SPDX-License-Identifier: MIT
// Edges of a surface against a count by a map of vertex positions, and by hand.
#include "cooker/import/surface_edges.h"

#include <array>
#include <cstdint>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "cooker/import/mesh_arrays.h"
#include "tests/support/meshes.h"

namespace boxtree::cooker {
namespace {

using Point = std::array<double, 3>;

// Every edge with the directions in which faces run along it; a double compares -0 equal to 0.
SurfaceEdges counted_by_map(const SourceMesh& mesh) {
  std::map<std::pair<Point, Point>, std::vector<bool>> directions;
  for (const Face& face : mesh.faces) {
    std::vector<Point> corners;
    for (const std::uint32_t corner : face.corner) {
      if (corner == kNoCorner) continue;
      const Eigen::Vector3d p = mesh.positions[corner];
      corners.push_back({p[0], p[1], p[2]});
    }
    if (std::set<Point>(corners.begin(), corners.end()).size() < corners.size()) continue;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Point& a = corners[i];
      const Point& b = corners[(i + 1) % corners.size()];
      directions[std::minmax(a, b)].push_back(a < b);
    }
  }
  SurfaceEdges edges;
  edges.is_empty = directions.empty();
  for (const auto& [edge, runs] : directions) {
    if (runs.size() == 1) ++edges.open;
    if (runs.size() > 2) ++edges.non_manifold;
    if (runs.size() == 2 && runs[0] == runs[1]) ++edges.inconsistent;
  }
  return edges;
}

SurfaceEdges count(const SourceMesh& mesh) {
  return count_surface_edges(arrays_of(mesh));
}

// Importers weld; generated meshes are as they were made.
SourceMesh welded(const SourceMesh& mesh) {
  SourceMesh out;
  out.name = mesh.name;
  std::map<Point, std::uint32_t> numbers;
  for (Face face : mesh.faces) {
    for (std::uint32_t& corner : face.corner) {
      if (corner == kNoCorner) continue;
      const Eigen::Vector3d p = mesh.positions[corner];
      const auto [place, is_new] =
          numbers.try_emplace({p[0], p[1], p[2]}, static_cast<std::uint32_t>(numbers.size()));
      for (Eigen::Index k = 0; is_new && k < 3; ++k) {
        out.positions.f32.push_back(static_cast<float>(p[k]));
      }
      corner = place->second;
    }
    out.faces.push_back(face);
  }
  return out;
}

SourceMesh tetrahedron() {
  SourceMesh mesh;
  mesh.positions.f32 = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  mesh.faces = {{{0, 2, 1, kNoCorner}},
                {{0, 1, 3, kNoCorner}},
                {{0, 3, 2, kNoCorner}},
                {{1, 2, 3, kNoCorner}}};
  return mesh;
}

TEST(SurfaceEdges, TetrahedronIsClosed) {
  EXPECT_EQ(count(tetrahedron()), SurfaceEdges{});
  EXPECT_TRUE(count(tetrahedron()).is_closed());
}

TEST(SurfaceEdges, AMissingFaceLeavesItsEdgesOpen) {
  SourceMesh mesh = tetrahedron();
  mesh.faces.pop_back();
  EXPECT_EQ(count(mesh), (SurfaceEdges{3, 0, 0}));
}

TEST(SurfaceEdges, ATurnedFaceIsInconsistentOnAllItsEdges) {
  SourceMesh mesh = tetrahedron();
  std::swap(mesh.faces[2].corner[0], mesh.faces[2].corner[1]);
  EXPECT_EQ(count(mesh), (SurfaceEdges{0, 0, 3}));
}

TEST(SurfaceEdges, AFaceTwiceIsNonManifold) {
  SourceMesh mesh = tetrahedron();
  mesh.faces.push_back(mesh.faces.front());
  EXPECT_EQ(count(mesh), (SurfaceEdges{0, 3, 0}));
}

TEST(SurfaceEdges, AFaceThatNamesAVertexTwiceHasNoSides) {
  SourceMesh mesh = tetrahedron();
  mesh.faces.push_back({{0, 1, 1, kNoCorner}});
  EXPECT_TRUE(count(mesh).is_closed());
}

TEST(SurfaceEdges, TheSignOfAZeroOpensNothing) {
  SourceMesh mesh = tetrahedron();
  mesh.positions.f32.insert(mesh.positions.f32.end(), {-0.0f, 0.0f, -0.0f});
  mesh.faces[1].corner[0] = 4;
  EXPECT_TRUE(count(mesh).is_closed());
}

TEST(SurfaceEdges, QuadsHaveFourEdges) {
  SourceMesh mesh;
  mesh.positions.f32 = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  mesh.faces = {{{0, 1, 2, 3}}};
  EXPECT_EQ(count(mesh), (SurfaceEdges{4, 0, 0}));
}

TEST(SurfaceEdges, OfNothingThereAreNone) {
  EXPECT_TRUE(count(SourceMesh{}).is_empty);
  SourceMesh points = tetrahedron();
  points.faces = {{{0, 1, 1, kNoCorner}}, {{2, 2, 2, kNoCorner}}};
  EXPECT_TRUE(count(points).is_empty);
  EXPECT_FALSE(count(points).is_closed());
}

TEST(SurfaceEdges, EqualACountByPositions) {
  for (const SourceMesh& generated : test::all_kinds()) {
    const SourceMesh mesh = welded(generated);
    EXPECT_EQ(count(mesh), counted_by_map(mesh)) << mesh.name;
  }
  EXPECT_TRUE(count(welded(test::torus(12, 20))).is_closed());
  // Few vertices and many faces: edges of every kind, in numbers.
  std::mt19937 random(7);
  for (std::uint32_t vertices = 3; vertices < 12; ++vertices) {
    SourceMesh mesh;
    for (std::uint32_t v = 0; v < 3 * vertices; ++v) {
      mesh.positions.f32.push_back(static_cast<float>(v) * (v % 7 == 0 ? -0.0f : 1.0f));
    }
    for (std::uint32_t f = 0; f < 4 * vertices; ++f) {
      const auto any = [&] { return static_cast<std::uint32_t>(random() % vertices); };
      mesh.faces.push_back({{any(), any(), any(), f % 5 == 0 ? any() : kNoCorner}});
    }
    const SurfaceEdges expected = counted_by_map(mesh);
    EXPECT_EQ(count(mesh), expected) << vertices;
    EXPECT_FALSE(expected.is_closed());
  }
}

}  // namespace
}  // namespace boxtree::cooker
