// SPDX-License-Identifier: MIT
// Bits of edges solve a system of linear equations over GF(2), one for each edge, whose
// coefficients lie within 64 bits: Gauss's elimination in the order of the hashes keeps them there.
#include "cooker/encode/active_edges.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "format/active_edges.h"
#include "runtime/primitive/normal.h"
#include "runtime/tree/active_edges.h"
#include "runtime/tree/bound_tree.h"

namespace boxtree::cooker {
namespace {

// The edges of one triangle that has an area, as a reader finds them.
struct TriangleEdges {
  Triangle triangle;  // tree space
  std::uint32_t active = 0;
};

struct Leaf {
  std::array<TriangleEdges, 2 * kLeafFaces> triangle;
  std::uint32_t count = 0;

  [[nodiscard]] LeafEdges code() const {
    const auto all_are = [&](std::uint32_t edges) {
      return std::all_of(triangle.begin(), triangle.begin() + count,
                         [&](const TriangleEdges& each) { return each.active == edges; });
    };
    if (all_are(0)) return LeafEdges::kNone;
    return all_are(kAllEdges) ? LeafEdges::kAll : LeafEdges::kMixed;
  }
};

// The bits of the triangles of a face: edges of a quad are 0 and 1 of its first half and 1 and 2 of
// its second; its diagonal is flat.
std::uint32_t edges_of_half(std::uint32_t of_face, std::uint32_t half, bool is_quad) {
  if (!is_quad) return of_face & 7u;
  return half == 0 ? of_face & 3u : of_face >> 2 << 1 & 6u;
}

// An edge whose bit has to be `value`.
struct Equation {
  std::uint64_t hash;
  bool value;
};

// The bits such that every edge has its own; nothing if there are none. Precondition: ascending by
// hash, which are different.
std::optional<std::vector<std::uint64_t>> solve(std::span<const Equation> equations,
                                                std::uint32_t start_count) {
  const std::size_t slots = std::size_t{start_count} + kEdgeBits - 1;
  std::vector<std::uint64_t> row(slots, 0);  // of the equation whose first coefficient is there
  std::vector<bool> value(slots, false);
  for (const Equation& equation : equations) {
    auto [start, selected] = EdgeBits::of(equation.hash, start_count);
    std::size_t at = start;
    bool wanted = equation.value;
    for (;;) {
      if (row[at] == 0) {
        row[at] = selected;
        value[at] = wanted;
        break;
      }
      selected ^= row[at];
      wanted ^= value[at];
      if (selected == 0) {
        if (wanted) return std::nullopt;
        break;  // it follows from others
      }
      const int zeros = std::countr_zero(selected);
      at += static_cast<std::size_t>(zeros);
      selected >>= zeros;
    }
  }
  std::vector<std::uint64_t> bits(slots / 64 + 2, 0);
  std::uint64_t after = 0;  // bits from slot + 1 on
  for (std::size_t slot = slots; slot-- > 0;) {
    std::uint64_t here = after << 1;
    if (row[slot] != 0) {
      const bool others = std::popcount(row[slot] & here) % 2 != 0;
      here |= others != value[slot] ? 1u : 0u;
    }
    if ((here & 1u) != 0) bits[slot / 64] |= std::uint64_t{1} << (slot % 64);
    after = here;
  }
  return bits;
}

class Encoder {
 public:
  Encoder(const Tree& tree, std::span<const std::uint32_t> order, const ActiveEdges& edges)
      : tree_(BoundTree::of(tree)), order_(order), edges_(edges) {}

