// SPDX-License-Identifier: MIT
// Computes costs from the leaves up and decides from the root down.
#include "cooker/encode/wide_collapse.h"

#include <limits>

#include "cooker/build/splitter.h"

namespace boxtree::cooker {

WideCollapse::WideCollapse(const BuildTree& tree, double node_cost)
    : tree_(tree), left_roots_(tree.nodes.size()), own_division_(tree.nodes.size()) {
  const double root_area = half_area(tree.nodes[0].bounds);
  // From the last node in preorder to the first, both children come before their parent, the left
  // one last. Costs are kept of nodes alone whose parent is still to come: one on each level.
  std::vector<Costs> pending;
  for (std::size_t i = tree.nodes.size(); i-- > 0;) {
    if (tree.nodes[i].is_leaf()) {  // one root, which costs the same everywhere
      pending.push_back({});
      continue;
    }
    const Costs left = pending.back();
    pending.pop_back();
    const Costs right = pending.back();
    const Division below = best_division(left, right, kWideChildren);
    own_division_[i] = below.on_left;
    // If the root has no area, all nodes cost the same.
    const double area = root_area > 0 ? half_area(tree.nodes[i].bounds) / root_area : 1;
    pending.back() = choose_forests(left, right, below.cost + area + node_cost, left_roots_[i]);
  }
}

// The cheapest forest with exactly two sides and `roots` roots.
WideCollapse::Division WideCollapse::best_division(const Costs& left, const Costs& right,
                                                   std::size_t roots) {
  Division best{std::numeric_limits<double>::infinity(), 0};
  for (std::size_t on_left = 1; on_left < roots; ++on_left) {
    const double here = left[on_left - 1] + right[roots - on_left - 1];
    if (here < best.cost) best = {here, static_cast<std::uint8_t>(on_left)};
  }
  return best;
}

WideCollapse::Costs WideCollapse::choose_forests(const Costs& left, const Costs& right,
                                                 double own_cost, LeftRoots& left_roots) {
  Costs costs;
  costs[0] = own_cost;
  for (std::size_t roots = 2; roots <= kWideChildren; ++roots) {
    const Division division = best_division(left, right, roots);
    // Costs fall with the number of roots, because roots may stay unused.
    const bool pays = division.cost < costs[roots - 2];
    costs[roots - 1] = pays ? division.cost : costs[roots - 2];
    left_roots[roots - 1] = pays ? division.on_left : kSameAsFewer;
  }
  return costs;
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
  while (roots > 1 && left_roots_[node][roots - 1] == kSameAsFewer) --roots;
  if (roots == 1) {
    children.push_back(node);
    return;
  }
  const std::size_t on_left = left_roots_[node][roots - 1];
  gather(node + 1, on_left, children);
  gather(tree_.nodes[node].right, roots - on_left, children);
}

}  // namespace boxtree::cooker
