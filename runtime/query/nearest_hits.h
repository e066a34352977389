// SPDX-License-Identifier: MIT
// The first of all hits of a ray, in order: what trees and scenes share.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include <boxtree/query.h>

namespace boxtree {

/// Fills `hits` with the first of those that `visit_all` visits, in the order of `comes_first`, and
/// returns how many there are. `visit_all(visitor)`: calls visitor(hit) -> double, the largest t
/// that is still of interest, as for RayVisitor. `t_max`: of the ray.
template <class Hit, class VisitAll, class ComesFirst>
[[nodiscard]] Result<std::size_t> first_hits(std::span<Hit> hits, double t_max,
                                             const VisitAll& visit_all,
                                             const ComesFirst& comes_first) {
  std::size_t count = 0;
  const Result<Visit> visited = visit_all([&](const Hit& hit) {
    std::size_t place = count;
    while (place > 0 && comes_first(hit, hits[place - 1])) --place;
    if (place < hits.size()) {
      count = std::min(count + 1, hits.size());
      const auto from = hits.begin() + static_cast<std::ptrdiff_t>(place);
      const auto end = hits.begin() + static_cast<std::ptrdiff_t>(count);
      std::move_backward(from, end - 1, end);
      hits[place] = hit;
    }
    if (count < hits.size()) return t_max;
    return hits.empty() ? -1.0 : hits.back().t;
  });
  if (!visited) return visited.error();
  return count;
}

}  // namespace boxtree
