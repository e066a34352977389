// SPDX-License-Identifier: MIT
// Words and numbers, read as assimp reads them.
#include <charconv>

#include <assimp/fast_atof.h>
#include <fmt/format.h>

#include <boxtree/cooker/import/flatten.h>
#include <boxtree/cooker/import/text_tokens.h>

namespace boxtree::cooker {
namespace {

struct NotANumber {
  template <class... Ignored>
  explicit NotANumber(Ignored&&... /*words*/) {}
};

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\0' || c == '\\';
}

// In the arithmetic of T; words that are no numbers count as 0.
template <class T, class Read>
Eigen::Vector3d position_as(const VertexWords& words, Read read) {
  std::array<T, 4> value{};
  for (std::size_t i = 0; i < 4; ++i) value[i] = read(words[i]).value_or(0);
  return {double{value[0] / value[3]}, double{value[1] / value[3]}, double{value[2] / value[3]}};
}

}  // namespace

void split_tokens(std::string_view text, Tokens& tokens) {
  tokens.clear();
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t start = i;
    while (i < text.size() && !is_space(text[i])) ++i;
    if (i > start) tokens.push_back(text.substr(start, i - start));
    while (i < text.size() && is_space(text[i])) ++i;
  }
}

std::optional<float> read_number(std::string_view token) {
  float number = 0;
  try {
    Assimp::fast_atoreal_move<float, NotANumber>(std::string(token).c_str(), number);
  } catch (const NotANumber&) {
    return std::nullopt;
  }
  return number;
}

std::optional<double> read_exact_number(std::string_view token) {
  const std::optional<float> rounded = read_number(token);
  if (!rounded) return std::nullopt;
  const std::size_t sign = token.starts_with('+') ? 1 : 0;
  double number = 0;
  const auto [end, error] =
      std::from_chars(token.data() + sign, token.data() + token.size(), number);
  // Spellings that only assimp reads ("1,5", "nan(...)") keep what it makes of them.
  return error == std::errc() && end == token.data() + token.size() ? number : double{*rounded};
}

Eigen::Vector3d read_position(const VertexWords& words, bool exact) {
  return exact ? position_as<double>(words, read_exact_number)
               : position_as<float>(words, read_number);
}

std::string marker_line(std::size_t fault) {
  return fmt::format("v nan inf {}\n", static_cast<long>(KnownFaults::marker(fault).z));
}

bool has_extension(const std::filesystem::path& path, std::string_view extension) {
  const std::string own = path.extension().string();
  if (own.size() != extension.size() + 1) return false;
  for (std::size_t i = 0; i < extension.size(); ++i) {
    const char c = own[i + 1];
    const char lower = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    if (lower != extension[i]) return false;
  }
  return true;
}

}  // namespace boxtree::cooker
