// SPDX-License-Identifier: MIT
// Loops over triangles in long double.
#include "tests/robustness/cast_reference.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "runtime/tree/bound_tree.h"
#include "tests/robustness/mesh_kinds.h"
#include "tests/support/infinity.h"

namespace boxtree::robustness {
namespace {

using test::kInfinity;
using test::LongShape;
using test::LongTriangle;
using test::LongVector;

// What cast.h allows, in units of the largest coordinate.
constexpr long double kDoubt = 0x1p-46L;
// Long double tells no difference below this part of the largest coordinate.
constexpr long double kResolved = 0x1p-58L;

// A collision of one face of several parts of a split polygon, whose ids are the same.
using Key = std::tuple<std::uint32_t, std::uint32_t>;

}  // namespace

CastReference::CastReference(const Tree& tree) {
  const BoundTree& bound = BoundTree::of(tree);
  const long double scale = std::ldexp(1.0L, bound.scale_exponent());
  for (const DecodedTriangle& t : decoded_triangles(tree)) {
    LongTriangle triangle = test::long_triangle(t.triangle);
    for (LongVector& corner : triangle) {
      corner = scale * corner + bound.frame().origin.cast<long double>();
    }
    add(t.face, t.half, triangle);
  }
}

CastReference::CastReference(const SourceMesh& mesh) {
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const std::size_t halves = mesh.faces[f].corner[3] == cooker::kNoCorner ? 1 : 2;
    for (std::size_t half = 0; half < halves; ++half) {
      add(static_cast<std::uint32_t>(f), static_cast<std::uint32_t>(half),
          test::long_triangle(source_triangle(mesh, f, half)));
    }
  }
}

void CastReference::add(std::uint32_t face, std::uint32_t half, const LongTriangle& triangle) {
  items_.push_back({face, half, test::BoundedTriangle(triangle)});
  for (const LongVector& corner : triangle) {
    largest_ = std::max(largest_, corner.cwiseAbs().maxCoeff());
  }
}

const CastReference::Item* CastReference::find(std::uint32_t face, std::uint32_t half) const {
  const auto found =
      std::lower_bound(items_.begin(), items_.end(), Key(face, half),
                       [](const Item& a, const Key& b) { return Key(a.face, a.half) < b; });
  const bool is_it = found != items_.end() && found->face == face && found->half == half;
  return is_it ? &*found : nullptr;
}

bool CastReference::check_cast(Run& run, const Tree& tree, const Cast& cast,
                               const std::string& name) const {
  const auto check = [&](bool holds, const char* what) {
    run.check(holds, [&] { return name + ", " + name_of(cast.shape) + ": " + what; });
    return holds;
  };
  return with_shape(cast.shape, [&](const auto& shape) {
    const Motion& motion = cast.motion;
    const CastResult hit = cast_closest(tree, shape, motion);
    const CastResult any = cast_any(tree, shape, motion);
    double first = std::numeric_limits<double>::infinity();
    bool is_named = false;
    const Result<Visit> all = cast_all(tree, shape, motion, [&](const CastHit& each) {
      first = std::min(first, each.t_lower);
      is_named |= hit && each.t_lower == hit->t_lower && each.face.index == hit->face.index &&
                  each.triangle == hit->triangle && each.t == hit->t;
      return motion.t_max;
    });
    if (!check(hit.ok() && any.ok() && all.ok(), "refused")) return false;
    check(any.has_value() == hit.has_value(), "cast_any differs from cast_closest");

    const LongShape exact = test::long_shape(shape);
    const LongVector direction = motion.direction.template cast<long double>();
    const long double far = exact.center.cwiseAbs().maxCoeff();
    const long double size = largest_ + 2 * (exact.reach + exact.radius) + far / 8;
    const long double doubt = kDoubt * size, radius = exact.radius;
    // Beyond this nothing is touched.
    const long double speed = direction.norm();
    const long double whole =
        speed > 0 ? std::min<long double>(motion.t_max, 4 * (far + size) / speed) : 0;
    const auto least = [&](long double to) {
      long double best = kInfinity;
      for (const Item& item : items_) {
        best = std::min(best, test::least_of(item.triangle, exact, direction, to, radius + doubt));
      }
      return best;
    };
    if (!hit) {
      check(first == std::numeric_limits<double>::infinity(), "cast_all differs");
      check(least(whole) > radius, "missed");
      return false;
    }
    check(first == hit->t_lower && is_named, "cast_all differs from cast_closest");
    check(any->t_lower >= hit->t_lower, "cast_any is before cast_closest");
    check(0 <= hit->t_lower && hit->t_lower <= hit->t && hit->t <= motion.t_max, "order of times");
    check(hit->initially_touching == (hit->t == 0), "touches at its start");
    // A little before t_lower, since the shape may touch there.
    const long double before = hit->t_lower * (1 - 0x1p-50L);
    if (before > 0) {
      const long double nearest = least(before);
      check(nearest > radius * (1 - 1e-18L) || (hit->t_lower - before) * speed < kResolved * size,
            "touches before t_lower");
    }
    const Item* const named = find(hit->face.id, hit->triangle);
    if (!check(named != nullptr, "no such face")) return true;
    const LongTriangle& triangle = named->triangle.corner;
    check(
        test::least_of(named->triangle, exact, direction, hit->t, radius + doubt) <= radius + doubt,
        "does not touch by t");
    check(
        test::distance(exact, LongVector(hit->t_lower * direction), triangle) <= radius + 4 * doubt,
        "t_lower is too early");
    const LongVector point = hit->point.template cast<long double>();
    check(test::distance_in_extended_precision({point, point, point}, triangle) <= 4 * doubt,
          "point off the triangle");
    if (hit->initially_touching) return true;
    check(test::distance(exact, LongVector(hit->t_lower * direction), {point, point, point}) <=
              radius + 8 * doubt,
          "point off the shape");
    check(std::abs(hit->normal.norm() - 1) < 1e-12, "length of the normal");
    check(hit->normal.dot(motion.direction.stableNormalized()) <= 1e-6, "normal along the motion");
    return true;
  });
}

