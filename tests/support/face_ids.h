// SPDX-License-Identifier: MIT
// Sections of face ids.
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "cooker/encode/face_ids.h"

namespace boxtree::test {

using Ids = std::vector<std::uint32_t>;

[[nodiscard]] inline Ids ascending(std::uint32_t count) {
  Ids ids(count);
  std::iota(ids.begin(), ids.end(), 0u);
  return ids;
}

/// The section of faces that have these ids, in their order.
[[nodiscard]] inline std::vector<std::byte> encoded(const Ids& ids) {
  cooker::SourceMesh mesh;
  mesh.face_ids = ids;
  return cooker::encode_face_ids(mesh, ascending(static_cast<std::uint32_t>(ids.size())));
}

}  // namespace boxtree::test
