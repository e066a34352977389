// SPDX-License-Identifier: MIT
// The frustum of a query: of any planes, matrix or corners.
#pragma once

#include <array>

#include <boxtree/boxtree.h>

#include "tests/fuzz/query_input.h"

namespace boxtree::fuzz {

[[nodiscard]] inline Frustum frustum_of(const QueryInput& query) {
  switch (query.option(4) % 3) {
    case 0: {
      Frustum frustum;
      for (std::size_t i = 0; i < frustum.planes.size(); ++i) {
        frustum.planes[i] << query.vector(i), query.number(6 + i);
      }
      return frustum;
    }
    case 1: {
      Frustum::ViewProjection matrix = Frustum::ViewProjection::Identity();
      for (std::size_t i = 0; i < 12; ++i) {
        matrix(static_cast<Eigen::Index>(i / 4), static_cast<Eigen::Index>(i % 4)) =
            query.number(i);
      }
      if (query.option(4) >= 128) matrix.row(3).swap(matrix.row(2));
      return Frustum::of(matrix, static_cast<ClipDepth>(query.option(7) % 2));
    }
    default:
      std::array<Eigen::Vector3d, 8> corners;
      for (std::size_t i = 0; i < corners.size(); ++i) {
        corners[i] = query.vector(i % 4) + (i < 4 ? Eigen::Vector3d::Zero() : query.vector(9));
      }
      return Frustum::of(corners);
  }
}

}  // namespace boxtree::fuzz
