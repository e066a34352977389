// SPDX-License-Identifier: MIT
#include "cooker/write/temporary_name.h"

#include <cstdint>
#include <optional>
#ifdef _WIN32
#include <cerrno>
#include <random>
#include <stdexcept>
#else
#include <unistd.h>
#ifdef __APPLE__
#include <sys/random.h>
#endif
#endif

#include <fmt/format.h>

namespace boxtree::cooker {
namespace {

constexpr std::size_t kRandomDigits = 16;
constexpr std::size_t kLongestName = 200;  // of the target: a file name has at most 255 bytes

std::optional<std::uint64_t> random_number() {
#ifdef _WIN32
  try {
    std::random_device device;  // of the system
    return std::uint64_t{device()} << 32 | device();
  } catch (const std::runtime_error&) {
    errno = ENOSYS;
    return std::nullopt;
  }
#else
  std::uint64_t random = 0;
  if (::getentropy(&random, sizeof(random)) != 0) return std::nullopt;
  return random;
#endif
}

// Cut between characters of UTF-8, of which Windows takes no parts. They have 4 bytes at most.
std::string_view start_of(std::string_view target) {
  if (target.size() <= kLongestName) return target;
  std::size_t size = kLongestName;
  for (int i = 0; i < 3 && (static_cast<unsigned char>(target[size]) & 0xc0u) == 0x80u; ++i) --size;
  return target.substr(0, size);
}

}  // namespace

std::string temporary_prefix(std::string_view target) {
  return fmt::format(".{}.", start_of(target));
}

bool is_temporary_name(std::string_view name, std::string_view prefix) {
  if (name.size() != prefix.size() + kRandomDigits + kTemporaryEnding.size()) return false;
  const std::string_view digits = name.substr(prefix.size(), kRandomDigits);
  return name.starts_with(prefix) && name.ends_with(kTemporaryEnding) &&
         digits.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

std::string temporary_name(std::string_view target) {
  const std::optional<std::uint64_t> random = random_number();
  if (!random) return {};
  return fmt::format("{}{:016x}{}", temporary_prefix(target), *random, kTemporaryEnding);
}

}  // namespace boxtree::cooker
