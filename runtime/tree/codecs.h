// SPDX-License-Identifier: MIT
// All codecs as one type: what a bound tree holds.
#pragma once

#include <concepts>
#include <variant>

#include <boxtree/format/codec_packed.h>
#include <boxtree/format/codec_plain.h>
#include <boxtree/format/codec_wide.h>
#include <boxtree/format/tree_record.h>

namespace boxtree {

/// What a tree and its queries ask of a codec. `bind` checks what can be checked without reading
/// nodes; `expand` is the one question of a traversal. Whatever the bytes, neither reads outside
/// the section given to `bind`.
template <class C>
concept Codec = requires(const C& codec, const TreeRecord& record, Bytes section, NodeRef ref,
                         const Box<typename C::Scalar>& box, typename C::Children& out) {
  { C::bind(record, section) } -> std::same_as<Result<C>>;
  { codec.root(record) }
  noexcept->std::same_as<NodeRef>;
  { codec.expand(ref, box, out) }
  noexcept->std::same_as<bool>;
};

/// One alternative a codec; a codec is added by its name here and in bind_codec().
using AnyCodec =
    std::variant<PlainCodec<float>, PlainCodec<std::uint16_t>, PackedCodec<PackedCut::kF32>,
                 PackedCodec<PackedCut::kF16>, PackedCodec<PackedCut::kF64>,
                 PackedCodec<PackedCut::kTable>, WideCodec<Wide8Node>, WideCodec<Wide4Node>>;

/// The codec of `record` over the bytes of its nodes section. Errors: kCodecUnsupported and those
/// of the codec's own bind.
Result<AnyCodec> bind_codec(const TreeRecord& record, Bytes nodes);

}  // namespace boxtree
