// SPDX-License-Identifier: MIT
// Measures the original. Rays, boxes and points descend its pointers with the runtime's box tests
// and end with the runtime's leaf tests.
#include <cmath>
#include <vector>

#include "format/binary_node.h"
#include "runtime/query/ray_slab.h"
#include "runtime/query/relative_pose.h"
#include "runtime/walk/traversal.h"
#include "tests/bench/original_pairs.h"
#include "tests/bench/subject.h"

namespace boxtree::bench {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

template <class Visit>
void for_each_triangle(const OriginalNode::Leaf& leaf, Visit visit) {
  const auto point = [&](std::size_t i) {
    return Eigen::Vector3d(leaf.points[leaf.point[i]].cast<double>());
  };
  for (std::size_t i = 2; i < 4 && leaf.point[i] != kNoPoint; ++i) {
    visit(Triangle{{point(0), point(i - 1), point(i)}});
  }
}

// Nearest first. query.key(box), query.bound(), query.leaf(leaf) as in traverse_nearest.
template <class Query>
void descend_nearest(const OriginalNode* node, const Box<float>& box, Query& query) {
  if (node->is_leaf()) {
    query.leaf(node->leaf);
    return;
  }
  std::array<Box<float>, 2> child;
  std::array<double, 2> key = {kInfinity, kInfinity};
  for (std::size_t side = 0; side < 2; ++side) {
    if (node->inner.child[side] == nullptr) continue;
    child[side] = child_box(box, node->cutplane, side, node->inner.cut[side]);
    key[side] = query.key(child[side]);
  }
  const std::size_t near = key[1] < key[0] ? 1 : 0;
  for (const std::size_t side : {near, 1 - near}) {
    if (key[side] == kInfinity || key[side] > query.bound()) continue;
    descend_nearest(node->inner.child[side], child[side], query);
  }
}

struct RayQuery {
  RaySlab slab;
  RayShear shear;
  double t = kInfinity;

  [[nodiscard]] double bound() const { return t; }
  [[nodiscard]] double key(const Box<float>& box) const {
    const SlabInterval interval = slab.intersect(box);
    return interval.enter <= interval.leave && interval.leave >= 0 ? interval.enter : kInfinity;
  }
  void leaf(const OriginalNode::Leaf& leaf) {
    for_each_triangle(leaf, [this](const Triangle& triangle) {
      const auto hit = intersect_ray_triangle(shear, triangle);
      if (hit && hit->t >= 0) t = std::min(t, hit->t);
    });
  }
};

struct PointQuery {
  Eigen::Vector3d point;
  double best = kInfinity;

  [[nodiscard]] double bound() const { return best; }
  [[nodiscard]] double key(const Box<float>& box) const { return squared_distance(point, box); }
  void leaf(const OriginalNode::Leaf& leaf) {
    for_each_triangle(leaf, [this](const Triangle& triangle) {
      best = std::min(best, (closest_point_on_triangle(point, triangle) - point).squaredNorm());
    });
  }
};

double count_in_box(const OriginalNode* node, const Box<float>& bounds,
                    const Eigen::AlignedBox3d& box) {
  const Box<double> query{{box.min()[0], box.min()[1], box.min()[2]},
                          {box.max()[0], box.max()[1], box.max()[2]}};
  if (!boxes_overlap(bounds, query)) return 0;
  double count = 0;
  if (node->is_leaf()) {
    for_each_triangle(node->leaf, [&](const Triangle& triangle) {
      if (!boxes_overlap(bounds_of(triangle), query)) return;
      count += triangle_intersects_box(triangle, box.min(), box.max()) ? 1 : 0;
    });
    return count;
  }
  for (std::size_t side = 0; side < 2; ++side) {
    if (node->inner.child[side] == nullptr) continue;
    count += count_in_box(node->inner.child[side],
                          child_box(bounds, node->cutplane, side, node->inner.cut[side]), box);
  }
  return count;
}

class OriginalSubject : public Subject {
 public:
  explicit OriginalSubject(const TriangleMesh& mesh)
      : mesh_(mesh),
        tree_(build_tree(mesh.source, cooker::Builder::kPaper), mesh.source, mesh.positions) {}

