// SPDX-License-Identifier: MIT
// From a codec's number to its functions.
#include <array>
#include <atomic>
#include <string>
#include <string_view>

#include "format/message.h"
#include "runtime/tree/bound_codec.h"

namespace boxtree {
namespace {

#if BOXTREE_HAS_WIDE8
constexpr CodecFunctions kWide8Functions = functions_of<WideCodec<Wide8Node>>(CodecId::kWide8);
#endif
#if BOXTREE_HAS_WIDE4
constexpr CodecFunctions kWide4Functions = functions_of<WideCodec<Wide4Node>>(CodecId::kWide4);
#endif
constexpr std::array<const CodecFunctions*, BOXTREE_HAS_WIDE8 + BOXTREE_HAS_WIDE4> kOwnCodecs = {
#if BOXTREE_HAS_WIDE8
    &kWide8Functions,
#endif
#if BOXTREE_HAS_WIDE4
    &kWide4Functions,
#endif
};

// Those of boxtree::paper, once it is used.
constinit std::atomic<const CodecSet*> added = nullptr;

const CodecFunctions* find_in(CodecSet codecs, CodecId id) noexcept {
  for (const CodecFunctions* codec : codecs) {
    if (codec->id == id) return codec;
  }
  return nullptr;
}

}  // namespace

const CodecFunctions kNoCodec = {
    CodecId{},
    2,
    [](const TreeRecord&, Bytes) -> Result<BoundCodec> { return Errc::kInternal; },
    [](const BoundCodec&, const TreeRecord&) noexcept { return NodeRef{0, 0}; },
    [](const BoundCodec&, NodeRef, const Box<double>&, AnyChildren&) noexcept { return false; },
    nullptr};

void add_codecs(const CodecSet& codecs) noexcept {
  added.store(&codecs, std::memory_order_release);
}

Result<const CodecFunctions*> find_codec_functions(CodecId id) {
  if (const CodecFunctions* own = find_in(kOwnCodecs, id)) return own;
  if (const CodecSet* codecs = added.load(std::memory_order_acquire)) {
    if (const CodecFunctions* found = find_in(*codecs, id)) return found;
  }
  const std::string name(codec_name(id));
  constexpr std::string_view kBuilt = " " BOXTREE_CODEC_NAMES " ";
  const bool is_built = kBuilt.find(" " + name + " ") != std::string_view::npos;
  return error_with(Errc::kCodecUnsupported, "codec " + name,
                    is_built ? " is one of boxtree::paper: link it and call use_paper_codecs()"
                             : " was left out of this build, which has " BOXTREE_CODEC_NAMES);
}

}  // namespace boxtree
