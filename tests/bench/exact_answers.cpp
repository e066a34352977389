// SPDX-License-Identifier: MIT
// Loops over all triangles; for pairs a sweep along x, which does not use a tree either.
#include "tests/bench/exact_answers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <span>

#include "runtime/primitive/predicates.h"
#include "runtime/primitive/triangle_distance.h"

namespace boxtree::bench {
namespace {

// Work in triangle tests for each kind of query: a few seconds.
constexpr double kTests = 1e8;
constexpr std::size_t kFewest = 4;

std::size_t affordable(std::size_t queries, double tests_each) {
  const auto most = static_cast<std::size_t>(kTests / tests_each);
  return std::min(queries, std::max(most, kFewest));
}

double closest_t(const std::vector<Triangle>& triangles, const Ray& ray) {
  const RayShear shear(ray.origin, ray.direction);
  double best = std::numeric_limits<double>::infinity();
  for (const Triangle& triangle : triangles) {
    const auto hit = intersect_ray_triangle(shear, triangle);
    if (hit && hit->t >= 0 && hit->t <= ray.t_max) best = std::min(best, hit->t);
  }
  return best;
}

// The least root of a s^2 + 2 b s + c of those that are not negative, where c >= 0; infinity if
// there is none.
double least_root(double a, double b, double c) {
  const double discriminant = b * b - a * c;
  if (b >= 0 || discriminant < 0) return std::numeric_limits<double>::infinity();
  return c / (std::sqrt(discriminant) - b);
}

// When the center meets the faces, edges and corners of a triangle that is thickened by the radius.
double touching_t(const ShapeCast& cast, const Triangle& triangle) {
  const Ray& ray = cast.ray;
  const double radius = cast.radius;
  const Eigen::Vector3d& direction = ray.direction;
  if ((closest_point_on_triangle(ray.origin, triangle) - ray.origin).norm() <= radius) return 0;
  double best = std::numeric_limits<double>::infinity();
  const auto& corner = triangle.corner;
  const Eigen::Vector3d n = (corner[1] - corner[0]).cross(corner[2] - corner[0]).normalized();
  for (const double side : {-1.0, 1.0}) {
    const Eigen::Vector3d up = side * radius * n;
    const Ray lowered{ray.origin - up, direction};
    const auto hit = intersect_ray_triangle(RayShear(lowered.origin, direction), triangle);
    if (hit && hit->t >= 0) best = std::min(best, hit->t);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d from = ray.origin - corner[i];
    best = std::min(best, least_root(direction.squaredNorm(), direction.dot(from),
                                     from.squaredNorm() - radius * radius));
    const Eigen::Vector3d edge = corner[(i + 1) % 3] - corner[i];
    const double length = edge.norm();
    if (length == 0) continue;
    const Eigen::Vector3d across = direction.cross(edge) / length, off = from.cross(edge) / length;
    const double t = least_root(across.squaredNorm(), across.dot(off),
                                std::max(0.0, off.squaredNorm() - radius * radius));
    const double along = (from + t * direction).dot(edge) / (length * length);
    if (along >= 0 && along <= 1) best = std::min(best, t);
  }
  return best;
}

double first_touch(const std::vector<Triangle>& triangles, const ShapeCast& cast) {
  double best = std::numeric_limits<double>::infinity();
  for (const Triangle& triangle : triangles) best = std::min(best, touching_t(cast, triangle));
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

// The point of the surface nearest to `to`.
Eigen::Vector3d nearest_to(const std::vector<Triangle>& triangles, const Eigen::Vector3d& from) {
  double best = std::numeric_limits<double>::infinity();
  Eigen::Vector3d nearest = from;
  for (const Triangle& triangle : triangles) {
    const Eigen::Vector3d point = closest_point_on_triangle(from, triangle);
    if ((point - from).squaredNorm() >= best) continue;
    best = (point - from).squaredNorm();
    nearest = point;
  }
  return nearest;
}

// Neighbouring triangles, found by a sort along x and one along y. This is not a tree, but it skips
// most pairs of a large mesh.
struct Block {
  Eigen::AlignedBox3d bounds;
  std::span<const BoundedTriangle> triangles;
};

std::vector<Block> in_blocks(std::vector<BoundedTriangle>& triangles) {
  constexpr std::size_t kBlock = 64;
  const auto sort_along = [](std::span<BoundedTriangle> part, Eigen::Index axis) {
    std::sort(part.begin(), part.end(), [&](const BoundedTriangle& a, const BoundedTriangle& b) {
      return a.bounds.min()[axis] < b.bounds.min()[axis];
    });
  };
  const std::span<BoundedTriangle> all(triangles);
  sort_along(all, 0);
  const auto slabs = static_cast<double>(all.size()) / static_cast<double>(kBlock);
  const std::size_t slab = kBlock * static_cast<std::size_t>(std::ceil(std::sqrt(slabs)));
  std::vector<Block> blocks;
  for (std::size_t i = 0; i < all.size(); i += slab) {
    const auto part = all.subspan(i, std::min(slab, all.size() - i));
    sort_along(part, 1);
    for (std::size_t j = 0; j < part.size(); j += kBlock) {
      Block block{{}, part.subspan(j, std::min(kBlock, part.size() - j))};
      for (const BoundedTriangle& triangle : block.triangles) block.bounds.extend(triangle.bounds);
      blocks.push_back(block);
    }
  }
  return blocks;
}

// Tests every pair of triangles whose bounds are nearer than the best known distance. The first
// known distances come from projecting the corners of the bounds onto one surface, then the other,
// and back.
double distance_of_copy(const TriangleMesh& mesh, const std::vector<Triangle>& triangles,
                        const Pose& pose) {
  const Pose back = pose.inverse();
  double best = std::numeric_limits<double>::infinity();
  for (int corner = 0; corner < 8; ++corner) {
    Eigen::Vector3d here = mesh.bounds.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner));
    for (int times = 0; times < 3; ++times) {
      const Eigen::Vector3d there = pose * nearest_to(triangles, back * here);
      here = nearest_to(triangles, there);
      best = std::min(best, (there - here).norm());
    }
  }
  auto first = sorted_along_x(triangles, Pose::Identity());
  auto second = sorted_along_x(triangles, pose);
  const std::vector<Block> second_blocks = in_blocks(second);
  for (const Block& block : in_blocks(first)) {
    for (const Block& other : second_blocks) {
      if (block.bounds.squaredExteriorDistance(other.bounds) > best * best) continue;
      for (const BoundedTriangle& a : block.triangles) {
        if (a.bounds.squaredExteriorDistance(other.bounds) > best * best) continue;
        for (const BoundedTriangle& b : other.triangles) {
          if (a.bounds.squaredExteriorDistance(b.bounds) > best * best) continue;
          best = std::min(best, triangle_distance(a.triangle, b.triangle).upper);
        }
      }
    }
  }
  return best;
}

}  // namespace

