// SPDX-License-Identifier: MIT
// The record of how a file was made: JSON for people and build systems, stored in the file.
#pragma once

#include <string>

#include "cooker/cook.h"

namespace boxtree::cooker {

/// Tool, options and sources, without folders; a profile is recorded as a hash.
[[nodiscard]] std::string make_cook_record(const CookOptions& options, const CookInput& input,
                                           const Profile& profile);

}  // namespace boxtree::cooker
