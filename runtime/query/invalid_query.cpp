// SPDX-License-Identifier: MIT
#include "runtime/query/invalid_query.h"

namespace boxtree {

Error invalid_query(const char* argument) noexcept {
  return {Errc::kInvalidQuery, argument};
}

const char* invalid_field(const Approximation& approximation) noexcept {
  if (!(approximation.relative_error >= 0)) return "relative_error";
  if (!(approximation.absolute_error >= 0)) return "absolute_error";
  if (!(approximation.max_distance >= 0)) return "max_distance";
  return nullptr;
}

bool is_finite_box(const Eigen::AlignedBox3d& box) noexcept {
  return box.min().allFinite() && box.max().allFinite() &&
         (box.min().array() <= box.max().array()).all();
}

}  // namespace boxtree
