// SPDX-License-Identifier: MIT
// Writes all bytes to a descriptor, although the system may take fewer at a time or be interrupted.
#pragma once

#include <cerrno>
#include <cstddef>

#include "cooker/system/descriptor.h"
#include "format/bytes.h"

namespace boxtree::cooker {

/// Writes all bytes. False, with the reason in errno, if the system takes no more.
[[nodiscard]] inline bool write_all(int descriptor, Bytes bytes) noexcept {
  while (!bytes.empty()) {
    const std::ptrdiff_t wrote = write_some(descriptor, bytes);
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote < 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(wrote));
  }
  return true;
}

}  // namespace boxtree::cooker
