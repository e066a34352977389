// SPDX-License-Identifier: MIT
// From a codec's number to its type.
#include <boxtree/runtime/tree/codecs.h>

namespace boxtree {
namespace {

template <Codec C>
Result<AnyCodec> bind_as(const TreeRecord& record, Bytes nodes) {
  Result<C> codec = C::bind(record, nodes);
  if (!codec) return codec.error();
  return AnyCodec(*codec);
}

}  // namespace

Result<AnyCodec> bind_codec(const TreeRecord& record, Bytes nodes) {
  switch (record.codec) {
    case CodecId::kPlainF32:
      return bind_as<PlainCodec<float>>(record, nodes);
    case CodecId::kPlainF16:
      return bind_as<PlainCodec<std::uint16_t>>(record, nodes);
    case CodecId::kPackedF32:
      return bind_as<PackedCodec<PackedCut::kF32>>(record, nodes);
    case CodecId::kPackedF16:
      return bind_as<PackedCodec<PackedCut::kF16>>(record, nodes);
    case CodecId::kPackedF64:
      return bind_as<PackedCodec<PackedCut::kF64>>(record, nodes);
    case CodecId::kDedup:
      return bind_as<PackedCodec<PackedCut::kTable>>(record, nodes);
    case CodecId::kWide8:
      return bind_as<WideCodec<Wide8Node>>(record, nodes);
    case CodecId::kWide4:
      return bind_as<WideCodec<Wide4Node>>(record, nodes);
  }
  return Errc::kCodecUnsupported;
}

}  // namespace boxtree
