// SPDX-License-Identifier: MIT
// Encodes nodes from build trees. Conservative: every decoded box contains what is below it. Binary
// codecs start from plain nodes: one walk of the build tree for each scalar type of cuts, then one
// packing for each codec.
#pragma once

#include "cooker/encode/encoded.h"
#include "cooker/encode/wide_layout.h"

namespace boxtree::cooker {

/// The paper's threshold: an empty slab is cut off when it holds at least this share of the box.
inline constexpr double kShrinkShare = 0.15;

/// The scalar type of cuts in plain nodes.
enum class PlainCut : std::uint8_t { kF16, kF32, kF64 };

/// The plain nodes that a binary codec starts from.
[[nodiscard]] constexpr PlainCut plain_cut_of(CodecId codec) noexcept {
  if (codec == CodecId::kPlainF16 || codec == CodecId::kPackedF16) return PlainCut::kF16;
  return codec == CodecId::kPackedF64 ? PlainCut::kF64 : PlainCut::kF32;
}

/// Codecs plain-f16 and plain-f32, and plain nodes with cuts in f64, which no file holds. `mesh` is
/// the source of the tree, used only for f64: the build tree's own bounds are f32. `shrink_share`
/// is above 0. Precondition: a tree with one triangle per leaf.
[[nodiscard]] EncodedNodes encode_plain(const BuildTree& tree, const MeshView& mesh, PlainCut cut,
                                        FaceOrder order, double shrink_share = kShrinkShare);

/// The nodes of a binary codec, from plain nodes with cuts as in plain_cut_of(codec). `widths`
/// affects only packed codecs and dedup.
[[nodiscard]] EncodedNodes pack_nodes(const EncodedNodes& plain, CodecId codec, FieldWidths widths);

/// Codecs wide8 and wide4.
[[nodiscard]] EncodedNodes encode_wide(const WideLayout& layout, CodecId codec);

}  // namespace boxtree::cooker
