// SPDX-License-Identifier: MIT
// Generators of meshes with coincident and coplanar faces.
#include "tests/support/coincident.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>

#include "tests/support/meshes.h"

namespace boxtree::test {
namespace {

using cooker::Face;
using cooker::kNoCorner;
using cooker::SourceMesh;

// A vertex of the plane z = x, moved by `height` along z.
std::uint32_t add_at(SourceMesh& mesh, float x, float y, float height = 0) {
  mesh.positions.f32.insert(mesh.positions.f32.end(), {x, y, x + height});
  return static_cast<std::uint32_t>(mesh.positions.size() - 1);
}

SourceMesh one_triangle(const char* name) {
  SourceMesh mesh;
  mesh.name = name;
  add_at(mesh, -0.5f, -0.5f);
  add_at(mesh, 0.5f, -0.5f);
  add_at(mesh, 0, 0.5f);
  return mesh;
}

// A square of `cells` x `cells` cells of two triangles.
void add_plate(SourceMesh& mesh, unsigned cells, float height) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const auto at = [&](unsigned i) {
    return static_cast<float>(i) / static_cast<float>(cells) - 0.5f;
  };
  for (unsigned i = 0; i <= cells; ++i) {
    for (unsigned j = 0; j <= cells; ++j) add_at(mesh, at(i), at(j), height);
  }
  for (unsigned i = 0; i < cells; ++i) {
    for (unsigned j = 0; j < cells; ++j) {
      const std::uint32_t a = first + i * (cells + 1) + j;
      const std::uint32_t b = a + cells + 1;
      mesh.faces.push_back({{a, b, b + 1, kNoCorner}});
      mesh.faces.push_back({{a, b + 1, a + 1, kNoCorner}});
    }
  }
}

}  // namespace

SourceMesh identical_faces(unsigned faces) {
  SourceMesh mesh = one_triangle("identical");
  mesh.faces.assign(faces, Face{{0, 1, 2, kNoCorner}});
  return mesh;
}

SourceMesh corner_orders(unsigned faces) {
  SourceMesh mesh = one_triangle("corner orders");
  std::array<std::uint32_t, 3> corner{0, 1, 2};
  for (unsigned i = 0; i < faces; ++i) {
    mesh.faces.push_back({{corner[0], corner[1], corner[2], kNoCorner}});
    std::next_permutation(corner.begin(), corner.end());
  }
  return mesh;
}

SourceMesh overlapping_faces(unsigned faces, unsigned seed) {
  std::mt19937 random(seed);
  const auto coordinate = [&] { return static_cast<float>(random() >> 8) * 0x1p-24f - 0.5f; };
  SourceMesh mesh;
  mesh.name = "overlapping";
  for (unsigned i = 0; i < faces; ++i) {
    std::array<std::uint32_t, 3> corner;
    for (std::uint32_t& c : corner) {
      const float x = coordinate();
      c = add_at(mesh, x, coordinate());
    }
    mesh.faces.push_back({{corner[0], corner[1], corner[2], kNoCorner}});
  }
  return mesh;
}

SourceMesh parallel_plates(unsigned faces) {
  SourceMesh mesh;
  mesh.name = "plates";
  const auto cells = static_cast<unsigned>(std::lround(std::sqrt(faces / 4.0)));
  add_plate(mesh, std::max(1u, cells), 0);
  add_plate(mesh, std::max(1u, cells), 0.25f);
  return mesh;
}

SourceMesh mixed(const SourceMesh& first, const SourceMesh& second) {
  SourceMesh mesh = first;
  mesh.name = first.name + " in " + second.name;
  const auto offset = static_cast<std::uint32_t>(first.positions.size());
  mesh.positions.f32.insert(mesh.positions.f32.end(), second.positions.f32.begin(),
                            second.positions.f32.end());
  mesh.faces.clear();
  for (std::size_t i = 0; i < std::max(first.faces.size(), second.faces.size()); ++i) {
    if (i < first.faces.size()) mesh.faces.push_back(first.faces[i]);
    if (i >= second.faces.size()) continue;
    Face face = second.faces[i];
    for (std::uint32_t& corner : face.corner) corner += corner == kNoCorner ? 0 : offset;
    mesh.faces.push_back(face);
  }
  return mesh;
}

std::vector<SourceMesh> coincident_kinds(unsigned faces) {
  const auto all = [](unsigned n) {
    return std::vector{identical_faces(n), corner_orders(n), overlapping_faces(n, 1),
                       parallel_plates(n)};
  };
  std::vector<SourceMesh> kinds = all(faces);
  const auto rings = static_cast<unsigned>(std::lround(std::sqrt(faces / 8.0)));
  for (const SourceMesh& half : all(faces / 2)) {
    kinds.push_back(mixed(half, sphere(std::max(3u, rings), std::max(4u, 2 * rings))));
  }
  return kinds;
}

}  // namespace boxtree::test
