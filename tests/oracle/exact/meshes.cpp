// SPDX-License-Identifier: MIT
// Kinds of meshes: each fills a list of triangles, which are then rounded to the precision.
#include "tests/oracle/exact/meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "tests/oracle/exact/geometry.h"

namespace boxtree::oracle {
namespace {

using cooker::Precision;
using cooker::SourceMesh;

struct Sketch {
  std::vector<Face> faces;
  std::vector<bool> is_quad;  // the face goes on to the parallelogram's fourth corner
};

Point unit_point(Draw& d) {
  return {d.unit(), d.unit(), d.unit()};
}
Point add(const Point& a, const Point& b, double factor = 1) {
  return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
}
Face scaled(Face t, double factor) {
  for (Point& c : t) {
    for (double& x : c) x *= factor;
  }
  return t;
}
Face soup_face(Draw& d) {
  return {unit_point(d), unit_point(d), unit_point(d)};
}

using Maker = void (*)(Draw&, std::uint32_t, bool, Sketch&);

// Exponents that leave room for the mantissa of the precision.
int low_exponent(bool f64) {
  return f64 ? -990 : -120;
}
int high_exponent(bool f64) {
  return f64 ? 1010 : 120;
}

void soup(Draw& d, std::uint32_t n, bool f64, Sketch& s) {
  const double size = d.one_in(2) ? 1 : d.power(low_exponent(f64), high_exponent(f64));
  for (std::uint32_t i = 0; i < n; ++i) s.faces.push_back(scaled(soup_face(d), size));
}

void small_faces(Draw& d, std::uint32_t n, bool f64, Sketch& s) {
  const double size = d.one_in(2) ? 1 : d.power(low_exponent(f64), high_exponent(f64));
  for (std::uint32_t i = 0; i < n; ++i) {
    const Point at = unit_point(d);
    Face t = scaled(soup_face(d), 0.25);
    for (Point& c : t) c = add(c, at);
    s.faces.push_back(scaled(t, size));
  }
}

void any_numbers(Draw& d, std::uint32_t n, bool f64, Sketch& s) {
  for (std::uint32_t i = 0; i < n; ++i) {
    Face t;
    for (Point& c : t) {
      for (double& x : c) x = f64 ? d.any_f64() : double{d.any_f32()};
    }
    s.faces.push_back(t);
  }
}

void mixed_sizes(Draw& d, std::uint32_t n, bool f64, Sketch& s) {
  const int low = f64 ? -900 : -116, high = f64 ? 900 : 100;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double size = d.power(low, high);
    Face t = scaled(soup_face(d), size);
    if (d.one_in(2)) {  // somewhere among larger ones
      const Point at = unit_point(d);
      const double away = size * d.power(0, 40);
      for (Point& c : t) c = add(c, at, away);
    }
    s.faces.push_back(t);
  }
}

void tiny_beside_huge(Draw& d, std::uint32_t n, bool f64, Sketch& s) {
  // Half of the time as far apart as the precision lets them be.
  const bool apart = d.one_in(2);
  const int top = f64 ? 1000 : 126, bottom = f64 ? -900 : -140;
  const int huge = d.between(apart ? top - 20 : 20, top);
  const int tiny = d.between(bottom, apart ? bottom + 40 : 0);
  for (std::uint32_t i = 0; i < n; ++i) {
    s.faces.push_back(scaled(soup_face(d), std::ldexp(1.0, d.one_in(2) ? huge : tiny)));
  }
}

Face needle(Draw& d, double sine) {
  const Point a = unit_point(d), along = unit_point(d), aside = unit_point(d);
  const Point b = add(a, along);
  return {a, b, add(add(a, along, d.part()), aside, sine)};
}

void needles(Draw& d, std::uint32_t n, bool f64, Sketch& s) {
  const double size = d.one_in(2) ? 1 : d.power(low_exponent(f64), high_exponent(f64));
  for (std::uint32_t i = 0; i < n; ++i) {
    // Rounding of the corners bends thinner ones into what the precision holds; those with an end
    // in the origin keep a sine of any size.
    const double sine = std::pow(10.0, -20 * d.part());
    Face t = needle(d, sine);
    if (d.one_in(3)) {
      t = {Point{0, 0, 0}, Point{1, 0, 0}, Point{d.part(), sine * d.unit(), sine * d.unit()}};
      const auto turn = d.below(3);
      for (Point& c : t) std::rotate(c.begin(), c.begin() + turn, c.end());
    }
    std::swap(t[0], t[d.below(3)]);
    s.faces.push_back(scaled(t, size));
  }
}

void lattice(Draw& d, std::uint32_t n, bool f64, Sketch& s) {
  const int range = d.between(1, 6);
  const double size = d.one_in(2) ? 1 : d.power(low_exponent(f64), high_exponent(f64) - 25);
  const double far = d.one_in(3) ? d.sign() * 0x1p20 : 0;
  const auto corner = [&] {
    return Point{d.between(-range, range) + far, d.between(-range, range) + far,
                 d.between(-range, range) + far};
  };
  for (std::uint32_t i = 0; i < n; ++i) {
    Face t{corner(), corner(), corner()};
    if (d.one_in(8)) t[2] = t[1];
    if (d.one_in(16)) t[1] = t[2] = t[0];
    s.faces.push_back(scaled(t, size));
    s.is_quad.push_back(d.one_in(6));
  }
}

void height_field(Draw& d, std::uint32_t n, bool f64, Sketch& s) {
  const auto side = static_cast<std::uint32_t>(std::ceil(std::sqrt(n / 2.0)));
  const double size = d.one_in(2) ? 1 : d.power(low_exponent(f64), high_exponent(f64) - 25);
  const int heights = d.between(0, 2);
  std::vector<double> z;
  for (std::uint32_t i = 0; i < (side + 1) * (side + 1); ++i) {
    z.push_back(d.between(-heights, heights) * 0.5);
  }
  const auto at = [&](std::uint32_t x, std::uint32_t y) {
    return Point{double(x), double(y), z[y * (side + 1) + x]};
  };
  for (std::uint32_t y = 0; y < side; ++y) {
    for (std::uint32_t x = 0; x < side; ++x) {
      s.faces.push_back(scaled({at(x, y), at(x + 1, y), at(x, y + 1)}, size));
      s.faces.push_back(scaled({at(x + 1, y + 1), at(x, y + 1), at(x + 1, y)}, size));
    }
  }
}

void far_away(Draw& d, std::uint32_t n, bool, Sketch& s) {
  const Point at = unit_point(d);
  const double away = d.power(5, 30);
  for (std::uint32_t i = 0; i < n; ++i) {
    Face t = soup_face(d);
    for (Point& c : t) c = add(c, at, away);
    s.faces.push_back(t);
  }
}

void flat(Draw& d, std::uint32_t n, bool f64, Sketch& s) {
  soup(d, n, f64, s);
  const auto axis = d.below(3);
  const double at = d.one_in(2) ? 0 : s.faces[0][0][axis];
  for (Face& t : s.faces) {
    for (Point& c : t) c[axis] = at;
  }
}

void no_area(Draw& d, std::uint32_t n, bool f64, Sketch& s) {
  soup(d, n, f64, s);
  for (Face& t : s.faces) {
    const auto kind = d.below(3);
    if (kind == 0) t[1] = t[2] = t[0];
    if (kind == 1) t[2] = t[d.below(2)];
    if (kind == 2) t = {t[0], Point{t[0][0], t[1][1], t[0][2]}, Point{t[0][0], t[2][1], t[0][2]}};
  }
}

struct Kind {
  const char* name;
  Maker make;
  bool extreme;
};
constexpr std::array kKinds = {
    Kind{"soup", soup, false},
    Kind{"small faces", small_faces, false},
    Kind{"needles", needles, false},
    Kind{"lattice", lattice, false},
    Kind{"height field", height_field, false},
    Kind{"far away", far_away, false},
    Kind{"flat", flat, false},
    Kind{"no area", no_area, false},
    Kind{"any numbers", any_numbers, true},
    Kind{"mixed sizes", mixed_sizes, true},
    Kind{"tiny beside huge", tiny_beside_huge, true},
};

void append(SourceMesh& mesh, const Point& p) {
  for (const double x : p) {
    if (mesh.positions.precision == Precision::kF64) {
      mesh.positions.f64.push_back(x);
    } else {
      constexpr float kMax = std::numeric_limits<float>::max();
      mesh.positions.f32.push_back(std::clamp(static_cast<float>(x), -kMax, kMax));
    }
  }
}

}  // namespace

