// SPDX-License-Identifier: MIT
// Which instruction sets walks may use.
#pragma once

#include <cstdint>

namespace boxtree {

/// Those that the machine has, as bits of Highway (HWY_AVX2), without those that
/// hwy::DisableTargets() or hwy::SetSupportedTargetsForTest() took away. Detects them once,
/// and again after these. Safe from any thread.
[[nodiscard]] std::int64_t chosen_targets() noexcept;

/// The one of them that walks of the wide codecs take, for people: "AVX2". As long as the program.
[[nodiscard]] const char* chosen_instruction_set() noexcept;

}  // namespace boxtree
