// SPDX-License-Identifier: MIT
// Value noise over integer lattices; boxes of cells.
#include "tests/bench/generated_mesh.h"

#include <algorithm>
#include <array>
#include <bit>

namespace boxtree::bench {
namespace {

using cooker::kNoCorner;
using cooker::SourceMesh;
using Point = std::array<double, 3>;

// The finaliser of SplitMix64 (Steele, Lea, Flood, "Fast splittable pseudorandom number
// generators", 2014).
std::uint64_t mix(std::uint64_t bits) {
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
  return bits ^ (bits >> 31);
}

std::uint64_t hash(std::uint64_t seed, std::int64_t x, std::int64_t y, std::uint64_t what) {
  std::uint64_t bits = mix(seed + 0x9e3779b97f4a7c15u * (what + 1));
  bits = mix(bits ^ static_cast<std::uint64_t>(x));
  return mix(bits ^ static_cast<std::uint64_t>(y));
}

// In [low, high).
double spread(std::uint64_t bits, double low, double high) {
  return low + (high - low) * (static_cast<double>(bits >> 11) * 0x1p-53);
}

std::int64_t floor_division(std::int64_t value, std::int64_t by) {
  return value >= 0 ? value / by : -((by - 1 - value) / by);
}

// Smooth between the lattice points `wavelength` apart, in [-1, 1).
double noise(std::uint64_t seed, std::int64_t x, std::int64_t y, std::int64_t wavelength) {
  const std::int64_t i = floor_division(x, wavelength), j = floor_division(y, wavelength);
  const auto lattice = [&](std::int64_t a, std::int64_t b) {
    return spread(hash(seed, a, b, static_cast<std::uint64_t>(wavelength)), -1, 1);
  };
  const auto smooth = [&](std::int64_t offset) {
    const double t = static_cast<double>(offset) / static_cast<double>(wavelength);
    return t * t * (3 - 2 * t);
  };
  const double u = smooth(x - i * wavelength), v = smooth(y - j * wavelength);
  const double below = lattice(i, j) + (lattice(i + 1, j) - lattice(i, j)) * u;
  const double above = lattice(i, j + 1) + (lattice(i + 1, j + 1) - lattice(i, j + 1)) * u;
  return below + (above - below) * v;
}

// Octaves from `wavelength` down to `finest`. Each has half the wavelength of the previous one and
// a little less than half its height, so that slopes stay similar and small features are not all
// spikes.
double height_at(std::uint64_t seed, std::int64_t x, std::int64_t y, std::int64_t wavelength,
                 std::int64_t finest) {
  double height = 0;
  double amplitude = static_cast<double>(wavelength) * 0.3;
  for (; wavelength >= finest; wavelength /= 2, amplitude *= 0.47) {
    height += amplitude * noise(seed, x, y, wavelength);
  }
  return height;
}

std::uint32_t add_vertex(SourceMesh& mesh, const Point& at) {
  for (const double coordinate : at) {
    mesh.positions.f32.push_back(static_cast<float>(coordinate));
  }
  return static_cast<std::uint32_t>(mesh.positions.size() - 1);
}

// Collects triangles up to the requested number; further ones are dropped.
class Canvas {
 public:
  Canvas(SourceMesh& mesh, std::size_t triangles) : mesh_(mesh), left_(triangles) {
    mesh.faces.reserve(triangles);
  }

  [[nodiscard]] std::size_t left() const { return left_; }

  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (left_ == 0) return;
    mesh_.faces.push_back({{a, b, c, kNoCorner}});
    --left_;
  }

