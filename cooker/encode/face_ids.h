// SPDX-License-Identifier: MIT
// The numbers of source faces (reader: format/face_ids.h), which all geometry stores may have.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cooker/import/source_mesh.h"

namespace boxtree::cooker {

/// Section face_ids of the faces in `order`, as small as its form allows. Precondition: `order` is
/// not empty.
[[nodiscard]] std::vector<std::byte> encode_face_ids(const SourceMesh& mesh,
                                                     std::span<const std::uint32_t> order);

/// Whether the faces in `order` have the ids 0, 1, 2 and so on, so that no section is needed.
[[nodiscard]] bool is_in_source_order(const SourceMesh& mesh, std::span<const std::uint32_t> order);

}  // namespace boxtree::cooker
