// SPDX-License-Identifier: MIT
// Typed reading of a profile's tables; keys that no reader requests are reported.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cooker/scene/profile.h"
#include "cooker/scene/toml_tree.h"

namespace boxtree::cooker {

/// Tables, "[scene]", in the order of their reading, each with the keys that it may have.
using TableKeys = std::vector<std::pair<std::string, std::vector<std::string>>>;

/// The first fault of a profile: of several complaints the one with the smallest line is kept.
class Complaints {
 public:
  /// `tables`: of all profiles, for messages about a key that stands in another table.
  explicit Complaints(std::string path, TableKeys tables = {})
      : path_(std::move(path)), tables_(std::move(tables)) {}

  /// Notes the keys of a table, once for all tables of that name.
  void add_table(const std::string& name, const std::vector<std::string>& keys);
  [[nodiscard]] const TableKeys& tables() const { return tables_; }
  /// "[scene] or [[object]]": the tables that may have a key; empty if none may.
  [[nodiscard]] std::string tables_with(std::string_view key) const;

  /// Whether a complaint of this line would be kept; if not, its text need not be made.
  [[nodiscard]] bool wants(std::uint32_t line) const { return text_.empty() || line < line_; }
  void add(std::uint32_t line, const std::string& text, Errc code = Errc::kProfileInvalid);
  /// "WHERE: expected EXPECTED, found FOUND".
  void expected(std::uint32_t line, std::string_view where, std::string_view expected,
                std::string_view found);
  [[nodiscard]] Status status() const;

 private:
  std::string path_;
  TableKeys tables_;
  Errc code_ = Errc::kProfileInvalid;
  std::string text_;
  std::uint32_t line_ = 0;
};

/// The range of allowed numbers.
struct NumberRange {
  const char* wording;  // "a number above 0"
  double low;
  bool low_included;
  double high = std::numeric_limits<double>::infinity();  // included
};
inline constexpr NumberRange kAnyNumber = {"a finite number", std::numeric_limits<double>::lowest(),
                                           true};
inline constexpr NumberRange kAboveZero = {"a number above 0", 0, false};
inline constexpr NumberRange kSharpAngle = {"degrees from 0 to 90", 0, true, 90};

/// The keys of one table. Each reader returns nothing if the key is missing or its value is
/// invalid; invalid values are reported.
class Fields {
 public:
  /// `where` is the name of the table in messages: "[scene]". `line`: of its header.
  Fields(const TomlTable& table, std::string where, std::uint32_t line, Complaints& complaints)
      : table_(table), where_(std::move(where)), line_(line), complaints_(complaints) {}

  [[nodiscard]] std::uint32_t line() const { return line_; }
  [[nodiscard]] Complaints& complaints() { return complaints_; }

  const TomlEntry* find(std::string_view key);
  std::optional<Stated<bool>> flag(std::string_view key);
  std::optional<Stated<double>> number(std::string_view key, const NumberRange& range);
  std::optional<Stated<std::uint64_t>> count(std::string_view key);  // 1 or more
  std::optional<Stated<std::string>> text(std::string_view key);     // not empty
  std::optional<Stated<std::string>> required_text(std::string_view key);
  /// Each with its own line.
  std::optional<std::vector<Stated<std::string>>> texts(std::string_view key);
  std::optional<Stated<std::vector<double>>> numbers(std::string_view key, std::size_t count,
                                                     std::string_view wording);
  /// The index of a value in `names`.
  std::optional<Stated<std::uint32_t>> one_of(std::string_view key,
                                              std::span<const std::string> names,
                                              std::string_view wording);
  /// The index of a name that was read; an unknown name is reported with the nearest known one.
  std::optional<std::uint32_t> number_of(const Stated<std::string>& name, std::string_view key,
                                         std::span<const std::string> names,
                                         std::string_view wording);
  /// Reports two keys that exclude each other, at the later one.
  void exclude(std::string_view first, std::string_view second);
  /// Whether a key that was not requested is `key`, misspelt; reports it.
  bool is_misspelt(std::string_view key);
  /// Whether the key was requested.
  [[nodiscard]] bool knows(std::string_view key) const;
  /// Reports all keys that were not requested.
  void finish();

 private:
  [[nodiscard]] std::string found_instead_of(std::string_view key) const;
  void refuse(const TomlEntry& entry, std::span<const std::string> known);

  const TomlTable& table_;
  std::string where_;
  std::uint32_t line_;
  Complaints& complaints_;
  std::vector<std::string> known_;
};

}  // namespace boxtree::cooker
