// SPDX-License-Identifier: MIT
// From a codec's number to its functions.
#include <array>
#include <atomic>

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

// The codecs of boxtree::paper, once it is used.
constinit std::atomic<const CodecSet*> added = nullptr;

const CodecFunctions* find_in(CodecSet codecs, CodecId id) noexcept {
  for (const CodecFunctions* codec : codecs) {
    if (codec->id == id) return codec;
  }
  return nullptr;
}

static_assert(kCodecs.size() == 8, "is_built() says of each whether it is");
constexpr bool is_built(CodecId id) noexcept {
  constexpr std::uint32_t kBuilt =
      BOXTREE_HAS_PLAIN_F32 << static_cast<unsigned>(CodecId::kPlainF32) |
      BOXTREE_HAS_PLAIN_F16 << static_cast<unsigned>(CodecId::kPlainF16) |
      BOXTREE_HAS_PACKED_F32 << static_cast<unsigned>(CodecId::kPackedF32) |
      BOXTREE_HAS_PACKED_F16 << static_cast<unsigned>(CodecId::kPackedF16) |
      BOXTREE_HAS_PACKED_F64 << static_cast<unsigned>(CodecId::kPackedF64) |
      BOXTREE_HAS_DEDUP << static_cast<unsigned>(CodecId::kDedup);
  const auto bit = static_cast<unsigned>(id);
  return bit < 32 && ((kBuilt >> bit) & 1u) != 0;
}

}  // namespace

const CodecFunctions kNoCodec = {
    CodecId{},
    2,
    [](const TreeCounts&, Bytes, BoundCodec&) -> Status { return Errc::kInternal; },
    [](const BoundCodec&) noexcept {
      return NodeRef{0, 0};
    },
    [](const BoundCodec&, NodeRef, const Box<double>&, AnyChildren&) noexcept {
      return NodeState::kCorrupt;
    },
    nullptr};

void add_codecs(const CodecSet& codecs) noexcept {
  added.store(&codecs, std::memory_order_release);
}

Status bind_codec(CodecId id, const TreeCounts& counts, Bytes nodes,
                  const CodecFunctions*& functions, BoundCodec& codec) {
  const CodecFunctions* found = find_in(kOwnCodecs, id);
  const CodecSet* others = added.load(std::memory_order_acquire);
  if (found == nullptr && others != nullptr) found = find_in(*others, id);
  if (found == nullptr) {
    return error_with(Errc::kCodecUnsupported, codec_name(id),
                      is_built(id)
                          ? " is a codec of boxtree::paper: link it and call use_paper_codecs()"
                          : " was left out of this build, which has " BOXTREE_CODEC_NAMES
                            "; BOXTREE_CODECS of CMake chooses");
  }
  functions = found;
  return found->bind(counts, nodes, codec);
}

}  // namespace boxtree
