// SPDX-License-Identifier: MIT
// One function a codec; encode_nodes() in encoded.h chooses among them.
#pragma once

#include <boxtree/cooker/encode/encoded.h>

namespace boxtree::cooker {

[[nodiscard]] EncodedNodes encode_plain_f32(const BuildTree& tree, FaceOrder order);
[[nodiscard]] EncodedNodes encode_plain_f16(const BuildTree& tree, FaceOrder order);

[[nodiscard]] EncodedNodes encode_packed_f32(const BuildTree& tree, FaceOrder order,
                                             FieldWidths widths);
[[nodiscard]] EncodedNodes encode_packed_f16(const BuildTree& tree, FaceOrder order,
                                             FieldWidths widths);
/// Needs the mesh: the build tree's own bounds are f32.
[[nodiscard]] EncodedNodes encode_packed_f64(const BuildTree& tree, const SourceMesh& mesh,
                                             FaceOrder order, FieldWidths widths);
[[nodiscard]] EncodedNodes encode_dedup(const BuildTree& tree, FaceOrder order, FieldWidths widths);

/// Of trees with full leaves. They choose the order of faces: EncodedNodes::face_order.
[[nodiscard]] EncodedNodes encode_wide8(const BuildTree& full_leaves);
[[nodiscard]] EncodedNodes encode_wide4(const BuildTree& full_leaves);

}  // namespace boxtree::cooker