SourceMesh draw_mesh(Draw& d, const MeshWish& wish) {
  SourceMesh mesh;
  const bool f64 = wish.f64 && d.one_in(3);
  mesh.positions.precision = f64 ? Precision::kF64 : Precision::kF32;
  const Kind* kind = &kKinds[d.below(kKinds.size())];
  while (kind->extreme && !wish.extreme) kind = &kKinds[d.below(kKinds.size())];
  mesh.name = std::string(kind->name) + (f64 ? " f64" : "");
  std::uint32_t faces = 1 + d.below(d.one_in(3) ? 8 : wish.faces);
  if (d.one_in(16)) faces = 1 + d.below(8 * wish.faces);
  Sketch sketch;
  kind->make(d, faces, f64, sketch);
  sketch.is_quad.resize(sketch.faces.size(), false);
  for (std::size_t i = 0; i < sketch.faces.size(); ++i) {
    const Face& t = sketch.faces[i];
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Point& c : t) append(mesh, c);
    cooker::Face face{{first, first + 1, first + 2, cooker::kNoCorner}};
    if (sketch.is_quad[i]) {
      append(mesh, add(add(t[0], t[2]), t[1], -1));
      face.corner[3] = first + 3;
    }
    mesh.faces.push_back(face);
  }
  return mesh;
}

}  // namespace boxtree::oracle
