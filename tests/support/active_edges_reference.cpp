// SPDX-License-Identifier: MIT
#include "tests/support/active_edges_reference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

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

std::vector<Polygon> polygons_of(const cooker::SourceMesh& mesh) {
  std::vector<Polygon> polygons;
  for (const cooker::Face& face : mesh.faces) {
    Polygon polygon;
    for (std::size_t i = 0; i < (face.is_quad() ? 4u : 3u); ++i) {
      const Eigen::Vector3d p = mesh.positions[face.corner[i]];
      polygon.corner.push_back({p[0] + 0.0, p[1] + 0.0, p[2] + 0.0});
    }
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
  // The turn from one normal to the other about the edge, positive where the surface falls.
  const long double turn = std::atan2(n.cross(other).dot(along), n.dot(other));
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

}  // namespace boxtree::test
