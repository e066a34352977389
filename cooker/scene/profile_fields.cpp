// SPDX-License-Identifier: MIT
// Checks types and ranges; messages state the expected value.
#include "cooker/scene/profile_fields.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "cooker/text/nearest_name.h"

namespace boxtree::cooker {
namespace {

std::optional<double> number_in(const TomlNode& node) {
  if (const auto* integer = std::get_if<std::int64_t>(&node.value)) {
    return static_cast<double>(*integer);
  }
  const auto* number = std::get_if<double>(&node.value);
  return number != nullptr && std::isfinite(*number) ? std::optional(*number) : std::nullopt;
}

// What other programs call keys and values of profiles.
constexpr Synonym kSynonyms[] = {
    {"position", "translation"}, {"location", "translation"}, {"quaternion", "rotation"},
    {"transform", "matrix"},     {"pose", "matrix"},          {"path", "file"},
    {"grid_bits", "tolerance"},  {"exclude", "leave_out"},    {"skip", "leave_out"},
    {"move", "motion"},          {"moving", "motion"},        {"dynamic", "moving"},
    {"kinematic", "moving"},     {"moves", "moving"},         {"size", "memory"},
    {"small", "memory"},         {"fast", "speed"},
};

// `wording` may list the names itself.
std::string with_nearest(std::string_view wording, std::string_view name,
                         std::span<const std::string> names) {
  const std::string nearest = nearest_in_words(name, names, kSynonyms);
  const bool repeats = !names.empty() && nearest == fmt::format(" ({})", wording);
  return repeats ? std::string(wording) : std::string(wording) + nearest;
}

}  // namespace

void Complaints::add(std::uint32_t line, const std::string& text, Errc code) {
  if (!wants(line)) return;
  code_ = code;
  line_ = line;
  text_ = text;
}

void Complaints::expected(std::uint32_t line, std::string_view where, std::string_view expected,
                          std::string_view found) {
  if (wants(line)) add(line, fmt::format("{}: expected {}, found {}", where, expected, found));
}

void Complaints::add_table(const std::string& name, const std::vector<std::string>& keys) {
  const auto has_name = [&](const auto& table) { return table.first == name; };
  if (std::none_of(tables_.begin(), tables_.end(), has_name)) tables_.emplace_back(name, keys);
}

std::string Complaints::tables_with(std::string_view key) const {
  std::vector<std::string> names;
  for (const auto& [name, keys] : tables_) {
    if (std::find(keys.begin(), keys.end(), key) != keys.end()) names.push_back(name);
  }
  return listed(names);
}

Status Complaints::status() const {
  if (text_.empty()) return {};
  return Error{code_, fmt::format("{}:{}: {}", path_, line_, text_)};
}

const TomlEntry* Fields::find(std::string_view key) {
  if (!knows(key)) known_.emplace_back(key);
  const auto found = std::find_if(table_.begin(), table_.end(),
                                  [&](const TomlEntry& entry) { return entry.key == key; });
  return found == table_.end() ? nullptr : &*found;
}

std::optional<Stated<bool>> Fields::flag(std::string_view key) {
  const TomlEntry* entry = find(key);
  if (entry == nullptr) return std::nullopt;
  if (const auto* value = std::get_if<bool>(&entry->node.value)) {
    return Stated<bool>{*value, entry->line};
  }
  complaints_.expected(entry->line, key, "true or false", shown(entry->node));
  return std::nullopt;
}

std::optional<Stated<double>> Fields::number(std::string_view key, const NumberRange& range) {
  const TomlEntry* entry = find(key);
  if (entry == nullptr) return std::nullopt;
  const std::optional<double> value = number_in(entry->node);
  if (value && (range.low_included ? *value >= range.low : *value > range.low) &&
      *value <= range.high) {
    return Stated<double>{*value, entry->line};
  }
  complaints_.expected(entry->line, key, range.wording, shown(entry->node));
  return std::nullopt;
}

std::optional<Stated<std::uint64_t>> Fields::count(std::string_view key) {
  const TomlEntry* entry = find(key);
  if (entry == nullptr) return std::nullopt;
  const auto* value = std::get_if<std::int64_t>(&entry->node.value);
  if (value != nullptr && *value >= 1) {
    return Stated<std::uint64_t>{static_cast<std::uint64_t>(*value), entry->line};
  }
  const auto* number = std::get_if<double>(&entry->node.value);
  const bool is_spelt = number == nullptr || *number != std::floor(*number) || *number < 1;
  complaints_.expected(
      entry->line, key,
      is_spelt ? "a whole number of 1 or more" : "a whole number without a point or an exponent",
      shown(entry->node));
  return std::nullopt;
}

std::optional<Stated<std::string>> Fields::text(std::string_view key) {
  const TomlEntry* entry = find(key);
  if (entry == nullptr) return std::nullopt;
  const auto* value = std::get_if<std::string>(&entry->node.value);
  // The system takes a name to end there.
  const std::size_t nul = value == nullptr ? std::string::npos : value->find('\0');
  if (nul != std::string::npos) {
    complaints_.expected(entry->line, key, "a text without NUL characters",
                         fmt::format("one at byte {}", nul + 1));
  } else if (value != nullptr && !value->empty()) {
    return Stated<std::string>{*value, entry->line};
  } else {
    complaints_.expected(entry->line, key, "a text that is not empty", shown(entry->node));
  }
  return std::nullopt;
}

std::optional<Stated<std::string>> Fields::required_text(std::string_view key) {
  auto value = text(key);
  const bool is_there = std::any_of(table_.begin(), table_.end(),
                                    [&](const TomlEntry& entry) { return entry.key == key; });
  if (!is_there) {
    complaints_.expected(line_, where_, fmt::format("the key \"{}\"", key), found_instead_of(key));
  }
  return value;
}

// A key that is probably a misspelling of the one that is missing, or "none".
std::string Fields::found_instead_of(std::string_view key) const {
  const std::string meant(key);
  const auto misspelt = std::find_if(table_.begin(), table_.end(), [&](const TomlEntry& entry) {
    return !suggestion(entry.key, std::span(&meant, 1)).empty();
  });
  return misspelt == table_.end() ? "none"
                                  : fmt::format("\"{}\" in line {}", misspelt->key, misspelt->line);
}

std::optional<std::vector<Stated<std::string>>> Fields::texts(std::string_view key) {
  const TomlEntry* entry = find(key);
  if (entry == nullptr) return std::nullopt;
  const auto* array = std::get_if<TomlArray>(&entry->node.value);
  if (array == nullptr) {
    complaints_.expected(entry->line, key, "an array of texts", shown(entry->node));
    return std::nullopt;
  }
  std::vector<Stated<std::string>> values;
  for (const TomlNode& node : *array) {
    const auto* value = std::get_if<std::string>(&node.value);
    if (value == nullptr || value->empty()) {
      complaints_.expected(node.line, key, "texts that are not empty", shown(node));
      return std::nullopt;
    }
    values.push_back({*value, node.line});
  }
  return values;
}

std::optional<Stated<std::vector<double>>> Fields::numbers(std::string_view key, std::size_t count,
                                                           std::string_view wording) {
  const TomlEntry* entry = find(key);
  if (entry == nullptr) return std::nullopt;
  const auto* array = std::get_if<TomlArray>(&entry->node.value);
  if (array == nullptr || array->size() != count) {
    complaints_.expected(entry->line, key, wording, shown(entry->node));
    return std::nullopt;
  }
  std::vector<double> values;
  for (const TomlNode& node : *array) {
    const std::optional<double> value = number_in(node);
    if (!value) {
      complaints_.expected(node.line, key, kAnyNumber.wording, shown(node));
      return std::nullopt;
    }
    values.push_back(*value);
  }
  return Stated<std::vector<double>>{std::move(values), entry->line};
}

std::optional<Stated<std::uint32_t>> Fields::one_of(std::string_view key,
                                                    std::span<const std::string> names,
                                                    std::string_view wording) {
  const auto name = text(key);
  if (!name) return std::nullopt;
  const auto number = number_of(*name, key, names, wording);
  if (!number) return std::nullopt;
  return Stated<std::uint32_t>{*number, name->line};
}

std::optional<std::uint32_t> Fields::number_of(const Stated<std::string>& name,
                                               std::string_view key,
                                               std::span<const std::string> names,
                                               std::string_view wording) {
  const auto found = std::find(names.begin(), names.end(), name.value);
  if (found != names.end()) return static_cast<std::uint32_t>(found - names.begin());
  if (complaints_.wants(name.line)) {
    complaints_.expected(name.line, key, with_nearest(wording, name.value, names),
                         '"' + name.value + '"');
  }
  return std::nullopt;
}

void Fields::exclude(std::string_view first, std::string_view second) {
  const TomlEntry* one = find(first);
  const TomlEntry* other = find(second);
  if (one == nullptr || other == nullptr) return;
  if (one->line > other->line) std::swap(one, other);
  complaints_.expected(other->line, other->key,
                       fmt::format("either \"{}\" or \"{}\"", first, second), "both");
}

bool Fields::knows(std::string_view key) const {
  return std::find(known_.begin(), known_.end(), key) != known_.end();
}

bool Fields::is_misspelt(std::string_view key) {
  const std::array<std::string, 1> meant = {std::string(key)};
  const auto found = std::find_if(table_.begin(), table_.end(), [&](const TomlEntry& entry) {
    return !knows(entry.key) && !suggestion(entry.key, meant).empty();
  });
  if (found == table_.end()) return false;
  refuse(*found, meant);
  return true;
}

void Fields::finish() {
  if (where_.starts_with('[')) complaints_.add_table(where_, known_);  // not those of the profile
  for (const TomlEntry& entry : table_) {
    if (!knows(entry.key) && complaints_.wants(entry.line)) refuse(entry, known_);
  }
}

void Fields::refuse(const TomlEntry& entry, std::span<const std::string> known) {
  const std::string tables = complaints_.tables_with(entry.key);
  const std::string found = '"' + entry.key + '"';
  if (tables.empty()) {
    complaints_.expected(entry.line, where_, with_nearest("a known key", entry.key, known), found);
  } else {
    complaints_.expected(entry.line, where_, "a key of this table",
                         fmt::format("{}, a key of {}", found, tables));
  }
}

}  // namespace boxtree::cooker
