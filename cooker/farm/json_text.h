// SPDX-License-Identifier: MIT
// Texts, and states of files, of documents that may hold anything.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "cooker/farm/file_state.h"
#include "cooker/text/json.h"

namespace boxtree::cooker {

/// The text that is a member of an object; empty if there is none such.
[[nodiscard]] inline std::string text_at(const Json& object, std::string_view key) {
  const Json* const value = object.find(key);
  return value != nullptr && value->is_string() ? value->get<std::string>() : std::string();
}

/// The five numbers of a state, in the order of its members.
[[nodiscard]] inline Json to_json(const FileState& state) {
  Json numbers = Json::array();
  for (const std::uint64_t number : state.numbers) numbers.push_back(number);
  return numbers;
}

/// The state that is the member "state" of an object; nothing if there is none such.
[[nodiscard]] inline std::optional<FileState> state_in(const Json& line) {
  const Json* const numbers = line.find("state");
  FileState state;
  if (numbers == nullptr || !numbers->is_array() || numbers->size() != state.numbers.size())
    return std::nullopt;
  std::size_t i = 0;
  for (const Json& number : *numbers) {
    if (!number.is_number_unsigned()) return std::nullopt;
    state.numbers[i++] = number.get<std::uint64_t>();
  }
  return state;
}

}  // namespace boxtree::cooker
