// SPDX-License-Identifier: MIT
// From a codec's number to its encoder.
#include <boxtree/cooker/encode/encoders.h>

namespace boxtree::cooker {
namespace {

EncodedNodes encode_with(const BuildTree& tree, const SourceMesh& mesh, CodecId codec,
                         FaceOrder order, FieldWidths widths) {
  switch (codec) {
    case CodecId::kWide8:
      return encode_wide8(tree);
    case CodecId::kWide4:
      return encode_wide4(tree);
    case CodecId::kPlainF32:
    case CodecId::kPlainF16:
      return encode_plain(tree, mesh, plain_cut_of(codec), order);
    case CodecId::kPackedF32:
    case CodecId::kPackedF16:
    case CodecId::kPackedF64:
    case CodecId::kDedup:
      break;
  }
  return pack_nodes(encode_plain(tree, mesh, plain_cut_of(codec), order), codec, widths);
}

}  // namespace

EncodedNodes encode_nodes(const BuildTree& tree, const SourceMesh& mesh, CodecId codec,
                          FaceOrder order, FieldWidths widths) {
  EncodedNodes nodes = encode_with(tree, mesh, codec, order, widths);
  nodes.codec = codec;
  return nodes;
}

}  // namespace boxtree::cooker
