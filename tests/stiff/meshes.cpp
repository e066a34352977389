// SPDX-License-Identifier: MIT
// Height fields, stairs and walls.
#include "tests/stiff/meshes.h"

#include <array>
#include <cmath>
#include <numbers>

namespace boxtree::stiff {
namespace {

using cooker::kNoCorner;

std::uint32_t add_vertex(SourceMesh& mesh, const Eigen::Vector3d& at) {
  for (const double coordinate : at) mesh.positions.f32.push_back(static_cast<float>(coordinate));
  return static_cast<std::uint32_t>(mesh.positions.size() - 1);
}

void add_quad(SourceMesh& mesh, const std::array<Eigen::Vector3d, 4>& corners) {
  cooker::Face face{};
  for (std::size_t i = 0; i < 4; ++i) face.corner[i] = add_vertex(mesh, corners[i]);
  mesh.faces.push_back(face);
}

// 10 degrees about an axis that is no edge of the grid.
constexpr double kTiltRadians = 10 * std::numbers::pi / 180;

double height_at(Field field, double x, double y, double size) {
  switch (field) {
    case Field::kFlat:
      return kFlatHeight;
    case Field::kSine: {
      const double wave = 2 * std::numbers::pi * kSineWaves / size;
      return kSineHeight * std::sin(wave * x) * std::sin(wave * y);
    }
    case Field::kTilted: {
      const Eigen::Vector3d normal = tilted_normal();
      return -(normal.x() * x + normal.y() * y) / normal.z();
    }
  }
  return 0;
}

}  // namespace

SourceMesh box(const Eigen::Vector3d& half_extents) {
  SourceMesh mesh;
  mesh.name = "box";
  for (unsigned i = 0; i < 8; ++i) {
    const Eigen::Vector3d side((i & 1u) != 0 ? 1 : -1, (i & 2u) != 0 ? 1 : -1,
                               (i & 4u) != 0 ? 1 : -1);
    add_vertex(mesh, side.cwiseProduct(half_extents));
  }
  constexpr std::array<std::array<std::uint32_t, 4>, 6> kSides = {
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  for (const auto& side : kSides) {
    mesh.faces.push_back({{side[0], side[1], side[2], kNoCorner}});
    mesh.faces.push_back({{side[0], side[2], side[3], kNoCorner}});
  }
  return mesh;
}

SourceMesh stairs(unsigned steps, unsigned cells, double size) {
  SourceMesh mesh;
  mesh.name = "stairs";
  const double tread = size / steps;
  const double width = size / cells;
  for (unsigned i = 0; i < steps; ++i) {
    const double front = -size / 2 + tread * i;
    const double back = front + tread;
    const double below = double{kStairRise} * i;
    const double top = double{kStairRise} * (i + 1);
    for (unsigned j = 0; j < cells; ++j) {
      const double left = -size / 2 + width * j;
      const double right = left + width;
      add_quad(
          mesh,
          {{{front, left, below}, {front, left, top}, {front, right, top}, {front, right, below}}});
      add_quad(mesh,
               {{{front, left, top}, {back, left, top}, {back, right, top}, {front, right, top}}});
    }
  }
  return mesh;
}

Eigen::Vector3d tread_middle(unsigned step, unsigned steps, double size) {
  const auto top = static_cast<float>(double{kStairRise} * (step + 1));
  return {-size / 2 + size / steps * (step + 0.5), 0, top};
}

Eigen::Vector3d tilted_normal() {
  constexpr double kAzimuth = 0.4;
  return {std::sin(kTiltRadians) * std::cos(kAzimuth), std::sin(kTiltRadians) * std::sin(kAzimuth),
          std::cos(kTiltRadians)};
}

SourceMesh field(Field field, unsigned cells, double size) {
  SourceMesh mesh;
  mesh.name = "field";
  const double cell = size / cells;
  for (unsigned j = 0; j <= cells; ++j) {
    for (unsigned i = 0; i <= cells; ++i) {
      const double x = -size / 2 + cell * i;
      const double y = -size / 2 + cell * j;
      add_vertex(mesh, {x, y, height_at(field, x, y, size)});
    }
  }
  for (unsigned j = 0; j < cells; ++j) {
    for (unsigned i = 0; i < cells; ++i) {
      const std::uint32_t corner = j * (cells + 1) + i;
      const std::uint32_t above = corner + cells + 1;
      mesh.faces.push_back({{corner, corner + 1, above + 1, kNoCorner}});
      mesh.faces.push_back({{corner, above + 1, above, kNoCorner}});
    }
  }
  return mesh;
}

double wall_front(unsigned wall, unsigned walls, double size) {
  // At no even distances, whose cuts f16 would hold.
  const double place = wall + 0.37 + 0.006 * wall * wall;
  return static_cast<float>(-size / 2 + size / walls * place);
}

SourceMesh walls(unsigned walls, double thickness, double size) {
  SourceMesh mesh;
  mesh.name = "walls";
  constexpr double kCell = 0.25;
  constexpr unsigned kCells = 8;
  for (unsigned w = 0; w < walls; ++w) {
    const double front = wall_front(w, walls, size);
    const double back = front + thickness;
    for (unsigned i = 0; i < kCells; ++i) {
      for (unsigned j = 0; j < kCells; ++j) {
        const double y = -1 + kCell * i;
        const double z = -1 + kCell * j;
        const double u = y + kCell;
        const double v = z + kCell;
        add_quad(mesh, {{{front, y, z}, {front, y, v}, {front, u, v}, {front, u, z}}});
        add_quad(mesh, {{{back, y, z}, {back, u, z}, {back, u, v}, {back, y, v}}});
      }
    }
  }
  return mesh;
}

}  // namespace boxtree::stiff
