// SPDX-License-Identifier: MIT
// Medians over whole workloads: single queries are shorter than the resolution of a clock.
#include "cooker/choose/measure.h"

#include <boxtree/boxtree.h>

#include "cooker/system/process.h"
#include "runtime/tree/bound_codec.h"
#include "runtime/tree/bound_tree.h"
#include "runtime/walk/chosen_targets.h"

namespace boxtree::cooker {
namespace {

// Seconds per query, and the first error of any query.
template <class Queries, class RunQuery>
double per_query(const Queries& queries, std::size_t runs, Status& status, RunQuery run_query) {
  if (queries.empty()) return 0;
  const double seconds = median_seconds(runs, [&] {
    for (const auto& query : queries) {
      if (const Errc error = run_query(query); error != Errc::kOk && status.ok()) status = error;
    }
  });
  return seconds / static_cast<double>(queries.size());
}

// The same of a batch of rays.
double per_ray(const Tree& tree, const std::vector<Ray>& rays, std::size_t runs, Status& status) {
  if (rays.empty()) return 0;
  std::vector<RayResult> results(rays.size());
  const double seconds = median_seconds(runs, [&] {
    if (const Status cast = closest_hits(tree, rays, results); !cast && status.ok()) status = cast;
  });
  for (const RayResult& result : results) {
    if (!result.ok() && status.ok()) status = result.error();
  }
  return seconds / static_cast<double>(rays.size());
}

// And of points.
double per_point(const Tree& tree, const std::vector<Eigen::Vector3d>& points, std::size_t runs,
                 Status& status) {
  if (points.empty()) return 0;
  std::vector<PointResult> results(points.size());
  const double seconds = median_seconds(runs, [&] {
    const Status found = closest_points(tree, points, results);
    if (!found && status.ok()) status = found;
  });
  for (const PointResult& result : results) {
    if (!result.ok() && status.ok()) status = result.error();
  }
  return seconds / static_cast<double>(points.size());
}

// And of shapes: `overlap_all(results)`.
template <class OverlapAll>
double per_shape(std::size_t count, std::size_t runs, Status& status,
                 const OverlapAll& overlap_all) {
  if (count == 0) return 0;
  std::vector<VisitResult> results(count);
  const double seconds = median_seconds(runs, [&] {
    const Status visited = overlap_all(results);
    if (!visited && status.ok()) status = visited;
  });
  for (const VisitResult& result : results) {
    if (!result.ok() && status.ok()) status = result.error();
  }
  return seconds / static_cast<double>(count);
}

}  // namespace

const char* instruction_set() noexcept {
  if constexpr (kWalksByVectors) {
    return chosen_instruction_set();
  } else {
    return "none";
  }
}

double clock_cost_ns() {
  using Clock = std::chrono::steady_clock;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 1000; ++i) {
    const Clock::time_point start = Clock::now();
    const std::chrono::duration<double, std::nano> taken = Clock::now() - start;
    least = std::min(least, taken.count());
  }
  return least;
}

