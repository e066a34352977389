// SPDX-License-Identifier: MIT
// Family "rays": closest and any hits, against the exact line and all triangles.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "tests/oracle/exact/families.h"
#include "tests/oracle/exact/queries.h"
#include "tests/oracle/exact/ray_truth.h"
#include "tests/support/infinity.h"

namespace boxtree::oracle {
namespace family_rays {
namespace {

using test::kInfinity;
// Signs are exact for sheared corners, which are rounded a few times: 2^-46 is 64 ulp.
constexpr double kTolerance = 0x1p-46;

struct Setting {
  const Subject& subject;
  const Group& group;
  Ray ray;                      // object space
  std::vector<RayTruth> truth;  // of each triangle
};

std::string describe(const Setting& s, const Cooked& cooked, const std::string& what,
                     const std::vector<std::uint32_t>& faces) {
  return fmt::format("{}: {}\n    origin {} direction {} t {:a} to {:a}\n    {}", cooked.name, what,
                     text(point_of(s.ray.origin)), text(point_of(s.ray.direction)), s.ray.t_min,
                     s.ray.t_max, text(s.subject.mesh, faces));
}

struct Complaint {
  std::string category;
  std::string what;
  std::vector<std::uint32_t> faces;
};
using Complaints = std::vector<Complaint>;

// Whether a triangle is hit by all means, and at most at which t.
std::optional<double> latest_sure(const Setting& s, const RayTruth& truth) {
  if (!truth.is_surely_hit) return std::nullopt;
  const double t = truth.t;
  // Two of the smallest doubles: t itself may be less than one.
  const double tolerance = truth.t_tolerance + 2 * std::numeric_limits<double>::denorm_min();
  if (!std::isfinite(t) || !std::isfinite(tolerance)) return std::nullopt;
  if (!(t - tolerance >= s.ray.t_min) || !(t + tolerance <= s.ray.t_max)) return std::nullopt;
  return t + tolerance;
}

void examine_hit(const Setting& s, const RayHit& hit, Complaints& complaints) {
  const Decoded* found = find(s.group, hit.face.id, hit.triangle);
  if (found == nullptr) {
    complaints.push_back({"no such face", "no such face", {}});
    return;
  }
  const RayTruth& truth = s.truth[static_cast<std::size_t>(found - s.group.triangles.data())];
  const std::vector<std::uint32_t> faces{hit.face.id};
  if (!truth.may_be_hit) complaints.push_back({"a hit beside the face", "beside the face", faces});
  if (!(hit.t >= s.ray.t_min) || !(hit.t <= s.ray.t_max)) {
    complaints.push_back({"t out of range", fmt::format("t {:a}", hit.t), faces});
  }
  const double tolerance = truth.t_tolerance + 2 * std::numeric_limits<double>::denorm_min();
  const double low = (std::isnan(truth.t) ? truth.t_low : truth.t) - tolerance;
  const double high = (std::isnan(truth.t) ? truth.t_high : truth.t) + tolerance;
  if (std::isfinite(low) && std::isfinite(high) && (hit.t < low || hit.t > high)) {
    complaints.push_back(
        {"wrong t", fmt::format("t {:.17g}, exact {:.17g} to {:.17g}", hit.t, low, high), faces});
  }
  if (!(hit.u >= 0 && hit.v >= 0 && hit.u <= 1 && hit.v <= 1)) {
    complaints.push_back({"weights out of range", fmt::format("{:a} {:a}", hit.u, hit.v), faces});
  }
}

void examine_missed(const Setting& s, const std::optional<RayHit>& closest,
                    Complaints& complaints) {
  for (std::size_t i = 0; i < s.truth.size(); ++i) {
    const auto latest = latest_sure(s, s.truth[i]);
    if (!latest || (closest && closest->t <= *latest)) continue;
    complaints.push_back(
        {closest ? "a nearer hit missed" : "missed",
         fmt::format("face {} is hit at {:.17g}", s.group.triangles[i].face, s.truth[i].t),
         {s.group.triangles[i].face}});
    return;
  }
}

bool is_same(const std::optional<RayHit>& a, const std::optional<RayHit>& b) {
  if (a.has_value() != b.has_value()) return false;
  return !a || (a->t == b->t && a->u == b->u && a->v == b->v && a->face.id == b->face.id &&
                a->triangle == b->triangle);
}

void check_any(const Setting& s, const Cooked& cooked, bool has_closest, Tally& tally) {
  const auto any = any_hit(cooked.tree, s.ray);
  tally.answer();
  if (!any.ok() || any.has_value() != has_closest) {
    return tally.wrong("any hit is not as closest hit",
                       [&] { return describe(s, cooked, "any hit", {}); });
  }
  if (!any.has_value()) return;
  Complaints complaints;
  examine_hit(s, *any, complaints);
  for (const Complaint& c : complaints) {
    tally.wrong("any hit: " + c.category, [&] { return describe(s, cooked, c.what, c.faces); });
  }
}

void check_all(Setting& s, Tally& tally) {
  const Point origin = to_tree(s.group.frame(), s.ray.origin);
  const bool is_beyond = !(largest(origin) <= 0x1p200);
  if (!is_beyond) {
    const ExactRay ray(origin, point_of(s.ray.direction));
    for (const Decoded& t : s.group.triangles)
      s.truth.push_back(truth_of(ray, t.at, kTolerance, 0, exponent_of(s.group.frame())));
  }
  std::optional<RayHit> first;
  for (std::size_t i = 0; i < s.group.trees.size(); ++i) {
    const Cooked& cooked = *s.group.trees[i];
    const auto hit = closest_hit(cooked.tree, s.ray);
    tally.answer();
    if (!hit.ok() && is_beyond && hit.code() == Errc::kInvalidQuery) {
      tally.refused();
      continue;
    }
    if (!hit.ok() || is_beyond) {
      tally.wrong("error, or not refused", [&] { return describe(s, cooked, "error", {}); });
      continue;
    }
    if (i == 0) first = hit.as_optional();
    if (!is_same(hit.as_optional(), first)) {
      tally.wrong("other bits than plain-f32", [&] { return describe(s, cooked, "bits", {}); });
    }
    Complaints complaints;
    if (hit.has_value()) examine_hit(s, *hit, complaints);
    examine_missed(s, hit.as_optional(), complaints);
    for (const Complaint& c : complaints) {
      tally.wrong(c.category, [&] { return describe(s, cooked, c.what, c.faces); });
    }
    check_any(s, cooked, hit.has_value(), tally);
  }
}

Eigen::Vector3d draw_direction(Draw& d, const Group& group, const Eigen::Vector3d& origin) {
  Eigen::Vector3d direction(d.unit(), d.unit(), d.unit());
  const auto kind = d.below(10);
  if (kind < 6) direction = draw_position(d, group).at - origin;
  if (kind == 6) {
    direction.setZero();
    direction[d.below(3)] = d.sign();
  }
  if (kind == 7) direction[d.below(3)] = d.one_in(2) ? 0 : d.unit() * d.power(-1000, -50);
  if (kind == 8) {
    for (Eigen::Index k = 0; k < 3; ++k) direction[k] = d.any_f64(-1000, 900);
  }
  if (d.one_in(8)) direction *= d.power(-900, 900);
  if (d.one_in(4)) direction[d.below(3)] = 0;
  if (!direction.allFinite() || direction.isZero(0)) direction = {0.5, -0.25, 1};
  return direction;
}

Ray draw_ray(Draw& d, const Group& group) {
  Ray ray;
  ray.origin = draw_position(d, group).at;
  ray.direction = draw_direction(d, group, ray.origin);
  if (d.one_in(6)) {  // from outside, through what the direction aims at
    const Eigen::Vector3d back = ray.origin - ray.direction * d.power(0, 60);
    if (back.allFinite()) ray.origin = back;
  }
  if (d.one_in(4)) ray.t_max = d.one_in(2) ? 1 : d.part() * d.power(-20, 60);
  if (d.one_in(8)) ray.t_min = d.part() * (ray.t_max == kInfinity ? 2 : ray.t_max);
  return ray;
}

}  // namespace
}  // namespace family_rays

void run_rays(Draw& draw, Tally& tally, std::uint64_t number) {
  using namespace family_rays;
  constexpr int kRays = 40;
  const auto subject = make_subject(draw_mesh(draw), draw.one_in(3));
  tally.begin_case(number, subject->mesh.faces.size(), subject->mesh.name);
  for (const Group& group : subject->groups) {
    for (int i = 0; i < kRays; ++i) {
      Setting s{*subject, group, draw_ray(draw, group), {}};
      check_all(s, tally);
    }
  }
}

}  // namespace boxtree::oracle
