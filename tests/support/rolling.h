// SPDX-License-Identifier: MIT
// Bodies that slide and roll over floors at 60 Hz, pushed by contacts.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <variant>
#include <vector>

#include <boxtree/boxtree.h>

#include "cooker/import/source_mesh.h"
#include "tests/support/require.h"

namespace boxtree::rolling {

using cooker::SourceMesh;
using Eigen::Vector3d;

inline constexpr double kStep = 1.0 / 60;
inline constexpr int kSteps = 150;
inline constexpr double kGravity = 9.81;
inline constexpr double kFriction = 0.5;  // of what turns
inline constexpr double kSpeed = 5;
inline constexpr double kSunk = 1e-3;  // so that bodies touch triangles beside them

inline constexpr double kSize = 20;  // of a floor

inline double flat(double, double) {
  return 0;
}

// A square around the origin of cells^2 cells of two triangles each, with vertices and diagonals at
// random.
inline SourceMesh floor_of(unsigned cells, double (*height)(double, double), unsigned seed = 1) {
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

inline std::vector<NamedBody> bodies() {
  constexpr double kRadius = 0.4;
  OrientedBox box{{0, 0, 0.3}, {0.5, 0.35, 0.3}, {}};
  box.rotation = Eigen::AngleAxisd(0.3, Vector3d::UnitZ());
  return {{"a sphere that slides", Sphere{{0, 0, kRadius}, kRadius}, 0},
          {"a sphere that rolls", Sphere{{0, 0, kRadius}, kRadius}, 0.4 * kRadius * kRadius},
          {"a capsule upright", Capsule{{0, 0, kRadius}, {0, 0, 1.4}, kRadius}, 0},
          {"a capsule along x", Capsule{{-0.5, 0, kRadius}, {0.5, 0, kRadius}, kRadius}, 0},
          {"a crate", box, 0}};
}

inline Body moved(Body body, const Vector3d& by) {
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
  constexpr int kIterations = 30;
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

inline std::vector<Vector3d> directions() {
  std::vector<Vector3d> out;
  for (const double degrees : {0.0, 17.0, 45.0, 90.0, 203.0}) {
    const double x = degrees * (std::numbers::pi / 180);
    out.emplace_back(std::cos(x), std::sin(x), 0);
  }
  return out;
}

// Starts so that the whole way lies on the floor.
inline Vector3d start_of(const Vector3d& direction) {
  return Vector3d(0.123, 0.071, 0) - 6 * direction;
}

}  // namespace boxtree::rolling
