// SPDX-License-Identifier: MIT
// The cells that a world is cut into: an octree whose cells are aligned to absolute coordinates, so
// that borders depend on what is in the world alone.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cooker/tile/world_faces.h"

namespace boxtree::cooker {

/// Halvings below the largest cells: what lies in a cell of the last is not told apart.
inline constexpr int kTileLevels = 20;

/// A cube: on each axis from index * 2^exponent to (index + 1) * 2^exponent, the end excluded.
struct TileCell {
  int exponent = 0;
  std::array<std::int32_t, 3> index{};

  bool operator==(const TileCell&) const = default;
  /// "e7_-1_0_12": what its files are called.
  [[nodiscard]] std::string name() const;
};

/// Where a face belongs, as paths to the last level: on each axis kTileLevels + 1 bits, from the
/// half of the world to the last halving.
using TilePath = std::array<std::uint32_t, 3>;

/// The least exponent e for which all coordinates are below 2^e in magnitude, at least -126.
/// Precondition: finite, at least 0.
[[nodiscard]] int tile_exponent(float largest);

/// The path of the center of the face's box, in cells of the world with that exponent. Twice the
/// center is the sum of two floats in double precision, which rounds alike everywhere; one on a
/// border is in the cell that begins there. So each face has one cell, by its corners alone.
/// Precondition: no coordinate is 2^exponent or more in magnitude.
[[nodiscard]] TilePath tile_path(std::span<const WorldCorner> corners, int exponent);

/// Faces in a cell.
struct TileCounts {
  std::uint64_t faces = 0;
  std::uint64_t triangles = 0;

  TileCounts& operator+=(const TileCounts& other) {
    faces += other.faces;
    triangles += other.triangles;
    return *this;
  }
};

/// The cells of a world: one of more than so many triangles is split in eight, unless it is of the
/// last level. They are found in rounds, in each of which all faces are counted anew, four levels
/// below those cells that are split; memory is that of 4096 counts for each.
class TileTree {
 public:
  /// `exponent`: tile_exponent of the largest coordinate.
  TileTree(int exponent, std::uint64_t triangles_per_tile);

  /// Whether another round is needed.
  [[nodiscard]] bool is_open() const { return !open_.empty(); }
  /// The bytes that the counts of this round take.
  [[nodiscard]] std::uint64_t round_bytes() const;
  /// Begins the round.
  void begin_round();
  /// Counts a face of `triangles`.
  void count(const TilePath& path, std::uint64_t triangles);
  void end_round();

  /// The cells with faces, in the order of the octree. Precondition: no round is needed.
  struct Tile {
    TileCell cell;
    TileCounts counts;
  };
  [[nodiscard]] const std::vector<Tile>& tiles() const { return tiles_; }
  /// The number of the tile of a face. Nothing where no face was counted, or while rounds are
  /// needed.
  [[nodiscard]] std::optional<std::uint32_t> tile_of(const TilePath& path) const;
  [[nodiscard]] int exponent() const { return exponent_; }

 private:
  static constexpr int kLevelsOfRound = 4;
  static constexpr std::uint32_t kNone = 0xffffffffu;

  struct Node {
    TileCell cell;
    TileCounts counts;
    int level = 0;                   // 0: an eighth of the world
    std::uint32_t children = kNone;  // eight, in order
    std::uint32_t open = kNone;      // place in open_
    std::uint32_t tile = kNone;
  };

  [[nodiscard]] std::uint32_t leaf_of(const TilePath& path) const;
  void grow(std::uint32_t node, std::span<const TileCounts> counts);
  void number_tiles(std::uint32_t node);

  int exponent_;
  std::uint64_t most_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> open_;  // nodes whose counts are to be known by parts
  std::vector<TileCounts> counts_;   // of this round, for each of open_
  std::vector<Tile> tiles_;
};

}  // namespace boxtree::cooker
