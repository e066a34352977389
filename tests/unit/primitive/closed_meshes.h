// SPDX-License-Identifier: MIT
// Two closed surfaces, triangles sharing their corners bit for bit.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "runtime/primitive/triangle.h"

namespace boxtree::test {

/// The unit sphere from an icosahedron whose faces are split `levels` times.
inline std::vector<Triangle> icosphere(int levels) {
  const double g = std::numbers::phi;
  const std::array<Eigen::Vector3d, 12> v = {{{-1, g, 0},
                                              {1, g, 0},
                                              {-1, -g, 0},
                                              {1, -g, 0},
                                              {0, -1, g},
                                              {0, 1, g},
                                              {0, -1, -g},
                                              {0, 1, -g},
                                              {g, 0, -1},
                                              {g, 0, 1},
                                              {-g, 0, -1},
                                              {-g, 0, 1}}};
  constexpr std::array<std::array<std::size_t, 3>, 20> kFaces = {
      {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
       {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
       {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
  std::vector<Triangle> faces;
  for (const auto& f : kFaces) {
    faces.push_back({{v[f[0]].normalized(), v[f[1]].normalized(), v[f[2]].normalized()}});
  }
  for (int level = 0; level < levels; ++level) {
    std::vector<Triangle> finer;
    for (const Triangle& t : faces) {
      // Addition commutes exactly, so both faces at an edge compute the same middle.
      const auto& [a, b, c] = t.corner;
      const Eigen::Vector3d ab = (a + b).normalized(), bc = (b + c).normalized(),
                            ca = (c + a).normalized();
      finer.insert(finer.end(), {{{a, ab, ca}}, {{b, bc, ab}}, {{c, ca, bc}}, {{ab, bc, ca}}});
    }
    faces.swap(finer);
  }
  return faces;
}

/// A torus around z: main radius 3, tube radius 1.
inline std::vector<Triangle> torus(int around, int tube) {
  const auto vertex = [&](int i, int j) -> Eigen::Vector3d {
    const double u = 2 * std::numbers::pi * (i % around) / around;
    const double v = 2 * std::numbers::pi * (j % tube) / tube;
    const double r = 3 + std::cos(v);
    return {r * std::cos(u), r * std::sin(u), std::sin(v)};
  };
  std::vector<Triangle> faces;
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < tube; ++j) {
      const Eigen::Vector3d a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i + 1, j + 1),
                            d = vertex(i, j + 1);
      faces.push_back({{a, b, c}});
      faces.push_back({{a, c, d}});
    }
  }
  return faces;
}

}  // namespace boxtree::test
