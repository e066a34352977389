// SPDX-License-Identifier: MIT
// Effects of rounding to a grid: the number of triangles that lose their area, and shared vertices.
#include <array>
#include <bit>
#include <cmath>
#include <map>

#include "cooker/quantise/grid.h"
#include "runtime/tree/bound_tree.h"
#include "tests/robustness/mesh_kinds.h"
#include "tests/robustness/run.h"
#include "tests/support/require.h"
#include "tests/unit/primitive/exact_simplex.h"

namespace boxtree::robustness {
namespace {

constexpr GeometryId kGrid = GeometryId::kGrid;

// The number of steps nearest to a coordinate, halves up.
std::int64_t steps_of(double x, int step_exponent) {
  return static_cast<std::int64_t>(std::floor(std::ldexp(x, -step_exponent) + 0.5));
}

bool has_no_area(const SourceMesh& mesh, std::size_t face, std::size_t half, int step_exponent) {
  std::array<test::IntVector, 3> p;
  const Triangle triangle = source_triangle(mesh, face, half);
  for (std::size_t c = 0; c < 3; ++c) {
    const Eigen::Vector3d& v = triangle.corner[c];
    p[c] = {steps_of(v[0], step_exponent), steps_of(v[1], step_exponent),
            steps_of(v[2], step_exponent)};
  }
  const auto minus = [](const test::IntVector& a, const test::IntVector& b) {
    return test::IntVector{a.x - b.x, a.y - b.y, a.z - b.z};
  };
  return test::cross_signs(minus(p[1], p[0]), minus(p[2], p[0])) == std::array{0, 0, 0};
}

// Counts the same with integers; vertices move by at most half a step on each axis.
void collapsed_faces(Run& run) {
  constexpr int kFinest = -40;  // nothing of these meshes is degenerate there
  std::uint32_t collapsed_in_all = 0;
  for (const SourceMesh& mesh :
       {test::torus(120, 60), test::terrain(30, 1), test::sphere(60, 90), test::soup(300, 3)}) {
    const std::size_t faces = mesh.faces.size();
    std::uint32_t before = 0;
    for (std::size_t f = 0; f < faces; ++f) before += has_no_area(mesh, f, 0, kFinest) ? 1u : 0u;
    run.premise(before == 0, mesh.name + ": degenerate to begin with");
    for (int bits = 8; bits <= 16; ++bits) {
      for (const CodecInfo& codec : kCodecs) {
        cooker::CookOptions options;
        options.geometry = kGrid;
        options.grid.bits = bits;
        options.codec = codec.id;
        const cooker::CookedTree cooked = test::require(cooker::cook_mesh(mesh, options));
        const Tree tree = test::require(cooker::bind_encoded(cooked.tree));
        const int step = BoundTree::of(tree).grid_exponent();
        std::uint32_t expected = 0;
        for (std::size_t f = 0; f < faces; ++f) expected += has_no_area(mesh, f, 0, step) ? 1u : 0u;
        const auto name = [&] {
          return mesh.name + ", " + std::string(codec.name) + ", " + std::to_string(bits) +
                 " bits: " + std::to_string(cooked.collapsed) + " instead of " +
                 std::to_string(expected);
        };
        collapsed_in_all += expected;
        run.check(cooked.collapsed == expected, name);
        const std::vector<DecodedTriangle> triangles = decoded_triangles(tree);
        run.check(triangles.size() == faces, name);
        bool is_near = true;
        for (const DecodedTriangle& t : triangles) {
          const Triangle source = source_triangle(mesh, t.face, t.half);
          for (std::size_t c = 0; c < 3; ++c) {
            const Eigen::Vector3d at = BoundTree::of(tree).frame().to_object(t.triangle.corner[c]);
            is_near &= (at - source.corner[c]).cwiseAbs().maxCoeff() <= std::ldexp(0.5, step);
          }
        }
        run.check(is_near, name);
      }
    }
  }
  run.premise(collapsed_in_all > 100, "hardly any face loses its area");
}

using Position = std::array<std::uint64_t, 3>;
Position bits_of(const Eigen::Vector3d& v) {
  return {std::bit_cast<std::uint64_t>(v[0] + 0.0), std::bit_cast<std::uint64_t>(v[1] + 0.0),
          std::bit_cast<std::uint64_t>(v[2] + 0.0)};
}

// Tiles of one terrain as separate meshes. All faces that share a vertex of the source decode it to
// the same bits.
void shared_vertices(Run& run) {
  SourceMesh terrain = times(test::terrain(24, 1), 1.0 / 3);
  terrain = plus(terrain, Eigen::Vector3d(1000, -500, 3));
  std::array<SourceMesh, 4> tiles;
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    tiles[i].positions = terrain.positions;
    tiles[i].name = "tile " + std::to_string(i);
  }
  const Eigen::Vector3d middle = bounds_of(terrain).center();
  for (std::size_t f = 0; f < terrain.faces.size(); ++f) {
    const Eigen::Vector3d at = source_triangle(terrain, f, 0).corner[0];
    const std::size_t tile = (at[0] < middle[0] ? 0u : 1u) + (at[1] < middle[1] ? 0u : 2u);
    tiles[tile].faces.push_back(terrain.faces[f]);
  }
  // Only the faces and vertices of the tile, so that each tile has separate bounds.
  for (SourceMesh& tile : tiles) {
    std::vector<Corners> triangles;
    for (std::size_t f = 0; f < tile.faces.size(); ++f) {
      triangles.push_back(source_triangle(tile, f, 0).corner);
    }
    tile = from_triangles(tile.name, triangles);
  }
  for (const int bits : {10, 14, 24}) {
    for (const CodecInfo& codec : kCodecs) {
      cooker::CookOptions options;
      options.geometry = kGrid;
      options.grid.bits = bits;
      options.codec = codec.id;
      const cooker::Grid grid =
          test::require(cooker::choose_grid(bounds_of(terrain), options.grid));
      std::map<Position, Position> decoded;  // by source
      std::map<Position, std::size_t> first_tile;
      std::size_t shared = 0;
      for (std::size_t i = 0; i < tiles.size(); ++i) {
        const cooker::CookedTree cooked = test::require(cooker::cook_mesh(tiles[i], options, grid));
        const Tree tree = test::require(cooker::bind_encoded(cooked.tree));
        for (const DecodedTriangle& t : decoded_triangles(tree)) {
          const Triangle source = source_triangle(tiles[i], t.face, t.half);
          for (std::size_t c = 0; c < 3; ++c) {
            const Position from = bits_of(source.corner[c]);
            const Position to =
                bits_of(BoundTree::of(tree).frame().to_object(t.triangle.corner[c]));
            const auto [place, is_new] = decoded.try_emplace(from, to);
            shared += !is_new && first_tile[from] != i ? 1u : 0u;
            if (is_new) first_tile[from] = i;
            run.check(place->second == to, [&] {
              return tiles[i].name + ", " + std::string(codec.name) + ", " + std::to_string(bits) +
                     " bits: face " + std::to_string(t.face);
            });
          }
        }
      }
      run.premise(shared > 100, "tiles share hardly any vertex");
    }
  }
}

}  // namespace

std::vector<Case> store_cases() {
  return {
      {"R15", "CollapsedFaces", "faces that lose their area at 8 to 16 bits, counted again exactly",
       "wrong counts", 0, collapsed_faces},
      {"R25", "SharedVertices", "vertices that faces and tiles share decode to the same bits",
       "corners that differ", 0, shared_vertices},
  };
}

}  // namespace boxtree::robustness
