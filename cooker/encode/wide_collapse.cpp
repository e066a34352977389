// SPDX-License-Identifier: MIT
// Computes costs from the leaves up and decides from the root down.
#include "cooker/encode/wide_collapse.h"

#include <limits>

#include "cooker/build/splitter.h"

namespace boxtree::cooker {

WideCollapse::WideCollapse(const BuildTree& tree, double node_cost)
    : tree_(tree), forests_(tree.nodes.size()), own_division_(tree.nodes.size()) {
  const double root_area = half_area(tree.nodes[0].bounds);
  // Children have larger indices than their parents.
  for (std::size_t i = tree.nodes.size(); i-- > 0;) {
    if (tree.nodes[i].is_leaf()) continue;  // a leaf is one root and costs the same everywhere
    const auto node = static_cast<std::uint32_t>(i);
    double below = 0;
    own_division_[i] = best_division(node, kWideChildren, below);
    // If the root has no area, all nodes cost the same.
    const double area = root_area > 0 ? half_area(tree.nodes[i].bounds) / root_area : 1;
    forests_[i] = forests_of(node, below + area + node_cost);
  }
}

// The cheapest forest with exactly two sides and `roots` roots; returns the number on the left.
std::uint8_t WideCollapse::best_division(std::uint32_t node, std::size_t roots,
                                         double& cost) const {
  const Forests& left = forests_[node + 1];
  const Forests& right = forests_[tree_.nodes[node].right];
  cost = std::numeric_limits<double>::infinity();
  std::uint8_t best = 0;
  for (std::size_t on_left = 1; on_left < roots; ++on_left) {
    const double here = left.cost[on_left - 1] + right.cost[roots - on_left - 1];
    if (here < cost) {
      cost = here;
      best = static_cast<std::uint8_t>(on_left);
    }
  }
  return best;
}

WideCollapse::Forests WideCollapse::forests_of(std::uint32_t node, double own_cost) const {
  Forests forests;
  forests.cost[0] = own_cost;
  for (std::size_t roots = 2; roots <= kWideChildren; ++roots) {
    double cost = 0;
    const std::uint8_t division = best_division(node, roots, cost);
    // Costs fall with the number of roots, because roots may stay unused.
    const bool pays = cost < forests.cost[roots - 2];
    forests.cost[roots - 1] = pays ? cost : forests.cost[roots - 2];
    forests.left_roots[roots - 1] = pays ? division : kSameAsFewer;
  }
  return forests;
}

void WideCollapse::children_of(std::uint32_t node, std::vector<std::uint32_t>& children) const {
  children.clear();
  const std::size_t on_left = own_division_[node];
  gather(node + 1, on_left, children);
  gather(tree_.nodes[node].right, kWideChildren - on_left, children);
}

void WideCollapse::gather(std::uint32_t node, std::size_t roots,
                          std::vector<std::uint32_t>& children) const {
  if (tree_.nodes[node].is_leaf()) {
    children.push_back(node);
    return;
  }
  while (roots > 1 && forests_[node].left_roots[roots - 1] == kSameAsFewer) --roots;
  if (roots == 1) {
    children.push_back(node);
    return;
  }
  const std::size_t on_left = forests_[node].left_roots[roots - 1];
  gather(node + 1, on_left, children);
  gather(tree_.nodes[node].right, roots - on_left, children);
}

}  // namespace boxtree::cooker
