// SPDX-License-Identifier: MIT
// Sections grow record by record.
#pragma once

#include <cstddef>
#include <type_traits>
#include <vector>

namespace boxtree::cooker {

/// Appends the bytes of a record or number to those of a section.
template <class T>
void append(std::vector<std::byte>& bytes, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  const auto* const from = reinterpret_cast<const std::byte*>(&value);
  bytes.insert(bytes.end(), from, from + sizeof(T));
}

}  // namespace boxtree::cooker
