// SPDX-License-Identifier: MIT
// Where the shape of a cast may be in a tree's space.
#include "runtime/scene/placed_cast.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/primitive/normal.h"
#include "runtime/primitive/rounding.h"
#include "runtime/primitive/vector3.h"
#include "runtime/query/scaled_length.h"
#include "runtime/tree/root_box.h"

namespace boxtree {
namespace {

// Larger than any tree, and than the distance of any two points of one.
constexpr double kEverywhere = 4 * kMaxCoordinate;

// A parameter of the line in object space over that of CastQuery; 0 if it has no direction.
double scale_of(const Ray& line, const BoundTree& tree) noexcept {
  const double length = largest_magnitude(line.direction);
  const bool is_direction = length > 0 && length <= std::numeric_limits<double>::max();
  return is_direction ? std::ldexp(1.0, tree.scale_exponent() - exponent_of(length)) : 0;
}

}  // namespace

// Let q(s) be the line in tree space, as computed, c(s) the line in the world, L the placement. If
// the shape touches the image of a point x of a triangle at s, that image is c(s) + w for some w of
// the shape, up to the rounding of the triangle, so x - q(s) = L^-1 (w + e), where e is what q(s)
// and the triangle are off by, measured in the world: that of the start, and of the direction times
// the largest s at which the shape is near the tree. L^-1 makes no vector longer than 1 /
// stretch.least times its length; it takes axes of the shape to axes, up to what is measured, too.
InstanceCast::InstanceCast(const UnitCast& cast, const BoundScene::Placed& instance) noexcept
    : line_(instance.placement.to_object(cast.line)), is_moving_(cast.is_moving) {
  const BoundTree& tree = *instance.tree;
  const Placement& placement = instance.placement;
  const AffineMap& to_world = placement.to_world();
  placed_.to_world = to_world;
  placed_.is_mirror = is_mirror(to_world.linear);
  placed_.inactive = instance.inactive;

  const Eigen::Vector3d& center = cast.line.origin;
  const Box<double> root = root_box<double>(tree);
  const Eigen::Vector3d extent = cast.shape.half_extents();
  // Rounded up as RaySlab does: codecs round root boxes differently.
  const double near = RaySlab::power_above(max_abs_of(to_world.hull(root)).maxCoeff()) +
                      2 * largest_magnitude(extent);
  placed_.moving = {cast.shape, is_moving_ ? cast.line.direction : Eigen::Vector3d::Zero(),
                    MovingShape::doubt_of(near, largest_magnitude(center)) + cast.shape.error};
  placed_.moving.shape.center = center;

  const Eigen::Vector3d start = tree.frame().to_tree(line_.origin);
  double error = placement.distance_error(start, center, root) + 4 * placed_.moving.doubt;
  if (is_moving_) {
    // Not the end of the line, which a touch of another instance shortens: where a search begins
    // decides the last bits of what it finds.
    const double last = 2 * (largest_magnitude(center) + near);
    const Eigen::Vector3d& direction = cast.line.direction;
    error += last * placement.vector_error(placement.vector_to_tree(direction), direction);
  }
  around_.axes = cast.shape.axes;
  around_.half = cast.shape.half;
  for (std::uint32_t i = 0; i < around_.axes; ++i) {
    const Eigen::Vector3d& axis = cast.shape.axis[i];
    around_.axis[i] = placement.vector_to_tree(axis);
    error += around_.half[i] * placement.vector_error(around_.axis[i], axis);
  }
  const Stretch stretch = stretch_of(to_world.linear);
  constexpr double kUp = 1 + 16 * kRoundoffF64;
  around_.radius = (cast.shape.radius + error) / stretch.least * kUp + kLengthUnderflow;
  // The other way round: what is d from the core in tree space is at most stretch.most * d + error
  // from it in the world, and sides that move by d there move by stretch.least * d or more.
  placed_.inside.radius =
      placed_.moving.is_box()
          ? 0
          : (cast.shape.radius - error) / (stretch.most * kUp) - kLengthUnderflow;
  placed_.inside.ratio = stretch.most / stretch.least * kUp;
  placed_.inside.less = error / stretch.least * kUp + kLengthUnderflow;

  placed_.scale = scale_of(line_, tree);
  const bool is_known = std::isnormal(placed_.scale) && is_within_range(start) &&
                        largest_magnitude(around_.half_extents()) <= kMaxCoordinate;
  if (!is_known) {
    around_ = {};
    around_.radius = kEverywhere;
    placed_.inside.radius = -1;
    line_ = {tree.frame().origin, Eigen::Vector3d::UnitX(), 0, cast.line.t_max};
    placed_.scale = scale_of(line_, tree);
  }
}

}  // namespace boxtree
