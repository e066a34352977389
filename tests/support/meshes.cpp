// SPDX-License-Identifier: MIT
// Generators of test meshes.
#include "tests/support/meshes.h"

#include <cmath>
#include <numbers>
#include <random>

namespace boxtree::test {
namespace {

using cooker::kNoCorner;

// Uniform in [low, high) by integer arithmetic: the same for every standard library.
float uniform(std::mt19937& random, float low, float high) {
  return low + (high - low) * (static_cast<float>(random() >> 8) * 0x1p-24f);
}

std::uint32_t add_vertex(SourceMesh& mesh, float x, float y, float z) {
  mesh.positions.f32.insert(mesh.positions.f32.end(), {x, y, z});
  return static_cast<std::uint32_t>(mesh.positions.size() - 1);
}

void add_triangle(SourceMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  mesh.faces.push_back({{a, b, c, kNoCorner}});
}

// A grid of rings x segments points that is closed in both directions, as a torus.
template <class Point>
SourceMesh closed_grid(std::string name, unsigned rings, unsigned segments, Point point) {
  SourceMesh mesh;
  mesh.name = std::move(name);
  for (unsigned i = 0; i < rings; ++i) {
    for (unsigned j = 0; j < segments; ++j) point(mesh, i, j);
  }
  const auto at = [&](unsigned i, unsigned j) { return (i % rings) * segments + j % segments; };
  for (unsigned i = 0; i < rings; ++i) {
    for (unsigned j = 0; j < segments; ++j) {
      add_triangle(mesh, at(i, j), at(i + 1, j), at(i + 1, j + 1));
      add_triangle(mesh, at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
  return mesh;
}

}  // namespace

SourceMesh sphere(unsigned rings, unsigned segments) {
  SourceMesh mesh;
  mesh.name = "sphere";
  const std::uint32_t north = add_vertex(mesh, 0, 0, 1);
  for (unsigned i = 1; i < rings; ++i) {
    const float theta =
        std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(rings);
    for (unsigned j = 0; j < segments; ++j) {
      const float phi =
          2 * std::numbers::pi_v<float> * static_cast<float>(j) / static_cast<float>(segments);
      add_vertex(mesh, std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                 std::cos(theta));
    }
  }
  const std::uint32_t south = add_vertex(mesh, 0, 0, -1);
  const auto at = [&](unsigned i, unsigned j) { return 1 + (i - 1) * segments + j % segments; };
  for (unsigned j = 0; j < segments; ++j) {
    add_triangle(mesh, north, at(1, j), at(1, j + 1));
    add_triangle(mesh, south, at(rings - 1, j + 1), at(rings - 1, j));
    for (unsigned i = 1; i + 1 < rings; ++i) {
      add_triangle(mesh, at(i, j), at(i + 1, j), at(i + 1, j + 1));
      add_triangle(mesh, at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
  return mesh;
}

SourceMesh torus(unsigned rings, unsigned segments) {
  return closed_grid("torus", rings, segments, [&](SourceMesh& mesh, unsigned i, unsigned j) {
    const float u =
        2 * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(rings);
    const float v =
        2 * std::numbers::pi_v<float> * static_cast<float>(j) / static_cast<float>(segments);
    const float radius = 1 + 0.4f * std::cos(v);
    add_vertex(mesh, radius * std::cos(u), radius * std::sin(u), 0.4f * std::sin(v));
  });
}

SourceMesh terrain(unsigned cells, unsigned seed) {
  std::mt19937 random(seed);
  SourceMesh mesh;
  mesh.name = "terrain";
  for (unsigned i = 0; i <= cells; ++i) {
    for (unsigned j = 0; j <= cells; ++j) {
      add_vertex(mesh, static_cast<float>(i), static_cast<float>(j), uniform(random, 0, 2));
    }
  }
  for (unsigned i = 0; i < cells; ++i) {
    for (unsigned j = 0; j < cells; ++j) {
      const std::uint32_t corner = i * (cells + 1) + j;
      add_triangle(mesh, corner, corner + cells + 1, corner + cells + 2);
      add_triangle(mesh, corner, corner + cells + 2, corner + 1);
    }
  }
  return mesh;
}

SourceMesh city(unsigned blocks, unsigned seed) {
  std::mt19937 random(seed);
  SourceMesh mesh;
  mesh.name = "city";
  for (unsigned block = 0; block < blocks; ++block) {
    const auto x = static_cast<float>(block % 8);
    const auto y = static_cast<float>(block / 8);
    const float height = 1 + static_cast<float>(random() % 4);
    std::uint32_t v[8];
    for (unsigned i = 0; i < 8; ++i) {
      v[i] = add_vertex(mesh, x + static_cast<float>(i & 1u), y + static_cast<float>(i >> 1 & 1u),
                        (i & 4u) != 0 ? height : 0);
    }
    const unsigned sides[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                  {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (const auto& side : sides) {
      mesh.faces.push_back({{v[side[0]], v[side[1]], v[side[2]], v[side[3]]}});
    }
  }
  return mesh;
}

SourceMesh soup(unsigned faces, unsigned seed) {
  std::mt19937 random(seed);
  SourceMesh mesh;
  mesh.name = "soup";
  for (unsigned face = 0; face < faces; ++face) {
    const float x = uniform(random, -5, 5);
    const float y = uniform(random, -5, 5);
    const float z = uniform(random, -5, 5);
    std::uint32_t v[3];
    for (std::uint32_t& corner : v) {
      corner = add_vertex(mesh, x + uniform(random, -1, 1), y + uniform(random, -1, 1),
                          z + uniform(random, -1, 1));
    }
    add_triangle(mesh, v[0], v[1], v[2]);
  }
  return mesh;
}

SourceMesh slivers(unsigned faces, unsigned seed) {
  std::mt19937 random(seed);
  SourceMesh mesh;
  mesh.name = "slivers";
  for (unsigned face = 0; face < faces; ++face) {
    const float x = uniform(random, -5, 5);
    const float y = uniform(random, -5, 5);
    const float z = uniform(random, -5, 5);
    const std::uint32_t a = add_vertex(mesh, x, y, z);
    const std::uint32_t b = add_vertex(mesh, x + uniform(random, -9, 9), y + uniform(random, -9, 9),
                                       z + uniform(random, -9, 9));
    add_triangle(mesh, a, b, add_vertex(mesh, x + 1e-5f, y - 1e-5f, z));
  }
  return mesh;
}

SourceMesh duplicates(unsigned copies) {
  SourceMesh mesh;
  mesh.name = "duplicates";
  const std::uint32_t a = add_vertex(mesh, 0, 0, 0);
  const std::uint32_t b = add_vertex(mesh, 1, 0, 0.25f);
  const std::uint32_t c = add_vertex(mesh, 0, 1, 0.5f);
  for (unsigned i = 0; i < copies; ++i) add_triangle(mesh, a, b, c);
  return mesh;
}

SourceMesh huge_among_tiny(unsigned tiny, unsigned seed) {
  std::mt19937 random(seed);
  SourceMesh mesh;
  mesh.name = "huge_among_tiny";
  add_triangle(mesh, add_vertex(mesh, -1000, -1000, 0), add_vertex(mesh, 1000, -1000, 0),
               add_vertex(mesh, 0, 1000, 1));
  for (unsigned i = 0; i < tiny; ++i) {
    const float x = uniform(random, -1, 1);
    const float y = uniform(random, -1, 1);
    const float z = uniform(random, -1, 1);
    add_triangle(mesh, add_vertex(mesh, x, y, z), add_vertex(mesh, x + 1e-3f, y, z),
                 add_vertex(mesh, x, y + 1e-3f, z + 1e-3f));
  }
  return mesh;
}

std::vector<SourceMesh> all_kinds() {
  return {sphere(16, 24),  torus(20, 12),   terrain(16, 1),          city(24, 2),   soup(400, 3),
          slivers(200, 4), duplicates(100), huge_among_tiny(200, 5), duplicates(1), duplicates(2)};
}

}  // namespace boxtree::test
