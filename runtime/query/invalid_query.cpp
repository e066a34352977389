// SPDX-License-Identifier: MIT
#include "runtime/query/invalid_query.h"

#include "runtime/query/approximation.h"
#include "runtime/query/ray_query.h"

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

const char* refused_field(const Ray& ray) noexcept {
  const char* const field = invalid_field(ray, largest_magnitude(ray.direction));
  return field != nullptr ? field : "origin";
}

bool is_finite_box(const Eigen::AlignedBox3d& box) noexcept {
  return box.min().allFinite() && box.max().allFinite() &&
         (box.min().array() <= box.max().array()).all();
}

}  // namespace boxtree
