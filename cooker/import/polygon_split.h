// SPDX-License-Identifier: MIT
// Converts polygons to the faces of a SourceMesh: quads where possible, otherwise triangles. All
// decisions use exact orientation signs (runtime/primitive/orientation.h), never an epsilon.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace boxtree::cooker {

/// Whether three points lie on one line, coincident points included. Exact.
[[nodiscard]] bool is_collinear(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                const Eigen::Vector3d& c);

/// A corner, and the largest rounding error of each of its coordinates: half a unit in the last
/// place for a coordinate read from a file.
struct RoundedCorner {
  Eigen::Vector3d position;
  Eigen::Vector3d rounding;
};

/// Whether the triangles (0,1,2) and (0,2,3) represent the quad. It must be convex, and planar up
/// to the rounding of its coordinates; corners of 180 degrees and repeated corners are allowed. A
/// quad whose corners are all collinear counts as planar and convex.
[[nodiscard]] bool is_planar_convex_quad(const std::array<RoundedCorner, 4>& corners);

/// A set of numbers below a bound. Finds the next member from any number on in O(log64 of the
/// bound): each word of a level records which words of the level below are not zero.
class CornerSet {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  /// Sets the bound to `count`; the set is then full or empty.
  void reset(std::uint32_t count, bool all);
  void insert(std::uint32_t number);
  void erase(std::uint32_t number);
  /// The first member from `from` on, wrapping around to 0; kNone if the set is empty.
  [[nodiscard]] std::uint32_t next_around(std::uint32_t from) const;

 private:
  [[nodiscard]] std::uint32_t next(std::uint32_t from) const;

  std::vector<std::vector<std::uint64_t>> levels_;  // the numbers' own bits first
};

/// Splits polygons into triangles by ear clipping. Holds buffers, so reuse one for many polygons.
class PolygonSplitter {
 public:
  using Triangle = std::array<std::uint32_t, 3>;

  /// n corners give n - 2 triangles of corner numbers, in the winding of the polygon; every edge of
  /// the polygon is an edge of one of them. A simple polygon, convex or not, is covered exactly
  /// once as seen along its normal. A degenerate or self-crossing polygon gets triangles over all
  /// its corners. A quad without a reflex corner, as seen along the axis to which its normal is
  /// closest, becomes (0,1,2), (0,2,3). The result is valid until the next call. Precondition: n >=
  /// 3, coordinates finite.
  ///
  /// O(n log n), except for large, nearly empty ears beside many reflex corners: each is tested
  /// against the reflex corners in the grid cells that its bounds cover. After kMaxTests
  /// corner-in-ear tests the rest is clipped without tests, which bounds the time.
  std::span<const Triangle> split(std::span<const Eigen::Vector3d> corners);

  /// [2^29] corner-in-ear tests per polygon, two to ten seconds.
  static constexpr std::size_t kMaxTests = std::size_t{1} << 29;

 private:
  // Kinds of ears, best first; a kind is tried only if no ear of a better kind is left.
  enum class EarKind {
    kClean,     // turns left, no corner inside or on its border
    kTouching,  // turns left, no corner strictly inside; after those without area, see split()
  };

  // Corners that may be ears of a kind. The other corners are not: they do not turn left, or
  // another corner blocks them. They become candidates again when either changes.
  struct Candidates {
    CornerSet corners;
    std::vector<std::uint32_t> blocker;     // of each corner that is blocked
    std::vector<std::uint32_t> last_block;  // of each corner, the last entry of blocks, or none
    struct Block {
      std::uint32_t blocked;
      std::uint32_t before;  // the entry before it with the same blocker, or none
    };
    std::vector<Block> blocks;

    void reset(std::uint32_t count);
    void block(std::uint32_t corner, std::uint32_t by);
    void changed(std::uint32_t corner);  // its neighbours changed: a candidate again
    void unblock(std::uint32_t by);
  };

  void project(std::span<const Eigen::Vector3d> corners);
  void link(std::uint32_t count);
  void make_grid(std::uint32_t count);
  [[nodiscard]] std::array<std::uint32_t, 2> cell_of(const Eigen::Vector2d& point) const;
  [[nodiscard]] int turn(std::uint32_t corner) const;
  [[nodiscard]] std::uint32_t find_ear(std::uint32_t from, EarKind kind);
  [[nodiscard]] std::uint32_t find_blocker(std::uint32_t corner, EarKind kind);
  [[nodiscard]] bool blocks(std::uint32_t other, std::uint32_t corner, bool border_blocks) const;
  void clip(std::uint32_t corner);
  void update(std::uint32_t corner);

  std::vector<Eigen::Vector3d> scaled_;  // scaled corners
  std::vector<Eigen::Vector2d> points_;  // their projection along an axis, counter-clockwise
  std::vector<std::uint32_t> next_, previous_;
  std::array<Candidates, 2> candidates_;  // of each EarKind
  CornerSet flat_;                        // corners without area
  // Corners that do not turn left, in the cells of a grid over all of them.
  std::vector<std::vector<std::uint32_t>> cells_;
  std::vector<std::uint32_t> slot_;  // index of a corner in its cell, or kNowhere
  std::array<std::uint32_t, 2> cell_count_{1, 1};
  Eigen::Vector2d grid_low_, cells_per_length_;
  std::vector<Triangle> triangles_;
  std::size_t tests_ = 0;
};

}  // namespace boxtree::cooker