Result<QueryFigures> measure_queries(const Tree& tree, const Workload& workload, std::size_t runs) {
  QueryFigures figures;
  Status status;
  const std::uint64_t rounds = runs + 1;  // every round adds the same to the counts
  const auto one_by_one = [&](const std::vector<Ray>& rays, std::uint64_t& hits) {
    return per_query(rays, runs, status, [&](const Ray& ray) {
      const auto hit = closest_hit(tree, ray);
      if (hit) ++hits;
      return hit.code();
    });
  };
  figures.ray_ns = 1e9 * one_by_one(workload.rays, figures.ray_hits);
  figures.ray_batch_ns = 1e9 * per_ray(tree, workload.rays, runs, status);
  figures.camera_ns = 1e9 * one_by_one(workload.camera, figures.camera_hits);
  figures.camera_batch_ns = 1e9 * per_ray(tree, workload.camera, runs, status);
  figures.cast_sphere_ns =
      1e9 * per_query(workload.rays, runs, status, [&](const Ray& ray) {
        const auto hit =
            cast_closest(tree, Sphere{ray.origin, workload.cast_radius}, Motion{ray.direction});
        if (hit) ++figures.cast_sphere_hits;
        return hit.code();
      });
  figures.box_ns =
      1e9 * per_query(workload.boxes, runs, status, [&](const Eigen::AlignedBox3d& box) {
        return overlap_box(tree, box,
                           [&](const FaceRef&) {
                             ++figures.box_faces;
                             return true;
                           })
            .code();
      });
  figures.box_batch_ns = 1e9 * per_shape(workload.boxes.size(), runs, status, [&](auto& results) {
                           return overlap_boxes(tree, workload.boxes, results,
                                                [](std::size_t, const FaceRef&) { return true; });
                         });
  figures.point_ns =
      1e9 * per_query(workload.points, runs, status, [&](const Eigen::Vector3d& point) {
        const auto closest = closest_point(tree, point);
        if (closest) figures.point_distance += closest->distance;
        return closest.code();
      });
  figures.point_batch_ns = 1e9 * per_point(tree, workload.points, runs, status);
  figures.lattice_ns =
      1e9 * per_query(workload.lattice, runs, status, [&](const Eigen::Vector3d& point) {
        return closest_point(tree, point).code();
      });
  figures.lattice_batch_ns = 1e9 * per_point(tree, workload.lattice, runs, status);
  std::vector<Sphere> balls;
  balls.reserve(workload.lattice.size());
  for (const Eigen::Vector3d& center : workload.lattice)
    balls.push_back({center, workload.cast_radius});
  figures.ball_ns =
      1e9 * per_query(balls, runs, status, [&](const Sphere& ball) {
        return overlap_sphere(tree, ball, [](const FaceRef&) { return false; }).code();
      });
  figures.ball_batch_ns =
      1e9 * per_shape(balls.size(), runs, status, [&](auto& results) {
        return overlap_spheres(tree, balls, results,
                               [](std::size_t, const FaceRef&) { return false; });
      });
  const Pose here = Pose::Identity();
  figures.pair_first_us = 1e6 * per_query(workload.poses, runs, status, [&](const Pose& pose) {
                            const auto contact = first_contact(tree, here, tree, pose);
                            if (contact) ++figures.pair_hits;
                            return contact.code();
                          });
  figures.pair_all_us = 1e6 * per_query(workload.poses, runs, status, [&](const Pose& pose) {
                          return overlap_pairs(tree, here, tree, pose,
                                               [&](const FacePair&) {
                                                 ++figures.pair_pairs;
                                                 return true;
                                               })
                              .code();
                        });
  if (!status) return status.error();
  figures.ray_hits /= rounds;
  figures.camera_hits /= rounds;
  figures.cast_sphere_hits /= rounds;
  figures.box_faces /= rounds;
  figures.point_distance /= static_cast<double>(rounds);
  figures.pair_hits /= rounds;
  figures.pair_pairs /= rounds;
  return figures;
}

Status first_query(const Tree& tree) {
  const Eigen::AlignedBox3d bounds = bounds_in_object_space(tree);
  const Eigen::Vector3d along(0.1, 0.2, -1);
  const auto hit = closest_hit(tree, {bounds.center() - bounds.sizes().norm() * along, along});
  return hit.ok() ? Status() : Status(hit.error());
}

Result<OpenFigures> measure_open(const std::filesystem::path& path, std::uint32_t tree,
                                 std::size_t runs) {
  OpenFigures figures;
  std::vector<double> open_us;
  std::vector<double> answer_us;
  for (std::size_t i = 0; i <= runs; ++i) {
    const std::uint64_t faults_before = page_faults();
    const double start = thread_seconds();
    const Result<File> file = File::open(path.string());
    if (!file) return file.error();
    const Result<Tree> bound = Tree::bind(*file, tree);
    if (!bound) return bound.error();
    const double opened = thread_seconds();
    const Status queried = first_query(*bound);
    const double answered = thread_seconds();
    if (!queried) return queried.error();
    figures.page_faults = page_faults() - faults_before;
    if (i == 0) continue;
    open_us.push_back(1e6 * (opened - start));
    answer_us.push_back(1e6 * (answered - start));
  }
  figures.open_us = median(open_us);
  figures.first_answer_us = median(answer_us);
  return figures;
}

Eigen::AlignedBox3d bounds_in_object_space(const Tree& tree) {
  if (tree.empty()) return {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  return BoundTree::of(tree).to_object(BoundTree::of(tree).root().box);
}

}  // namespace boxtree::cooker