  [[nodiscard]] SubjectBytes bytes() const override {
    const double tree = static_cast<double>(tree_.node_count() * kOriginalNodeBytes);
    return {tree, tree + static_cast<double>(mesh_.positions.size() * 3 * sizeof(float))};
  }

  bool rays(std::span<const Ray> rays, std::span<double> out) override {
    const Eigen::Vector3d max_abs =
        mesh_.bounds.min().cwiseAbs().cwiseMax(mesh_.bounds.max().cwiseAbs());
    for (std::size_t i = 0; i < rays.size(); ++i) {
      RayQuery query{RaySlab(rays[i].origin, rays[i].direction, widened(max_abs).maxCoeff()),
                     RayShear(rays[i].origin, rays[i].direction)};
      if (query.key(tree_.root_box()) != kInfinity) {
        descend_nearest(tree_.root(), tree_.root_box(), query);
      }
      out[i] = query.t;
    }
    return true;
  }
  bool boxes(std::span<const Eigen::AlignedBox3d> boxes, std::span<double> out) override {
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      out[i] = count_in_box(tree_.root(), tree_.root_box(), boxes[i]);
    }
    return true;
  }
  bool points(std::span<const Eigen::Vector3d> points, std::span<double> out) override {
    for (std::size_t i = 0; i < points.size(); ++i) {
      PointQuery query{points[i]};
      descend_nearest(tree_.root(), tree_.root_box(), query);
      out[i] = std::sqrt(query.best);
    }
    return true;
  }
  bool first_contacts(std::span<const Pose> poses, std::span<double> out) override {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      out[i] = 0;
      OriginalPairs(tree_, tree_, poses[i], [&](std::uint32_t, std::uint32_t) {
        out[i] = 1;
        return false;
      });
    }
    return true;
  }
  bool all_pairs(std::span<const Pose> poses, std::span<double> out) override {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      out[i] = 0;
      OriginalPairs(tree_, tree_, poses[i], [&](std::uint32_t, std::uint32_t) {
        ++out[i];
        return true;
      });
    }
    return true;
  }

  [[nodiscard]] std::optional<PairWork> pair_work(std::span<const Pose> poses, bool first_only,
                                                  CacheModel& cache) override {
    struct Listener {
      PairWork* work;
      CacheModel* cache;
      void node(const OriginalNode* node) { cache->read(node, sizeof(*node)); }
      void pair() { ++work->node_pairs; }
      void leaf_test(const OriginalNode::Leaf& e, const OriginalNode::Leaf& f) {
        ++work->leaf_tests;
        read_points(e);
        read_points(f);
      }
      void read_points(const OriginalNode::Leaf& leaf) {
        for (const std::uint32_t point : leaf.point) {
          if (point != kNoPoint) cache->read(&leaf.points[point], sizeof(Eigen::Vector3f));
        }
      }
    };
    PairWork work;
    for (const Pose& pose : poses) {
      OriginalPairs(
          tree_, tree_, pose, [&](std::uint32_t, std::uint32_t) { return !first_only; },
          Listener{&work, &cache});
    }
    return work;
  }

 private:
  // Planes from cuts in f32 are off by their rounding. The widening allows for it in rays, as the
  // original's 1e-6 does in pairs.
  static Eigen::Vector3d widened(const Eigen::Vector3d& max_abs) {
    constexpr double kShareOfSlabMargin = 1e-6 / (8 * 0x1p-53);
    return max_abs * kShareOfSlabMargin;
  }

  const TriangleMesh& mesh_;
  OriginalTree tree_;
};

}  // namespace

void add_original(std::vector<Library>& libraries) {
  libraries.push_back({"original", "pointers", [](const TriangleMesh& mesh) {
                         return std::make_unique<OriginalSubject>(mesh);
                       }});
}

}  // namespace boxtree::bench
