// SPDX-License-Identifier: MIT
// Numbers nodes, leaves and faces from the root down: the top levels first, then subtrees.
#include "cooker/encode/wide_layout.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

#include "cooker/encode/wide_collapse.h"

namespace boxtree::cooker {
namespace {

// The weight of the bytes of all nodes: equal to this many more visits in each query. Each node has
// an equal share of it, so that small and large meshes are treated alike.
constexpr double kVisitsForBytes = 2;

// Number of levels stored together at the front, because every query reads some nodes of each: 73
// nodes if all are full, one page of wide4 or little more than one of wide8. A fourth level would
// make it ten pages.
constexpr std::uint32_t kTopLevels = 3;

// The number of full nodes that hold this many leaves.
double full_nodes(std::size_t leaves) {
  return static_cast<double>(leaves) / (kWideChildren - 1);
}

class Layouter {
 public:
  Layouter(const BuildTree& tree, WideLayout& out)
      : tree_(tree), collapse_(tree, kVisitsForBytes / full_nodes(out.leaf_count)), out_(out) {}

  void run() {
    out_.nodes.resize(1);
    place_top();
    fill(0, 0, 1);
  }

 private:
  // Numbers the nodes of the top levels, level by level.
  void place_top() {
    std::vector<std::uint32_t> level = {0};
    std::vector<std::uint32_t> children;
    for (std::uint32_t depth = 1; depth < kTopLevels; ++depth) {
      std::vector<std::uint32_t> next;
      for (const std::uint32_t source : level) {
        first_child_in_top_.emplace(source, static_cast<std::uint32_t>(out_.nodes.size()));
        collapse_.children_of(source, children);
        std::erase_if(children, [this](std::uint32_t child) { return is_leaf(child); });
        out_.nodes.resize(out_.nodes.size() + children.size());
        next.insert(next.end(), children.begin(), children.end());
      }
      level = std::move(next);
    }
  }

  // The number of the first of `count` siblings below the node `source` of the build tree.
  std::uint32_t place_nodes(std::uint32_t source, std::size_t count) {
    const auto top = first_child_in_top_.find(source);
    if (top != first_child_in_top_.end()) return top->second;
    const auto first = static_cast<std::uint32_t>(out_.nodes.size());
    out_.nodes.resize(first + count);
    return first;
  }

  [[nodiscard]] bool is_leaf(std::uint32_t node) const { return tree_.nodes[node].is_leaf(); }

  // Fills node `number`, and all below it, from node `source` of the build tree. Below the top
  // levels, siblings are stored together, followed by the subtree of the first, and so on.
  void fill(std::uint32_t number, std::uint32_t source, std::uint32_t depth) {
    out_.depth = std::max(out_.depth, depth);
    std::vector<std::uint32_t> children;
    collapse_.children_of(source, children);

    WideLayout::Node node{};
    node.links = {0, 0, 0, static_cast<std::uint32_t>(children.size())};
    std::uint32_t leaves = 0;
    bool holds_partial_leaf = false;
    for (std::size_t i = 0; i < children.size(); ++i) {
      const BuildNode& child = tree_.nodes[children[i]];
      node.content[i] = child.bounds;
      if (child.is_leaf()) {
        ++leaves;
        holds_partial_leaf |= child.first() + kLeafFaces > tree_.order.size();
      } else {
        node.links.inner_mask |= 1u << i;
      }
    }
    node.links.first_node = place_nodes(source, children.size() - leaves);
    out_.nodes[number] = node;

    // Leaves of a node have consecutive numbers. They are placed at the first leaf from left to
    // right, between the subtrees of its siblings: neighbours in number are then neighbours in
    // space, which keeps clusters of grid geometry small.
    bool are_placed = false;
    std::uint32_t next_node = node.links.first_node;
    for (const std::uint32_t child : children) {
      if (!is_leaf(child)) {
        fill(next_node++, child, depth + 1);
      } else if (!are_placed) {
        place_leaves(number, children, leaves, holds_partial_leaf);
        are_placed = true;
      }
    }
  }

  // The leaf that is not full must have the largest number. It is the last one from left to right,
  // so it is also the last of its siblings.
  void place_leaves(std::uint32_t number, const std::vector<std::uint32_t>& children,
                    std::uint32_t leaves, bool hold_partial_leaf) {
    const std::uint32_t first = hold_partial_leaf ? out_.leaf_count - leaves : next_leaf_;
    if (!hold_partial_leaf) next_leaf_ += leaves;
    out_.nodes[number].links.first_leaf = first;
    std::uint32_t next = first;
    for (const std::uint32_t child : children) {
      if (is_leaf(child)) place_leaf(next++, child);
    }
  }

  // A leaf's number gives the places of its faces.
  void place_leaf(std::uint32_t number, std::uint32_t leaf) {
    const std::size_t from = tree_.nodes[leaf].first();
    const std::size_t to = std::size_t{number} * kLeafFaces;
    for (std::size_t i = 0; i < kLeafFaces && from + i < tree_.order.size(); ++i) {
      out_.face_order[to + i] = tree_.order[from + i];
    }
  }

  const BuildTree& tree_;
  WideCollapse collapse_;
  WideLayout& out_;
  std::uint32_t next_leaf_ = 0;
  std::unordered_map<std::uint32_t, std::uint32_t> first_child_in_top_;  // number, by source
};

}  // namespace

WideLayout lay_out_wide(const BuildTree& full_leaves) {
  WideLayout out;
  if (full_leaves.nodes.empty()) return out;
  out.root_box = full_leaves.nodes[0].bounds;
  out.leaf_count = static_cast<std::uint32_t>(leaves_of(full_leaves.order.size()));
  if (out.leaf_count == 1) {
    out.root = RootKind::kLeaf;
    out.face_order = full_leaves.order;
    return out;
  }
  out.root = RootKind::kSubtree;
  out.face_order.resize(full_leaves.order.size());
  Layouter(full_leaves, out).run();
  return out;
}

}  // namespace boxtree::cooker
