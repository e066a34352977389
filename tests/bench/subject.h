// SPDX-License-Identifier: MIT
// The interface of a library under measurement. Each query has one number as its answer, so that
// answers can be compared one by one. A call runs a whole workload, so times exclude the
// indirection.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cooker/build/build_tree.h"
#include "cooker/choose/workload.h"
#include "tests/bench/cache_model.h"
#include "tests/bench/triangle_mesh.h"

namespace boxtree::bench {

/// Memory in bytes. `total` is all that must be resident for any query, geometry included.
struct SubjectBytes {
  double tree = 0;
  double total = 0;
};

/// From a closed file to answers, for libraries with files.
struct SubjectOpen {
  double micros = 0;          // to the first answer
  double file_bytes = 0;      // on disk
  double resident_bytes = 0;  // allocated or read by opening alone
};

/// Work of pair queries, summed over all poses.
struct PairWork {
  std::uint64_t node_pairs = 0;  // pairs of nodes expanded; the original also counts leaf pairs
  std::uint64_t leaf_tests = 0;  // pairs of leaves whose polygons were compared
};

/// A sphere; an upright capsule twice as long as wide; a turned cube, whose half edge is the
/// radius.
enum class ShapeKind : std::uint8_t { kSphere, kCapsule, kCube };

/// The rotation of cubes.
inline const Eigen::Quaterniond kCubeRotation = Eigen::Quaterniond(0.9, 0.1, 0.3, 0.2).normalized();

/// A shape whose center moves along the ray.
struct ShapeCast {
  Ray ray;
  double radius = 0;
  ShapeKind kind = ShapeKind::kSphere;
};

struct PlacedShape {
  Eigen::Vector3d center;
  double radius = 0;
  ShapeKind kind = ShapeKind::kSphere;
};

/// The mesh and its copy in that pose.
struct DistanceRequest {
  Pose pose;
  double relative_error = 0;  // allowed
};

/// One mesh in one library's structure. Queries that the library does not have return false and do
/// not change their answers.
class Subject {
 public:
  virtual ~Subject() = default;

  [[nodiscard]] virtual SubjectBytes bytes() const = 0;
  [[nodiscard]] virtual std::optional<SubjectOpen> open(std::size_t /*runs*/) { return {}; }

  /// Distance along the ray to the closest hit; infinity without one.
  virtual bool rays(std::span<const Ray>, std::span<double>) { return false; }
  /// Whether it ends rays at their t_max; others do not get segments.
  [[nodiscard]] virtual bool ends_rays() const { return false; }
  /// The same of many rays in a call.
  virtual bool ray_batches(std::span<const Ray>, std::span<double>) { return false; }
  /// How far along the ray the shape is when it first touches; infinity if it does not.
  virtual bool casts(std::span<const ShapeCast>, std::span<double>) { return false; }
  /// Number of triangles that touch the shape.
  virtual bool overlaps(std::span<const PlacedShape>, std::span<double>) { return false; }
  /// Number of contacts, each with point, normal and depth.
  virtual bool contacts(std::span<const PlacedShape>, std::span<double>) { return false; }
  /// Number of triangles that touch the box.
  virtual bool boxes(std::span<const Eigen::AlignedBox3d>, std::span<double>) { return false; }
  /// Distance to the closest point.
  virtual bool points(std::span<const Eigen::Vector3d>, std::span<double>) { return false; }
  /// Distance to the copy; at most the allowed error above the true one.
  virtual bool distances(std::span<const DistanceRequest>, std::span<double>) { return false; }
  /// The mesh against its copy in that pose: 1 if they touch, else 0.
  virtual bool first_contacts(std::span<const Pose>, std::span<double>) { return false; }
  /// The number of pairs of triangles that touch, in the same pose.
  virtual bool all_pairs(std::span<const Pose>, std::span<double>) { return false; }

  /// Repeats first_contacts or all_pairs with a walk that counts and passes addresses to the cache
  /// model.
  [[nodiscard]] virtual std::optional<PairWork> pair_work(std::span<const Pose>,
                                                          bool /*first_only*/, CacheModel&) {
    return {};
  }
};

/// One way to build a subject.
struct Library {
  std::string name;
  std::string variant;
  std::function<std::unique_ptr<Subject>(const TriangleMesh&)> build;
};

// Each library adds its variants; those that are not installed are not compiled.
void add_boxtree(std::vector<Library>& libraries, cooker::Builder builder);
void add_original(std::vector<Library>& libraries);
void add_bullet(std::vector<Library>& libraries);
void add_cgal(std::vector<Library>& libraries);
void add_embree(std::vector<Library>& libraries);
void add_fcl(std::vector<Library>& libraries);
void add_ode(std::vector<Library>& libraries);

}  // namespace boxtree::bench
