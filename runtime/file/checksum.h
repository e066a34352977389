// SPDX-License-Identifier: MIT
// XXH3-64, the checksum of header and sections. It detects accidents, not attacks: memory safety
// never depends on it.
#pragma once

#include <cstdint>

#include "format/bytes.h"

namespace boxtree {

/// XXH3-64 (seed 0) of `head` followed by `tail`. Pure; never allocates.
[[nodiscard]] std::uint64_t checksum(Bytes head, Bytes tail = {}) noexcept;

}  // namespace boxtree
