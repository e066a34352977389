// SPDX-License-Identifier: MIT
// What tests of caches store.
#pragma once

#include <cstdint>

#include "cooker/farm/sha256.h"

namespace boxtree::test {

inline const cooker::Digest kKey = cooker::sha256_of("key");
inline constexpr std::uint64_t kRoom = std::uint64_t{1} << 40;  // of a cache, enough for all

}  // namespace boxtree::test
