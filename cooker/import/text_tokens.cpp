// SPDX-License-Identifier: MIT
#include "cooker/import/text_tokens.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <limits>

#include <fmt/format.h>

namespace boxtree::cooker {
namespace {

// Space, tab, and what ends a line or a page: from \t to \r there is nothing else.
bool is_space(char c) {
  static_assert('\n' == '\t' + 1 && '\v' == '\t' + 2 && '\f' == '\t' + 3 && '\r' == '\t' + 4);
  return c == ' ' || (c >= '\t' && c <= '\r');
}

// `token` in the spelling of from_chars, which does not accept a plus sign.
std::string_view without_plus(std::string_view token) {
  const bool has_plus = token.size() > 1 && token[0] == '+' && token[1] != '-';
  return token.substr(has_plus ? 1 : 0);
}

template <class T>
std::optional<T> read_whole(std::string_view digits) {
  T number = 0;
  const char* const last = digits.data() + digits.size();
  const auto [end, error] = std::from_chars(digits.data(), last, number);
  if (error != std::errc() || end != last) return std::nullopt;
  return number;
}

// Whether a number that from_chars finds out of range is too small rather than too large.
bool is_below_one(std::string_view digits) {
  if (digits.starts_with('-')) digits.remove_prefix(1);
  const std::size_t mantissa = std::min(digits.find_first_of("eE"), digits.size());
  std::int64_t exponent = 0;
  if (mantissa < digits.size()) {
    const bool has_plus = digits.substr(mantissa + 1).starts_with('+');
    const char* const last = digits.data() + digits.size();
    const char* const first = digits.data() + mantissa + (has_plus ? 2 : 1);
    if (std::from_chars(first, last, exponent).ec != std::errc()) return *first == '-';
  }
  // Place of the first non-zero digit relative to the point.
  const std::size_t point = std::min(digits.find('.'), mantissa);
  const std::size_t first = digits.find_first_of("123456789");
  const auto place = static_cast<std::int64_t>(point) - static_cast<std::int64_t>(first);
  return place < -exponent;
}

template <class T>
std::optional<Eigen::Vector3d> position_as(const VertexWords& words) {
  std::array<T, 4> value{};
  for (std::size_t i = 0; i < 4; ++i) {
    const std::optional<T> number = read_number<T>(words[i]);
    if (!number) return std::nullopt;
    value[i] = *number;
  }
  return Eigen::Vector3d(value[0] / value[3], value[1] / value[3], value[2] / value[3]);
}

}  // namespace

bool begins_with_solid(std::string_view text) {
  return in_lower_case(text.substr(0, 5)) == "solid";
}

std::string_view without_blanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") + 1 - first);
}

std::string in_lower_case(std::string_view word) {
  std::string lower(word);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return lower;
}

Result<std::string_view> text_of(std::string_view file) {
  const std::string_view text = file.substr(0, file.find_last_not_of('\0') + 1);
  const std::size_t zero = text.find('\0');
  if (zero == std::string_view::npos) return text;
  const std::string_view before = text.substr(0, zero);
  return Error{Errc::kImportFailed,
               fmt::format("line {}: a zero byte: no text, or one in UTF-16",
                           std::count(before.begin(), before.end(), '\n') + 1)};
}

bool has_open_end(std::string_view text) {
  return !text.empty() && text.back() != '\n' && text.back() != '\r';
}

std::string_view take_line(std::string_view& rest) {
  // Lines are short: a loop takes less time than find_first_of, which calls a function for each
  // character.
  std::size_t end = 0;
  while (end < rest.size() && rest[end] != '\n' && rest[end] != '\r') ++end;
  const std::string_view line = rest.substr(0, end);
  const std::size_t end_bytes = rest.substr(end).starts_with("\r\n") ? 2 : 1;
  rest.remove_prefix(std::min(end + end_bytes, rest.size()));
  return line;
}

void split_tokens(std::string_view text, Tokens& tokens) {
  tokens.clear();
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t start = i;
    while (i < text.size() && !is_space(text[i])) ++i;
    if (i > start) tokens.push_back(text.substr(start, i - start));
    while (i < text.size() && is_space(text[i])) ++i;
  }
}

std::optional<std::int64_t> read_integer(std::string_view token) {
  return read_whole<std::int64_t>(without_plus(token));
}

std::optional<std::uint64_t> read_count(std::string_view token) {
  return read_whole<std::uint64_t>(token);
}

template <class T>
std::optional<T> read_number(std::string_view token) {
  const std::string_view digits = without_plus(token);
  const char* const last = digits.data() + digits.size();
  T number = 0;
  const auto [end, error] = std::from_chars(digits.data(), last, number);
  if (end != last || error == std::errc::invalid_argument) return std::nullopt;
  if (error == std::errc()) return number;
  const T beyond = is_below_one(digits) ? T{0} : std::numeric_limits<T>::infinity();
  return digits.starts_with('-') ? -beyond : beyond;
}
template std::optional<float> read_number(std::string_view token);
template std::optional<double> read_number(std::string_view token);

std::string_view find_no_number(std::span<const std::string_view> tokens) {
  // Most are numbers of vertices, which need not be read to be recognised.
  const auto is_whole = [](std::string_view token) {
    return !token.empty() && std::all_of(token.begin(), token.end(), is_digit);
  };
  const auto found = std::find_if(tokens.begin(), tokens.end(), [&](std::string_view token) {
    return !is_whole(token) && !read_number<float>(token);
  });
  return found == tokens.end() ? std::string_view() : *found;
}

std::optional<Eigen::Vector3d> read_position(const VertexWords& words, Precision precision) {
  return precision == Precision::kF32 ? position_as<float>(words) : position_as<double>(words);
}

bool has_extension(const std::filesystem::path& path, std::string_view extension) {
  const std::string own = in_lower_case(path.extension().string());
  return own.starts_with('.') && std::string_view(own).substr(1) == extension;
}

}  // namespace boxtree::cooker