  // A grid of cells, two triangles each, over points (0, 0) to (columns, rows).
  template <class PointAt>
  void add_grid(std::size_t columns, std::size_t rows, const PointAt& point_at) {
    const std::size_t width = columns + 1;
    // Rows without triangles would have vertices of no face.
    rows = std::min(rows, (left_ + 2 * columns - 1) / (2 * columns));
    if (rows == 0) return;
    const std::size_t first = mesh_.positions.size();
    for (std::size_t row = 0; row <= rows; ++row) {
      for (std::size_t column = 0; column < width; ++column) {
        add_vertex(mesh_, point_at(column, row));
      }
    }
    for (std::size_t row = 0; row < rows; ++row) {
      for (std::size_t column = 0; column < columns; ++column) {
        const auto corner = static_cast<std::uint32_t>(first + row * width + column);
        const auto above = static_cast<std::uint32_t>(corner + width);
        add_triangle(corner, corner + 1, above + 1);
        add_triangle(corner, above + 1, above);
      }
    }
  }

 private:
  SourceMesh& mesh_;
  std::size_t left_;
};

constexpr std::int64_t kLotMetres = 64;
constexpr std::int64_t kLotCells = 4;
constexpr double kStreetMetres = 12;

double ground_at(std::uint64_t seed, std::int64_t x, std::int64_t y) {
  return 0.1 * height_at(seed, x, y, 1024, 64);
}

struct Building {
  Point centre;       // of the floor
  Point size;         // along the building's axes
  double cosine = 1;  // of the angle of rotation
  double sine = 0;
  double cell = 1;  // metres between vertices of the facades
};

std::size_t cells_along(double length, double cell) {
  return std::max<std::size_t>(1, static_cast<std::size_t>(length / cell));
}

std::size_t triangles_of(const Building& building, double cell) {
  const std::size_t x = cells_along(building.size[0], cell);
  const std::size_t y = cells_along(building.size[1], cell);
  const std::size_t z = cells_along(building.size[2], cell);
  return 2 * (2 * x * z + 2 * y * z + x * y);
}

// Four walls and a roof.
void add_building(Canvas& canvas, const Building& building) {
  std::array<std::size_t, 3> cells{};
  for (std::size_t k = 0; k < 3; ++k) cells[k] = cells_along(building.size[k], building.cell);
  const auto point = [&](std::size_t i, std::size_t j, std::size_t k) -> Point {
    const auto along = [&](std::size_t axis, std::size_t step) {
      return building.size[axis] * static_cast<double>(step) / static_cast<double>(cells[axis]);
    };
    const double x = along(0, i) - building.size[0] / 2, y = along(1, j) - building.size[1] / 2;
    return {building.centre[0] + building.cosine * x - building.sine * y,
            building.centre[1] + building.sine * x + building.cosine * y,
            building.centre[2] + along(2, k)};
  };
  const std::size_t nx = cells[0], ny = cells[1], nz = cells[2];
  canvas.add_grid(nx, nz, [&](std::size_t a, std::size_t b) { return point(a, 0, b); });
  canvas.add_grid(nx, nz, [&](std::size_t a, std::size_t b) { return point(nx - a, ny, b); });
  canvas.add_grid(ny, nz, [&](std::size_t a, std::size_t b) { return point(0, ny - a, b); });
  canvas.add_grid(ny, nz, [&](std::size_t a, std::size_t b) { return point(nx, a, b); });
  canvas.add_grid(nx, ny, [&](std::size_t a, std::size_t b) { return point(a, b, nz); });
}

// One of `across` x `across` buildings of a lot.
Building design(std::uint64_t seed, std::int64_t lot_x, std::int64_t lot_y, std::int64_t across,
                std::int64_t place) {
  const auto roll = [&](std::uint64_t what) {
    return hash(seed, lot_x, lot_y, 100 + 16 * static_cast<std::uint64_t>(place) + what);
  };
  const double room =
      (static_cast<double>(kLotMetres) - kStreetMetres) / static_cast<double>(across);
  Building building;
  const auto from_street = [&](std::int64_t lot, std::int64_t number) {
    return static_cast<double>(lot * kLotMetres) + kStreetMetres +
           room * (static_cast<double>(number) + 0.5);
  };
  building.centre = {from_street(lot_x, place % across), from_street(lot_y, place / across),
                     ground_at(seed, lot_x * kLotMetres, lot_y * kLotMetres) - 2};
  const double highest = across == 1 ? 300 : across == 2 ? 40 : 8;
  const double tall = spread(roll(0), 0, 1);
  building.size = {spread(roll(1), 0.5, 0.9) * room, spread(roll(2), 0.5, 0.9) * room,
                   5 + tall * tall * highest};
  building.cell = std::array{0.5, 0.5, 1.0, 1.0, 2.0, 4.0, 8.0, 1000.0}[roll(3) % 8];
  if (roll(4) % 4 == 0) {
    // Angles of Pythagorean triples; rotated buildings are smaller, to stay on their own ground.
    const auto turn =
        std::array<std::array<double, 3>, 3>{{{3, 4, 5}, {12, 5, 13}, {15, 8, 17}}}[roll(5) % 3];
    building.cosine = turn[0] / turn[2];
    building.sine = turn[1] / turn[2];
    building.size[0] *= 0.7;
    building.size[1] *= 0.7;
  }
  return building;
}

void add_lot(Canvas& canvas, std::uint64_t seed, std::int64_t lot_x, std::int64_t lot_y) {
  canvas.add_grid(kLotCells, kLotCells, [&](std::size_t a, std::size_t b) -> Point {
    const std::int64_t step = kLotMetres / kLotCells;
    const std::int64_t x = lot_x * kLotMetres + static_cast<std::int64_t>(a) * step;
    const std::int64_t y = lot_y * kLotMetres + static_cast<std::int64_t>(b) * step;
    return {static_cast<double>(x), static_cast<double>(y), ground_at(seed, x, y)};
  });
  const std::int64_t across = std::array{1, 2, 2, 4}[hash(seed, lot_x, lot_y, 99) % 4];
  for (std::int64_t place = 0; place < across * across; ++place) {
    Building building = design(seed, lot_x, lot_y, across, place);
    // Makes cells coarser, so that no building takes most of a small mesh.
    while (triangles_of(building, building.cell) > canvas.left() / 4 && building.cell < 1000) {
      building.cell *= 2;
    }
    if (triangles_of(building, building.cell) <= canvas.left()) add_building(canvas, building);
  }
}

}  // namespace

