// SPDX-License-Identifier: MIT
// Whether a mesh is closed: how many of its edges are open, non-manifold or inconsistently oriented.
#pragma once

#include <cstdint>

#include <boxtree/tree.h>

namespace boxtree::cooker {

/// Edges by the faces that share them. A quad has four; the diagonals of split polygons are edges of
/// the two triangles beside them.
struct SurfaceEdges {
  std::uint64_t open = 0;          // one face
  std::uint64_t non_manifold = 0;  // three faces or more
  std::uint64_t inconsistent = 0;  // two faces, whose windings run along it in the same direction

  /// Whether the surface separates inside from outside wherever it does not cross itself.
  [[nodiscard]] bool is_closed() const { return open + non_manifold + inconsistent == 0; }
  bool operator==(const SurfaceEdges&) const = default;
};

/// Counts the edges of a mesh whose corners are all vertices and whose vertices are welded. Vertices
/// that differ in the sign of a zero alone count as one. Faces that name a vertex twice have no
/// sides, and are skipped.
///
/// O(faces); 24 bytes a triangle of memory while it runs.
[[nodiscard]] SurfaceEdges count_surface_edges(const MeshArrays& mesh);

}  // namespace boxtree::cooker
