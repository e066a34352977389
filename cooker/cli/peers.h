// SPDX-License-Identifier: MIT
// boxtree_peers as a program of its own: the original and other libraries are no part of the
// product.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <boxtree/error.h>

#include "cooker/report/paper_tables.h"

namespace boxtree::cooker {

/// Runs `program` with `arguments` and --json. Its messages go where ours do unless `quiet`.
/// Errors: as read_failure when it does not start, kFileUnreadable when it fails; kDocumentInvalid
/// when it prints no rows.
Result<std::vector<PeerRow>> run_peers(const std::filesystem::path& program,
                                       const std::vector<std::string>& arguments, bool quiet);

}  // namespace boxtree::cooker
