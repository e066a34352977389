// SPDX-License-Identifier: MIT
// A box query on an instance of a scene: a shape like those of query/shape_query.h.
#pragma once

#include <boxtree/scene.h>

#include "runtime/primitive/predicates.h"
#include "runtime/query/relative_pose.h"
#include "runtime/tree/bound_tree.h"
#include "runtime/walk/face_visit.h"
#include "runtime/walk/traversal.h"

namespace boxtree {

/// Passes on the faces of one instance: by one indirect call per face, not two, as a query has
/// hundreds of faces.
struct FacesOfInstance {
  SceneFaceVisitor visitor;
  std::uint32_t instance;

  bool operator()(const FaceRef& face) const { return visitor({instance, face}); }
};

/// A world box against a placed tree. A box of the tree is compared by the hull of its image, which
/// contains the images of its contents exactly (AffineMap::hull).
struct PlacedBoxQuery {
  using Visitor = FacesOfInstance;

  AffineMap to_world;  // from tree space
  Box<double> box;     // world

  template <class S>
  [[nodiscard]] bool overlaps(const Box<S>& of_tree) const noexcept {
    return boxes_overlap(to_world.hull(of_tree), box);
  }
  [[nodiscard]] bool touches(const Triangle& triangle) const noexcept {
    return triangle_intersects_box(to_world.apply(triangle), {box.low[0], box.low[1], box.low[2]},
                                   {box.high[0], box.high[1], box.high[2]});
  }
};

/// By vectors; see walk_tree.h.
Errc walk_wide(const BoundTree& tree, FaceWalk<PlacedBoxQuery>& walk);

}  // namespace boxtree
