// SPDX-License-Identifier: MIT
// Words and numbers, of which assimp's spellings are the widest.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

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

// Spellings of its own; no more digits than f32 has.
std::optional<float> read_as_assimp(std::string_view token) {
  float number = 0;
  try {
    Assimp::fast_atoreal_move<float, NotANumber>(std::string(token).c_str(), number);
  } catch (const NotANumber&) {
    return std::nullopt;
  }
  return number;
}

}  // namespace

std::string_view take_line(std::string_view& rest) {
  const std::size_t end = std::min(rest.find_first_of("\r\n"), rest.size());
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

std::optional<std::uint64_t> read_count(std::string_view token) {
  std::uint64_t count = 0;
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), count);
  if (error != std::errc() || end != token.data() + token.size()) return std::nullopt;
  return count;
}

template <class T>
std::optional<T> read_number(std::string_view token) {
  // from_chars knows no plus sign.
  const bool has_plus = token.size() > 1 && token[0] == '+' && token[1] != '-';
  const char* const first = token.data() + (has_plus ? 1 : 0);
  const char* const last = token.data() + token.size();
  T number = 0;
  const auto [end, error] = std::from_chars(first, last, number);
  if (end == last && error == std::errc()) return number;
  if (end == last && error == std::errc::result_out_of_range) {
    // What is beyond long double as well, assimp takes for infinite or zero.
    long double wide = 0;
    if (std::from_chars(first, last, wide).ec == std::errc()) {
      const T beyond = std::abs(wide) > 1 ? std::numeric_limits<T>::infinity() : T{0};
      return std::copysign(beyond, static_cast<T>(std::signbit(wide) ? -1 : 1));
    }
  }
  const std::optional<float> rounded = read_as_assimp(token);
  return rounded ? std::optional<T>(*rounded) : std::nullopt;
}
template std::optional<float> read_number(std::string_view token);
template std::optional<double> read_number(std::string_view token);

std::string_view find_no_number(std::span<const std::string_view> tokens) {
  const auto found = std::find_if(tokens.begin(), tokens.end(), [](std::string_view token) {
    return !read_number<float>(token);
  });
  return found == tokens.end() ? std::string_view() : *found;
}

std::optional<Eigen::Vector3d> read_position(const VertexWords& words, Precision precision) {
  return precision == Precision::kF32 ? position_as<float>(words) : position_as<double>(words);
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
