// SPDX-License-Identifier: MIT
// A cast on one instance: boxes are compared in its tree's space, triangles where they are placed.
#pragma once

#include "runtime/query/cast_query.h"
#include "runtime/scene/bound_scene.h"

namespace boxtree {

/// A cast in the units of a scene.
struct UnitCast {
  const ConvexShape& shape;  // its center is the origin of the line
  const Ray& line;           // the largest component of its direction is in [1/2, 1)
  bool is_moving;            // see CastLine
};

/// The same on an instance. Where its placement is so uneven that its tree's space tells nothing of
/// the world, all triangles are compared.
class InstanceCast {
 public:
  InstanceCast(const UnitCast& cast, const BoundScene::Placed& instance) noexcept;

  [[nodiscard]] CastQuery::Path path() const noexcept {
    return {around_, line_, is_moving_, &placed_};
  }

 private:
  ConvexShape around_;  // holds the shape's image in tree space, at any s
  Ray line_;            // object space
  bool is_moving_;
  PlacedCast placed_;
};

}  // namespace boxtree