SourceMesh make_terrain(std::size_t triangles, std::uint64_t seed) {
  SourceMesh mesh;
  mesh.name = "terrain";
  std::size_t columns = 1;
  while (2 * (columns + 1) * (columns + 1) <= triangles) ++columns;
  const std::size_t rows = (triangles + 2 * columns - 1) / (2 * columns);
  const auto longest = static_cast<std::int64_t>(std::max<std::size_t>(std::bit_ceil(columns), 8));
  Canvas canvas(mesh, triangles);
  canvas.add_grid(columns, rows, [&](std::size_t column, std::size_t row) -> Point {
    const auto x = static_cast<std::int64_t>(column), y = static_cast<std::int64_t>(row);
    return {static_cast<double>(x), static_cast<double>(y), height_at(seed, x, y, longest / 4, 2)};
  });
  return mesh;
}

SourceMesh make_city(std::size_t triangles, std::uint64_t seed) {
  SourceMesh mesh;
  mesh.name = "city";
  Canvas canvas(mesh, triangles);
  // Lots in a square spiral: sides of 1, 1, 2, 2, 3, 3, ... lots.
  std::int64_t x = 0, y = 0, step_x = 1, step_y = 0;
  for (std::int64_t side = 2; canvas.left() > 0; ++side) {
    for (std::int64_t lot = 0; lot < side / 2; ++lot) {
      add_lot(canvas, seed, x, y);
      x += step_x;
      y += step_y;
    }
    const std::int64_t turned = -step_y;
    step_y = step_x;
    step_x = turned;
  }
  return mesh;
}

}  // namespace boxtree::bench
