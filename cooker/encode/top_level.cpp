// SPDX-License-Identifier: MIT
// Binary splits by the surface-area heuristic at every position along every axis. Nodes get eight
// children by dividing the largest child first.
#include "cooker/encode/top_level.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "cooker/build/splitter.h"
#include "cooker/encode/encoders.h"
#include "runtime/scene/scene_frame.h"
#include "runtime/tree/root_box.h"

namespace boxtree::cooker {
namespace {

// From this depth of binary splits on, sets are halved. 28 more levels suffice for kMaxInstances,
// and nodes with eight children are never deeper than the splits they come from.
constexpr std::uint32_t kSplitDepth = kMaxWideDepth - 32;

// Instances of one subtree. FaceBox::face is the number of an instance.
struct Set {
  std::span<FaceBox> instances;
  std::uint32_t depth;  // of binary splits above it
  Box<float> box;

  Set(std::span<FaceBox> of, std::uint32_t splits)
      : instances(of), depth(splits), box(empty_box<float>()) {
    for (const FaceBox& instance : of) expand(box, instance.box);
  }
};

class TopLevelBuilder {
 public:
  explicit TopLevelBuilder(WideLayout& out) : out_(out) {}

  // Returns the instances in the order of the leaves. Reorders `instances`.
  std::vector<std::uint32_t> run(std::span<FaceBox> instances) {
    const Set all(instances, 0);
    out_.root_box = all.box;
    out_.leaf_count = static_cast<std::uint32_t>(instances.size());
    if (instances.size() == 1) {
      out_.root = RootKind::kLeaf;
      leaves_.push_back(instances[0].face);
    } else {
      out_.root = RootKind::kSubtree;
      out_.nodes.resize(1);
      fill(0, all, 1);
    }
    return std::move(leaves_);
  }

 private:
  // Sibling nodes have consecutive numbers, and so have sibling leaves.
  void fill(std::uint32_t number, const Set& set, std::uint32_t depth) {
    out_.depth = std::max(out_.depth, depth);
    const std::vector<Set> children = open(set);
    WideLayout::Node node{};
    node.links = {static_cast<std::uint32_t>(out_.nodes.size()),
                  static_cast<std::uint32_t>(leaves_.size()), 0,
                  static_cast<std::uint32_t>(children.size())};
    std::uint32_t inner = 0;
    for (std::size_t i = 0; i < children.size(); ++i) {
      node.content[i] = children[i].box;
      if (children[i].instances.size() == 1) {
        leaves_.push_back(children[i].instances[0].face);
      } else {
        node.links.inner_mask |= 1u << i;
        ++inner;
      }
    }
    out_.nodes[number] = node;
    out_.nodes.resize(out_.nodes.size() + inner);
    std::uint32_t next = node.links.first_node;
    for (const Set& child : children) {
      if (child.instances.size() > 1) fill(next++, child, depth + 1);
    }
  }

  // The children of a node: the largest is divided until there are eight, or only leaves.
  std::vector<Set> open(const Set& set) {
    std::vector<Set> children{set};
    while (children.size() < kWideChildren) {
      const auto largest =
          std::max_element(children.begin(), children.end(), [](const Set& a, const Set& b) {
            const auto weight = [](const Set& one) {
              return one.instances.size() < 2 ? -1 : half_area(one.box);
            };
            return weight(a) < weight(b);
          });
      if (largest->instances.size() < 2) break;
      const Set opened = *largest;
      const std::size_t left = divide(opened);
      *largest = Set(opened.instances.first(left), opened.depth + 1);
      children.insert(largest + 1, Set(opened.instances.subspan(left), opened.depth + 1));
    }
    return children;
  }

  // Reorders a set so that the first part is separate from the rest; returns the size of that part.
  std::size_t divide(const Set& set) {
    const std::span<FaceBox> all = set.instances;
    if (set.depth >= kSplitDepth) {
      return split_at(all, all.size() / 2, widest_axis(set.box)).left_count;
    }
    double best_cost = std::numeric_limits<double>::infinity();
    std::uint32_t best_axis = 0;
    std::size_t best_left = all.size() / 2;
    areas_.resize(all.size());
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      std::sort(all.begin(), all.end(), [axis](const FaceBox& a, const FaceBox& b) {
        const double x = centre(a, axis), y = centre(b, axis);
        return x != y ? x < y : a.face < b.face;
      });
      Box<float> box = empty_box<float>();
      for (std::size_t i = all.size(); i-- > 1;) {
        expand(box, all[i].box);
        areas_[i] = half_area(box);
      }
      box = empty_box<float>();
      for (std::size_t left = 1; left < all.size(); ++left) {
        expand(box, all[left - 1].box);
        const double cost = half_area(box) * static_cast<double>(left) +
                            areas_[left] * static_cast<double>(all.size() - left);
        if (cost < best_cost) {
          best_cost = cost;
          best_axis = axis;
          best_left = left;
        }
      }
    }
    return split_at(all, best_left, best_axis).left_count;
  }

  WideLayout& out_;
  std::vector<std::uint32_t> leaves_;
  std::vector<double> areas_;
};

}  // namespace

EncodedTopLevel build_top_level(std::span<const Box<double>> world_boxes,
                                std::span<const Box<double>> moving_boxes) {
  EncodedTopLevel top;
  const Frame frame =
      frame_around(world_boxes.empty() ? moving_boxes : world_boxes, top.scale_exponent);
  top.origin = {frame.origin[0], frame.origin[1], frame.origin[2]};
  if (world_boxes.empty()) {
    top.nodes.codec = CodecId::kWide8;
    top.nodes.root = RootKind::kEmpty;
    return top;
  }
  std::vector<FaceBox> instances;
  instances.reserve(world_boxes.size());
  for (const Box<double>& world : world_boxes) {
    const Eigen::Vector3d low = frame.to_tree({world.low[0], world.low[1], world.low[2]});
    const Eigen::Vector3d high = frame.to_tree({world.high[0], world.high[1], world.high[2]});
    instances.push_back(
        {rounded_outward<float>({{low[0], low[1], low[2]}, {high[0], high[1], high[2]}}),
         static_cast<std::uint32_t>(instances.size())});
  }
  WideLayout layout;
  top.order = TopLevelBuilder(layout).run(instances);
  top.nodes = encode_wide(layout, CodecId::kWide8);
  return top;
}

}  // namespace boxtree::cooker
