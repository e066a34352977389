// SPDX-License-Identifier: MIT
#include "cooker/encode/strip.h"

#include <algorithm>
#include <bit>
#include <cstddef>

#include "format/cluster_leaf.h"

namespace boxtree::cooker {
namespace {

constexpr std::uint8_t kNoTurn = 3;

// The edge of `to` that is edge `edge` of `from`, reversed; kNoTurn if there is none.
std::uint8_t turn_over(const ClusterFace& from, std::uint32_t edge, const ClusterFace& to) {
  const std::uint16_t begin = from.corner[(edge + 1) % 3], end = from.corner[edge];
  for (std::uint8_t turn = 0; turn < 3; ++turn) {
    if (to.corner[turn] == begin && to.corner[(turn + 1u) % 3] == end) return turn;
  }
  return kNoTurn;
}

// Orders the faces of a leaf so that many share an edge with the previous one: from each face,
// walks over shared edges to the neighbour with the fewest others left, and keeps the best walk.
class StripOrder {
 public:
  explicit StripOrder(std::span<ClusterFace> faces) : faces_(faces), count_(faces.size()) {
    // Edges from corner to corner as one number. Those of faces that are not there match nothing.
    std::array<std::uint32_t, kEdges> edge;
    edge.fill(kNoEdge);
    for (std::size_t f = 0; f < count_; ++f) {
      for (std::size_t e = 0; e < 3; ++e) {
        edge[e * kLeafFaces + f] = number_of(faces[f].corner[e], faces[f].corner[(e + 1) % 3]);
      }
    }
    for (std::size_t f = 0; f < count_; ++f) {
      for (std::size_t e = 0; e < 3; ++e) {
        const std::uint32_t sought = number_of(faces[f].corner[(e + 1) % 3], faces[f].corner[e]);
        std::uint32_t found = 0;
        for (std::size_t i = 0; i < kEdges; ++i) {
          // A mask: for a choice, compilers load the bit only after a branch.
          found |= kBit[i] & (0u - (edge[i] == sought ? 1u : 0u));
        }
        found &= ~(kFirstOfTurns << f);
        found_[f][e] = found;
        across_[f][e] = (found | found >> kLeafFaces | found >> (2 * kLeafFaces)) & kAllFaces;
      }
      near_[f] = across_[f][0] | across_[f][1] | across_[f][2];
    }
  }

  void apply() {
    // No walk has fewer faces apart than there are sets of faces that share no edge.
    const std::uint32_t fewest_apart = components();
    Walk best;
    for (std::size_t start = 0; start < count_; ++start) {
      Walk walk;
      if (!walk_from(start, best.apart, walk)) continue;
      best = walk;
      if (best.apart == fewest_apart) break;
    }
    std::array<ClusterFace, kLeafFaces> ordered;
    for (std::size_t i = 0; i < count_; ++i) ordered[i] = faces_[best.face[i]];
    std::copy_n(ordered.begin(), count_, faces_.begin());
  }

 private:
  static constexpr std::size_t kEdges = std::size_t{3} * kLeafFaces;
  static constexpr std::uint32_t kAllFaces = (1u << kLeafFaces) - 1;
  static constexpr std::uint32_t kFirstOfTurns = 1u | 1u << kLeafFaces | 1u << (2 * kLeafFaces);
  static constexpr std::uint32_t kNoEdge = 0xfffffffeu;  // vertices of a cluster are fewer

  static std::uint32_t number_of(std::uint32_t from, std::uint32_t to) { return from << 16 | to; }

  // In memory, so that compilers compare several edges at once.
  static constexpr auto kBit = [] {
    std::array<std::uint32_t, kEdges> bits{};
    for (std::size_t i = 0; i < kEdges; ++i) bits[i] = 1u << i;
    return bits;
  }();

  struct Walk {
    std::array<std::size_t, kLeafFaces> face{};
    std::uint32_t apart = kLeafFaces + 1;  // faces that share no edge with the one before
  };

  [[nodiscard]] std::uint32_t components() const {
    std::uint32_t count = 0;
    for (std::uint32_t left = all(); left != 0; ++count) {
      std::uint32_t border = left & (~left + 1);
      while (border != 0) {
        left &= ~(border & (~border + 1));
        border = (border | near_[std::countr_zero(border)]) & left;
      }
    }
    return count;
  }
  [[nodiscard]] std::uint32_t all() const { return (1u << count_) - 1; }

  // Returns false as soon as no fewer faces than `limit` are apart.
  [[nodiscard]] bool walk_from(std::size_t at, std::uint32_t limit, Walk& walk) const {
    walk.apart = 1;
    std::uint32_t left = all();
    std::uint32_t entered = 0;
    for (std::size_t length = 0; walk.apart < limit; ++length) {
      walk.face[length] = at;
      left &= ~(1u << at);
      if (left == 0) return true;
      const std::uint32_t first = (entered + 1) % 3, second = (entered + 2) % 3;
      const std::uint32_t near = (across_[at][first] | across_[at][second]) & left;
      const std::size_t next = loneliest(near != 0 ? near : left, left);
      entered = 0;
      if (near != 0) {
        const bool is_first = ((across_[at][first] >> next) & 1u) != 0;
        const std::uint32_t found = found_[at][is_first ? first : second];
        // The first turn, as step_between finds it.
        entered = static_cast<std::uint32_t>(std::countr_zero((found >> next) & kFirstOfTurns)) /
                  kLeafFaces;
      } else {
        ++walk.apart;
      }
      at = next;
    }
    return false;
  }

  // Of some faces, the one with the fewest neighbours left. Precondition: there is one.
  [[nodiscard]] std::size_t loneliest(std::uint32_t faces, std::uint32_t left) const {
    std::size_t best = 0;
    std::uint64_t fewest = kLeafFaces + 1;
    for (; faces != 0; faces &= faces - 1) {
      const auto face = static_cast<std::size_t>(std::countr_zero(faces));
      // Not std::popcount, which is a call where the instruction set has none.
      const std::uint64_t others = kRanksOfBits[near_[face] & left] >> 56;
      if (others < fewest) {
        fewest = others;
        best = face;
      }
    }
    return best;
  }

  std::span<ClusterFace> faces_;
  std::size_t count_;
  // Bit turn * kLeafFaces + j: face j can follow face i over its edge, entered by the turn.
  std::uint32_t found_[kLeafFaces][3];
  std::uint32_t across_[kLeafFaces][3];  // bit j: by any of its edges
  std::uint32_t near_[kLeafFaces];       // over any edge
};

}  // namespace

Step step_between(const ClusterFace& from, std::uint32_t entered, const ClusterFace& to) {
  for (std::uint32_t side = 0; side < 2; ++side) {
    const std::uint8_t turn = turn_over(from, (entered + 1 + side) % 3, to);
    if (turn != kNoTurn) return {StripStep::code(side, turn), turn};
  }
  return {};
}

void order_as_strip(std::span<ClusterFace> faces) {
  StripOrder(faces).apply();
}

}  // namespace boxtree::cooker
