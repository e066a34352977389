// SPDX-License-Identifier: MIT
// Which of a face and its copies a caller wants to be told of: what rays and casts share.
#pragma once

#include <algorithm>
#include <cstdint>

#include <boxtree/face_options.h>

#include "runtime/walk/face_copies.h"

namespace boxtree {

struct FaceWishes {
  FaceWishes(const BoundTree& tree, const FaceOptions* face_options) noexcept
      : options(face_options), copies_left(2 * std::uint64_t{tree.duplicate_count()}) {}

  [[nodiscard]] bool has_filter() const noexcept {
    return options != nullptr && options->filter.has_value();
  }

  /// Names the first of face `index` of the tree's order and its copies that the filter accepts;
  /// false if it accepts none. Precondition: has_filter().
  [[nodiscard]] bool name_wanted(const BoundTree& tree, std::uint32_t index, FaceRef& face) const {
    const FaceWithCopies faces(tree, index);
    for (std::uint32_t i = 0; i < faces.count(); ++i) {
      face = faces.face(i);
      if ((*options->filter)(face)) return true;
    }
    return false;
  }

  /// Calls visit(face) -> double with each of them that is wanted, the original first, which
  /// name(index) -> FaceRef names; it returns the largest parameter that is still of interest, to
  /// which `t_max` is lowered, or a negative number to stop. Errors: kNodeCorrupt.
  template <class Name, class Visit>
  [[nodiscard]] Errc visit_wanted(const BoundTree& tree, std::uint32_t index, double& t_max,
                                  Name&& name, const Visit& visit) {
    const FaceWithCopies faces(tree, index);
    stopped = faces.count() - 1 > copies_left;
    if (stopped) return Errc::kNodeCorrupt;
    copies_left -= faces.count() - 1;
    for (std::uint32_t i = 0; i < faces.count() && !stopped; ++i) {
      const FaceRef face = i == 0 ? name(index) : faces.face(i);
      if (has_filter() && !(*options->filter)(face)) continue;
      const double wanted_to = visit(face);
      stopped = !(wanted_to >= 0);
      t_max = std::min(t_max, wanted_to);
    }
    return Errc::kOk;
  }

  const FaceOptions* options;  // null: every face
  // In valid files each copy is visited once for each triangle of its face; in corrupt ones many
  // faces may have the same copies.
  std::uint64_t copies_left;
  bool stopped = false;
};

}  // namespace boxtree
