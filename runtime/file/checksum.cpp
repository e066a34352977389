// SPDX-License-Identifier: MIT
// XXH3-64, compiled in here alone, so that the runtime links no further library.
#include "runtime/file/checksum.h"

#include <new>

#include "runtime/file/checksum_stream.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace boxtree {

std::uint64_t checksum(Bytes head, Bytes tail) noexcept {
  if (tail.empty()) return XXH3_64bits(head.data(), head.size());
  ChecksumStream stream;
  stream.add(head);
  stream.add(tail);
  return stream.value();
}

ChecksumStream::ChecksumStream() noexcept {
  static_assert(sizeof(state_) >= sizeof(XXH3_state_t) &&
                alignof(ChecksumStream) >= alignof(XXH3_state_t));
  XXH3_64bits_reset(::new (state_.data()) XXH3_state_t);
}

void ChecksumStream::add(Bytes bytes) noexcept {
  XXH3_64bits_update(std::launder(reinterpret_cast<XXH3_state_t*>(state_.data())), bytes.data(),
                     bytes.size());
}

std::uint64_t ChecksumStream::value() const noexcept {
  return XXH3_64bits_digest(std::launder(reinterpret_cast<const XXH3_state_t*>(state_.data())));
}

}  // namespace boxtree
