// SPDX-License-Identifier: MIT
// From polygons to the faces of a SourceMesh: which quads may stay, and triangles for the rest.
// All decisions hang on exact orientation signs (runtime/primitive/orientation.h): no epsilon.
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

/// A corner and how far each of its coordinates may be from what the author meant, because it was
/// rounded: half a unit in the last place for a coordinate just read from a file.
struct RoundedCorner {
  Eigen::Vector3d position;
  Eigen::Vector3d rounding;
};

/// Whether the triangles (0,1,2) and (0,2,3) stand for the quad: it is planar, up to what the
/// rounding of its own coordinates explains, and convex (corners of 180 degrees and repeated
/// corners are allowed). A quad whose corners all lie on one line counts as planar and convex.
[[nodiscard]] bool is_planar_convex_quad(const std::array<RoundedCorner, 4>& corners);

/// Splits polygons into triangles by ear clipping. Holds buffers, so use one for many polygons.
class PolygonSplitter {
 public:
  using Triangle = std::array<std::uint32_t, 3>;

  /// n corners give n - 2 triangles of corner numbers, in the winding of the polygon, every edge of
  /// the polygon an edge of one of them. A simple polygon, convex or not, is covered exactly once
  /// as seen along its normal; a degenerate or self-crossing one gets triangles over all its
  /// corners. A quad without a reflex corner becomes (0,1,2), (0,2,3). The result is valid until
  /// the next call. Precondition: n >= 3, coordinates finite.
  ///
  /// O(n) for convex polygons, O(n r) with r reflex corners. Beyond kMaxTests corner-in-ear tests
  /// the rest is clipped without looking (some 30 000 corners of a comb), so that it always ends.
  std::span<const Triangle> split(std::span<const Eigen::Vector3d> corners);

  /// [2^29] corner-in-ear tests a polygon, about two seconds.
  static constexpr std::size_t kMaxTests = std::size_t{1} << 29;

 private:
  // How much an ear may do harm; a kind is tried only when no ear of the kinds before is left.
  enum class EarKind {
    kClean,     // turns left, no corner inside or on its border
    kFlat,      // no area: clipping it changes nothing but a corner
    kTouching,  // turns left, no corner strictly inside
    kAny,       // the polygon crosses itself
  };

  void project(std::span<const Eigen::Vector3d> corners);
  void link(std::size_t count);
  [[nodiscard]] int turn(std::uint32_t corner) const;
  [[nodiscard]] bool is_ear(std::uint32_t corner, EarKind kind);
  [[nodiscard]] bool blocks(std::uint32_t other, std::uint32_t corner, bool border_blocks) const;
  void clip(std::uint32_t corner);
  void update_reflex(std::uint32_t corner);

  std::vector<Eigen::Vector2d> points_;  // counter-clockwise
  std::vector<std::uint32_t> next_, previous_;
  std::vector<std::uint32_t> reflex_;       // corners that do not turn left, in no order
  std::vector<std::uint32_t> reflex_slot_;  // where a corner stands in reflex_, or kNowhere
  std::vector<Triangle> triangles_;
  std::size_t tests_ = 0;
};

}  // namespace boxtree::cooker
