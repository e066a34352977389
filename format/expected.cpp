// SPDX-License-Identifier: MIT
// What queries expect of their arguments. Queries return names of arguments alone, which a
// std::string takes without allocating; only who prints an error links these texts.
#include <cstddef>
#include <string_view>

#include <boxtree/error.h>

namespace boxtree {
namespace {

constexpr std::string_view kInRange = "a finite point, at most 2^185 mesh extents away";
constexpr std::string_view kFinite = "finite and 0 or more";
constexpr std::string_view kUnsigned = "0 or more";

struct Expectation {
  std::string_view argument;
  std::string_view expected;
};
constexpr Expectation kExpectations[] = {
    {"origin", kInRange},
    {"center", kInRange},
    {"start", kInRange},
    {"end", kInRange},
    {"position", kInRange},
    {"point", kInRange},
    {"points", "1 to 256 finite points, none farther than 2^185 mesh extents away"},
    {"direction", "finite, and not zero for a ray"},
    {"radius", kFinite},
    {"half_extents", kFinite},
    {"rotation", "four finite numbers, not all 0"},
    {"t_min", kUnsigned},
    {"t_max", "0 or more, and of a ray not less than t_min"},
    {"distance", kUnsigned},
    {"max_distance", kUnsigned},
    {"relative_error", kUnsigned},
    {"absolute_error", kUnsigned},
    {"box", "finite corners, min not above max on any axis"},
    {"struct_size", "sizeof the struct, and zeros in newer members"},
    {"planes", "a matrix of finite numbers, and of rows whose sums are finite"},
};

}  // namespace

std::string_view expected_of(std::string_view argument) noexcept {
  const std::size_t before = argument.rfind(": ");  // "hit: struct_size"
  if (before != std::string_view::npos) argument.remove_prefix(before + 2);
  for (const Expectation& each : kExpectations) {
    if (each.argument == argument) return each.expected;
  }
  return {};
}

}  // namespace boxtree
