// SPDX-License-Identifier: MIT
// Bodies that slide and roll over floors of many triangles move as over a floor of one quad, as
// contacts at inactive edges take the normal of the face; with the normals of the contacts
// themselves they do not.
#include "tests/support/rolling.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "tests/support/cooked.h"
#include "tests/support/require.h"
#include "tests/support/scenes.h"

namespace boxtree::rolling {
namespace {

double hills(double x, double y) {
  return 0.4 * std::sin(x / 4) * std::cos(y / 5);
}

cooker::CookOptions with_active_edges(GeometryId geometry) {
  cooker::CookOptions options;
  options.active_edges = 5;
  options.geometry = geometry;
  options.grid.bits = 21;
  return options;
}

constexpr std::array<test::Encoding, 2> kEncodings = {
    {{CodecId::kWide8, GeometryId::kExact}, {CodecId::kWide4, GeometryId::kGrid}}};

TEST(Rolling, OverTenThousandFlatTrianglesIsAsOverOneQuad) {
  SourceMesh quad = floor_of(1, flat);
  quad.faces = {{{0, 1, 3, 2}}};
  for (const test::Encoding& encoding : kEncodings) {
    const cooker::CookOptions options = with_active_edges(encoding.geometry);
    const test::CookedTree many = test::cook_tree(floor_of(71, flat), encoding.codec, options);
    ASSERT_GE(many.tree.triangle_count(), 10000u);
    const test::CookedTree one = test::cook_tree(quad, encoding.codec, options);
    for (const NamedBody& body : bodies()) {
      double worst = 0;
      for (const Vector3d& direction : directions()) {
        const Vector3d start = start_of(direction);
        const Ride expected = ride(one.tree, body, start, direction, Normals::kResolved);
        const Ride found = ride(many.tree, body, start, direction, Normals::kResolved);
        EXPECT_NEAR(found.up, expected.up, 1e-9) << body.name;
        EXPECT_NEAR(found.down, expected.down, 1e-9) << body.name;
        EXPECT_NEAR(found.least_speed, expected.least_speed, 1e-9) << body.name;
        EXPECT_LE((found.end - expected.end).norm(), 1e-8) << body.name;
        EXPECT_LE(found.up, 1e-9);
        const Ride control = ride(many.tree, body, start, direction, Normals::kOfContacts);
        // What stands in the way of a crate is a wall.
        worst = std::max({worst, control.up, expected.least_speed - control.least_speed});
      }
      EXPECT_GE(worst, 0.1) << body.name << " shows nothing without active edges";
    }
  }
}

// A rectangle around the origin of cells of 1/4, whose borders fit those of others.
SourceMesh tile_of(unsigned columns, unsigned rows, unsigned seed) {
  SourceMesh mesh;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> jitter(-0.35, 0.35);
  for (unsigned y = 0; y <= rows; ++y) {
    for (unsigned x = 0; x <= columns; ++x) {
      const bool is_border = x == 0 || x == columns || y == 0 || y == rows;
      const auto at = [&](unsigned i, unsigned count) {
        return (i + (is_border ? 0 : jitter(random)) - count / 2.0) / 4;
      };
      const double px = at(x, columns), py = at(y, rows);
      for (const double number : {px, py, 0.0}) {
        mesh.positions.f32.push_back(static_cast<float>(number));
      }
    }
  }
  for (unsigned y = 0; y < rows; ++y) {
    for (unsigned x = 0; x < columns; ++x) {
      const unsigned a = y * (columns + 1) + x, b = a + 1, c = b + columns + 1, d = a + columns + 1;
      const bool rises = random() % 2 == 0;
      mesh.faces.push_back({{a, b, rises ? c : d, cooker::kNoCorner}});
      mesh.faces.push_back({{rises ? a : b, c, d, cooker::kNoCorner}});
    }
  }
  return mesh;
}

// A floor of instances.
struct Tiles {
  const char* name;
  std::vector<SourceMesh> meshes;
  cooker::SceneParts parts;

