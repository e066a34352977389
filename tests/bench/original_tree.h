// SPDX-License-Identifier: MIT
// The baseline: the BoxTree before the paper (its section 2.1 and table 2.1). Nodes and leaves are
// separate objects on the heap, linked by pointers; each leaf holds one polygon of three or four
// points. Leaf tests are the runtime's, so all differences are the tree's.
#pragma once

#include <cstdint>
#include <vector>

#include <boxtree/query.h>

#include "cooker/build/build_tree.h"

namespace boxtree::bench {

/// Marks the missing fourth point of a triangle.
inline constexpr std::uint32_t kNoPoint = 0xffffffffu;

/// A node or a leaf: 48 bytes, plus 8 for malloc.
struct OriginalNode {
  struct Inner {
    OriginalNode* child[2];  // null: an empty box was cut off
    float cut[2];            // off the high side for child 0, off the low side for child 1
    std::uint64_t padding;
  };
  struct Leaf {
    std::uint32_t polygon;
    std::uint32_t padding;
    std::uint32_t point[4];
    const Eigen::Vector3f* points;
  };

  virtual ~OriginalNode() = default;  // the original has one, without needing it

  [[nodiscard]] bool is_leaf() const { return (cutplane & kLeafFlag) != 0; }

  static constexpr std::uint32_t kLeafFlag = 0x8000;
  std::uint32_t cutplane = 0;  // the axis, or kLeafFlag
  union {
    Inner inner{};
    Leaf leaf;
  };
};
static_assert(sizeof(OriginalNode) == 48);
inline constexpr std::size_t kOriginalNodeBytes = 56;

class OriginalTree {
 public:
  /// Uses the cooker's splits. `points` must outlive the tree. Coordinates are those of the mesh.
  OriginalTree(const cooker::BuildTree& build, const cooker::SourceMesh& mesh,
               const std::vector<Eigen::Vector3f>& points);
  ~OriginalTree();
  OriginalTree(const OriginalTree&) = delete;
  OriginalTree& operator=(const OriginalTree&) = delete;

  [[nodiscard]] const OriginalNode* root() const { return root_; }
  [[nodiscard]] const Box<float>& root_box() const { return root_box_; }
  [[nodiscard]] std::size_t node_count() const { return node_count_; }  // leaves included

 private:
  OriginalNode* build_node(const cooker::BuildTree& build, const cooker::SourceMesh& mesh,
                           const Eigen::Vector3f* points, std::uint32_t source,
                           const Box<float>& box, std::uint32_t depth);
  static void free(OriginalNode* node);

  OriginalNode* root_ = nullptr;
  Box<float> root_box_{};
  std::size_t node_count_ = 0;
};

}  // namespace boxtree::bench
