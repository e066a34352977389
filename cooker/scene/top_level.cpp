// SPDX-License-Identifier: MIT
// Binary splits by the surface-area heuristic over all places along all axes, eight children a node
// by opening the largest child first.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <boxtree/cooker/encode/encoders.h>
#include <boxtree/cooker/scene/top_level.h>
#include <boxtree/runtime/tree/frame.h>

namespace boxtree::cooker {
namespace {

// From this depth of binary splits on sets are halved, whatever it costs: 28 more levels do for
// kMaxInstances, and nodes of eight children are never deeper than the splits they come from.
constexpr std::uint32_t kSplitDepth = kMaxWideDepth - 32;

// The largest extent of a tree lies below 2^kExtentExponent, as that of every tree (TreeRecord).
constexpr int kExtentExponent = 15;

double half_area(const Box<float>& box) {
  const double x = double{box.high[0]} - box.low[0];
  const double y = double{box.high[1]} - box.low[1];
  const double z = double{box.high[2]} - box.low[2];
  return x * y + (y * z + z * x);
}

float centre(const Box<float>& box, std::size_t axis) {
  return box.low[axis] / 2 + box.high[axis] / 2;
}

Box<float> rounded_outward(const Box<double>& box) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Box<float> out = box_cast<float>(box);
  for (std::size_t k = 0; k < 3; ++k) {
    if (out.low[k] > box.low[k]) out.low[k] = std::nextafter(out.low[k], -kInfinity);
    if (out.high[k] < box.high[k]) out.high[k] = std::nextafter(out.high[k], kInfinity);
  }
  return out;
}

// A set of instances: a range of `order`.
struct Set {
  std::uint32_t first;
  std::uint32_t count;
  std::uint32_t depth;  // of binary splits above it
  Box<float> box;
};

class TopLevelBuilder {
 public:
  TopLevelBuilder(std::span<const Box<float>> boxes, WideLayout& out) : boxes_(boxes), out_(out) {
    order_.resize(boxes.size());
    std::iota(order_.begin(), order_.end(), 0u);
  }

  void run() {
    const Set all = set_of(0, static_cast<std::uint32_t>(order_.size()), 0);
    out_.root_box = all.box;
    out_.leaf_count = all.count;
    if (all.count == 1) {
      out_.root = RootKind::kLeaf;
      leaves_.push_back(order_[0]);
      return;
    }
    out_.root = RootKind::kSubtree;
    out_.nodes.resize(1);
    fill(0, all, 1);
  }

  std::vector<std::uint32_t> take_leaves() { return std::move(leaves_); }

 private:
  [[nodiscard]] Set set_of(std::uint32_t first, std::uint32_t count, std::uint32_t depth) const {
    Set set{first, count, depth, empty_box<float>()};
    for (std::uint32_t i = 0; i < count; ++i) expand(set.box, boxes_[order_[first + i]]);
    return set;
  }

  // Nodes of siblings, and leaves of siblings, have consecutive numbers.
  void fill(std::uint32_t number, const Set& set, std::uint32_t depth) {
    out_.depth = std::max(out_.depth, depth);
    std::vector<Set> children{set};
    while (children.size() < kWideChildren) {
      std::size_t largest = children.size();
      for (std::size_t i = 0; i < children.size(); ++i) {
        if (children[i].count < 2) continue;
        if (largest == children.size() ||
            half_area(children[i].box) > half_area(children[largest].box)) {
          largest = i;
        }
      }
      if (largest == children.size()) break;
      const Set opened = children[largest];
      const std::uint32_t left = divide(opened);
      children[largest] = set_of(opened.first, left, opened.depth + 1);
      children.insert(children.begin() + static_cast<std::ptrdiff_t>(largest) + 1,
                      set_of(opened.first + left, opened.count - left, opened.depth + 1));
    }
    WideLayout::Node node{};
    node.links = {static_cast<std::uint32_t>(out_.nodes.size()),
                  static_cast<std::uint32_t>(leaves_.size()), 0,
                  static_cast<std::uint32_t>(children.size())};
    std::uint32_t inner = 0;
    for (std::size_t i = 0; i < children.size(); ++i) {
      node.content[i] = children[i].box;
      if (children[i].count == 1) {
        leaves_.push_back(order_[children[i].first]);
      } else {
        node.links.inner_mask |= 1u << i;
        ++inner;
      }
    }
    out_.nodes[number] = node;
    out_.nodes.resize(out_.nodes.size() + inner);
    std::uint32_t next = node.links.first_node;
    for (const Set& child : children) {
      if (child.count > 1) fill(next++, child, depth + 1);
    }
  }

