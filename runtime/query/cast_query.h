// SPDX-License-Identifier: MIT
// The state of a cast in one tree, shared by the walks of all codecs.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include <boxtree/cast.h>

#include "format/instance_edges.h"
#include "runtime/primitive/moving_shape.h"
#include "runtime/query/ray_query.h"
#include "runtime/query/relative_pose.h"
#include "runtime/query/shape_in_tree.h"
#include "runtime/tree/bound_tree.h"
#include "runtime/walk/traversal.h"
#include "runtime/walk/work.h"

namespace boxtree {

/// A caller's cast, checked: the line of the shape's center.
struct CastLine {
  CastLine(const ShapeInTree& shape, const Motion& motion) noexcept;

  Ray line;             // of a shape that stays where it is: of no length, along some direction
  bool is_moving;       // whether it has a direction
  const char* invalid;  // the field that is not valid, or null; then the rest is not, either
};

/// A touch: at `touch`, in parameters of MovingShape, and the triangle where it is compared with
/// the shape, unspecified where the contact is known (kContacts) or the face alone matters
/// (kFaces).
struct CastCandidate {
  bool is_hit = false;  // if false, the rest is unspecified
  MovingShape::Touch touch{0};
  FaceRef face;
  std::uint32_t original = 0;  // the face of the tree's order that it is, or is a copy of
  std::uint32_t half = 0;
  Triangle triangle;
  Triangle in_tree;             // the same in tree space
  bool is_placed = false;       // whether a pose has made `triangle` of it
  bool is_mirror = false;       // whether its corners 1 and 2 have changed places there
  InactiveEdges inactive;       // of the instance, besides those of the tree
  Penetration at;               // of kContacts
  Eigen::Vector3d face_normal;  // likewise: see face_normal()
};

/// What of the space of a tree is surely inside a shape: what is not farther than `radius` from the
/// core of Path::shape; of a box, where that has none, what is not farther than r from a core that
/// is r * ratio + less smaller on all sides. Nothing is where `radius` is negative.
struct InnerShape {
  double radius;
  double ratio = 1;
  double less = 0;
};

/// A cast on a tree that is placed by a pose: triangles are compared where it places them.
struct PlacedCast {
  AffineMap to_world;      // from tree space
  bool is_mirror;          // whether the pose turns the order of corners over
  MovingShape moving;      // in the world
  double scale;            // s of `moving` = it * s of the query in tree space; a power of two
  InactiveEdges inactive;  // see BoundScene::Placed
  InnerShape inside;

  [[nodiscard]] Triangle apply(const Triangle& triangle) const noexcept {
    Triangle placed = to_world.apply(triangle);
    if (is_mirror) std::swap(placed.corner[1], placed.corner[2]);
    return placed;
  }
};

/// A query of traverse_nearest: the line of the shape's center against boxes that are widened by
/// the shape.
struct CastQuery : RayInTree {
  /// Receives each touch, those of copies after their original's; returns the largest parameter of
  /// MovingShape that is still of interest, or a negative number to stop.
  using Visitor = FunctionRef<double(const CastQuery& query, const CastCandidate& found)>;

  /// kFaces, kContacts: of a shape that stays where it is; kFaces: all, where the faces alone
  /// matter.
  enum class Wanted : std::uint8_t { kClosest, kAny, kAll, kFaces, kContacts };

  /// What of the shape and its way is in tree space.
  struct Path {
    const ConvexShape& shape;            // or one that holds its image there, but for the center
    const Ray& line;                     // of its center, in object space
    bool is_moving;                      // as in CastLine
    const PlacedCast* placed = nullptr;  // null: triangles are compared in tree space
  };

  /// `all`: the visitor of all that is wanted, or null. `face_options`: null: every face may be
  /// hit.
  CastQuery(const BoundTree& queried, const Path& path, Wanted wanted_touches, const Visitor* all,
            WalkBound& bound, const FaceOptions* face_options = nullptr) noexcept;

  /// Walks the tree; `best` or the visitor has the answers then. Errors: those of corrupt bytes and
  /// limits.
  [[nodiscard]] Errc run();

  [[nodiscard]] double bound() const noexcept { return t_max; }

  [[nodiscard]] bool leaf(NodeRef ref) {
    error = tree.leaves().read(ref.first, ref.second, batch);
    if (error != Errc::kOk) return false;
    for (std::uint32_t i = 0; i < batch.count && !is_done(); ++i) {
      test(batch.triangle(i), batch.face[i], half_of_face(batch, i));
    }
    return !is_done();
  }

  /// Whether no other triangle can matter.
  [[nodiscard]] bool is_done() const noexcept {
    return faces.stopped || error != Errc::kOk || (wanted == Wanted::kAny && best.is_hit);
  }

  void test(const Triangle& triangle, std::uint32_t face_index, std::uint32_t half);

  /// What test() is made of, for walks that find touches of several triangles together. Fills in
  /// which triangle a touch is of. `found`: as it is when it is made.
  void set_triangle(const Triangle& triangle, std::uint32_t face_index, std::uint32_t half,
                    CastCandidate& found) const noexcept;
  /// Takes a touch, which `found` holds.
  void take(CastCandidate& found);
  /// The same of kFaces: of a triangle of which nothing else is known.
  void take_face(std::uint32_t face_index, std::uint32_t half);

  const BoundTree& tree;
  WalkBound& nodes;
  const ConvexShape& shape;  // see Path
  Eigen::Vector3d extent;    // half, of its bounds
  // The largest coordinate of the tree, in every codec, and of the shape while it is near.
  double near;
  const PlacedCast* placed;
  bool is_moving;
  MovingShape moving;
  Wanted wanted;
  const Visitor* visitor;
  FaceWishes faces;
  LeafFaceRefs names{tree};  // for visitors
  CastCandidate best;
  Errc error = Errc::kOk;
  TriangleBatch batch;

 private:
  // `half`: the extent of the shape.
  CastQuery(const BoundTree& queried, const Path& path, const Eigen::Vector3d& half,
            Wanted wanted_touches, const Visitor* all, WalkBound& bound,
            const FaceOptions* face_options) noexcept;

  // Of `moving`, over that of the line.
  [[nodiscard]] double scale_of_parameters() const noexcept {
    return placed == nullptr ? 1 : placed->scale;
  }

  // Whether only one side of a triangle may be hit.
  [[nodiscard]] bool wants_a_side() const noexcept {
    return faces.options != nullptr && faces.options->back_faces != BackFaces::kHit;
  }
  // Whether a triangle may be hit, from the side from which it is met.
  [[nodiscard]] bool admits_side(const CastCandidate& found) const noexcept;

  [[nodiscard]] MovingShape moving_in_tree() const noexcept;
};

/// What a caller is told of a touch in a tree, but for the id of its face. `line`: whose t is told,
/// that of parameter s * 2^-exponent; `frame`: from the space of `moving` to the caller's.
[[nodiscard]] CastHit hit_of(const BoundTree& tree, const MovingShape& moving,
                             const CastCandidate& found, const Ray& line, int exponent,
                             const Frame& frame) noexcept;

/// By vectors; see walk_tree.h.
Errc walk_wide(const BoundTree& tree, CastQuery& query);

}  // namespace boxtree
