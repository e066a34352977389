// SPDX-License-Identifier: MIT
// Converts a binary tree to one with eight children per node by choosing which nodes stay.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cooker/build/build_tree.h"
#include "format/codec_wide.h"

namespace boxtree::cooker {

/// The cheapest choice of nodes that stay such that each has at most eight children (dynamic
/// programming over forests, after Ylitie, Karras, Laine, "Efficient Incoherent Ray Traversal on
/// GPUs Through Compressed Wide BVHs", 2017). A node costs its area, as it is visited by that share
/// of rays, plus `node_cost` of the root's area for the bytes it takes.
class WideCollapse {
 public:
  /// Precondition: the tree has more than one leaf.
  WideCollapse(const BuildTree& tree, double node_cost);

  /// Nodes and leaves of the build tree that become the children of `node`, from left to right.
  void children_of(std::uint32_t node, std::vector<std::uint32_t>& children) const;

 private:
  // For forests with at most 1 .. 8 roots over a node and its subtree: the cost, and the number of
  // roots on the left; kSameAsFewer if one root less is as cheap.
  static constexpr std::uint8_t kSameAsFewer = 0xff;
  struct Forests {
    std::array<double, kWideChildren> cost{};
    std::array<std::uint8_t, kWideChildren> left_roots{};
  };

  [[nodiscard]] Forests forests_of(std::uint32_t node, double own_cost) const;
  [[nodiscard]] std::uint8_t best_division(std::uint32_t node, std::size_t roots,
                                           double& cost) const;
  void gather(std::uint32_t node, std::size_t roots, std::vector<std::uint32_t>& children) const;

  const BuildTree& tree_;
  std::vector<Forests> forests_;
  std::vector<std::uint8_t> own_division_;  // of the eight roots below a node that stays
};

}  // namespace boxtree::cooker
