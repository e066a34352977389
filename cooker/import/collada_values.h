// SPDX-License-Identifier: MIT
// Checks what decides geometry in a Collada document: assimp believes its counts, takes words that
// are no number for others, and then reads past arrays or what the file does not say.
#pragma once

#include <string_view>

#include <boxtree/error.h>

namespace boxtree::cooker {

/// Limit of nested elements, which assimp visits by recursion.
inline constexpr int kMaxXmlDepth = 1024;

/// kImportFailed with the place, what is expected and what was found; kMeshIndexOutOfRange for
/// indices of vertices that are not there. XML without a COLLADA element passes. Time: linear in
/// the document.
Status check_collada(std::string_view file);

}  // namespace boxtree::cooker
