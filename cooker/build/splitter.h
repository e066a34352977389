// SPDX-License-Identifier: MIT
// The interface of split rules: a rule divides a set of faces into two smaller sets.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>
#include <limits>
#include <optional>
#include <span>

#include <Eigen/Core>

#include "cooker/build/build_tree.h"

namespace boxtree::cooker {

/// Half the surface of a box, in double so that thin boxes do not round to nothing.
[[nodiscard]] inline double half_area(const Box<float>& box) {
  const double x = double{box.high[0]} - box.low[0];
  const double y = double{box.high[1]} - box.low[1];
  const double z = double{box.high[2]} - box.low[2];
  return x * y + y * z + z * x;
}

/// The bounds of faces as they grow: four numbers a side, of which the last means nothing, so that
/// a side is one vector.
class FaceBounds {
 public:
  void add(const FaceBox& face) {
    // Whatever follows three numbers in memory is the fourth.
    static_assert(offsetof(FaceBox, box) == 0 && sizeof(FaceBox) == sizeof(Box<float>) + 4);
    FaceBounds bounds;
    std::memcpy(bounds.low_.data(), &face, sizeof(low_));
    std::memcpy(bounds.high_.data(), reinterpret_cast<const std::byte*>(&face) + 3 * sizeof(float),
                sizeof(high_));
    add(bounds);
  }
  void add(const FaceBounds& other) {
    low_ = low_.min(other.low_);
    high_ = high_.max(other.high_);
  }
  [[nodiscard]] Box<float> box() const {
    return {{low_[0], low_[1], low_[2]}, {high_[0], high_[1], high_[2]}};
  }

 private:
  static constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Eigen::Array4f low_ = Eigen::Array4f::Constant(kInfinity);
  Eigen::Array4f high_ = Eigen::Array4f::Constant(-kInfinity);
};

/// Twice the centre of a box; comparisons do not need the factor.
[[nodiscard]] inline double centre(const FaceBox& face, std::size_t axis) {
  return double{face.box.low[axis]} + face.box.high[axis];
}

[[nodiscard]] inline std::size_t imbalance(std::size_t left, std::size_t right) {
  return left > right ? left - right : right - left;
}

/// A division under consideration. Smaller cost wins, then the more even division, then the lower
/// axis: no cost can be NaN, and flat sets, whose costs are all zero, still split in the middle.
struct SplitCost {
  double cost = std::numeric_limits<double>::infinity();
  std::size_t imbalance = 0;
  std::size_t axis = 0;
  std::size_t position = 0;  // first bin, or first face of the sorted order, that goes right

  [[nodiscard]] bool improves_on(const SplitCost& best) const {
    return cost < best.cost || (cost == best.cost && imbalance < best.imbalance);
  }
};

/// The result of a division: faces [0, left_count) go left. Neither side is empty.
struct Split {
  std::size_t left_count;
  std::uint32_t axis;
};

/// Reorders `faces` and divides them. The two resulting sets must depend only on the set of faces,
/// not on their order, so that the tree does not depend on earlier partitions. Empty if the rule
/// finds no difference between the faces.
using SplitRule = std::optional<Split> (*)(std::span<FaceBox> faces, const Box<float>& bounds);

[[nodiscard]] std::optional<Split> split_sah(std::span<FaceBox> faces, const Box<float>& bounds);
[[nodiscard]] std::optional<Split> split_paper(std::span<FaceBox> faces, const Box<float>& bounds);

/// Divides a set that will become `roots` children of a wide node, so that the leaves and nodes on
/// the left are full; the right side takes the rest. For large sets; UnitSweep divides small ones.
/// Precondition: more leaves than roots, two to eight roots.
[[nodiscard]] std::optional<Split> split_sah_full_leaves(std::span<FaceBox> faces,
                                                         std::size_t roots);

/// The axis along which a box is longest.
[[nodiscard]] std::uint32_t widest_axis(const Box<float>& bounds);

/// The first `count` faces by box centre along an axis, ties by face number, go left. Always
/// succeeds. With half of the faces, it bounds the depth.
[[nodiscard]] Split split_at(std::span<FaceBox> faces, std::size_t count, std::uint32_t axis);

/// Levels of even halving until sets have one element. Precondition: at least one.
[[nodiscard]] constexpr std::uint32_t halvings(std::size_t count) {
  return static_cast<std::uint32_t>(std::bit_width(count - 1));
}

/// The node `node` above its two finished children; the left child is the next node.
[[nodiscard]] inline BuildNode inner_node(std::span<const BuildNode> nodes, std::size_t node,
                                          std::size_t right, std::uint32_t axis) {
  const BuildNode& on_left = nodes[node + 1];
  const BuildNode& on_right = nodes[right];
  Box<float> bounds = on_left.bounds;
  expand(bounds, on_right.bounds);
  const std::uint32_t height = 1 + std::max(on_left.height(), on_right.height());
  return {bounds, static_cast<std::uint32_t>(right), axis | height << 8};
}

}  // namespace boxtree::cooker