  void place(std::uint32_t tree, double x, double y, const Eigen::Matrix3d& linear) {
    cooker::PlacedTree placed;
    placed.tree = tree;
    placed.id = static_cast<std::uint32_t>(parts.instances.size());
    placed.pose.linear() = linear;
    placed.pose.translation() = Vector3d(x, y, 0);
    parts.instances.push_back(placed);
  }
};

Tiles tiles_in_a_row() {
  Tiles tiles{"a row of tiles", {tile_of(8, 80, 1)}, {}};
  for (int i = 0; i < 10; ++i) tiles.place(0, 2 * i - 9, 0, Eigen::Matrix3d::Identity());
  return tiles;
}

// Turned by right angles, some of them mirrored.
Tiles tiles_in_a_grid() {
  Tiles tiles{"a grid of tiles", {tile_of(8, 8, 2)}, {}};
  std::mt19937 random(4);
  for (int y = 0; y < 10; ++y) {
    for (int x = 0; x < 10; ++x) {
      Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
      for (unsigned i = random() % 4; i > 0; --i) {
        turn = Eigen::Matrix3d{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}} * turn;
      }
      if (random() % 3 == 0) turn.col(0) = -turn.col(0);
      tiles.place(0, 2 * x - 9, 2 * y - 9, turn);
    }
  }
  return tiles;
}

// One floor of random triangles, cut into meshes.
Tiles cut_floor() {
  constexpr unsigned kCells = 80, kPieces = 10;
  const SourceMesh whole = floor_of(kCells, flat);
  Tiles tiles{"a floor that is cut", std::vector<SourceMesh>(kPieces * kPieces), {}};
  for (std::size_t f = 0; f < whole.faces.size(); ++f) {
    const std::size_t cell = f / 2, x = cell % kCells, y = cell / kCells;
    SourceMesh& piece = tiles.meshes[y * kPieces / kCells * kPieces + x * kPieces / kCells];
    cooker::Face face = whole.faces[f];
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3d p = whole.positions[face.corner[i]];
      face.corner[i] = static_cast<std::uint32_t>(piece.positions.size());
      for (const double number : {p[0], p[1], p[2]}) {
        piece.positions.f32.push_back(static_cast<float>(number));
      }
    }
    piece.faces.push_back(face);
  }
  for (std::uint32_t i = 0; i < tiles.meshes.size(); ++i) {
    tiles.place(i, 0, 0, Eigen::Matrix3d::Identity());
  }
  return tiles;
}

TEST(Rolling, OverInstancesThatMeetIsAsOverOneQuad) {
  SourceMesh quad = floor_of(1, flat);
  quad.faces = {{{0, 1, 3, 2}}};
  for (const test::Encoding& encoding : kEncodings) {
    const cooker::CookOptions options = with_active_edges(encoding.geometry);
    const test::CookedTree one = test::cook_tree(quad, encoding.codec, options);
    for (const Tiles& tiles : {tiles_in_a_row(), tiles_in_a_grid(), cut_floor()}) {
      SCOPED_TRACE(tiles.name);
      const test::CookedScene cooked =
          test::cook_scene(tiles.meshes, tiles.parts, {encoding.codec}, options);
      const Scene many = test::require(Scene::bind(cooked.file));
      // Instances that may move have the edges of their trees alone.
      std::vector<std::uint32_t> all(many.instance_count());
      std::iota(all.begin(), all.end(), 0u);
      SceneOptions apart;
      apart.moving = all;
      const Scene control = test::require(Scene::bind(cooked.file, apart));
      double worst = 0;
      for (const NamedBody& body : bodies()) {
        for (const Vector3d& direction : directions()) {
          const Vector3d start = start_of(direction);
          const Ride expected = ride(one.tree, body, start, direction, Normals::kResolved);
          const Ride found = ride(many, body, start, direction, Normals::kResolved);
          EXPECT_NEAR(found.up, expected.up, 1e-9) << body.name;
          EXPECT_NEAR(found.down, expected.down, 1e-9) << body.name;
          EXPECT_NEAR(found.least_speed, expected.least_speed, 1e-9) << body.name;
          EXPECT_LE((found.end - expected.end).norm(), 1e-8) << body.name;
          EXPECT_LE(found.up, 1e-9);
          const Ride bumped = ride(control, body, start, direction, Normals::kResolved);
          worst = std::max({worst, bumped.up, expected.least_speed - bumped.least_speed});
        }
      }
      EXPECT_GE(worst, 0.1) << "shows nothing where borders are active";
    }
  }
}

// No facet is steeper than this; a body is not lifted faster than along it.
TEST(Rolling, OverGentleHillsNothingIsThrownUp) {
  const SourceMesh mesh = floor_of(71, hills);
  double steepest = 0;
  for (const cooker::Face& face : mesh.faces) {
    const Vector3d a = mesh.positions[face.corner[0]];
    const Vector3d n =
        (mesh.positions[face.corner[1]] - a).cross(mesh.positions[face.corner[2]] - a);
    steepest = std::max(steepest, n.head<2>().norm() / n[2]);
  }
  for (const test::Encoding& encoding : kEncodings) {
    const test::CookedTree cooked =
        test::cook_tree(mesh, encoding.codec, with_active_edges(encoding.geometry));
    for (const NamedBody& body : bodies()) {
      const bool is_round = !std::holds_alternative<OrientedBox>(body.shape);
      double worst = 0;
      for (const Vector3d& direction : directions()) {
        Vector3d start = start_of(direction);
        start[2] = hills(start[0], start[1]) + (is_round ? 0.0 : 0.1);
        const Ride found = ride(cooked.tree, body, start, direction, Normals::kResolved);
        const double most = kSpeed * steepest / std::sqrt(1 + steepest * steepest);
        EXPECT_LE(found.up, most) << body.name;
        EXPECT_GE(found.least_speed, 3) << body.name;  // what is left on a hill
        const Ride control = ride(cooked.tree, body, start, direction, Normals::kOfContacts);
        worst = std::max(worst, control.up - found.up);
      }
      EXPECT_GE(worst, 0.1) << body.name << " shows nothing without active edges";
    }
  }
}

}  // namespace
}  // namespace boxtree::rolling
