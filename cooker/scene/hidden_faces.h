// SPDX-License-Identifier: MIT
// Lists of faces that a user allows to be dropped.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "cooker/scene/profile.h"

namespace boxtree::cooker {

/// Numbers of source faces, one number or range ("12-40") a line; '#' starts a comment. Returned
/// ascending, joined where they touch. Error: kProfileInvalid, "LIST:3: expected ..., found ...".
Result<std::vector<FaceRange>> parse_hidden_faces(std::string_view text, std::string_view list);

/// Whether such a list has a face.
[[nodiscard]] bool is_hidden(const std::vector<FaceRange>& ascending, std::uint32_t face);

}  // namespace boxtree::cooker
