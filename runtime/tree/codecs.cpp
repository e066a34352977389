// SPDX-License-Identifier: MIT
// From a codec's number to its type.
#include "runtime/tree/codecs.h"

#include <string>

#include "format/message.h"

namespace boxtree {
namespace {

template <Codec C>
Result<AnyCodec> bind_as(const TreeRecord& record, Bytes nodes) {
  Result<C> codec = C::bind(record, nodes);
  if (!codec) return codec.error();
  return AnyCodec(*codec);
}

template <CodecId... Ids>
Result<AnyCodec> bind_one_of(CodecList<Ids...>, const TreeRecord& record, Bytes nodes) {
  using Bind = Result<AnyCodec> (*)(const TreeRecord&, Bytes);
  Bind bind = nullptr;
  ((record.codec == Ids ? void(bind = bind_as<typename CodecOf<Ids>::type>) : void()), ...);
  if (bind != nullptr) return bind(record, nodes);
  const std::string name = "codec " + std::string(codec_name(record.codec));
  return error_with(Errc::kCodecUnsupported, name,
                    " was left out of this build, which has " BOXTREE_CODEC_NAMES);
}

}  // namespace

Result<AnyCodec> bind_codec(const TreeRecord& record, Bytes nodes) {
  return bind_one_of(BuiltCodecs(), record, nodes);
}

}  // namespace boxtree
