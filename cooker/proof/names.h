// SPDX-License-Identifier: MIT
// Checks texts in the section of names, to which trees and scenes refer by offset and size.
#pragma once

#include <cstdint>
#include <string>

#include <boxtree/error.h>

#include "cooker/text/utf8.h"
#include "format/bytes.h"

namespace boxtree::cooker {

/// kRecordInvalid, with a message that begins with `what`, unless the text is inside the section
/// and UTF-8.
[[nodiscard]] inline Status check_text(Bytes names, std::uint32_t offset, std::uint32_t bytes,
                                       const std::string& what) {
  if (!in_range(offset, bytes, names.size())) {
    return Error{Errc::kRecordInvalid, what + " lies outside section names"};
  }
  const auto* const text = reinterpret_cast<const char*>(names.data());
  if (bytes == 0 || is_utf8({text + offset, bytes})) return {};
  return Error{Errc::kRecordInvalid, what + " is no UTF-8"};
}

}  // namespace boxtree::cooker
