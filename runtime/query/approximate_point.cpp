// SPDX-License-Identifier: MIT
// Closest points within an error or a number of nodes, over any codec.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include <boxtree/closest.h>

#include "runtime/primitive/float_state.h"
#include "runtime/primitive/rounding.h"
#include "runtime/primitive/vector3.h"
#include "runtime/query/approximation.h"
#include "runtime/query/invalid_query.h"
#include "runtime/query/point_query.h"
#include "runtime/query/scaled_length.h"
#include "runtime/walk/erased_codec.h"
#include "runtime/walk/frontier.h"
#include "runtime/walk/walk_tree.h"

namespace boxtree {
namespace {

// Visits nodes in the order of their distance until the budget is spent. Like the distance walk it
// is depth-first at the start, so that a small budget finds something.
class BestFirst {
 public:
  BestFirst(const BoundTree& tree, PointQuery& query, std::uint64_t budget) noexcept
      : tree_(tree), codec_{&tree}, query_(query), budget_(budget) {}

  Errc run() noexcept {
    Entry entry{root_box<double>(tree_), tree_.root_ref(), tree_.is_leaf()};
    double key = query_.key(entry.box);
    if (!frontier_.push(key, enough(), entry)) return Errc::kInternal;
    ErasedCodec::Children children;
    while (frontier_.pop(enough(), key, entry)) {
      bool goes_on = true;
      while (goes_on) {
        if (query_.nodes_expanded == budget_) {
          left_ = std::min(left_, key);
          is_spent_ = true;
          return Errc::kOk;
        }
        if (entry.is_leaf) {
          if (!query_.leaf(entry.ref)) return Errc::kOk;  // the query holds the error
          break;
        }
        ++query_.nodes_expanded;
        Errc error = query_.nodes.count(codec_.expand(entry.ref, entry.box, children));
        if (error == Errc::kOk) error = intersect(children, goes_on, key, entry);
        if (error != Errc::kOk) return error;
      }
    }
    return Errc::kOk;
  }

  [[nodiscard]] bool is_spent() const noexcept { return is_spent_; }
  /// The least key of what was not visited.
  [[nodiscard]] double left() const noexcept { return std::min(left_, frontier_.least_left()); }

 private:
  static constexpr std::size_t kQueue = 1024;
  struct Entry {
    Box<double> box;
    NodeRef ref;
    bool is_leaf;
  };

  // Equal distances are visited, so that ties end as in the exact query.
  [[nodiscard]] double enough() const noexcept {
    return std::nextafter(query_.bound(), std::numeric_limits<double>::infinity());
  }

  // Queues the children; but until something is found the nearest one is visited next.
  Errc intersect(const ErasedCodec::Children& children, bool& goes_on, double& key,
                 Entry& entry) noexcept {
    const auto child = [&](std::uint32_t i) {
      return Entry{children.box(i), children.ref[i], children.is_leaf(i)};
    };
    std::array<double, ErasedCodec::Children::kWidth> keys;
    std::uint32_t nearest = 0;
    for (std::uint32_t i = 0; i < children.count; ++i) {
      keys[i] = query_.key(children.box(i));
      if (keys[i] < keys[nearest]) nearest = i;
    }
    goes_on = !query_.found && children.count > 0 && keys[nearest] < enough();
    for (std::uint32_t i = 0; i < children.count; ++i) {
      if (goes_on && i == nearest) continue;
      if (!(keys[i] < enough())) {
        left_ = std::min(left_, keys[i]);
      } else if (!frontier_.push(keys[i], enough(), child(i))) {
        return Errc::kDepthExceeded;
      }
    }
    if (goes_on) {
      key = keys[nearest];
      entry = child(nearest);
    }
    return Errc::kOk;
  }

  const BoundTree& tree_;
  const ErasedCodec codec_;
  PointQuery& query_;
  const std::uint64_t budget_;
  double left_ = std::numeric_limits<double>::infinity();
  bool is_spent_ = false;
  Frontier<Entry, kQueue, kStackSize<ErasedCodec>> frontier_;
};

// An upper bound of the length of a vector, even where its square underflows.
double length_above(const Eigen::Vector3d& v) noexcept {
  constexpr double kMore = 1 + 4 * kRoundoffF64;
  constexpr int kExponent = 600;
  const double square = squared_length(v);
  if (square > 0x1p-900) return std::sqrt(square) * kMore;
  return scaled_above(std::sqrt(squared_length(std::ldexp(1.0, kExponent) * v)) * kMore,
                      -kExponent);
}

}  // namespace

Result<ApproximatePoint> closest_point(const Tree& queried, const Eigen::Vector3d& point,
                                       const PointOptions& options) {
  const DefaultFloatState state;
  const BoundTree& tree = BoundTree::of(queried);
  const Frame& frame = tree.frame();
  const Eigen::Vector3d tree_point = frame.to_tree(point);
  if (!is_within_range(tree_point)) return invalid_query("point");
  if (const char* field = invalid_field(options)) return invalid_query(field);
  ApproximatePoint result;
  result.lower = std::numeric_limits<double>::infinity();
  if (tree.empty()) return result;

  Approximation approximation = options;
  approximation.absolute_error *= frame.inverse_scale;
  approximation.max_distance *= frame.inverse_scale;
  WalkBound nodes(tree.node_count());
  const double most = approximation.max_distance * approximation.max_distance;
  PointQuery query{tree, nodes, tree_point, most, {}, Errc::kOk, {}};
  query.approximation = &approximation;
  double left = std::numeric_limits<double>::infinity();  // squared: of what was not visited
  Errc walked;
  if (options.node_budget == kUnlimitedNodes) {
    walked = walk_nearest(tree, query);
  } else {
    BestFirst walk(tree, query, options.node_budget);
    walked = walk.run();
    left = walk.left();
    result.converged = !walk.is_spent();
  }
  if (walked != Errc::kOk) return walked;
  if (query.error != Errc::kOk) return query.error;

  // What was skipped is beyond the bound, or was not visited; keys are within a factor of 1 + 4 u
  // of the square that they stand for, and so is a root. The point itself is off by the rounding of
  // its conversion to tree space.
  const int exponent = tree.scale_exponent();
  const double place =
      frame.origin.isZero(0) ? 0 : 2 * kRoundoffF64 * tree_point.cwiseAbs().maxCoeff();
  const double untested = std::sqrt(std::min(query.best, left)) * (1 - 8 * kRoundoffF64);
  result.lower =
      scaled_below(std::max(0.0, std::min(untested, query.tested_lower) - place), exponent);
  result.nodes_expanded = query.nodes_expanded;
  if (!query.found) return result;
  query.name_face();
  // A point of a face is off by up to 26 u of the largest coordinate (see triangle_distance.cpp),
  // and the point itself by half the least double where its conversion to tree space underflows.
  const double off = 26 * kRoundoffF64 * tree.largest_abs() + place;
  const double lost =
      frame.to_object(tree_point) == point ? 0 : std::numeric_limits<double>::denorm_min();
  const double upper = length_above(query.found->point - tree_point) + off + lost;
  result.upper = scaled_above(upper, exponent);
  result.witness = query.found;
  result.witness->point = frame.to_object(query.found->point);
  result.witness->distance = std::sqrt(query.found->distance) * frame.scale;
  return result;
}

}  // namespace boxtree
