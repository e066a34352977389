// SPDX-License-Identifier: MIT
// A hint that no result depends on.
#pragma once

namespace boxtree::cooker {

/// Lets the processor read memory that is needed soon. Nothing where the compiler has no such hint.
inline void prefetch([[maybe_unused]] const void* memory) noexcept {
#if defined(__GNUC__) || defined(__clang__)
  __builtin_prefetch(memory);
#endif
}

}  // namespace boxtree::cooker
