// SPDX-License-Identifier: MIT
// Whether texts of formats that assimp alone understands go on to the end that their format gives
// them: of a file that was cut short its readers take what is there.
#pragma once

#include <string_view>

#include <boxtree/error.h>

namespace boxtree::cooker {

/// AC3D: each object says how many follow below it, and they do. kImportFailed.
Status check_ac_end(std::string_view file);

/// ASE, MD5: each brace is closed. A file that was cut between two blocks looks whole.
/// kImportFailed.
Status check_blocks_end(std::string_view file);

/// DXF as text: the last entity is EOF. kImportFailed; no error for binary files.
Status check_dxf_end(std::string_view file);

/// SMD: each block is closed by "end". A file that was cut between two blocks looks whole.
/// kImportFailed.
Status check_smd_end(std::string_view file);

}  // namespace boxtree::cooker
