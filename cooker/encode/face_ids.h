// SPDX-License-Identifier: MIT
// The numbers of source faces, which all geometry stores hold.
#pragma once

#include <span>

#include "cooker/encode/encoded.h"

namespace boxtree::cooker {

/// Source numbers of the faces in `order`, in as few bytes as the largest takes.
void encode_face_ids(const SourceMesh& mesh, std::span<const std::uint32_t> order,
                     EncodedGeometry& out);

}  // namespace boxtree::cooker
