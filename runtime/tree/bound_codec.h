// SPDX-License-Identifier: MIT
// The nodes of a tree in any codec, behind one type. Which codecs exist is known when a tree is
// bound, not when the runtime is compiled: the wide ones are built in, those of the paper come from
// boxtree::paper.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <type_traits>

#include <boxtree/configuration.h>

#include "format/bytes.h"
#include "format/children.h"
#include "format/codec.h"
#include "format/codec_wide.h"

namespace boxtree {

struct CodecWalks;

/// Whether trees of a wide codec can be bound.
inline constexpr bool kHasWideCodecs = BOXTREE_HAS_WIDE8 || BOXTREE_HAS_WIDE4;

/// Whether the wide codecs have walks by vectors; otherwise they use the generic ones.
inline constexpr bool kWalksByVectors = BOXTREE_WALKS_BY_VECTORS;
/// The same for trees of the wide codecs, where the build has them.
inline constexpr bool kWalksTreesByVectors = kHasWideCodecs && kWalksByVectors;

/// What a walk needs: decodes one node after the other. Whatever the bytes, it reads nothing
/// outside of the nodes that it was made for.
template <class D>
concept NodeDecoder = requires(const D& decoder, NodeRef ref, const Box<typename D::Scalar>& box,
                               typename D::Children& out) {
  { D::kDepthLimit } -> std::convertible_to<std::uint32_t>;
  { decoder.expand(ref, box, out) }
  noexcept->std::same_as<NodeState>;
};

/// What a tree needs of a codec in addition. `bind` checks what can be checked without reading
/// nodes.
template <class C>
concept Codec = NodeDecoder<C> &&
    requires(const C& codec, const TreeCounts& counts, Bytes section) {
  { C::bind(counts, section) } -> std::same_as<Result<C>>;
  { codec.root() }
  noexcept->std::same_as<NodeRef>;
};

/// Some codec over the nodes of one tree, or none. Cheap to copy.
class BoundCodec {
 public:
  BoundCodec() noexcept = default;
  template <Codec C>
  explicit BoundCodec(const C& codec) noexcept {
    static_assert(std::is_trivially_copyable_v<C> && std::is_trivially_destructible_v<C>);
    static_assert(sizeof(C) <= kBytes && alignof(C) <= kAlignment);
    std::construct_at(reinterpret_cast<C*>(storage_), codec);
  }

  /// Precondition: made of a C.
  template <Codec C>
  [[nodiscard]] const C& as() const noexcept {
    return *std::launder(reinterpret_cast<const C*>(storage_));
  }

 private:
  static constexpr std::size_t kBytes = 112;  // of the largest, PackedCodec
  static constexpr std::size_t kAlignment = 8;
  alignas(kAlignment) std::byte storage_[kBytes] = {};
};

/// Children of a node of any codec. Boxes of f32 codecs convert to double and back unchanged.
using AnyChildren = ChildSet<kWideChildren, double>;

/// The functions of a codec whose type the caller does not know.
struct CodecFunctions {
  CodecId id;
  std::uint32_t width;  // children that a node has at most
  Status (*bind)(const TreeCounts& counts, Bytes nodes, BoundCodec& out);
  NodeRef (*root)(const BoundCodec& codec) noexcept;
  NodeState (*expand)(const BoundCodec& codec, NodeRef ref, const Box<double>& box,
                      AnyChildren& out) noexcept;
  /// Walks compiled for it (runtime/walk/codec_walks.h); null: it is walked by expand(), or by
  /// vectors.
  const CodecWalks* walks;
};

/// The functions of codec C.
template <Codec C>
[[nodiscard]] constexpr CodecFunctions functions_of(CodecId id,
                                                    const CodecWalks* walks = nullptr) noexcept {
  return {
      id,
      C::Children::kWidth,
      [](const TreeCounts& counts, Bytes nodes, BoundCodec& out) -> Status {
        const Result<C> codec = C::bind(counts, nodes);
        if (!codec) return codec.error();
        out = BoundCodec(*codec);
        return {};
      },
      [](const BoundCodec& codec) noexcept { return codec.as<C>().root(); },
      [](const BoundCodec& codec, NodeRef ref, const Box<double>& box, AnyChildren& out) noexcept {
        typename C::Children children;
        const NodeState state =
            codec.as<C>().expand(ref, box_cast<typename C::Scalar>(box), children);
        if (state != NodeState::kValid) return state;
        out.count = children.count;
        out.leaf_mask = children.leaf_mask;
        for (std::uint32_t i = 0; i < children.count; ++i) {
          for (std::size_t k = 0; k < 3; ++k) {
            out.low[k][i] = children.low[k][i];
            out.high[k][i] = children.high[k][i];
          }
          out.ref[i] = children.ref[i];
        }
        return state;
      },
      walks};
}

/// The functions of a tree that has no nodes: its expand() finds every reference corrupt.
extern const CodecFunctions kNoCodec;

using CodecSet = std::span<const CodecFunctions* const>;

/// From now on trees of these codecs can be bound, in place of any added before. The set and all it
/// points to must never be destroyed. Thread-safe.
void add_codecs(const CodecSet& codecs) noexcept;
void add_codecs(CodecSet&&) = delete;  // the set must never be destroyed

/// Binds the nodes of a tree in a codec. Errors: those of the codec's bind; kCodecUnsupported, with
/// the remedy, when it was left out of this build or is in a library that the program does not use.
Status bind_codec(CodecId id, const TreeCounts& counts, Bytes nodes,
                  const CodecFunctions*& functions, BoundCodec& codec);

}  // namespace boxtree
