// SPDX-License-Identifier: MIT
// All codecs as one type: what a bound tree holds.
#pragma once

#include <concepts>
#include <cstdint>
#include <string_view>
#include <type_traits>
#include <variant>

#include <boxtree/configuration.h>

#include "format/codec_packed.h"
#include "format/codec_plain.h"
#include "format/codec_wide.h"
#include "format/tree_record.h"

namespace boxtree {

template <CodecId... Ids>
struct CodecList {};

/// The codecs whose trees can be bound.
using BuiltCodecs = CodecList<BOXTREE_CODEC_IDS>;

/// Whether the wide codecs have walks of their own, by vectors; otherwise those of every codec.
inline constexpr bool kWalksByVectors = BOXTREE_WALKS_BY_VECTORS;

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

/// The type of each codec; a codec is added by a line here.
template <CodecId Id>
struct CodecOf;
template <>
struct CodecOf<CodecId::kPlainF32> : std::type_identity<PlainCodec<float>> {};
template <>
struct CodecOf<CodecId::kPlainF16> : std::type_identity<PlainCodec<std::uint16_t>> {};
template <>
struct CodecOf<CodecId::kPackedF32> : std::type_identity<PackedCodec<PackedCut::kF32>> {};
template <>
struct CodecOf<CodecId::kPackedF16> : std::type_identity<PackedCodec<PackedCut::kF16>> {};
template <>
struct CodecOf<CodecId::kPackedF64> : std::type_identity<PackedCodec<PackedCut::kF64>> {};
template <>
struct CodecOf<CodecId::kDedup> : std::type_identity<PackedCodec<PackedCut::kTable>> {};
template <>
struct CodecOf<CodecId::kWide8> : std::type_identity<WideCodec<Wide8Node>> {};
template <>
struct CodecOf<CodecId::kWide4> : std::type_identity<WideCodec<Wide4Node>> {};

template <class List>
struct VariantOf;
template <CodecId... Ids>
struct VariantOf<CodecList<Ids...>>
    : std::type_identity<std::variant<typename CodecOf<Ids>::type...>> {};

/// One alternative a codec that this build has.
using AnyCodec = VariantOf<BuiltCodecs>::type;

/// The codec of `record` over the bytes of its nodes section. Errors: kCodecUnsupported, also when
/// the codec was left out of this build, and those of the codec's own bind.
Result<AnyCodec> bind_codec(const TreeRecord& record, Bytes nodes);

}  // namespace boxtree
