// SPDX-License-Identifier: MIT
// The binary tree before it is encoded: splits and exact bounds, one face a leaf, no codec in
// sight.
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

/// Splits on the longest path of a build tree. Leaves room below kMaxDepth for shrink nodes, which
/// encoders add, and is twice what 2^31 faces need with even splits.
inline constexpr std::uint32_t kMaxSplitDepth = 64;

/// One face on its way through the builder: its bounds in tree space, rounded outward to f32.
struct FaceBox {
  Box<float> box;
  std::uint32_t face;
};
static_assert(sizeof(FaceBox) == 28);

/// A node of the build tree. Nodes stand in preorder: the left child of node i is i + 1.
struct BuildNode {
  Box<float> bounds;     // union of the face boxes below, tree space
  std::uint32_t right;   // number of the right child; 0 for a leaf
  std::uint32_t detail;  // leaf: its face, or first place in the order; else axis | height << 8

  [[nodiscard]] bool is_leaf() const { return right == 0; }
  [[nodiscard]] std::uint32_t face() const { return detail; }
  [[nodiscard]] std::uint32_t first() const { return detail; }
  [[nodiscard]] std::uint32_t axis() const { return detail & 3u; }
  /// Inner nodes on the longest path from here down, this one included.
  [[nodiscard]] std::uint32_t height() const { return is_leaf() ? 0 : detail >> 8; }
};
static_assert(sizeof(BuildNode) == 32);

/// A BoxTree in the making: 2n - 1 nodes for n leaves, none for a mesh without faces.
struct BuildTree {
  std::array<double, 3> origin = {0, 0, 0};  // of the frame, object space
  int scale_exponent = 0;                    // of the frame
  std::vector<BuildNode> nodes;
  /// Of trees with full leaves: faces in the order of leaves, from left to right. Otherwise empty.
  std::vector<std::uint32_t> order;

  [[nodiscard]] Frame frame() const { return Frame(origin, scale_exponent); }
};

/// The bounds of a face in tree space, as a reader computes its corners.
[[nodiscard]] Box<double> face_bounds(const SourceMesh& mesh, const Frame& frame, std::size_t face);

/// Where tree space begins.
enum class Origin : std::uint8_t {
  kByPrecision,  // see choose_frame()
  kZero,
};

enum class Builder : std::uint8_t {
  kSah,    // binned surface-area heuristic over box centres
  kPaper,  // the paper's: volume heuristic over box minima
};

/// Builds the tree of a mesh. Deterministic: the result depends on the mesh and the builder alone,
/// not on threads, order of execution or standard library. Every face becomes exactly one leaf, but
/// for duplicates: of those, only their originals.
/// Runs on the threads of the enclosing oneTBB arena.
/// Precondition: finite positions, corners in range (what import promises).
[[nodiscard]] BuildTree build_tree(const SourceMesh& mesh, Builder builder,
                                   Origin origin = Origin::kByPrecision,
                                   const Duplicates& duplicates = {});

/// The same with leaves of kLeafFaces faces, all full but the last one from left to right, by the
/// surface-area heuristic over divisions that allow it.
[[nodiscard]] BuildTree build_full_leaves(const SourceMesh& mesh,
                                          Origin origin = Origin::kByPrecision,
                                          const Duplicates& duplicates = {});

}  // namespace boxtree::cooker
