// SPDX-License-Identifier: MIT
// Bodies that slide and roll over floors of many triangles move as over a floor of one quad, as
// contacts at inactive edges take the normal of the face; with the normals of the contacts
// themselves they do not.
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

namespace boxtree {
namespace {

using cooker::SourceMesh;
using Eigen::Vector3d;

constexpr double kStep = 1.0 / 60;
constexpr double kGravity = 9.81;
constexpr double kSpeed = 5;
constexpr double kSunk = 1e-3;  // so that bodies touch triangles beside them

constexpr double kSize = 20;  // of a floor

double flat(double, double) {
  return 0;
}
double hills(double x, double y) {
  return 0.4 * std::sin(x / 4) * std::cos(y / 5);
}

// A square around the origin of cells^2 cells of two triangles each, with vertices and diagonals at
// random.
SourceMesh floor_of(unsigned cells, double (*height)(double, double), unsigned seed = 1) {
  SourceMesh mesh;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> jitter(-0.35, 0.35);
  for (unsigned y = 0; y <= cells; ++y) {
    for (unsigned x = 0; x <= cells; ++x) {
      const auto at = [&](unsigned i) {
        const bool is_border = i == 0 || i == cells;
        return ((is_border ? i : i + jitter(random)) / cells - 0.5) * kSize;
      };
      const double px = at(x), py = at(y);
      for (const double number : {px, py, height(px, py)}) {
        mesh.positions.f32.push_back(static_cast<float>(number));
      }
    }
  }
  const auto add = [&](unsigned a, unsigned b, unsigned c) {
    mesh.faces.push_back({{a, b, c, cooker::kNoCorner}});
  };
  for (unsigned y = 0; y < cells; ++y) {
    for (unsigned x = 0; x < cells; ++x) {
      const unsigned a = y * (cells + 1) + x, b = a + 1, c = b + cells + 1, d = a + cells + 1;
      if (random() % 2 == 0) {
        add(a, b, c), add(a, c, d);
      } else {
        add(a, b, d), add(b, c, d);
      }
    }
  }
  return mesh;
}

using Body = std::variant<Sphere, Capsule, OrientedBox>;

struct NamedBody {
  const char* name;
  Body shape;      // its lowest point at the origin
  double inertia;  // of a sphere, over mass; 0: it does not turn
};

std::vector<NamedBody> bodies() {
  constexpr double kRadius = 0.4;
  OrientedBox box{{0, 0, 0.3}, {0.5, 0.35, 0.3}, {}};
  box.rotation = Eigen::AngleAxisd(0.3, Vector3d::UnitZ());
  return {{"a sphere that slides", Sphere{{0, 0, kRadius}, kRadius}, 0},
          {"a sphere that rolls", Sphere{{0, 0, kRadius}, kRadius}, 0.4 * kRadius * kRadius},
          {"a capsule upright", Capsule{{0, 0, kRadius}, {0, 0, 1.4}, kRadius}, 0},
          {"a capsule along x", Capsule{{-0.5, 0, kRadius}, {0.5, 0, kRadius}, kRadius}, 0},
          {"a crate", box, 0}};
}

Body moved(Body body, const Vector3d& by) {
  std::visit(
      [&](auto& shape) {
        if constexpr (requires { shape.start; }) {
          shape.start += by;
          shape.end += by;
        } else {
          shape.center += by;
        }
      },
      body);
  return body;
}

enum class Normals { kResolved, kOfContacts };

// What the fastest vertical movement was, up and down, and where it ended.
struct Ride {
  double up = 0;
  double down = 0;
  double least_speed = kSpeed;
  Vector3d end = Vector3d::Zero();
};

// One contact of the solver, with the impulses (over mass) that it has given so far.
struct Row {
  Vector3d normal;
  Vector3d arm;  // from the center of a sphere
  double bias;
  double pushed = 0;
};

// Sequential impulses at 60 Hz, with what is too deep parted by a fifth a step.
template <class Surface>
Ride ride(const Surface& surface, const NamedBody& body, const Vector3d& start,
          const Vector3d& direction, Normals normals) {
  constexpr int kSteps = 150;
  constexpr int kIterations = 30;
  constexpr double kFriction = 0.5;
  Vector3d at = start - kSunk * Vector3d::UnitZ();
  Vector3d velocity = kSpeed * direction;
  Vector3d spin = Vector3d::Zero();
  const auto* const ball = std::get_if<Sphere>(&body.shape);
  if (body.inertia > 0) spin = Vector3d::UnitZ().cross(velocity) / ball->radius;
  Ride found;
  for (int step = 0; step < kSteps; ++step) {
    velocity[2] -= kGravity * kStep;
    std::vector<Row> rows;
    const Body placed = moved(body.shape, at);
    const auto touched = [&](const Contact& contact) {
      const Vector3d normal =
          normals == Normals::kResolved ? resolved_normal(contact, velocity) : contact.normal;
      const double bias = 0.2 * std::max(0.0, contact.depth - kSunk) / kStep;
      Vector3d arm = Vector3d::Zero();
      if (body.inertia > 0) arm = -ball->radius * normal;
      rows.push_back({normal, arm, bias});
      return true;
    };
    std::visit(
        [&](const auto& shape) {
          static_cast<void>(test::require(collide(surface, shape, touched)));
        },
        placed);
    for (int i = 0; i < kIterations; ++i) {
      for (Row& row : rows) {
        const double before = row.pushed;
        row.pushed = std::max(0.0, before + row.bias - velocity.dot(row.normal));
        velocity += (row.pushed - before) * row.normal;
        if (body.inertia == 0) continue;
        // Rolling friction, so that the sphere turns as it moves.
        const Vector3d at_contact = velocity + spin.cross(row.arm);
        const Vector3d slip = at_contact - at_contact.dot(row.normal) * row.normal;
        const double mass = 1 / (1 + row.arm.squaredNorm() / body.inertia);
        Vector3d impulse = -mass * slip;
        const double most = kFriction * row.pushed;
        if (impulse.norm() > most) impulse *= most / impulse.norm();
        velocity += impulse;
        spin += row.arm.cross(impulse) / body.inertia;
      }
    }
    at += kStep * velocity;
    found.up = std::max(found.up, velocity[2]);
    found.down = std::min(found.down, velocity[2]);
    found.least_speed = std::min(found.least_speed, velocity.head<2>().norm());
  }
  found.end = at;
  return found;
}

std::vector<Vector3d> directions() {
  std::vector<Vector3d> out;
  for (const double degrees : {0.0, 17.0, 45.0, 90.0, 203.0}) {
    const double x = degrees * (std::numbers::pi / 180);
    out.emplace_back(std::cos(x), std::sin(x), 0);
  }
  return out;
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

// Starts so that the whole way lies on the floor.
Vector3d start_of(const Vector3d& direction) {
  return Vector3d(0.123, 0.071, 0) - 6 * direction;
}

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
}  // namespace boxtree
