// SPDX-License-Identifier: MIT
// A counting sort by the smaller vertex of each edge; then the few edges of each vertex are sorted.
#include "cooker/import/surface_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "cooker/import/weld.h"
#include "format/limits.h"
#include "runtime/tree/geometry.h"

namespace boxtree::cooker {
namespace {

using Corners = std::array<std::uint32_t, 4>;

// Vertex numbers with -0 equal to 0; empty if no coordinate is -0.
std::vector<std::uint32_t> numbers_by_value(const MeshArrays& mesh) {
  const auto has_negative_zero = [&](std::uint32_t vertex) {
    const Eigen::Vector3d p = position_of(mesh, vertex);
    return std::any_of(p.begin(), p.end(), [](double x) { return x == 0 && std::signbit(x); });
  };
  std::vector<std::uint32_t> numbers;
  std::uint32_t first = 0;
  while (first < mesh.vertex_count && !has_negative_zero(first)) ++first;
  if (first == mesh.vertex_count) return numbers;
  std::vector<double> positions;
  Welder<double> welder(positions, mesh.vertex_count);
  numbers.reserve(mesh.vertex_count);
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
    const Eigen::Vector3d p = position_of(mesh, v);
    numbers.push_back(welder.add({p[0] + 0.0, p[1] + 0.0, p[2] + 0.0}));  // -0 + 0 is 0
  }
  return numbers;
}

// Calls visit(from, to) for each side of each face.
template <class Visit>
void visit_sides(const MeshArrays& mesh, const std::vector<std::uint32_t>& numbers, Visit visit) {
  for (std::uint32_t f = 0; f < mesh.face_count; ++f) {
    Corners corner = face_of(mesh, f);
    const std::size_t count = corner[3] == kMissingCorner ? 3 : 4;
    bool names_one_twice = false;
    for (std::size_t i = 0; i < count; ++i) {
      if (!numbers.empty()) corner[i] = numbers[corner[i]];
      for (std::size_t j = 0; j < i; ++j) names_one_twice |= corner[j] == corner[i];
    }
    if (names_one_twice) continue;
    for (std::size_t i = 0; i < count; ++i) visit(corner[i], corner[(i + 1) % count]);
  }
}

}  // namespace

SurfaceEdges count_surface_edges(const MeshArrays& mesh) {
  const std::vector<std::uint32_t> numbers = numbers_by_value(mesh);
  // Sides of vertex v are at [end[v - 1], end[v]) after placement.
  std::vector<std::size_t> end(std::size_t{mesh.vertex_count} + 1, 0);
  visit_sides(mesh, numbers, [&](std::uint32_t a, std::uint32_t b) { ++end[std::min(a, b) + 1]; });
  for (std::size_t v = 1; v < end.size(); ++v) end[v] += end[v - 1];
  // The larger vertex, and in the lowest bit whether the face goes from the larger to the smaller.
  static_assert(kMaxVertices <= 0x7fffffffu);
  std::vector<std::uint32_t> sides(end.back());
  visit_sides(mesh, numbers, [&](std::uint32_t a, std::uint32_t b) {
    sides[end[std::min(a, b)]++] = std::max(a, b) << 1 | (a > b ? 1u : 0u);
  });
  SurfaceEdges edges;
  edges.is_empty = sides.empty();
  std::size_t first = 0;
  for (std::uint32_t v = 0; v < mesh.vertex_count; first = end[v++]) {
    const auto begin = sides.begin() + static_cast<std::ptrdiff_t>(first);
    const auto past = sides.begin() + static_cast<std::ptrdiff_t>(end[v]);
    std::sort(begin, past);
    for (auto side = begin; side != past;) {
      const auto next =
          std::find_if(side, past, [&](std::uint32_t other) { return other >> 1 != *side >> 1; });
      const auto faces = next - side;
      edges.open += faces == 1 ? 1u : 0u;
      edges.non_manifold += faces > 2 ? 1u : 0u;
      edges.inconsistent += faces == 2 && side[0] == side[1] ? 1u : 0u;
      side = next;
    }
  }
  return edges;
}

}  // namespace boxtree::cooker