  Result<std::vector<std::byte>> run() {
    header_.degrees = static_cast<float>(edges_.degrees);
    header_.is_by_face = edges_.is_by_face ? 1 : 0;
    codes_.resize(leaf_edges_bytes(tree_.face_count()));
    for (std::uint32_t leaf = 0; std::uint64_t{leaf} * kLeafFaces < tree_.face_count(); ++leaf) {
      if (const Errc error = read(leaf); error != Errc::kOk) return error;
      const LeafEdges code = leaf_.code();
      codes_[leaf / 4] |=
          static_cast<std::byte>(static_cast<std::uint32_t>(code) << leaf % 4 * kLeafEdgesBits);
      if (code == LeafEdges::kMixed) mixed_.push_back(leaf);
    }
    std::vector<std::uint64_t> bits;
    while (!mixed_.empty()) {
      const Result<std::vector<Equation>> equations = collect();
      if (!equations) return equations.error();
      // More room with each seed, so that one will do.
      const std::size_t count = equations->size();
      const std::size_t spare =
          (count >> 8) * (static_cast<std::size_t>(std::bit_width(count)) + 2 * header_.seed) +
          std::size_t{32} * header_.seed;
      header_.start_count = static_cast<std::uint32_t>(count + spare + 1);
      if (auto solved = solve(*equations, header_.start_count)) {
        bits = std::move(*solved);
        break;
      }
      ++header_.seed;
    }
    return written(bits);
  }

 private:
  Errc read(std::uint32_t leaf) {
    leaf_.count = 0;
    const std::uint32_t first = leaf * kLeafFaces;
    const std::uint32_t last = first + std::min(kLeafFaces, tree_.face_count() - first);
    for (std::uint32_t face = first; face < last; ++face) {
      TriangleBatch batch;
      const Errc error = tree_.leaves().read(face, 1, batch);
      if (error != Errc::kOk) return error;
      for (std::uint32_t half = 0; half < batch.count; ++half) {
        const Triangle triangle = batch.triangle(half);
        if (unit_normal(triangle).isZero(0)) continue;
        leaf_.triangle[leaf_.count++] = {
            triangle, edges_of_half(edges_.of_face[order_[face]], half, batch.count == 2)};
      }
    }
    return Errc::kOk;
  }

  // One equation for each edge of mixed leaves.
  Result<std::vector<Equation>> collect() {
    std::vector<Equation> equations;
    for (const std::uint32_t leaf : mixed_) {
      if (const Errc error = read(leaf); error != Errc::kOk) return error;
      for (std::uint32_t t = 0; t < leaf_.count; ++t) {
        const TriangleEdges& each = leaf_.triangle[t];
        for (std::uint32_t i = 0; i < 3; ++i) {
          equations.push_back(
              {hash_of_edge(each.triangle, i, header_), (each.active >> i & 1u) != 0});
        }
      }
    }
    std::sort(equations.begin(), equations.end(), [](const Equation& a, const Equation& b) {
      return a.hash != b.hash ? a.hash < b.hash : a.value > b.value;
    });
    // Of equal ones the first stays, which is active if one is.
    equations.erase(
        std::unique(equations.begin(), equations.end(),
                    [](const Equation& a, const Equation& b) { return a.hash == b.hash; }),
        equations.end());
    constexpr std::size_t kMost = std::size_t{1} << 31;
    if (equations.size() > kMost) {
      return Error{Errc::kMeshTooLarge,
                   fmt::format("active edges: {} edges, limit {}", equations.size(), kMost)};
    }
    return equations;
  }

  [[nodiscard]] std::vector<std::byte> written(const std::vector<std::uint64_t>& bits) const {
    std::vector<std::byte> out(active_edges_bytes(tree_.face_count(), header_.start_count));
    std::memcpy(out.data(), &header_, sizeof(header_));
    std::copy(codes_.begin(), codes_.end(), out.begin() + sizeof(header_));
    if (header_.start_count == 0) return out;
    const std::size_t at = sizeof(header_) + codes_.size();
    const std::size_t used = (std::size_t{header_.start_count} + kEdgeBits - 1 + 7) / 8;
    for (std::size_t i = 0; i < used; ++i) {
      out[at + i] = static_cast<std::byte>(bits[i / 8] >> (i % 8 * 8) & 0xffu);
    }
    return out;
  }

  const BoundTree& tree_;
  std::span<const std::uint32_t> order_;
  const ActiveEdges& edges_;
  ActiveEdgesHeader header_{};
  std::vector<std::byte> codes_;
  std::vector<std::uint32_t> mixed_;
  Leaf leaf_;
};

}  // namespace

Result<std::vector<std::byte>> encode_active_edges(const Tree& tree,
                                                   std::span<const std::uint32_t> order,
                                                   const ActiveEdges& edges) {
  return Encoder(tree, order, edges).run();
}

}  // namespace boxtree::cooker
