// SPDX-License-Identifier: MIT
#include "runtime/query/nearby_leaves.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include "format/limits.h"
#include "runtime/primitive/vector3.h"
#include "runtime/query/best_first.h"
#include "runtime/query/point_query.h"
#include "runtime/tree/root_box.h"
#include "runtime/walk/walk_tree.h"

namespace boxtree {
namespace {

// A closest point takes some twenty of wide nodes, a hundred of binary ones; that of a ball to its
// middle would take all.
constexpr std::uint64_t kNodes = 256;
// Searches; two of each tree come within some thousandths of a place that is nearer than those
// around it.
constexpr std::size_t kSearches = 6;
// No further search where one came nearer by less than this share.
constexpr double kLeastGain = 0x1p-8;

// The leaf with the face that is closest to a point of tree space.
struct Closest {
  Eigen::Vector3d point;
  NodeRef leaf;
};

// Nothing if no face is within a distance whose square is `most`, nor of a point that a pose has
// put where nothing can be.
std::optional<Closest> closest_to(const BoundTree& tree, const Eigen::Vector3d& point,
                                  double most) noexcept {
  if (!is_within_range(point)) return std::nullopt;
  WalkBound nodes(tree.node_count());
  PointQuery query(tree, nodes, point, most);
  SearchBudget budget{kNodes};
  if (search_within(tree, query, budget) != Errc::kOk || query.error != Errc::kOk || !query.found)
    return std::nullopt;
  const std::uint32_t first = query.found->face.index / kLeafFaces * kLeafFaces;
  return Closest{query.found->point,
                 {first, std::min(kLeafFaces, tree.counts().faces_in_leaves - first)}};
}

}  // namespace

std::optional<NearbyLeaves> nearby_leaves(const BoundTree& first, const BoundTree& second,
                                          const RelativePose& pose) noexcept {
  const std::array<const BoundTree*, 2> tree = {&first, &second};
  const std::array<const AffineMap*, 2> to_other = {&pose.to_second(), &pose.to_first()};
  std::array<std::optional<Closest>, 2> found;
  // A point in the space of tree n % 2, and the square of the distance there to look in.
  Eigen::Vector3d from = pose.to_first().apply(center(root_box<double>(second)));
  double most = std::numeric_limits<double>::infinity();
  for (std::size_t n = 0; n < kSearches; ++n) {
    const std::size_t here = n % 2, there = 1 - here;
    const std::optional<Closest> closest = closest_to(*tree[here], from, most);
    if (!closest) break;
    found[here] = closest;
    if (n > 1 && squared_length(closest->point - from) > most * (1 - kLeastGain)) break;
    from = to_other[here]->apply(closest->point);
    // What was found there is that near, but for rounding.
    if (found[there]) most = squared_length(from - found[there]->point) * (1 + 0x1p-20);
  }
  if (!found[0] || !found[1]) return std::nullopt;
  return NearbyLeaves{found[0]->leaf, found[1]->leaf};
}

}  // namespace boxtree
