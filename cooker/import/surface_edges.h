// SPDX-License-Identifier: MIT
// Counts the open, non-manifold and inconsistently oriented edges of a mesh: a closed mesh has
// none.
#pragma once

#include <cstdint>

#include <boxtree/tree.h>

namespace boxtree::cooker {

/// Edges by the number of faces that share them. A quad has four edges. The diagonals of split
/// polygons are edges of the two adjacent triangles.
struct SurfaceEdges {
  std::uint64_t open = 0;          // one face
  std::uint64_t non_manifold = 0;  // three faces or more
  std::uint64_t inconsistent = 0;  // two faces whose windings traverse it in the same direction
  bool is_empty = false;           // no face has sides, so there is no edge

  /// Whether the surface separates inside from outside where it does not cross itself.
  [[nodiscard]] bool is_closed() const {
    return !is_empty && open + non_manifold + inconsistent == 0;
  }
  bool operator==(const SurfaceEdges&) const = default;
};

/// Counts the edges of a mesh. Precondition: all corners are vertices, and the vertices are welded.
/// Vertices that differ only in the sign of a zero count as one. Faces that refer to a vertex twice
/// are skipped: they have no sides.
///
/// O(faces); uses 12 bytes of memory per triangle while it runs.
[[nodiscard]] SurfaceEdges count_surface_edges(const MeshArrays& mesh);

}  // namespace boxtree::cooker
