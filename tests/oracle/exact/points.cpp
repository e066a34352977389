// SPDX-License-Identifier: MIT
// Family "points": the closest point, its distance and the bounds of an approximate answer, against
// the exact distances of all triangles.
#include <algorithm>
#include <cstring>
#include <limits>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "tests/oracle/exact/families.h"
#include "tests/oracle/exact/queries.h"
#include "tests/support/infinity.h"

namespace boxtree::oracle {
namespace family_points {
namespace {

using test::kInfinity;

struct Setting {
  const Subject& subject;
  const Group& group;
  Eigen::Vector3d point;  // object space
  Point at;               // tree space, as a frame brings it there
  ExactPoint exact;       // the same number
  double max_distance;

  /// The unit in which errors of distances to a triangle are counted, in tree space.
  [[nodiscard]] double unit(const Decoded& t) const {
    // An answer in object space may end where doubles end.
    const double least =
        std::ldexp(std::numeric_limits<double>::denorm_min(), -exponent_of(group.frame()));
    return std::max({ulp_of(std::max(t.largest, largest(at))), least, kResolution});
  }
  [[nodiscard]] Dyadic in_tree(double length) const {
    return Dyadic(length).times_power_of_two(-exponent_of(group.frame()));
  }
};

struct Complaint {
  std::string category;
  std::string what;
};
using Complaints = std::vector<Complaint>;

std::string describe(const Setting& s, const Cooked& cooked, const Complaint& complaint,
                     std::optional<std::uint32_t> face) {
  std::vector<std::uint32_t> faces;
  if (face) faces.push_back(*face);
  return fmt::format("{}: {}\n    point {} within {:a}\n    {}", cooked.name, complaint.what,
                     text(point_of(s.point)), s.max_distance, text(s.subject.mesh, faces));
}

// Whether the surface is surely within, or surely beyond, the largest distance.
enum class Within { kYes, kNo, kEither };
Within classify(const Setting& s) {
  if (s.max_distance == kInfinity) return Within::kYes;
  const Dyadic limit = s.in_tree(s.max_distance);
  Within all = Within::kNo;
  for (const Decoded& t : s.group.triangles) {
    const Dyadic slack = kUlps * s.unit(t);
    const Quotient square = squared_distance(s.exact, t.exact);
    const Dyadic less = limit - slack;
    if (less.sign() >= 0 && !(Quotient{less * less, 1.0} < square)) return Within::kYes;
    const Dyadic more = limit + slack;
    if (!(Quotient{more * more, 1.0} < square)) all = Within::kEither;
  }
  return all;
}

// The answer is no farther than any triangle allows.
void check_no_nearer(const Setting& s, const ClosestPoint& answer, Complaints& complaints,
                     double& worst) {
  const Dyadic distance = s.in_tree(answer.distance);
  const double above = answer.distance * s.group.frame().inverse_scale;
  for (const Decoded& t : s.group.triangles) {
    if (distance_below(s.at, t.bounds) >= above) continue;
    const Quotient square = squared_distance(s.exact, t.exact);
    if (is_at_most(distance, square)) continue;
    const double error = error_in_units(distance, square, s.unit(t));
    worst = std::max(worst, error);
    if (error <= kUlps) continue;
    complaints.push_back({"a nearer face", fmt::format("face {} is nearer by {:.3g} ulp: {:.17g} "
                                                       "and not {:.17g} (tree space)",
                                                       t.face, error, root_below(square), above)});
    return;
  }
}

// Distance and point belong to the face.
void check_face(const Setting& s, const ClosestPoint& answer, Complaints& complaints,
                double& worst) {
  const Decoded* t = find(s.group, answer.face.id, answer.triangle);
  if (t == nullptr) {
    complaints.push_back({"no such face", "no such face"});
    return;
  }
  const Quotient square = squared_distance(s.exact, t->exact);
  const double error = error_in_units(s.in_tree(answer.distance), square, s.unit(*t));
  worst = std::max(worst, error);
  if (error > kUlps) {
    complaints.push_back(
        {"distance of the face",
         fmt::format("off by {:.3g} ulp, {:.17g} is exact (tree space), {:.17g} "
                     "was answered",
                     error, root_below(square), answer.distance * s.group.frame().inverse_scale)});
  }
  // The point, which comes back to object space with a rounding.
  const Frame& frame = s.group.frame();
  const ExactPoint at = to_tree_exactly(frame, answer.point);
  const double unit =
      std::max(s.unit(*t), ulp_of(largest(point_of(answer.point))) * frame.inverse_scale);
  const double away = error_in_units(0.0, squared_distance(at, t->exact), unit);
  if (away > kUlps) {
    complaints.push_back({"point beside the face", fmt::format("{:.3g} ulp beside it", away)});
  }
  const ExactPoint between = minus(at, s.exact);
  const double off = error_in_units(s.in_tree(answer.distance), {dot(between, between), 1.0}, unit);
  if (off > kUlps) {
    complaints.push_back({"point not at the distance", fmt::format("{:.3g} ulp", off)});
  }
}

Complaints examine(const Setting& s, const std::optional<ClosestPoint>& answer, double& worst) {
  Complaints complaints;
  const Within within = classify(s);
  if (!answer) {
    if (within == Within::kYes) complaints.push_back({"nothing found", "nothing was found"});
    return complaints;
  }
  if (answer->distance == kInfinity) {  // in object space, where doubles end
    const double most =
        std::ldexp(std::numeric_limits<double>::max(), -8) * s.group.frame().inverse_scale * 128;
    for (const Decoded& t : s.group.triangles) {
      if (is_at_most(Dyadic(most), squared_distance(s.exact, t.exact))) continue;
      complaints.push_back({"infinite distance", "infinite"});
      break;
    }
    return complaints;
  }
  if (within == Within::kNo) complaints.push_back({"found beyond the limit", "beyond the limit"});
  check_no_nearer(s, *answer, complaints, worst);
  check_face(s, *answer, complaints, worst);
  return complaints;
}

bool is_same(const std::optional<ClosestPoint>& a, const std::optional<ClosestPoint>& b) {
  if (a.has_value() != b.has_value()) return false;
  if (!a) return true;
  return a->distance == b->distance && a->point == b->point && a->face.id == b->face.id &&
         a->triangle == b->triangle;
}

std::string words_of(const std::optional<ClosestPoint>& answer) {
  if (!answer) return "nothing";
  return fmt::format("face {} triangle {} point {} distance {:a}", answer->face.id,
                     answer->triangle, text(point_of(answer->point)), answer->distance);
}

std::optional<std::uint32_t> face_of(const std::optional<ClosestPoint>& answer) {
  return answer ? std::optional(answer->face.id) : std::nullopt;
}

// Bounds hold the distance of the very point that was given, and are tight.
void check_bounds(const Setting& s, const Cooked& cooked, const Quotient& square, Tally& tally) {
  const auto answer = closest_point(cooked.tree, s.point, PointOptions{});
  tally.answer();
  const auto complain = [&](const char* category, const std::string& what) {
    tally.wrong(category, [&] {
      return describe(s, cooked, {category, what},
                      answer ? face_of(answer->witness) : std::nullopt);
    });
  };
  if (!answer) return complain("bounds: error", "error");
  const std::string bounds =
      fmt::format("[{:.17g}, {:.17g}], exact {:.17g} x 2^{}", answer->lower, answer->upper,
                  root_below(square), exponent_of(s.group.frame()));
  if (answer->lower == kInfinity || !is_at_most(s.in_tree(answer->lower), square))
    complain("bounds: lower too large", bounds);
  const Dyadic upper = answer->upper == kInfinity ? Dyadic(0.0) : s.in_tree(answer->upper);
  if (answer->upper != kInfinity && Quotient{upper * upper, 1.0} < square) {
    complain("bounds: upper too small", bounds);
  }
  if (answer->upper == kInfinity && answer->witness) return;  // where doubles end
  const double wide = (answer->upper - answer->lower) * s.group.frame().inverse_scale;
  const double allowed =
      0x1p-44 * std::max(s.group.largest, largest(s.at)) +
      4 * std::ldexp(std::numeric_limits<double>::denorm_min(), -exponent_of(s.group.frame()));
  if (!(wide <= allowed)) {
    complain("bounds: wide",
             fmt::format("{} are {:.3g} of what is allowed", bounds, wide / allowed));
  }
}

Quotient nearest_square(const Setting& s, const ExactPoint& from) {
  std::optional<Quotient> best;
  double best_above = kInfinity;
  for (const Decoded& t : s.group.triangles) {
    // The point given and the rounded one are an ulp apart.
    const double slack = 4 * s.unit(t);
    if (distance_below(s.at, t.bounds) - slack > best_above) continue;
    const Quotient square = squared_distance(from, t.exact);
    if (best && !(square < *best)) continue;
    best = square;
    best_above = root_below(square) * (1 + 0x1p-50);
  }
  return *best;
}

void check_refusal(const Setting& s, Tally& tally) {
  tally.refused();
  for (const auto& cooked : s.group.trees) {
    tally.answer();
    const auto answer = closest_point(cooked->tree, s.point);
    if (answer.ok() || answer.code() != Errc::kInvalidQuery) {
      tally.wrong("not refused by all", [&] { return describe(s, *cooked, {"", ""}, {}); });
    }
  }
}

void check_all(const Setting& s, bool with_bounds, Tally& tally) {
  if (largest(s.at) > 0x1p200) return check_refusal(s, tally);
  std::optional<ClosestPoint> first;
  Complaints complaints;
  std::optional<Quotient> square;
  for (std::size_t i = 0; i < s.group.trees.size(); ++i) {
    const Cooked& cooked = *s.group.trees[i];
    const auto result = closest_point(cooked.tree, s.point, s.max_distance);
    tally.answer();
    if (!result.ok()) {
      tally.wrong("error", [&] { return describe(s, cooked, {"", result.error().message()}, {}); });
      continue;
    }
    const std::optional<ClosestPoint> answer = result.as_optional();
    double worst = 0;
    if (i == 0 || !is_same(answer, first)) complaints = examine(s, answer, worst);
    if (i == 0) {
      first = answer;
    } else if (!is_same(answer, first)) {
      tally.wrong("other bits than plain-f32", [&] {
        return describe(s, cooked, {"", words_of(answer) + ", plain-f32: " + words_of(first)},
                        face_of(answer));
      });
    }
    tally.error(worst);
    for (const Complaint& c : complaints) {
      tally.wrong(c.category, [&] { return describe(s, cooked, c, face_of(answer)); });
    }
    if (!with_bounds) continue;
    if (!square) square = nearest_square(s, to_tree_exactly(s.group.frame(), s.point));
    check_bounds(s, cooked, *square, tally);
  }
}

}  // namespace
}  // namespace family_points

void run_points(Draw& draw, Tally& tally, std::uint64_t number) {
  using namespace family_points;
  constexpr int kPoints = 40;
  const auto subject = make_subject(draw_mesh(draw), draw.one_in(3));
  tally.begin_case(number, subject->mesh.faces.size(), subject->mesh.name);
  for (const Group& group : subject->groups) {
    for (int i = 0; i < kPoints; ++i) {
      const Position position = draw_position(draw, group);
      Setting s{*subject, group, position.at, {}, {}, kInfinity};
      s.at = to_tree(group.frame(), s.point);
      if (!std::isfinite(s.at[0]) || !std::isfinite(s.at[1]) || !std::isfinite(s.at[2])) {
        check_refusal(s, tally);
        continue;
      }
      s.exact = as<Dyadic>(s.at);
      if (largest(s.at) <= 0x1p200 && draw.one_in(4)) {
        s.max_distance = draw_length(draw, group, position);
      }
      check_all(s, i % 4 == 0, tally);
    }
  }
}

}  // namespace boxtree::oracle