std::vector<ShapeCast> casts_of(const cooker::Workload& workload, ShapeKind kind) {
  std::vector<ShapeCast> casts;
  for (const Ray& ray : workload.rays) casts.push_back({ray, workload.cast_radius, kind});
  return casts;
}

std::vector<PlacedShape> shapes_on(const TriangleMesh& mesh, const cooker::Workload& workload,
                                   std::size_t count, ShapeKind kind) {
  std::mt19937_64 engine(1);
  std::uniform_int_distribution<std::size_t> any(0, mesh.triangles.size() - 1);
  std::uniform_real_distribution<double> share(0, 1), off(-1, 1);
  std::vector<PlacedShape> shapes;
  for (std::size_t i = 0; i < count; ++i) {
    const auto& [a, b, c] = mesh.triangle(any(engine)).corner;
    const double u = std::sqrt(share(engine)), v = share(engine);
    const Eigen::Vector3d point = (1 - u) * a + u * (1 - v) * b + u * v * c;
    const Eigen::Vector3d normal = (b - a).cross(c - a).normalized();  // 0 without area
    shapes.push_back(
        {point + off(engine) * workload.cast_radius * normal, workload.cast_radius, kind});
  }
  return shapes;
}

ExactAnswers exact_answers(const TriangleMesh& mesh, const cooker::Workload& workload,
                           std::size_t shapes) {
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
  for (std::size_t i = 0; i < affordable(workload.camera.size(), size); ++i) {
    answers.camera.push_back(closest_t(triangles, workload.camera[i]));
  }
  for (std::size_t i = 0; i < affordable(workload.segments.size(), size); ++i) {
    answers.segments.push_back(closest_t(triangles, workload.segments[i]));
  }
  constexpr double kCastWork = 8;
  const std::vector<ShapeCast> casts = casts_of(workload, ShapeKind::kSphere);
  for (std::size_t i = 0; i < affordable(casts.size(), kCastWork * size); ++i) {
    answers.sphere_casts.push_back(first_touch(triangles, casts[i]));
  }
  const std::vector<PlacedShape> spheres =
      shapes_on(mesh, workload, affordable(shapes, size), ShapeKind::kSphere);
  for (const auto& [center, radius, kind] : spheres) {
    double count = 0;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      if (bounds[t].squaredExteriorDistance(center) > radius * radius) continue;
      const Eigen::Vector3d closest = closest_point_on_triangle(center, triangles[t]);
      count += (closest - center).squaredNorm() <= radius * radius ? 1 : 0;
    }
    answers.spheres.push_back(count);
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
  // Sorting both sides, and the neighbours along x, some hundreds each.
  constexpr double kSweepWork = 300;
  for (std::size_t i = 0; i < affordable(workload.poses.size(), kSweepWork * size); ++i) {
    answers.pairs.push_back(static_cast<double>(count_pairs(triangles, workload.poses[i])));
  }
  // The projections, and the remaining pairs.
  constexpr double kDistanceWork = 100;
  for (std::size_t i = 0; i < affordable(workload.apart.size(), kDistanceWork * size); ++i) {
    answers.distances.push_back(distance_of_copy(mesh, triangles, workload.apart[i]));
  }
  return answers;
}

}  // namespace boxtree::bench
