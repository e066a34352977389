// SPDX-License-Identifier: MIT
// The encoders behind encode_nodes() in encoded.h. Binary codecs start from plain nodes: one walk
// of the build tree for each scalar of the cuts, packed in as many ways as are wanted.
#pragma once

#include <boxtree/cooker/encode/encoded.h>

namespace boxtree::cooker {

/// The paper's threshold: an empty slab is cut off when it holds at least this share of the box.
inline constexpr double kShrinkShare = 0.15;

/// How plain nodes hold their cuts.
enum class PlainCut : std::uint8_t { kF16, kF32, kF64 };

/// The plain nodes that a binary codec starts from.
[[nodiscard]] constexpr PlainCut plain_cut_of(CodecId codec) noexcept {
  if (codec == CodecId::kPlainF16 || codec == CodecId::kPackedF16) return PlainCut::kF16;
  return codec == CodecId::kPackedF64 ? PlainCut::kF64 : PlainCut::kF32;
}

/// Codecs plain-f16 and plain-f32, and plain nodes with cuts in f64, which no file holds. The mesh
/// serves f64 alone: the build tree's own bounds are f32.
[[nodiscard]] EncodedNodes encode_plain(const BuildTree& tree, const SourceMesh& mesh, PlainCut cut,
                                        FaceOrder order);

/// Packs plain nodes with the cuts of plain_cut_of(codec); codecs packed-f32, packed-f16,
/// packed-f64 and dedup.
[[nodiscard]] EncodedNodes pack_nodes(const EncodedNodes& plain, CodecId codec, FieldWidths widths);

/// Of trees with full leaves. They choose the order of faces: EncodedNodes::face_order.
[[nodiscard]] EncodedNodes encode_wide8(const BuildTree& full_leaves);
[[nodiscard]] EncodedNodes encode_wide4(const BuildTree& full_leaves);

}  // namespace boxtree::cooker