std::size_t CastReference::check_contacts(Run& run, const Tree& tree, const Shape& tested,
                                          const std::string& name) const {
  const auto check = [&](bool holds, const char* what) {
    run.check(holds, [&] { return name + ", " + name_of(tested) + ": " + what; });
    return holds;
  };
  return with_shape(tested, [&](const auto& shape) {
    std::vector<Contact> contacts;
    const Result<Visit> visit = collide(tree, shape, [&](const Contact& contact) {
      contacts.push_back(contact);
      return true;
    });
    if (!check(visit.ok(), "collide is refused")) return std::size_t{0};
    const LongShape exact = test::long_shape(shape);
    const long double doubt =
        kDoubt * (largest_ + exact.center.cwiseAbs().maxCoeff() + 2 * (exact.reach + exact.radius));
    std::vector<Key> touched;
    for (const Contact& contact : contacts) {
      const Item* const item = find(contact.face.id, contact.triangle);
      if (!check(item != nullptr, "contact of no such face")) continue;
      touched.emplace_back(item->face, item->half);
      const LongTriangle& triangle = item->triangle.corner;
      check(test::distance(exact, LongVector::Zero(), triangle) <= exact.radius + doubt,
            "contact of a face that is apart");
      const LongVector point = contact.point.template cast<long double>();
      check(test::distance_in_extended_precision({point, point, point}, triangle) <= 4 * doubt &&
                test::distance(exact, LongVector::Zero(), {point, point, point}) <=
                    exact.radius + 4 * doubt,
            "point of a contact");
      const LongVector normal = contact.normal.template cast<long double>();
      check(std::abs(contact.normal.norm() - 1) < 1e-12 && contact.depth >= 0, "normal or depth");
      check(test::depth_along(exact, normal, triangle) <= contact.depth + 8 * doubt,
            "the depth does not part them");
      // No other way is shorter: along the axes, and near the normal.
      for (int i = 0; i < 12; ++i) {
        LongVector other = (i % 2 == 0 ? 1 : -1) * LongVector::Unit(i / 2 % 3);
        if (i >= 6) other = (normal + 0.01L * other).normalized();
        check(test::depth_along(exact, other, triangle) >= contact.depth - 8 * doubt,
              "another way out is shorter");
      }
    }
    std::sort(touched.begin(), touched.end());
    check(std::adjacent_find(touched.begin(), touched.end()) == touched.end(), "a contact twice");
    for (const Item& item : items_) {
      if (std::binary_search(touched.begin(), touched.end(), Key(item.face, item.half))) continue;
      const long double apart =
          test::least_of(item.triangle, exact, LongVector::Zero(), 0, exact.radius + doubt);
      if (!check(apart > exact.radius, "a contact is missed")) break;
    }
    return touched.size();
  });
}

}  // namespace boxtree::robustness
