// SPDX-License-Identifier: MIT
#include "tests/support/active_edges_reference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "tests/support/scenes.h"

namespace boxtree::test {
namespace {

using Vector = Eigen::Matrix<long double, 3, 1>;
using Point = std::array<double, 3>;

struct Polygon {
  std::vector<Point> corner;
  std::multiset<Point> set;
  Vector normal = Vector::Zero();  // not of length 1
};

Vector vector_of(const Point& p) {
  return {p[0], p[1], p[2]};
}

// In the world; a pose that mirrors turns corners over.
std::vector<Polygon> polygons_of(const cooker::SourceMesh& mesh,
                                 const Pose& pose = Pose::Identity()) {
  const bool is_mirror = pose.linear().determinant() < 0;
  std::vector<Polygon> polygons;
  for (const cooker::Face& face : mesh.faces) {
    Polygon polygon;
    for (std::size_t i = 0; i < (face.is_quad() ? 4u : 3u); ++i) {
      const Eigen::Vector3d p = placed(pose, mesh.positions[face.corner[i]]);
      polygon.corner.push_back({p[0] + 0.0, p[1] + 0.0, p[2] + 0.0});
    }
    if (is_mirror) std::reverse(polygon.corner.begin() + 1, polygon.corner.end());
    polygon.set = {polygon.corner.begin(), polygon.corner.end()};
    for (std::size_t i = 1; i + 1 < polygon.corner.size(); ++i) {
      const Vector a = vector_of(polygon.corner[0]);
      const Vector normal =
          (vector_of(polygon.corner[i]) - a).cross(vector_of(polygon.corner[i + 1]) - a);
      if (polygon.normal.isZero(0)) polygon.normal = normal;
    }
    polygons.push_back(std::move(polygon));
  }
  return polygons;
}

// Whether some side of `polygon` leads from a to b.
bool has_side(const Polygon& polygon, const Point& a, const Point& b) {
  const std::size_t count = polygon.corner.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (polygon.corner[i] == a && polygon.corner[(i + 1) % count] == b) return true;
  }
  return false;
}

// Whether `next` lies more than `degrees` below the plane of `face` on the other side of an edge.
bool bends_away(const Polygon& face, const Polygon& next, const Point& a, const Point& b,
                bool is_turned, long double degrees) {
  const Vector along = (vector_of(b) - vector_of(a)).normalized();
  const Vector n = face.normal.normalized();
  const Vector other = next.normal.normalized() * (is_turned ? -1 : 1);
  // The turn from one normal to the other about the edge, positive where the surface falls, and
  // where it is folded: -0 + 0 is 0.
  const long double turn = std::atan2(n.cross(other).dot(along) + 0.0L, n.dot(other));
  return turn * 180 / std::numbers::pi_v<long double> > degrees;
}

}  // namespace

std::vector<std::uint8_t> active_edges_by_brute_force(const cooker::SourceMesh& mesh,
                                                      long double degrees) {
  const std::vector<Polygon> polygons = polygons_of(mesh);
  std::vector<std::uint8_t> active;
  for (const Polygon& face : polygons) {
    const std::size_t count = face.corner.size();
    std::uint32_t bits = (1u << count) - 1;
    for (std::size_t i = 0; i < count && !face.normal.isZero(0); ++i) {
      const Point &a = face.corner[i], &b = face.corner[(i + 1) % count];
      std::set<std::multiset<Point>> sheets;
      const Polygon *facing = nullptr, *turned = nullptr;
      for (const Polygon& other : polygons) {
        if (other.normal.isZero(0) || other.set == face.set) continue;
        const bool leads_back = has_side(other, b, a), leads_alike = has_side(other, a, b);
        if (leads_back || leads_alike) sheets.insert(other.set);
        if (leads_back && facing == nullptr) facing = &other;
        if (leads_alike && turned == nullptr) turned = &other;
      }
      if (sheets.size() != 1) continue;
      const bool is_turned = facing == nullptr;
      if (!bends_away(face, is_turned ? *turned : *facing, a, b, is_turned, degrees)) {
        bits &= ~(1u << i);
      }
    }
    active.push_back(static_cast<std::uint8_t>(bits));
  }
  return active;
}

namespace {

// Whether no other face of the same tree, but copies and backs of it, has the edge.
bool has_alone(const std::vector<Polygon>& tree, const Polygon& face, const Point& a,
               const Point& b) {
  return std::none_of(tree.begin(), tree.end(), [&](const Polygon& other) {
    return !other.normal.isZero(0) && other.set != face.set &&
           (has_side(other, a, b) || has_side(other, b, a));
  });
}

}  // namespace

std::vector<std::vector<std::uint8_t>> active_edges_by_brute_force(
    const std::vector<cooker::SourceMesh>& meshes, const std::vector<cooker::PlacedTree>& instances,
    long double degrees) {
  std::vector<std::vector<Polygon>> world;
  for (const cooker::PlacedTree& each : instances) {
    world.push_back(polygons_of(meshes[each.tree], each.pose));
  }
  std::vector<std::vector<std::uint8_t>> all;
  for (std::size_t n = 0; n < instances.size(); ++n) {
    std::vector<std::uint8_t> active =
        active_edges_by_brute_force(meshes[instances[n].tree], degrees);
    const bool is_mirror = instances[n].pose.linear().determinant() < 0;
    for (std::size_t f = 0; f < active.size() && !instances[n].moves; ++f) {
      const Polygon& face = world[n][f];
      const std::size_t count = face.corner.size();
      for (std::size_t i = 0; i < count && !face.normal.isZero(0); ++i) {
        const Point &a = face.corner[i], &b = face.corner[(i + 1) % count];
        if (!has_alone(world[n], face, a, b)) continue;
        std::set<std::multiset<Point>> sheets;
        const Polygon *facing = nullptr, *turned = nullptr;
        for (std::size_t m = 0; m < instances.size(); ++m) {
          if (m == n || instances[m].moves) continue;
          for (const Polygon& other : world[m]) {
            if (other.normal.isZero(0) || other.set == face.set) continue;
            const bool leads_back = has_side(other, b, a), leads_alike = has_side(other, a, b);
            if (!leads_back && !leads_alike) continue;
            if (!has_alone(world[m], other, a, b)) continue;
            sheets.insert(other.set);
            if (leads_back && facing == nullptr) facing = &other;
            if (leads_alike && turned == nullptr) turned = &other;
          }
        }
        if (sheets.size() != 1) continue;
        const bool is_turned = facing == nullptr;
        if (!bends_away(face, is_turned ? *turned : *facing, a, b, is_turned, degrees)) {
          active[f] &= static_cast<std::uint8_t>(~(1u << (is_mirror ? count - 1 - i : i)));
        }
      }
    }
    all.push_back(std::move(active));
  }
  return all;
}

}  // namespace boxtree::test
