// SPDX-License-Identifier: MIT
// Family "distances": bounds of the distance of two placed trees, and whether they overlap within a
// distance, against the exact distances of all pairs of triangles in the world.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "tests/oracle/exact/families.h"
#include "tests/oracle/exact/poses.h"
#include "tests/oracle/exact/queries.h"
#include "tests/support/infinity.h"

namespace boxtree::oracle {
namespace family_distances {
namespace {

using test::kInfinity;

// A triangle under the linear part of the first pose and the scale of its tree; the translation is
// the same for both trees.
struct Placed {
  std::uint32_t face;
  Face in_first;  // first tree's space
  ExactFace world;
  BoxOf bounds;  // of the world, widened by rounding
};

struct Setting {
  const Subject& first_subject;
  const Group& first;
  const Subject& second_subject;
  const Group& second;
  PlacedPair poses;
  std::vector<Placed> a, b;
  // Size of what is compared: largest coordinate in the first tree's space times the largest
  // entry of its map to the world. More than any coordinate of the world where the map stretches
  // unevenly: that is what rounding in the first tree's space comes to.
  double unit = 0;
  bool touches = false;
  Quotient square;  // of the distance
};

Placed place(std::uint32_t face, const Face& t, const Eigen::Matrix3d& linear, int exponent) {
  Placed placed{face, t, {}, {}};
  for (std::size_t i = 0; i < 3; ++i) {
    placed.bounds.low[i] = kInfinity;
    placed.bounds.high[i] = -kInfinity;
    const auto row = static_cast<Eigen::Index>(i);
    for (std::size_t c = 0; c < 3; ++c) {
      double rounded = 0, terms = 0;
      for (std::size_t j = 0; j < 3; ++j) {
        const double m = linear(row, static_cast<Eigen::Index>(j));
        const double term = std::ldexp(m * t[c][j], exponent);
        placed.world[c][i] =
            placed.world[c][i] + (Dyadic(m) * Dyadic(t[c][j])).times_power_of_two(exponent);
        rounded += term;
        terms += std::abs(term);
      }
      const double off = terms * 0x1p-48 + std::numeric_limits<double>::min();
      placed.bounds.low[i] = std::min(placed.bounds.low[i], rounded - off);
      placed.bounds.high[i] = std::max(placed.bounds.high[i], rounded + off);
    }
  }
  return placed;
}

double gap_below(const BoxOf& a, const BoxOf& b) {
  double gap = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    gap = std::max({gap, a.low[k] - b.high[k], b.low[k] - a.high[k]});
  }
  return gap * (1 - 0x1p-50);
}

void find_truth(Setting& s) {
  struct Candidate {
    double gap;
    const Placed* a;
    const Placed* b;
  };
  std::vector<Candidate> candidates;
  for (const Placed& a : s.a) {
    for (const Placed& b : s.b) {
      candidates.push_back({gap_below(a.bounds, b.bounds), &a, &b});
      s.touches = s.touches || triangles_touch(a.in_first, b.in_first);
    }
  }
  if (s.touches) return;
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& x, const Candidate& y) { return x.gap < y.gap; });
  bool is_first = true;
  double best_above = kInfinity;
  for (const Candidate& c : candidates) {
    if (c.gap > best_above) break;
    const Quotient square = squared_distance(c.a->world, c.b->world);
    if (!is_first && !(square < s.square)) continue;
    is_first = false;
    s.square = square;
    best_above = root_below(square) * (1 + 0x1p-50);
  }
}

Quotient square_of_faces(const Setting& s, std::uint32_t first, std::uint32_t second) {
  Quotient best;
  bool is_first = true;
  for (const Placed& a : s.a) {
    for (const Placed& b : s.b) {
      if (a.face != first || b.face != second) continue;
      const Quotient square = squared_distance(a.world, b.world);
      if (is_first || square < best) best = square;
      is_first = false;
    }
  }
  return best;
}

std::string describe(const Setting& s, const Cooked& a, const Cooked& b, const std::string& what) {
  return fmt::format(
      "{} with {}: {}; exact distance {:.17g}\n    first pose {}\n    second pose {}"
      "\n    first: {}\n    second: {}",
      a.name, b.name, what, root_below(s.square), text(s.poses.first), text(s.poses.second),
      text(s.first_subject.mesh, {}), text(s.second_subject.mesh, {}));
}

void check_distance(const Setting& s, const Cooked& a, const Cooked& b,
                    const DistanceOptions& options, Tally& tally) {
  const auto answer = distance(a.tree, s.poses.first, b.tree, s.poses.second, options);
  tally.answer();
  const auto complain = [&](const char* category) {
    tally.wrong(category, [&] {
      return describe(
          s, a, b,
          answer ? fmt::format("[{:.17g}, {:.17g}] with errors {:.3g}, {:.3g}", answer->lower,
                               answer->upper, options.relative_error, options.absolute_error)
                 : answer.error().message());
    });
  };
  if (!answer) return complain("error");
  if (answer->lower == kInfinity || !is_at_most(Dyadic(answer->lower), s.square)) {
    complain("lower too large");
  }
  if (answer->upper == kInfinity) return;  // where doubles end: nothing else can be told
  const Quotient upper{Dyadic(answer->upper) * Dyadic(answer->upper), 1.0};
  if (upper < s.square) complain("upper too small");
  const bool is_exact_wish = options.relative_error == 0 && options.absolute_error == 0;
  if (is_exact_wish && s.touches != (answer->upper == 0)) complain("contact or none");
  if (!answer->witness) return complain("no witness");
  if (upper <
      square_of_faces(s, answer->witness->faces.first.id, answer->witness->faces.second.id)) {
    complain("witness farther than upper");
  }
  if (!answer->converged) return;
  const double least = 8 * std::numeric_limits<double>::denorm_min();
  const double allowed = 0x1p-44 * s.unit + least +
                         std::max(answer->lower * options.relative_error, options.absolute_error);
  const double wide = answer->upper - answer->lower;
  if (is_exact_wish) tally.error(wide / (0x1p-44 * s.unit + least));
  if (!(wide <= allowed)) complain("wide");
}

