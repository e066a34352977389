// SPDX-License-Identifier: MIT
// XXH3-64, compiled in so that the runtime needs no further library at link time.
#include <boxtree/runtime/file/checksum.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace boxtree {

std::uint64_t checksum(Bytes head, Bytes tail) noexcept {
  if (tail.empty()) return XXH3_64bits(head.data(), head.size());
  XXH3_state_t state;
  XXH3_64bits_reset(&state);
  XXH3_64bits_update(&state, head.data(), head.size());
  XXH3_64bits_update(&state, tail.data(), tail.size());
  return XXH3_64bits_digest(&state);
}

}  // namespace boxtree
