// SPDX-License-Identifier: MIT
// Convex shapes of C callers.
#pragma once

#include <array>
#include <cstddef>

#include "runtime/c/call.h"
#include "runtime/c/convert.h"

namespace boxtree::c {

/// Calls `query(shape)` with the shape of the C++ interface that is meant.
template <class Query>
bxt_status with_shape(const bxt_shape* given, bxt_error* error, Query query) {
  bxt_shape shape = {};
  if (!read_struct(given, shape)) return refuse(error, "shape: struct_size");
  switch (shape.kind) {
    case BXT_SPHERE:
      return query(Sphere{to_cpp(shape.position), shape.radius});
    case BXT_CAPSULE:
      return query(Capsule{to_cpp(shape.position), to_cpp(shape.end), shape.radius});
    case BXT_BOX:
      return query(
          OrientedBox{to_cpp(shape.position), to_cpp(shape.half_extents), to_cpp(shape.rotation)});
    case BXT_CONVEX_HULL: {
#if BOXTREE_HAS_HULL_QUERIES
      if (shape.points == nullptr || shape.point_count == 0 || shape.point_count > kMaxHullPoints) {
        return refuse(error, "shape: points, of which a hull has 1 to 256");
      }
      std::array<Eigen::Vector3d, kMaxHullPoints> points;
      const auto count = static_cast<std::size_t>(shape.point_count);
      for (std::size_t i = 0; i < count; ++i) points[i] = to_cpp(shape.points[i]);
      return query(
          ConvexHull{{points.data(), count}, to_cpp(shape.position), to_cpp(shape.rotation)});
#else
      return fail(error, Errc::kPartLeftOut, "convex hulls, of this library");
#endif
    }
    default:
      return refuse(error, "shape: kind");
  }
}

}  // namespace boxtree::c