void check_within(const Setting& s, const Cooked& a, const Cooked& b, double limit, Tally& tally) {
  const auto answer = overlap_within(a.tree, s.poses.first, b.tree, s.poses.second, limit);
  tally.answer();
  const auto complain = [&](const char* category) {
    tally.wrong(category, [&] { return describe(s, a, b, fmt::format("within {:a}", limit)); });
  };
  if (!answer) return complain("within: error");
  const bool is_hit = answer->overlap == Overlap::kOverlapping;
  if (is_hit &&
      (!answer->contact ||
       square_of_faces(s, answer->contact->first.id, answer->contact->second.id).sign() != 0)) {
    complain("within: a hit that is none");
  }
  if (answer->overlap == Overlap::kDisjoint && s.touches)
    complain("within: disjoint though faces touch");
  if (answer->overlap == Overlap::kUndecided && is_at_most(Dyadic(limit), s.square)) {
    complain("within: undecided though all is farther");
  }
  if (answer->overlap == Overlap::kBudgetSpent) complain("within: budget spent");
}

void check_all(Setting& s, Draw& draw, Tally& tally) {
  const auto moved = images(s.first.trees[0]->tree, s.second, s.poses, s.second.trees[0]->tree);
  const auto probe =
      distance(s.first.trees[0]->tree, s.poses.first, s.second.trees[0]->tree, s.poses.second);
  if (!moved || !probe) {
    tally.refused();
    tally.answer();
    if (probe || probe.code() != Errc::kInvalidPose) {
      tally.wrong("not refused",
                  [&] { return describe(s, *s.first.trees[0], *s.second.trees[0], ""); });
    }
    return;
  }
  const int exponent = exponent_of(s.first.frame());
  const Eigen::Matrix3d linear = s.poses.first.linear();
  double size = 0;
  for (const Decoded& t : s.first.triangles) {
    s.a.push_back(place(t.face, t.at, linear, exponent));
    size = std::max(size, t.largest);
  }
  for (const Decoded& t : moved->triangles) {
    s.b.push_back(place(t.face, t.at, linear, exponent));
    size = std::max(size, t.largest);
  }
  s.unit = std::ldexp(size * linear.cwiseAbs().maxCoeff(), exponent);
  if (!(s.unit < 0x1p1000)) return;
  find_truth(s);
  DistanceOptions rough;
  rough.relative_error = draw.part();
  rough.absolute_error = draw.one_in(2) ? 0 : root_below(s.square) * draw.part();
  const double limit = draw.one_in(3)   ? 0
                       : draw.one_in(2) ? root_below(s.square) * (0.9 + 0.2 * draw.part())
                                        : s.unit * draw.power(-60, 1);
  const std::size_t count = std::min(s.first.trees.size(), s.second.trees.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Cooked& a = *s.first.trees[i];
    const Cooked& b = *s.second.trees[i];
    check_distance(s, a, b, {}, tally);
    check_distance(s, a, b, rough, tally);
    check_within(s, a, b, limit, tally);
  }
}

}  // namespace
}  // namespace family_distances

void run_distances(Draw& draw, Tally& tally, std::uint64_t number) {
  using namespace family_distances;
  constexpr int kPoses = 10;
  const bool grid = draw.one_in(4);
  const MeshWish wish{true, true, 10};
  const auto a = make_subject(draw_mesh(draw, wish), grid);
  const auto b = make_subject(draw_mesh(draw, wish), grid);
  tally.begin_case(number, a->mesh.faces.size() + b->mesh.faces.size(),
                   a->mesh.name + " with " + b->mesh.name);
  const std::size_t groups = std::min(a->groups.size(), b->groups.size());
  for (std::size_t g = 0; g < groups; ++g) {
    for (int i = 0; i < kPoses; ++i) {
      const Group& first = a->groups[g];
      const Group& second = b->groups[g];
      PlacedPair poses = draw_poses(draw, first, second);
      if (draw.one_in(2)) {  // apart
        const double away = first.largest * first.frame().scale * draw.power(-40, 20);
        for (Eigen::Index k = 0; k < 3; ++k) {
          poses.second.translation()[k] += draw.unit() * away * poses.first.linear().row(k).norm();
        }
      }
      Setting s{*a, first, *b, second, poses, {}, {}, 0, false, {}};
      check_all(s, draw, tally);
    }
  }
}

}  // namespace boxtree::oracle
