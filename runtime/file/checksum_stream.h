// SPDX-License-Identifier: MIT
// The checksum of bytes that arrive in pieces.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "format/bytes.h"

namespace boxtree {

/// XXH3-64 (seed 0) of all that was added. Never allocates.
class ChecksumStream {
 public:
  ChecksumStream() noexcept;
  void add(Bytes bytes) noexcept;
  [[nodiscard]] std::uint64_t value() const noexcept;

 private:
  // Holds XXH3's own state, which only checksum.cpp knows.
  alignas(64) std::array<std::byte, 640> state_;
};

}  // namespace boxtree
