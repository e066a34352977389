// SPDX-License-Identifier: MIT
// Family "spheres": which faces come within a radius, against the exact distances of all triangles.
#include <algorithm>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "tests/oracle/exact/families.h"
#include "tests/oracle/exact/queries.h"

namespace boxtree::oracle {
namespace family_spheres {
namespace {

using Faces = std::vector<std::uint32_t>;

struct Setting {
  const Subject& subject;
  const Group& group;
  Eigen::Vector3d center;  // object space
  double radius;
  Point at;  // tree space
  ExactPoint exact;
};

struct Truth {
  Faces surely;   // nearer than the radius by more than the tolerance
  Faces perhaps;  // those, and what is within it
};

double unit_of(const Setting& s, const Decoded& t) {
  const double least =
      std::ldexp(std::numeric_limits<double>::denorm_min(), -exponent_of(s.group.frame()));
  return std::max({ulp_of(std::max(t.largest, largest(s.at))), least, kResolution});
}

void add_once(Faces& faces, std::uint32_t face) {
  if (faces.empty() || faces.back() != face) faces.push_back(face);
}

Truth truth_of(const Setting& s) {
  Truth truth;
  const Dyadic radius = Dyadic(s.radius).times_power_of_two(-exponent_of(s.group.frame()));
  const double above = s.radius * s.group.frame().inverse_scale;
  for (const Decoded& t : s.group.triangles) {
    const double slack = kUlps * unit_of(s, t);
    if (distance_below(s.at, t.bounds) * (1 - 0x1p-50) > above + 2 * slack) continue;
    const Quotient square = squared_distance(s.exact, t.exact);
    const Dyadic less = radius - Dyadic(slack), more = radius + Dyadic(slack);
    if (Quotient{more * more, 1.0} < square) continue;
    add_once(truth.perhaps, t.face);
    if (less.sign() >= 0 && !(Quotient{less * less, 1.0} < square)) add_once(truth.surely, t.face);
  }
  return truth;
}

std::string describe(const Setting& s, const Cooked& cooked, const Faces& found,
                     const Faces& expected) {
  Faces differing;
  std::set_symmetric_difference(expected.begin(), expected.end(), found.begin(), found.end(),
                                std::back_inserter(differing));
  std::string distances;
  for (const Decoded& t : s.group.triangles) {
    if (!std::binary_search(differing.begin(), differing.end(), t.face)) continue;
    const Quotient square = squared_distance(s.exact, t.exact);
    distances += fmt::format(
        "\n    face {} is {:.17g} away, radius {:.17g} (tree space), {:.3g} ulp", t.face,
        root_below(square), s.radius * s.group.frame().inverse_scale,
        error_in_units(Dyadic(s.radius).times_power_of_two(-exponent_of(s.group.frame())), square,
                       unit_of(s, t)));
  }
  return fmt::format("{}: {} faces expected, {} found\n    center {} radius {:a}{}\n    {}",
                     cooked.name, expected.size(), found.size(), text(point_of(s.center)), s.radius,
                     distances, text(s.subject.mesh, differing));
}

void check_all(const Setting& s, Tally& tally) {
  const Truth truth = truth_of(s);
  Faces first;
  for (std::size_t i = 0; i < s.group.trees.size(); ++i) {
    const Cooked& cooked = *s.group.trees[i];
    Faces found;
    const auto visit = overlap_sphere(cooked.tree, s.center, s.radius, [&](const FaceRef& face) {
      found.push_back(face.id);
      return true;
    });
    tally.answer();
    if (!visit) {
      if (largest(s.at) > 0x1p200 && visit.code() == Errc::kInvalidQuery) {
        tally.refused();
      } else {
        tally.wrong("error", [&] { return describe(s, cooked, found, truth.surely); });
      }
      continue;
    }
    std::sort(found.begin(), found.end());
    if (i == 0) first = found;
    if (std::adjacent_find(found.begin(), found.end()) != found.end()) {
      tally.wrong("repeated", [&] { return describe(s, cooked, found, truth.surely); });
    }
    if (found != first) {
      tally.wrong("other faces than plain-f32", [&] { return describe(s, cooked, found, first); });
    }
    if (!std::includes(found.begin(), found.end(), truth.surely.begin(), truth.surely.end())) {
      tally.wrong("missed", [&] { return describe(s, cooked, found, truth.surely); });
    }
    if (!std::includes(truth.perhaps.begin(), truth.perhaps.end(), found.begin(), found.end())) {
      tally.wrong("extra", [&] { return describe(s, cooked, found, truth.perhaps); });
    }
  }
}

}  // namespace
}  // namespace family_spheres

void run_spheres(Draw& draw, Tally& tally, std::uint64_t number) {
  using namespace family_spheres;
  constexpr int kSpheres = 40;
  const auto subject = make_subject(draw_mesh(draw), draw.one_in(3));
  tally.begin_case(number, subject->mesh.faces.size(), subject->mesh.name);
  for (const Group& group : subject->groups) {
    for (int i = 0; i < kSpheres; ++i) {
      const Position position = draw_position(draw, group);
      Setting s{*subject, group, position.at, 0, {}, {}};
      s.at = to_tree(group.frame(), s.center);
      if (!(largest(s.at) <= 0x1p210)) continue;
      s.exact = as<Dyadic>(s.at);
      s.radius = draw_length(draw, group, position);
      if (std::isfinite(s.radius)) check_all(s, tally);
    }
  }
}

}  // namespace boxtree::oracle
