// SPDX-License-Identifier: MIT
// What wide8 and wide4 have in common: all of a tree but the planes of its boxes.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cooker/build/build_tree.h"
#include "format/codec_wide.h"

namespace boxtree::cooker {

/// Nodes with up to eight children, and where they, leaves and faces stand. Holds all that encoding
/// needs, so that the build tree can go.
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
  std::vector<std::uint32_t> face_order;  // source faces by leaf; geometry must follow it
};

/// Precondition: a tree with full leaves.
[[nodiscard]] WideLayout lay_out_wide(const BuildTree& full_leaves);

}  // namespace boxtree::cooker
