// SPDX-License-Identifier: MIT
// Texts of documents that may hold anything.
#pragma once

#include <string>
#include <string_view>

#include "cooker/text/json.h"

namespace boxtree::cooker {

/// The text that is a member of an object; empty if there is none such.
[[nodiscard]] inline std::string text_at(const Json& object, std::string_view key) {
  const Json* const value = object.find(key);
  return value != nullptr && value->is_string() ? value->get<std::string>() : std::string();
}

}  // namespace boxtree::cooker
