// SPDX-License-Identifier: MIT
// What the operating system says of this process.
#pragma once

#include <cstdint>

namespace boxtree::cooker {

/// Processor time of the calling thread. Windows counts it in steps of 16 ms, too coarse for a
/// query, so there it is time of the clock.
[[nodiscard]] double thread_seconds() noexcept;

/// The most memory that the process had so far; 0 if that is not known.
[[nodiscard]] std::uint64_t peak_bytes() noexcept;

/// That the process may use: the machine's, or the limit of a container or task; 0 if that is not
/// known.
[[nodiscard]] std::uint64_t memory_bytes() noexcept;

/// Pages so far that were touched for the first time.
[[nodiscard]] std::uint64_t page_faults() noexcept;

}  // namespace boxtree::cooker