  // Reorders a set so that its first part, whose size is returned, is apart from the rest.
  std::uint32_t divide(const Set& set) {
    const auto begin = order_.begin() + static_cast<std::ptrdiff_t>(set.first);
    const auto end = begin + static_cast<std::ptrdiff_t>(set.count);
    double best_cost = std::numeric_limits<double>::infinity();
    std::size_t best_axis = 0;
    std::uint32_t best_left = set.count / 2;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      sort(begin, end, axis);
      if (set.depth >= kSplitDepth) continue;
      areas_.resize(set.count);
      Box<float> box = empty_box<float>();
      for (std::uint32_t i = set.count; i-- > 1;) {
        expand(box, boxes_[order_[set.first + i]]);
        areas_[i] = half_area(box);
      }
      box = empty_box<float>();
      for (std::uint32_t left = 1; left < set.count; ++left) {
        expand(box, boxes_[order_[set.first + left - 1]]);
        const double cost = half_area(box) * left + areas_[left] * (set.count - left);
        if (cost < best_cost) {
          best_cost = cost;
          best_axis = axis;
          best_left = left;
        }
      }
    }
    if (set.depth >= kSplitDepth) {
      best_axis = 0;
      for (std::size_t k = 1; k < 3; ++k) {
        const auto extent = [&](std::size_t axis) {
          return set.box.high[axis] - set.box.low[axis];
        };
        if (extent(k) > extent(best_axis)) best_axis = k;
      }
    }
    sort(begin, end, best_axis);
    return best_left;
  }

  template <class Iterator>
  void sort(Iterator begin, Iterator end, std::size_t axis) const {
    std::sort(begin, end, [&](std::uint32_t a, std::uint32_t b) {
      const float x = centre(boxes_[a], axis), y = centre(boxes_[b], axis);
      return x != y ? x < y : a < b;
    });
  }

  std::span<const Box<float>> boxes_;
  WideLayout& out_;
  std::vector<std::uint32_t> order_;
  std::vector<std::uint32_t> leaves_;
  std::vector<double> areas_;
};

// A middle and a power of two that bring the boxes to where those of all trees are.
Frame choose_frame(std::span<const Box<double>> boxes, int& exponent) {
  Box<double> bounds = empty_box<double>();
  for (const Box<double>& box : boxes) expand(bounds, box);
  Eigen::Vector3d middle;
  double largest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    middle[static_cast<Eigen::Index>(k)] = bounds.low[k] / 2 + bounds.high[k] / 2;
    largest = std::max(largest, bounds.high[k] / 2 - bounds.low[k] / 2);
  }
  exponent = 0;
  if (largest > 0) {
    static_cast<void>(std::frexp(largest, &exponent));  // largest < 2^exponent; half an extent
    exponent = std::clamp(exponent + 1 - kExtentExponent, -kMaxScaleExponent, kMaxScaleExponent);
  }
  return {middle, exponent};
}

}  // namespace

EncodedTopLevel build_top_level(std::span<const Box<double>> world_boxes) {
  EncodedTopLevel top;
  if (world_boxes.empty()) {
    top.nodes.codec = CodecId::kWide8;
    top.nodes.root = RootKind::kEmpty;
    return top;
  }
  const Frame frame = choose_frame(world_boxes, top.scale_exponent);
  top.origin = {frame.origin[0], frame.origin[1], frame.origin[2]};
  std::vector<Box<float>> boxes;
  boxes.reserve(world_boxes.size());
  for (const Box<double>& world : world_boxes) {
    const Eigen::Vector3d low = frame.to_tree({world.low[0], world.low[1], world.low[2]});
    const Eigen::Vector3d high = frame.to_tree({world.high[0], world.high[1], world.high[2]});
    boxes.push_back(rounded_outward({{low[0], low[1], low[2]}, {high[0], high[1], high[2]}}));
  }
  WideLayout layout;
  TopLevelBuilder builder(boxes, layout);
  builder.run();
  top.order = builder.take_leaves();
  top.nodes = encode_wide(layout, CodecId::kWide8);
  return top;
}

}  // namespace boxtree::cooker
