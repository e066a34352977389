// SPDX-License-Identifier: MIT
#include "cooker/text/at_most.h"

#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "cooker/text/number_of.h"

namespace boxtree::cooker {

std::string at_most(double bound, int digits) {
  std::string nearest = fmt::format("{:.{}g}", bound, digits);
  const double told = number_of<double>(nearest).value_or(bound);
  if (!(told < bound)) return nearest;
  // One more in the last digit, whose place d.dde-07 tells.
  const std::string parts = fmt::format("{:.{}e}", told, digits - 1);
  const std::size_t sign = parts.find('e') + 1;
  const int exponent = number_of<int>(parts.substr(sign + (parts[sign] == '+'))).value_or(0);
  return fmt::format("{:.{}g}", told + std::pow(10.0, exponent + 1 - digits), digits);
}

std::string moves_in_words(double max_vertex_error) {
  return max_vertex_error > 0 ? "no vertex moved by more than " + at_most(max_vertex_error, 3)
                              : "no vertex moved";
}

}  // namespace boxtree::cooker
