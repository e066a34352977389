// SPDX-License-Identifier: MIT
// The part of a tree that wide8 and wide4 share: everything except the planes of boxes.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cooker/build/build_tree.h"
#include "format/codec_wide.h"

namespace boxtree::cooker {

/// Nodes with up to eight children, and the places of nodes, leaves and faces. Contains all that
/// encoding needs, so that the build tree can be freed.
struct WideLayout {
  struct Node {
    WideLinks links;
    std::array<Box<float>, kWideChildren> content;  // what the box of each child must hold
  };

  RootKind root = RootKind::kEmpty;
  Box<float> root_box{};
  std::vector<Node> nodes;  // by their numbers
  std::uint32_t leaf_count = 0;
  std::uint32_t depth = 0;
  std::vector<std::uint32_t> face_order;  // source faces in leaf order; geometry must match it
};

/// Precondition: a tree with full leaves.
[[nodiscard]] WideLayout lay_out_wide(const BuildTree& full_leaves);

}  // namespace boxtree::cooker
