// SPDX-License-Identifier: MIT
// Makes and changes meshes.
#include "tests/robustness/mesh_kinds.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "tests/unit/primitive/closed_meshes.h"

namespace boxtree::robustness {
namespace {

// Applies change(coordinate, axis) in double; rounds the result once.
template <class Change>
SourceMesh changed(SourceMesh mesh, Change change) {
  const auto apply = [&](auto& positions) {
    using Scalar = std::decay_t<decltype(positions[0])>;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      positions[i] =
          static_cast<Scalar>(change(double{positions[i]}, static_cast<Eigen::Index>(i % 3)));
    }
  };
  apply(mesh.positions.f32);
  apply(mesh.positions.f64);
  return mesh;
}

void add_position(SourceMesh& mesh, const Eigen::Vector3d& p) {
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (mesh.positions.precision == cooker::Precision::kF32) {
      mesh.positions.f32.push_back(static_cast<float>(p[k]));
    } else {
      mesh.positions.f64.push_back(p[k]);
    }
  }
}

}  // namespace

SourceMesh from_triangles(std::string name, const std::vector<Corners>& triangles,
                          cooker::Precision precision) {
  SourceMesh mesh;
  mesh.name = std::move(name);
  mesh.positions.precision = precision;
  for (const Corners& corners : triangles) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Eigen::Vector3d& corner : corners) add_position(mesh, corner);
    mesh.faces.push_back({{first, first + 1, first + 2, cooker::kNoCorner}});
  }
  return mesh;
}

Triangle source_triangle(const SourceMesh& mesh, std::size_t face, std::size_t half) {
  const cooker::Face& f = mesh.faces[face];
  return {{mesh.positions[f.corner[0]], mesh.positions[f.corner[1 + half]],
           mesh.positions[f.corner[2 + half]]}};
}

SourceMesh times(SourceMesh mesh, double factor) {
  return changed(std::move(mesh), [&](double x, Eigen::Index) { return x * factor; });
}

SourceMesh times(SourceMesh mesh, const Eigen::Vector3d& factor) {
  return changed(std::move(mesh), [&](double x, Eigen::Index k) { return x * factor[k]; });
}

SourceMesh plus(SourceMesh mesh, const Eigen::Vector3d& offset) {
  return changed(std::move(mesh), [&](double x, Eigen::Index k) { return x + offset[k]; });
}

SourceMesh in_double(SourceMesh mesh) {
  mesh.positions.precision = cooker::Precision::kF64;
  mesh.positions.f64.assign(mesh.positions.f32.begin(), mesh.positions.f32.end());
  mesh.positions.f32.clear();
  return mesh;
}

SourceMesh snapped(SourceMesh mesh, int exponent) {
  return changed(std::move(mesh), [&](double x, Eigen::Index) {
    return std::ldexp(std::floor(std::ldexp(x, -exponent) + 0.5), exponent);
  });
}

SourceMesh box_mesh(const Eigen::Vector3d& half) {
  SourceMesh mesh;
  mesh.name = "box";
  for (unsigned i = 0; i < 8; ++i) {
    add_position(mesh,
                 half.cwiseProduct(Eigen::Vector3d((i & 1u) != 0 ? 1 : -1, (i & 2u) != 0 ? 1 : -1,
                                                   (i & 4u) != 0 ? 1 : -1)));
  }
  const std::uint32_t sides[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                     {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& s : sides) {
    mesh.faces.push_back({{s[0], s[1], s[2], cooker::kNoCorner}});
    mesh.faces.push_back({{s[0], s[2], s[3], cooker::kNoCorner}});
  }
  return mesh;
}

SourceMesh flat_square(unsigned cells, Eigen::Index axis) {
  SourceMesh mesh;
  mesh.name = "flat square";
  for (unsigned i = 0; i <= cells; ++i) {
    for (unsigned j = 0; j <= cells; ++j) {
      Eigen::Vector3d p = Eigen::Vector3d::Zero();
      p[(axis + 1) % 3] = i;
      p[(axis + 2) % 3] = j;
      add_position(mesh, p);
    }
  }
  for (std::uint32_t i = 0; i < cells; ++i) {
    for (std::uint32_t j = 0; j < cells; ++j) {
      const std::uint32_t at = i * (cells + 1) + j;
      mesh.faces.push_back({{at, at + cells + 1, at + cells + 2, cooker::kNoCorner}});
      mesh.faces.push_back({{at, at + cells + 2, at + 1, cooker::kNoCorner}});
    }
  }
  return mesh;
}

SourceMesh icosphere_mesh(int levels) {
  SourceMesh mesh;
  mesh.name = "icosphere";
  std::map<std::array<float, 3>, std::uint32_t> numbers;
  for (const Triangle& triangle : test::icosphere(levels)) {
    cooker::Face face{{0, 0, 0, cooker::kNoCorner}};
    for (std::size_t c = 0; c < 3; ++c) {
      const Eigen::Vector3f p = triangle.corner[c].cast<float>();
      const auto next = static_cast<std::uint32_t>(numbers.size());
      const auto [place, is_new] = numbers.try_emplace({p[0], p[1], p[2]}, next);
      if (is_new) add_position(mesh, p.cast<double>());
      face.corner[c] = place->second;
    }
    mesh.faces.push_back(face);
  }
  return mesh;
}

}  // namespace boxtree::robustness
