// SPDX-License-Identifier: MIT
// Bounds and reports of walks of two trees.
#include "runtime/query/pair_work.h"

namespace boxtree {

PairBound::PairBound(const BoundTree& first, const BoundTree& second, QueryWork* work) noexcept
    : parts_(most_pairs(first.codec(), first.counts(), second.codec(), second.counts()), work),
      faces_left_(
          saturated_product(first.counts().faces_in_leaves, second.counts().faces_in_leaves)) {}

PairReport::PairReport(const BoundTree& first, const BoundTree& second,
                       PairVisitor visitor) noexcept
    : first_(first),
      second_(second),
      first_refs_(first),
      second_refs_(second),
      visitor_(visitor),
      pairs_left_(saturated_product(first.face_count(), second.face_count())) {}

// In valid files each pair is reported once; in corrupt ones many faces may have the same copies.
bool PairReport::report_copies(std::uint32_t first, std::uint32_t second) {
  const FaceWithCopies a(first_, first), b(second_, second);
  const std::uint64_t pairs = saturated_product(a.count(), b.count());
  if (pairs > pairs_left_) {
    error_ = Errc::kNodeCorrupt;
    return false;
  }
  pairs_left_ -= pairs;
  for (std::uint32_t i = 0; i < a.count(); ++i) {
    for (std::uint32_t j = 0; j < b.count(); ++j) {
      stopped_ = !visitor_({a.face(i), b.face(j)});
      if (stopped_) return false;
    }
  }
  return true;
}

}  // namespace boxtree
