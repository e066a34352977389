// SPDX-License-Identifier: MIT
// The binary tree before encoding: splits and exact bounds, one triangle per leaf, independent of
// codecs.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cooker/build/duplicates.h"
#include "cooker/import/source_mesh.h"
#include "format/box.h"
#include "format/limits.h"
#include "runtime/tree/frame.h"

namespace boxtree::cooker {

/// Largest number of splits on a path of a build tree. It is below kMaxDepth, because encoders add
/// shrink nodes, and is twice what 2^31 faces need with even splits.
inline constexpr std::uint32_t kMaxSplitDepth = 64;

/// One face to build from: its bounds in tree space, rounded outward to f32.
struct FaceBox {
  Box<float> box;
  std::uint32_t face;
};
static_assert(sizeof(FaceBox) == 28);

/// A node of the build tree. Nodes are stored in preorder: the left child of node i is i + 1.
struct BuildNode {
  Box<float> bounds;     // union of the face boxes below, tree space
  std::uint32_t right;   // number of the right child; 0 for a leaf
  std::uint32_t detail;  // leaf: its face, or its first index in `order`; else axis | height << 8

  [[nodiscard]] bool is_leaf() const { return right == 0; }
  [[nodiscard]] std::uint32_t face() const { return detail; }
  [[nodiscard]] std::uint32_t first() const { return detail; }
  [[nodiscard]] std::uint32_t axis() const { return detail & 3u; }
  /// Inner nodes on the longest path down from here, including this one.
  [[nodiscard]] std::uint32_t height() const { return is_leaf() ? 0 : detail >> 8; }
};
static_assert(sizeof(BuildNode) == 32);

/// A BoxTree before encoding: 2n - 1 nodes for n leaves, none for a mesh without faces.
struct BuildTree {
  std::array<double, 3> origin = {0, 0, 0};  // of the frame, object space
  int scale_exponent = 0;                    // of the frame
  std::vector<BuildNode> nodes;
  /// Trees with full leaves: faces in the order of leaves, from left to right. Otherwise empty.
  std::vector<std::uint32_t> order;

  [[nodiscard]] Frame frame() const { return Frame(origin, scale_exponent); }
};

/// The bounds of a face in tree space, as a reader computes its corners.
[[nodiscard]] Box<double> face_bounds(const MeshView& mesh, const Frame& frame, std::size_t face);

/// The origin of tree space.
enum class Origin : std::uint8_t {
  kByPrecision,  // see choose_frame()
  kZero,
};

enum class Builder : std::uint8_t {
  kSah,    // binned surface-area heuristic over box centres
  kPaper,  // the paper's volume heuristic over box minima
};

/// Builds the tree of a mesh. Deterministic: the result depends only on the mesh and the builder,
/// not on threads, order of execution or standard library. Every face becomes exactly one leaf,
/// except duplicates, of which only the original does. Runs on the threads of the enclosing oneTBB
/// arena. Precondition: finite positions, corners in range (import guarantees both).
[[nodiscard]] BuildTree build_tree(const MeshView& mesh, Builder builder,
                                   Origin origin = Origin::kByPrecision,
                                   const Duplicates& duplicates = {});

/// The same with leaves of kLeafFaces faces. All leaves are full except the last one from left to
/// right. Uses the surface-area heuristic over the divisions that allow full leaves.
[[nodiscard]] BuildTree build_full_leaves(const MeshView& mesh,
                                          Origin origin = Origin::kByPrecision,
                                          const Duplicates& duplicates = {});

}  // namespace boxtree::cooker
