// SPDX-License-Identifier: MIT
// Writes a pack of cooked files.
#pragma once

#include <cstdint>
#include <vector>

#include "cooker/write/output_target.h"
#include "cooker/write/pack_members.h"

namespace boxtree::cooker {

struct PackReport {
  std::uint64_t bytes = 0;
  std::uint64_t members = 0;
  std::uint64_t trees = 0;
};

/// Writes a pack, maps it, checks it (verify_checksums, check_pack) and commits it to `to`: on any
/// error before, the old file is unchanged. The bytes depend on the members and their names alone,
/// not on their order or paths. Reads members one by one, twice; memory is that of `members` and of
/// the index.
/// Errors: kInvalidQuery if two trees or members have one name, or there is no member;
/// kMeshTooLarge for more trees, names or bytes than a pack holds; those of `open`; kWriteFailed;
/// kFileUnreadable if an input changes meanwhile.
Result<PackReport> write_pack(const OutputTarget& to, std::vector<PackMember> members,
                              const OpenInput& open);

}  // namespace boxtree::cooker
