// SPDX-License-Identifier: MIT
// One function a mesh.
#include "tests/same_bytes/meshes.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <random>
#include <utility>

#include "tests/bench/generated_mesh.h"

namespace boxtree::same_bytes {
namespace {

using cooker::kNoCorner;
using cooker::Precision;
using cooker::SourceMesh;
using Point = std::array<double, 3>;

// Distributions of the standard library may differ; its engines may not.
class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) : engine_(seed) {}

  // In [low, high).
  double within(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
  }
  Point point(double low, double high) {
    return {within(low, high), within(low, high), within(low, high)};
  }
  // In [0, count).
  int below(int count) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(count)); }

 private:
  std::mt19937_64 engine_;
};

SourceMesh named(SourceMesh mesh, const char* name) {
  mesh.name = name;
  return mesh;
}

SourceMesh empty(const char* name, Precision precision = Precision::kF32) {
  SourceMesh mesh;
  mesh.name = name;
  mesh.positions.precision = precision;
  return mesh;
}

std::uint32_t add_vertex(SourceMesh& mesh, const Point& at) {
  for (const double coordinate : at) {
    if (mesh.positions.precision == Precision::kF32) {
      mesh.positions.f32.push_back(static_cast<float>(coordinate));
    } else {
      mesh.positions.f64.push_back(coordinate);
    }
  }
  return static_cast<std::uint32_t>(mesh.positions.size() - 1);
}

// A face with vertices of its own: three or four.
void add_face(SourceMesh& mesh, std::initializer_list<Point> corners) {
  cooker::Face face{{0, 0, 0, kNoCorner}};
  std::size_t corner = 0;
  for (const Point& at : corners) face.corner[corner++] = add_vertex(mesh, at);
  mesh.faces.push_back(face);
}

