// SPDX-License-Identifier: MIT
// Reads lists of faces that may be dropped.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "cooker/scene/profile.h"

namespace boxtree::cooker {

/// Numbers of source faces, one number or range ("12-40") per line; '#' starts a comment. Returns
/// ascending ranges; adjacent ones are joined. Error: kProfileInvalid, "LIST:3: expected ..., found
/// ...".
Result<std::vector<FaceRange>> parse_hidden_faces(std::string_view text, std::string_view list);

/// Whether `ascending` contains a face.
[[nodiscard]] bool is_hidden(const std::vector<FaceRange>& ascending, std::uint32_t face);

}  // namespace boxtree::cooker
