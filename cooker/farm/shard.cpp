// SPDX-License-Identifier: MIT
#include "cooker/farm/shard.h"

namespace boxtree::cooker {

std::uint32_t shard_of(const Digest& digest, std::uint32_t count) {
  std::uint64_t number = 0;
  for (std::size_t i = 0; i < 8; ++i) {
    number = number << 8 | std::to_integer<std::uint64_t>(digest[i]);
  }
  return static_cast<std::uint32_t>(number % count);
}

}  // namespace boxtree::cooker
