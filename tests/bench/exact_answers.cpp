// SPDX-License-Identifier: MIT
// Loops over all triangles, and for pairs a sweep along x, which is no tree either.
#include "tests/bench/exact_answers.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <boxtree/runtime/primitive/predicates.h>

namespace boxtree::bench {
namespace {

// Work in triangle tests for each kind of question: a few seconds.
constexpr double kTests = 1e8;
constexpr std::size_t kFewest = 4;

std::size_t affordable(std::size_t questions, double tests_each) {
  const auto most = static_cast<std::size_t>(kTests / tests_each);
  return std::min(questions, std::max(most, kFewest));
}

double closest_t(const std::vector<Triangle>& triangles, const Ray& ray) {
  const RayShear shear(ray.origin, ray.direction);
  double best = std::numeric_limits<double>::infinity();
  for (const Triangle& triangle : triangles) {
    const auto hit = intersect_ray_triangle(shear, triangle);
    if (hit && hit->t >= 0) best = std::min(best, hit->t);
  }
  return best;
}

struct BoundedTriangle {
  Eigen::AlignedBox3d bounds;
  Triangle triangle;
};

std::vector<BoundedTriangle> sorted_along_x(const std::vector<Triangle>& triangles,
                                            const Pose& pose) {
  std::vector<BoundedTriangle> out;
  out.reserve(triangles.size());
  for (const Triangle& triangle : triangles) {
    BoundedTriangle moved;
    for (std::size_t c = 0; c < 3; ++c) {
      moved.triangle.corner[c] = pose * triangle.corner[c];
      moved.bounds.extend(moved.triangle.corner[c]);
    }
    out.push_back(moved);
  }
  std::sort(out.begin(), out.end(), [](const BoundedTriangle& a, const BoundedTriangle& b) {
    return a.bounds.min().x() < b.bounds.min().x();
  });
  return out;
}

// Pairs whose first member along x is `a`: partners start inside its interval.
template <class Strict>
std::size_t pairs_from(const std::vector<BoundedTriangle>& as,
                       const std::vector<BoundedTriangle>& bs, Strict starts_before) {
  std::size_t count = 0;
  std::size_t first = 0;
  for (const BoundedTriangle& a : as) {
    while (first < bs.size() && starts_before(bs[first], a)) ++first;
    for (std::size_t i = first; i < bs.size(); ++i) {
      if (bs[i].bounds.min().x() > a.bounds.max().x()) break;
      if (!a.bounds.intersects(bs[i].bounds)) continue;
      count += triangles_intersect(a.triangle, bs[i].triangle) ? 1u : 0u;
    }
  }
  return count;
}

std::size_t count_pairs(const std::vector<Triangle>& triangles, const Pose& pose) {
  const auto here = sorted_along_x(triangles, Pose::Identity());
  const auto there = sorted_along_x(triangles, pose);
  const auto start = [](const BoundedTriangle& t) { return t.bounds.min().x(); };
  return pairs_from(here, there,
                    [&](const auto& b, const auto& a) { return start(b) < start(a); }) +
         pairs_from(there, here,
                    [&](const auto& b, const auto& a) { return start(b) <= start(a); });
}

}  // namespace

ExactAnswers exact_answers(const TriangleMesh& mesh, const cooker::Workload& workload) {
  std::vector<Triangle> triangles;
  std::vector<Eigen::AlignedBox3d> bounds;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    triangles.push_back(mesh.triangle(i));
    bounds.emplace_back();
    for (const Eigen::Vector3d& corner : triangles.back().corner) bounds.back().extend(corner);
  }
  const auto size = static_cast<double>(triangles.size());
  ExactAnswers answers;
  for (std::size_t i = 0; i < affordable(workload.rays.size(), size); ++i) {
    answers.rays.push_back(closest_t(triangles, workload.rays[i]));
  }
  for (std::size_t i = 0; i < affordable(workload.boxes.size(), size); ++i) {
    const Eigen::AlignedBox3d& box = workload.boxes[i];
    double count = 0;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      if (!box.intersects(bounds[t])) continue;
      count += triangle_intersects_box(triangles[t], box.min(), box.max()) ? 1 : 0;
    }
    answers.boxes.push_back(count);
  }
  for (std::size_t i = 0; i < affordable(workload.points.size(), size); ++i) {
    const Eigen::Vector3d& point = workload.points[i];
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      if (bounds[t].squaredExteriorDistance(point) > best) continue;
      best = std::min(best, (closest_point_on_triangle(point, triangles[t]) - point).squaredNorm());
    }
    answers.points.push_back(std::sqrt(best));
  }
  // Sorting both sides and the neighbours along x, of which there are some hundreds each.
  constexpr double kSweepWork = 300;
  for (std::size_t i = 0; i < affordable(workload.poses.size(), kSweepWork * size); ++i) {
    answers.pairs.push_back(static_cast<double>(count_pairs(triangles, workload.poses[i])));
  }
  return answers;
}

}  // namespace boxtree::bench
