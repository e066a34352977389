// SPDX-License-Identifier: MIT
// Active features, and the normals of others.
#include "runtime/query/touched_feature.h"

#include <cmath>

#include <boxtree/cast.h>

#include "runtime/primitive/float_state.h"
#include "runtime/primitive/normal.h"
#include "runtime/primitive/vector3.h"
#include "runtime/tree/active_edges.h"

namespace boxtree {

// Of a triangle a, c, b: vertices 1 and 2 change places, and edges a-c and b-a.
TrianglePart part_of_face(const CastCandidate& found, TrianglePart part) noexcept {
  if (!found.is_mirror) return part;
  if (part.feature == Feature::kVertex)
    part.index = static_cast<std::uint8_t>((3 - part.index) % 3);
  if (part.feature == Feature::kEdge) part.index = static_cast<std::uint8_t>(2 - part.index);
  return part;
}

namespace {

// Of a triangle of a face, in tree space, those of `edges` that are active. A quad's diagonal never
// is, though its ends may be those of an edge of another face, which is found by them.
std::uint32_t active_of(const BoundTree& tree, std::uint32_t face, const Triangle& triangle,
                        std::uint32_t half, std::uint32_t edges) noexcept {
  const std::uint32_t active = active_edges_of(tree.active_edges(), face, triangle) & edges;
  const std::uint32_t diagonal = half == 0 ? 4 : 1;
  if ((active & diagonal) == 0 || !tree.active_edges()) return active;
  if (half == 0) {
    TriangleBatch halves;
    if (tree.leaves().read(face, 1, halves) != Errc::kOk || halves.count < 2) return active;
  }
  return active & ~diagonal;
}

// The same of the face that was found, where it was.
std::uint32_t active_of(const BoundTree& tree, const CastCandidate& found, const Triangle& triangle,
                        std::uint32_t half, std::uint32_t edges) noexcept {
  return active_of(tree, found.original, triangle, half,
                   edges & ~found.inactive.of_triangle(found.original, half));
}

// The edges of a triangle that end at corner `i`.
std::uint32_t edges_at(std::uint32_t i) noexcept {
  return 1u << i | 1u << (i + 2) % 3;
}

}  // namespace

bool is_active(const BoundTree& tree, const CastCandidate& found,
               const TrianglePart& part) noexcept {
  if (part.feature == Feature::kFace || !tree.active_edges()) return true;
  const bool is_edge = part.feature == Feature::kEdge;
  const std::uint32_t edges = is_edge ? 1u << part.index : edges_at(part.index);
  if (active_of(tree, found, found.in_tree, found.half, edges) != 0) return true;
  if (is_edge) return false;
  // Where both triangles of a quad meet, one edge at the vertex is of the other one.
  TriangleBatch face;
  if (tree.leaves().read(found.original, 1, face) != Errc::kOk || face.count < 2) return false;
  const std::uint32_t other_half = 1 - found.half;
  const Triangle other = face.triangle(other_half);
  for (std::uint32_t i = 0; i < 3; ++i) {
    if (other.corner[i] != found.in_tree.corner[part.index]) continue;
    if (active_of(tree, found, other, other_half, edges_at(i)) != 0) return true;
  }
  return false;
}

Eigen::Vector3d front_normal(const CastCandidate& found) noexcept {
  if (found.is_placed && unit_normal(found.in_tree).isZero(0)) return Eigen::Vector3d::Zero();
  return unit_normal(found.triangle);
}

Eigen::Vector3d face_normal(const CastCandidate& found, const Eigen::Vector3d& normal) noexcept {
  const Eigen::Vector3d front = front_normal(found);
  return dot(front, normal) < 0 ? Eigen::Vector3d(-front) : front;
}

// A normal in the plane of the face is off by what unit vectors are rounded.
Eigen::Vector3d resolved(const Eigen::Vector3d& normal, const Eigen::Vector3d& of_face,
                         bool keeps_its_own, const Eigen::Vector3d& velocity) noexcept {
  if (keeps_its_own || of_face.isZero(0)) return normal;
  constexpr double kOrthogonal = 0x1p-46;
  const bool is_along_face = std::abs(dot(normal, of_face)) <= kOrthogonal;
  return is_along_face && dot(velocity, of_face) > 0 ? Eigen::Vector3d(-of_face) : of_face;
}

Result<std::uint32_t> active_edges(const Tree& queried, const FaceRef& face, std::uint32_t half) {
  const DefaultFloatState state;
  const BoundTree& tree = BoundTree::of(queried);
  const Result<Triangle> triangle = tree.triangle(face, half);
  if (!triangle) return triangle.error();
  return active_of(tree, face.index, *triangle, half, kAllEdges);
}

Eigen::Vector3d resolved_normal(const CastHit& hit, const Eigen::Vector3d& velocity) {
  const DefaultFloatState state;
  return resolved(hit.normal, hit.face_normal, hit.is_active, velocity);
}

}  // namespace boxtree
