// SPDX-License-Identifier: MIT
// Contacts of a shape with the triangles of one tree: a cast that stays where it is.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include <boxtree/collide.h>

#include "runtime/primitive/float_state.h"
#include "runtime/primitive/vector3.h"
#include "runtime/query/cast_query.h"

namespace boxtree {

/// Calls visit(query, candidate) -> bool, whether to go on, with each triangle that is touched.
/// `wanted`: kContacts or kFaces.
template <class Visitor>
Result<Visit> visit_touched(const BoundTree& tree, const CastQuery::Path& path,
                            CastQuery::Wanted wanted, QueryWork& work, const Visitor& visit) {
  WalkBound nodes(tree.node_count(), &work);
  const auto touched = [&](const CastQuery& query, const CastCandidate& found) {
    return visit(query, found) ? 0.0 : -1.0;
  };
  const CastQuery::Visitor visitor(touched);
  CastQuery query(tree, path, wanted, &visitor, nodes);
  if (const Errc error = query.run(); error != Errc::kOk) return error;
  return query.faces.stopped ? Visit::kStopped : Visit::kComplete;
}

/// The line of a shape that stays where it is: of no length along any direction.
[[nodiscard]] inline Ray line_at(const Eigen::Vector3d& center) noexcept {
  return {center, Eigen::Vector3d::UnitX(), 0, 0};
}

/// What a caller is told of a touch. `frame`: from the space in which triangles are compared to the
/// caller's.
[[nodiscard]] Contact contact_of(const CastQuery& query, const CastCandidate& found,
                                 const Frame& frame) noexcept;

/// What merge_contacts() looks at.
struct MergedContact {
  Eigen::Vector3d point;
  Eigen::Vector3d normal;
  double depth;
};

/// merge_contacts() for `count` contacts of any kind: `read(i)` returns the MergedContact of one,
/// `drop(i)` makes its depth NaN, and `move(from, to)` copies one to the place of another.
///
/// The deepest contact is kept, and drops all that are alike; then the deepest of those that are
/// left, and so on. So none that is kept is like another, and each that is dropped is like one that
/// is kept and no less deep.
template <class Read, class Drop, class Move>
[[nodiscard]] std::size_t merge(std::size_t count, double distance, double cosine, const Read& read,
                                const Drop& drop, const Move& move) {
  const DefaultFloatState state;
  const auto is_same = [&](const MergedContact& a, const MergedContact& b) {
    const Eigen::Vector3d between = a.point - b.point;
    return std::sqrt(squared_length(between)) <= distance && dot(a.normal, b.normal) >= cosine;
  };
  std::size_t kept = 0;
  // Those kept so far are all that are deeper than `depth`, or as deep and before place `from`.
  double depth = std::numeric_limits<double>::infinity();
  std::size_t from = 0;
  while (true) {  // each turn keeps one
    std::size_t deepest = count;
    double most = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < count; ++i) {
      const double of_i = read(i).depth;
      const bool is_left = of_i < depth || (of_i == depth && i >= from);
      if (!is_left || (deepest != count && !(of_i > most))) continue;
      deepest = i;
      most = of_i;
    }
    if (deepest == count) break;
    const MergedContact best = read(deepest);
    for (std::size_t i = 0; i < count; ++i) {
      if (i != deepest && is_same(read(i), best)) drop(i);
    }
    depth = most;
    from = deepest + 1;
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!std::isnan(read(i).depth)) move(i, kept++);
  }
  return kept;
}

/// The same for those of trees and of scenes.
template <class AnyContact>
[[nodiscard]] std::size_t merge(std::span<AnyContact> contacts, double distance, double cosine) {
  return merge(
      contacts.size(), distance, cosine,
      [&](std::size_t i) {
        return MergedContact{contacts[i].point, contacts[i].normal, contacts[i].depth};
      },
      [&](std::size_t i) { contacts[i].depth = std::numeric_limits<double>::quiet_NaN(); },
      [&](std::size_t from, std::size_t to) { contacts[to] = contacts[from]; });
}

/// Tells the second triangle of a quad that was visited already from others, leaf by leaf.
class VisitedFaces {
 public:
  /// Whether the face, or the original of this copy, comes for the first time.
  bool is_new(const CastCandidate& found) noexcept {
    if (found.face.index != found.original) return is_new_;  // copies follow their original
    if (found.original / kLeafFaces != leaf_) {
      leaf_ = found.original / kLeafFaces;
      visited_ = 0;
    }
    const std::uint32_t bit = 1u << (found.original % kLeafFaces);
    is_new_ = (visited_ & bit) == 0;
    visited_ |= bit;
    return is_new_;
  }

 private:
  std::uint32_t leaf_ = ~std::uint32_t{0};
  std::uint32_t visited_ = 0;  // bit i: face i of the leaf
  bool is_new_ = true;
};

}  // namespace boxtree