Point sum(const Point& a, const Point& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

// Few different triangles, many times, from each of their corners and from both sides.
SourceMesh coincident() {
  Numbers numbers(1);
  SourceMesh mesh = empty("coincident");
  std::vector<std::array<Point, 3>> triangles(5);
  for (auto& triangle : triangles) {
    for (Point& corner : triangle) corner = numbers.point(-1, 1);
  }
  for (std::size_t i = 0; i < 1300; ++i) {
    const auto& triangle = triangles[i * i % triangles.size()];
    const Point &a = triangle[i % 3], &b = triangle[(i + 1) % 3], &c = triangle[(i + 2) % 3];
    if (i % 2 == 0) {
      add_face(mesh, {a, b, c});
    } else {
      add_face(mesh, {a, c, b});
    }
  }
  return mesh;
}

// A thousand units long, down to less than a billionth wide; every tenth without area.
SourceMesh slivers() {
  Numbers numbers(2);
  SourceMesh mesh = empty("slivers");
  for (int i = 0; i < 1500; ++i) {
    const Point from = numbers.point(-500, 500);
    const Point along = numbers.point(-500, 500);
    const double width = i % 10 == 0 ? 0 : std::ldexp(1.0, -numbers.below(40));
    const Point aside = numbers.point(-width, width);
    add_face(mesh, {from, sum(from, along),
                    sum(sum(from, {along[0] / 2, along[1] / 2, along[2] / 2}), aside)});
  }
  return mesh;
}

// Sizes from 2^-60 to 2^60 in one mesh.
SourceMesh scales() {
  Numbers numbers(3);
  SourceMesh mesh = empty("scales");
  for (int i = 0; i < 1500; ++i) {
    const double size = std::ldexp(1.0, numbers.below(121) - 60);
    const Point from = numbers.point(-size, size);
    add_face(mesh,
             {from, sum(from, numbers.point(-size, size)), sum(from, numbers.point(-size, size))});
  }
  return mesh;
}

// Cubes around the points of a lattice: every centre and every cost many times, planes through zero
// with both signs of it.
SourceMesh lattice() {
  Numbers numbers(4);
  SourceMesh mesh = empty("lattice");
  constexpr int kAcross = 8;
  for (int cube = 0; cube < kAcross * kAcross * kAcross; ++cube) {
    const std::array<int, 3> low = {cube % kAcross, cube / kAcross % kAcross,
                                    cube / kAcross / kAcross};
    const auto corner = [&](unsigned i) {
      Point at{};
      for (std::size_t k = 0; k < 3; ++k) {
        at[k] = low[k] + static_cast<int>(i >> k & 1u);
        if (at[k] == 0 && numbers.below(2) == 0) at[k] = -0.0;
      }
      return at;
    };
    for (unsigned axis = 0; axis < 3; ++axis) {
      const unsigned u = 1u << (axis + 1) % 3, v = 1u << (axis + 2) % 3;
      for (const unsigned side : {0u, 1u << axis}) {
        const Point a = corner(side), b = corner(side | u), c = corner(side | u | v);
        add_face(mesh, {a, b, c});
        add_face(mesh, {a, c, corner(side | v)});
      }
    }
  }
  return mesh;
}

// A flat sheet of quads, some of them cut in two triangles that share a face id.
SourceMesh quads() {
  Numbers numbers(5);
  SourceMesh mesh = empty("quads");
  constexpr std::uint32_t kAcross = 40;
  for (std::uint32_t row = 0; row <= kAcross; ++row) {
    for (std::uint32_t column = 0; column <= kAcross; ++column) {
      // Sheared, so that boxes overlap; whole numbers, so that the sheet is flat.
      add_vertex(mesh, {5.0 * column + 2.0 * row, 3.0 * row - 1.0 * column, 1.0 * column + row});
    }
  }
  std::uint32_t id = 0;
  for (std::uint32_t row = 0; row < kAcross; ++row) {
    for (std::uint32_t column = 0; column < kAcross; ++column, ++id) {
      const std::uint32_t a = row * (kAcross + 1) + column, d = a + kAcross + 1;
      if (numbers.below(4) != 0) {
        mesh.faces.push_back({{a, a + 1, d + 1, d}});
        mesh.face_ids.push_back(id);
        continue;
      }
      mesh.faces.push_back({{a, a + 1, d + 1, kNoCorner}});
      mesh.faces.push_back({{a, d + 1, d, kNoCorner}});
      mesh.face_ids.insert(mesh.face_ids.end(), {id, id});
    }
  }
  return mesh;
}

// In double precision, some hundred metres at the surface of the earth from its centre.
SourceMesh doubles() {
  Numbers numbers(6);
  SourceMesh mesh = empty("doubles", Precision::kF64);
  const Point centre = {3805512.7310846, 664803.4192057, 5056874.1528193};
  for (int i = 0; i < 1500; ++i) {
    const Point from = sum(centre, numbers.point(-200, 200));
    add_face(mesh, {from, sum(from, numbers.point(-3, 3)), sum(from, numbers.point(-3, 3))});
  }
  return mesh;
}

// Coordinates up to the ends of the range of float: a machine that flushes subnormals to zero, or
// that lets differences overflow, shows it here.
SourceMesh up_to(const char* name, double largest) {
  Numbers numbers(7);
  SourceMesh mesh = empty(name);
  for (int i = 0; i < 200; ++i) {
    add_face(mesh, {numbers.point(-largest, largest), numbers.point(-largest, largest),
                    numbers.point(-largest, largest)});
  }
  return mesh;
}

// In the plane of zero, with both signs of it.
SourceMesh few(const char* name, int faces) {
  Numbers numbers(8);
  SourceMesh mesh = empty(name, Precision::kF64);
  const auto corner = [&]() -> Point {
    return {numbers.within(-1, 1), numbers.within(-1, 1), numbers.below(2) == 0 ? 0.0 : -0.0};
  };
  for (int i = 0; i < faces; ++i) {
    const Point a = corner(), b = corner();
    add_face(mesh, {a, b, corner()});
  }
  return mesh;
}

}  // namespace

std::vector<SourceMesh> meshes() {
  std::vector<SourceMesh> all;
  // Large enough for every stage to divide its work among threads.
  all.push_back(named(bench::make_terrain(17000, 1), "terrain"));
  all.push_back(named(bench::make_city(3000, 1), "city"));
  all.push_back(coincident());
  all.push_back(slivers());
  all.push_back(scales());
  all.push_back(lattice());
  all.push_back(quads());
  all.push_back(doubles());
  all.push_back(up_to("faint", 0x1p-130));
  all.push_back(up_to("vast", 0x1.fp127));
  all.push_back(few("nine-faces", 9));
  all.push_back(few("one-face", 1));
  all.push_back(few("no-face", 0));
  return all;
}

}  // namespace boxtree::same_bytes
