// SPDX-License-Identifier: MIT
// Checks that text files read by assimp have the end that their format defines: assimp accepts
// truncated files.
#pragma once

#include <string_view>

#include <boxtree/error.h>

namespace boxtree::cooker {

/// AC3D: each object has as many children as it states. Error: kImportFailed.
Status check_ac_end(std::string_view file);

/// ASE, MD5: each brace is closed. A file truncated between two blocks passes. Error:
/// kImportFailed.
Status check_blocks_end(std::string_view file);

/// DXF as text: the last entity is EOF. Error: kImportFailed; none for binary files.
Status check_dxf_end(std::string_view file);

/// SMD: each block is closed by "end". A file truncated between two blocks passes. Error:
/// kImportFailed.
Status check_smd_end(std::string_view file);

}  // namespace boxtree::cooker
