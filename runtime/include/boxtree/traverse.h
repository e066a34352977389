// SPDX-License-Identifier: MIT
// Traversals of your own: for shapes and queries that no query answers.
#pragma once

#include <cstdint>

#include <Eigen/Geometry>

#include <boxtree/export.h>
#include <boxtree/query.h>

namespace boxtree {

/// Receives a box of object space that holds every triangle below a node; returns whether to look
/// into it.
using BoxTest = FunctionRef<bool(const Eigen::AlignedBox3d&)>;

/// A triangle of a leaf, in object space, as Tree::triangle() gives it.
struct LeafTriangle {
  Triangle triangle;       ///< Its corners.
  FaceRef face;            ///< The face that it belongs to.
  std::uint32_t half = 0;  ///< 0, or 1 for the second half (0,2,3) of a quad.
};

/// Receives one triangle after the other; returns whether to go on.
using TriangleVisitor = FunctionRef<bool(const LeafTriangle&)>;

/// Visits every triangle below boxes that all pass `intersect`, each once, in no promised order.
/// Missing nothing is up to the test: it must pass every box around a box that it passes. Faces
/// that coincide with another face are represented by it; see Tree::without_duplicates(). Errors:
/// the codes of corrupt bytes and limits as for closest_hit(). Never allocates. Every check that
/// keeps a walk of hostile bytes finite and inside the file is made here.
BOXTREE_API Result<Visit> traverse(const Tree& tree, BoxTest intersect, TriangleVisitor visitor,
                                   const QueryLimits& limits = {});

}  // namespace boxtree
