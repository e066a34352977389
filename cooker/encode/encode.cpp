// SPDX-License-Identifier: MIT
// From a codec's number to its encoder.
#include <boxtree/cooker/encode/encoders.h>

namespace boxtree::cooker {
namespace {

EncodedNodes encode_with(const BuildTree& tree, const SourceMesh& mesh, CodecId codec,
                         FaceOrder order, FieldWidths widths) {
  switch (codec) {
    case CodecId::kPlainF32:
      return encode_plain_f32(tree, order);
    case CodecId::kPlainF16:
      return encode_plain_f16(tree, order);
    case CodecId::kPackedF32:
      return encode_packed_f32(tree, order, widths);
    case CodecId::kPackedF16:
      return encode_packed_f16(tree, order, widths);
    case CodecId::kPackedF64:
      return encode_packed_f64(tree, mesh, order, widths);
    case CodecId::kDedup:
      return encode_dedup(tree, order, widths);
    case CodecId::kWide8:
      return encode_wide8(tree);
    case CodecId::kWide4:
      return encode_wide4(tree);
  }
  return {};
}

}  // namespace

EncodedNodes encode_nodes(const BuildTree& tree, const SourceMesh& mesh, CodecId codec,
                          FaceOrder order, FieldWidths widths) {
  EncodedNodes nodes = encode_with(tree, mesh, codec, order, widths);
  nodes.codec = codec;
  return nodes;
}

}  // namespace boxtree::cooker
