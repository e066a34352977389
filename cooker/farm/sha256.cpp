// SPDX-License-Identifier: MIT
#include "cooker/farm/sha256.h"

#include <charconv>
#include <span>
#include <system_error>

#include "cooker/import/whole_file.h"

namespace boxtree::cooker {
void Sha256::add(std::string_view text) {
  add(std::as_bytes(std::span(text)));
}

Digest sha256_of(Bytes bytes) {
  Sha256 sha;
  sha.add(bytes);
  return sha.finish();
}

Digest sha256_of(std::string_view text) {
  return sha256_of(std::as_bytes(std::span(text)));
}

Result<Digest> sha256_of_file(const std::filesystem::path& path) {
  Sha256 sha;
  const Status status = read_chunks(path, kAnyBytes, [&sha](const char* bytes, std::size_t count) {
    sha.add(std::string_view(bytes, count));
  });
  if (!status) return status.error();
  return sha.finish();
}

std::string hex_of(const Digest& digest) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string hex;
  hex.reserve(2 * digest.size());
  for (const std::byte byte : digest) {
    hex += kDigits[std::to_integer<std::size_t>(byte >> 4)];
    hex += kDigits[std::to_integer<std::size_t>(byte & std::byte{15})];
  }
  return hex;
}

std::optional<Digest> digest_of(std::string_view hex) {
  Digest digest;
  if (hex.size() != 2 * digest.size()) return std::nullopt;
  for (std::size_t i = 0; i < digest.size(); ++i) {
    unsigned value = 0;
    const char* const end = hex.data() + 2 * i + 2;
    const auto [stopped, error] = std::from_chars(end - 2, end, value, 16);
    if (error != std::errc() || stopped != end) return std::nullopt;
    digest[i] = static_cast<std::byte>(value);
  }
  return hex_of(digest) == hex ? std::optional(digest) : std::nullopt;
}

}  // namespace boxtree::cooker
