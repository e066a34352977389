// SPDX-License-Identifier: MIT
#include "cooker/tile/tile_cells.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

namespace boxtree::cooker {
namespace {

constexpr int kLeastExponent = -126;  // of normal floats

// The child of a cell of `level` that a path goes to: bit k is that of axis k.
std::uint32_t child_at(const TilePath& path, int level) {
  const int shift = kTileLevels - level;
  return (path[0] >> shift & 1) | (path[1] >> shift & 1) << 1 | (path[2] >> shift & 1) << 2;
}

}  // namespace

std::string TileCell::name() const {
  return fmt::format("e{}_{}_{}_{}", exponent, index[0], index[1], index[2]);
}

int tile_exponent(float largest) {
  int exponent = 0;
  static_cast<void>(std::frexp(largest, &exponent));  // largest < 2^exponent
  return std::max(exponent, kLeastExponent);
}

TilePath tile_path(std::span<const WorldCorner> corners, int exponent) {
  TilePath path{};
  for (std::size_t k = 0; k < 3; ++k) {
    float low = corners[0][k], high = low;
    for (const WorldCorner& corner : corners.subspan(1)) {
      low = std::min(low, corner[k]);
      high = std::max(high, corner[k]);
    }
    const double twice = double{low} + double{high};
    // Below 2^kTileLevels in magnitude: the path begins with the half.
    const double cell = std::floor(std::ldexp(twice, kTileLevels - exponent - 1));
    path[k] = static_cast<std::uint32_t>(static_cast<std::int32_t>(cell) + (1 << kTileLevels));
  }
  return path;
}

TileTree::TileTree(int exponent, std::uint64_t triangles_per_tile)
    : exponent_(exponent), most_(triangles_per_tile) {
  for (std::uint32_t i = 0; i < 8; ++i) {
    Node root;
    root.cell.exponent = exponent;
    for (std::uint32_t k = 0; k < 3; ++k) root.cell.index[k] = (i >> k & 1) != 0 ? 0 : -1;
    root.open = i;
    nodes_.push_back(root);
    open_.push_back(i);
  }
}

std::uint64_t TileTree::round_bytes() const {
  return std::uint64_t{open_.size()} << (3 * kLevelsOfRound) << 4;
}

void TileTree::begin_round() {
  static_assert(sizeof(TileCounts) == 1 << 4);
  counts_.assign(open_.size() << (3 * kLevelsOfRound), {});
}

std::uint32_t TileTree::leaf_of(const TilePath& path) const {
  std::uint32_t node = child_at(path, 0);
  for (int level = 1; nodes_[node].children != kNone; ++level) {
    node = nodes_[node].children + child_at(path, level);
  }
  return node;
}

void TileTree::count(const TilePath& path, std::uint64_t triangles) {
  const Node& leaf = nodes_[leaf_of(path)];
  if (leaf.open == kNone) return;
  // Octants below the leaf, the first in the highest bits. Below the last level there are none.
  std::size_t place = 0;
  for (int i = 1; i <= kLevelsOfRound; ++i) {
    const int level = leaf.level + i;
    place = place << 3 | (level <= kTileLevels ? child_at(path, level) : 0);
  }
  counts_[(std::size_t{leaf.open} << (3 * kLevelsOfRound)) + place] += {1, triangles};
}

void TileTree::end_round() {
  const std::vector<std::uint32_t> counted = std::move(open_);
  open_.clear();
  const std::size_t stride = std::size_t{1} << (3 * kLevelsOfRound);
  for (std::size_t i = 0; i < counted.size(); ++i) {
    nodes_[counted[i]].open = kNone;
    grow(counted[i], std::span(counts_).subspan(i * stride, stride));
  }
  counts_ = {};
  if (is_open()) return;
  for (std::uint32_t root = 0; root < 8; ++root) number_tiles(root);
}

// `counts` of the parts of the node, eight times as many for each level that is known.
void TileTree::grow(std::uint32_t node, std::span<const TileCounts> counts) {
  TileCounts sum;
  for (const TileCounts& part : counts) sum += part;
  nodes_[node].counts = sum;
  if (sum.triangles <= most_ || nodes_[node].level == kTileLevels) return;
  if (counts.size() == 1) {
    nodes_[node].open = static_cast<std::uint32_t>(open_.size());
    open_.push_back(node);
    return;
  }
  const auto children = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node].children = children;
  for (std::uint32_t i = 0; i < 8; ++i) {
    Node child;
    child.level = nodes_[node].level + 1;
    child.cell.exponent = nodes_[node].cell.exponent - 1;
    for (std::uint32_t k = 0; k < 3; ++k) {
      child.cell.index[k] = 2 * nodes_[node].cell.index[k] + static_cast<std::int32_t>(i >> k & 1);
    }
    nodes_.push_back(child);
  }
  const std::size_t part = counts.size() / 8;
  for (std::uint32_t i = 0; i < 8; ++i) grow(children + i, counts.subspan(i * part, part));
}

void TileTree::number_tiles(std::uint32_t node) {
  if (nodes_[node].children != kNone) {
    for (std::uint32_t i = 0; i < 8; ++i) number_tiles(nodes_[node].children + i);
    return;
  }
  if (nodes_[node].counts.faces == 0) return;
  nodes_[node].tile = static_cast<std::uint32_t>(tiles_.size());
  tiles_.push_back({nodes_[node].cell, nodes_[node].counts});
}

std::optional<std::uint32_t> TileTree::tile_of(const TilePath& path) const {
  const std::uint32_t tile = nodes_[leaf_of(path)].tile;
  if (tile == kNone) return std::nullopt;
  return tile;
}

}  // namespace boxtree::cooker
