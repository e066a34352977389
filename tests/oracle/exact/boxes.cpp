// SPDX-License-Identifier: MIT
// Family "boxes": which faces touch a box, against all triangles.
#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include <fmt/format.h>

#include "tests/oracle/exact/families.h"
#include "tests/oracle/exact/queries.h"

namespace boxtree::oracle {
namespace family_boxes {
namespace {

using Faces = std::vector<std::uint32_t>;

// How far a face is from the box.
struct Gap {
  double stated;  // in 1e-15 of the distance of its farthest corner from the box's middle
  double ulps;    // in units in the last place of the largest coordinate
};

struct Setting {
  const Subject& subject;
  const Group& group;
  Eigen::AlignedBox3d box;  // object space
  BoxOf at;                 // tree space
  Faces truth;
  std::map<std::uint32_t, Gap> gaps;  // of faces that were reported and do not touch
};

// Far beyond any mesh, where doubles do not overflow.
Point clamped(Point p) {
  for (double& x : p) x = std::clamp(x, -0x1p300, 0x1p300);
  return p;
}

Setting make_setting(const Subject& subject, const Group& group, const Eigen::AlignedBox3d& box) {
  const Frame& frame = group.frame();
  Setting s{subject, group,
            box,     {clamped(to_tree(frame, box.min())), clamped(to_tree(frame, box.max()))},
            {},      {}};
  for (const Decoded& t : group.triangles) {
    if (!s.truth.empty() && s.truth.back() == t.face) continue;
    if (boxes_touch(t.bounds, s.at) && triangle_touches_box(t.at, s.at)) s.truth.push_back(t.face);
  }
  return s;
}

std::string describe(const Setting& s, const Cooked& cooked, const Faces& found) {
  Faces differing;
  std::set_symmetric_difference(s.truth.begin(), s.truth.end(), found.begin(), found.end(),
                                std::back_inserter(differing));
  return fmt::format("{}: {} faces are exact, {} were found\n    box {} to {}\n    {}", cooked.name,
                     s.truth.size(), found.size(), text(point_of(s.box.min())),
                     text(point_of(s.box.max())), text(s.subject.mesh, differing));
}

// The squared distance of the nearest triangle of a face.
Quotient squared_gap(const Setting& s, std::uint32_t face) {
  Quotient gap;
  bool is_first = true;
  for (const Decoded& t : s.group.triangles) {
    if (t.face != face) continue;
    const Quotient found = squared_distance(t.at, s.at);
    if (is_first || found < gap) gap = found;
    is_first = false;
  }
  return gap;
}

double farthest_corner(const Setting& s, std::uint32_t face) {
  double far = 0;
  for (const Decoded& t : s.group.triangles) {
    if (t.face != face) continue;
    for (const Point& c : t.at) {
      double square = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const double away = c[k] - (s.at.low[k] / 2 + s.at.high[k] / 2);
        square += away * away;
      }
      far = std::max(far, std::sqrt(square));
    }
  }
  return far;
}

const Gap& gap_of(Setting& s, std::uint32_t face) {
  const auto known = s.gaps.find(face);
  if (known != s.gaps.end()) return known->second;
  const mpf_class gap = root_of(squared_gap(s, face));
  const double largest_of_all = std::max({s.group.largest, largest(s.at.low), largest(s.at.high)});
  const mpf_class stated(farthest_corner(s, face) * 1e-15, 320), unit(ulp_of(largest_of_all), 320);
  const Gap found{stated == 0 ? 0 : mpf_class(gap / stated, 320).get_d(),
                  mpf_class(gap / unit, 320).get_d()};
  return s.gaps.emplace(face, found).first->second;
}

void check_extra(Setting& s, const Cooked& cooked, const Faces& found, Tally& tally) {
  Faces extra;
  std::set_difference(found.begin(), found.end(), s.truth.begin(), s.truth.end(),
                      std::back_inserter(extra));
  for (const std::uint32_t face : extra) {
    const Gap& gap = gap_of(s, face);
    tally.error(gap.ulps);
    tally.wrong(
        gap.stated > 1 ? "extra, missed by more than 1e-15" : "extra, missed by less than 1e-15",
        [&] {
          return fmt::format("missed by {:.3g} x 1e-15 of the farthest corner; {}", gap.stated,
                             describe(s, cooked, found));
        });
  }
}

void check_overlap(Setting& s, const Cooked& cooked, Tally& tally) {
  Faces found;
  const auto visit = overlap_box(cooked.tree, s.box, [&](const FaceRef& face) {
    found.push_back(face.id);
    return true;
  });
  tally.answer();
  const auto describe_it = [&] { return describe(s, cooked, found); };
  if (!visit) return tally.wrong("error", describe_it);
  std::sort(found.begin(), found.end());
  if (std::adjacent_find(found.begin(), found.end()) != found.end()) {
    tally.wrong("repeated", describe_it);
  }
  if (!std::includes(found.begin(), found.end(), s.truth.begin(), s.truth.end())) {
    tally.wrong("missed", describe_it);
  }
  check_extra(s, cooked, found, tally);
}

bool is_some_face_nearer(const Setting& s, double distance) {
  const Dyadic limit = Dyadic(distance).times_power_of_two(-exponent_of(s.group.frame()));
  for (const Decoded& t : s.group.triangles) {
    if (!is_at_most(limit, squared_distance(t.at, s.at))) return true;
  }
  return false;
}

// The classification of overlap_box_within: exact but where it may be undecided.
void check_within(const Setting& s, const Cooked& cooked, double distance, Tally& tally) {
  const auto answer = overlap_box_within(cooked.tree, s.box, distance);
  tally.answer();
  const auto describe_it = [&] {
    return fmt::format("within {:a}: {}", distance, describe(s, cooked, {}));
  };
  if (!answer) return tally.wrong("within: error", describe_it);
  switch (answer->overlap) {
    case Overlap::kOverlapping:
      if (!answer->face || !std::binary_search(s.truth.begin(), s.truth.end(), answer->face->id)) {
        tally.wrong("within: a hit that is none", describe_it);
      }
      break;
    case Overlap::kDisjoint:
      if (!s.truth.empty()) tally.wrong("within: disjoint though a face touches", describe_it);
      break;
    case Overlap::kUndecided:
      if (s.truth.empty() && !is_some_face_nearer(s, distance)) {
        tally.wrong("within: undecided though all is farther", describe_it);
      }
      break;
    case Overlap::kBudgetSpent:
      tally.wrong("within: budget spent without a budget", describe_it);
      break;
  }
}

}  // namespace
}  // namespace family_boxes

void run_boxes(Draw& draw, Tally& tally, std::uint64_t number) {
  using namespace family_boxes;
  constexpr int kBoxes = 40;
  const auto subject = make_subject(draw_mesh(draw), draw.one_in(3));
  tally.begin_case(number, subject->mesh.faces.size(), subject->mesh.name);
  for (const Group& group : subject->groups) {
    for (int i = 0; i < kBoxes; ++i) {
      Setting s = make_setting(*subject, group, draw_box(draw, group));
      const double distance =
          draw.one_in(2) ? 0 : s.box.sizes().maxCoeff() * draw.power(-50, 3) * draw.part();
      for (const auto& cooked : group.trees) {
        check_overlap(s, *cooked, tally);
        if (i % 4 == 0 && std::isfinite(distance)) check_within(s, *cooked, distance, tally);
      }
    }
  }
}

}  // namespace boxtree::oracle
