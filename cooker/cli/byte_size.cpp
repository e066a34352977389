// SPDX-License-Identifier: MIT
#include "cooker/cli/byte_size.h"

#include <charconv>
#include <cmath>
#include <system_error>

#include <fmt/format.h>

namespace boxtree::cooker {

std::optional<std::uint64_t> byte_size(std::string_view text) {
  constexpr std::string_view kUnits = "KMGT";
  int exponent = 0;
  if (!text.empty()) {
    const std::size_t unit = kUnits.find(text.back());
    if (unit != std::string_view::npos) {
      exponent = 10 * (static_cast<int>(unit) + 1);
      text.remove_suffix(1);
    }
  }
  double number = 0;
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, number, std::chars_format::fixed);
  if (error != std::errc() || stopped != end || !std::isfinite(number)) return std::nullopt;
  const double bytes = std::floor(std::ldexp(number, exponent));
  if (!(bytes >= 1) || bytes >= std::ldexp(1.0, 63)) return std::nullopt;
  return static_cast<std::uint64_t>(bytes);
}

std::string byte_size_fault(const std::string& text) {
  if (byte_size(text)) return {};
  return fmt::format("expected a number of bytes, as 512M or 8G, found \"{}\"", text);
}

}  // namespace boxtree::cooker
