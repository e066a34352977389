// SPDX-License-Identifier: MIT
// Family "pairs": which faces of two placed trees touch, against all pairs of triangles.
#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "tests/oracle/exact/families.h"
#include "tests/oracle/exact/poses.h"

namespace boxtree::oracle {
namespace family_pairs {
namespace {

using FacePairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

void sort_each_once(FacePairs& pairs) {
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

FacePairs touching(const std::vector<Decoded>& first, const std::vector<Decoded>& second) {
  FacePairs pairs;
  for (const Decoded& a : first) {
    for (const Decoded& b : second) {
      if (boxes_touch(a.bounds, b.bounds) && triangles_touch(a.at, b.at)) {
        pairs.emplace_back(a.face, b.face);
      }
    }
  }
  sort_each_once(pairs);  // halves of quads
  return pairs;
}

// Two groups of trees with poses, and what is true of them.
struct Setting {
  const Subject& first_subject;
  const Group& first;
  const Subject& second_subject;
  const Group& second;
  PlacedPair poses;
  FacePairs truth;
};

std::string describe(const Setting& s, const Cooked& a, const Cooked& b, const FacePairs& found) {
  FacePairs differing;
  std::set_symmetric_difference(s.truth.begin(), s.truth.end(), found.begin(), found.end(),
                                std::back_inserter(differing));
  std::vector<std::uint32_t> of_first, of_second;
  for (const auto& [f, g] : differing) {
    of_first.push_back(f);
    of_second.push_back(g);
  }
  return fmt::format(
      "{} with {}: {} pairs are exact, {} were found\n    first pose {}\n    second pose {}\n    "
      "first: {}\n    second: {}",
      a.name, b.name, s.truth.size(), found.size(), text(s.poses.first), text(s.poses.second),
      text(s.first_subject.mesh, of_first), text(s.second_subject.mesh, of_second));
}

void check(const Setting& s, const Cooked& a, const Cooked& b, Tally& tally) {
  FacePairs found;
  const auto visit =
      overlap_pairs(a.tree, s.poses.first, b.tree, s.poses.second, [&](const FacePair& pair) {
        found.emplace_back(pair.first.id, pair.second.id);
        return true;
      });
  tally.answer();
  const auto describe_it = [&] { return describe(s, a, b, found); };
  const std::string by =
      a.codec == b.codec ? fmt::format(" by {}", codec_name(a.codec)) : " by mixed codecs";
  if (!visit) {
    tally.wrong("error" + by,
                [&] { return fmt::format("{}: {}", visit.error().message(), describe_it()); });
    return;
  }
  std::sort(found.begin(), found.end());
  if (std::adjacent_find(found.begin(), found.end()) != found.end()) {
    tally.wrong("repeated" + by, describe_it);
  }
  if (!std::includes(found.begin(), found.end(), s.truth.begin(), s.truth.end())) {
    tally.wrong("missed" + by, describe_it);
  }
  if (!std::includes(s.truth.begin(), s.truth.end(), found.begin(), found.end())) {
    tally.wrong("extra" + by, describe_it);
  }

  const auto contact = first_contact(a.tree, s.poses.first, b.tree, s.poses.second);
  tally.answer();
  if (!contact.ok() || contact.has_value() == s.truth.empty()) {
    tally.wrong("first contact" + by, describe_it);
  } else if (contact.has_value() &&
             !std::binary_search(s.truth.begin(), s.truth.end(),
                                 std::make_pair(contact->first.id, contact->second.id))) {
    tally.wrong("first contact that is none" + by, describe_it);
  }
}

void check_refusal(const Setting& s, Tally& tally) {
  tally.refused();
  for (std::size_t i = 0; i < s.first.trees.size() && i < s.second.trees.size(); ++i) {
    tally.answer();
    const auto contact = first_contact(s.first.trees[i]->tree, s.poses.first,
                                       s.second.trees[i]->tree, s.poses.second);
    if (contact.ok() || contact.code() != Errc::kInvalidPose) {
      tally.wrong("not refused by all",
                  [&] { return describe(s, *s.first.trees[i], *s.second.trees[i], {}); });
    }
  }
}

bool is_same(const std::vector<Decoded>& computed, const std::vector<Face>& exact) {
  for (std::size_t i = 0; i < exact.size(); ++i) {
    if (computed[i].at != exact[i]) return false;
  }
  return true;
}

void check_all(Setting& s, Draw& draw, Tally& tally) {
  const auto moved = images(s.first.trees[0]->tree, s.second, s.poses, s.second.trees[0]->tree);
  if (!moved) return check_refusal(s, tally);
  s.truth = touching(s.first.triangles, moved->triangles);
  // Origins of frames, which f64 meshes have, are subtracted with a rounding.
  const bool has_origins = !s.first.frame().origin.isZero(0) || !s.second.frame().origin.isZero(0);
  if (s.poses.may_be_exact && !has_origins) {
    const auto exact = exact_images(s.first, s.second, s.poses);
    if (exact && !is_same(moved->triangles, *exact)) {
      tally.wrong("exact composition",
                  [&] { return describe(s, *s.first.trees[0], *s.second.trees[0], {}); });
    }
  }
  const std::size_t count = std::min(s.first.trees.size(), s.second.trees.size());
  for (std::size_t i = 0; i < count; ++i) {
    check(s, *s.first.trees[i], *s.second.trees[i], tally);
  }
  for (int mixed = 0; mixed < 2; ++mixed) {
    const auto i = draw.below(static_cast<std::uint32_t>(s.first.trees.size()));
    const auto j = draw.below(static_cast<std::uint32_t>(s.second.trees.size()));
    check(s, *s.first.trees[i], *s.second.trees[j], tally);
  }
}

}  // namespace
}  // namespace family_pairs

void run_pairs(Draw& draw, Tally& tally, std::uint64_t number) {
  using namespace family_pairs;
  constexpr int kPoses = 12;
  const bool grid = draw.one_in(4);
  const MeshWish wish{true, true, 32};
  const auto a = make_subject(draw_mesh(draw, wish), grid);
  const auto b = make_subject(draw_mesh(draw, wish), grid);
  tally.begin_case(number, a->mesh.faces.size() + b->mesh.faces.size(),
                   a->mesh.name + " with " + b->mesh.name);
  const std::size_t groups = std::min(a->groups.size(), b->groups.size());
  for (std::size_t g = 0; g < groups; ++g) {
    for (int i = 0; i < kPoses; ++i) {
      const Group& first = a->groups[g];
      const Group& second = b->groups[g];
      if (draw.one_in(2)) {
        Setting s{*a, first, *b, second, draw_poses(draw, first, second), {}};
        check_all(s, draw, tally);
      } else {
        Setting s{*b, second, *a, first, draw_poses(draw, second, first), {}};
        check_all(s, draw, tally);
      }
    }
  }
}

}  // namespace boxtree::oracle
