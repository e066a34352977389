// SPDX-License-Identifier: MIT
// SHA-256 (FIPS 180-4), by OpenSSL, or by the system on Windows: what names content in keys and
// caches, where nobody may make two contents of one name.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <boxtree/error.h>

#include "format/bytes.h"

namespace boxtree::cooker {

using Digest = std::array<std::byte, 32>;

/// A digest of bytes that come in parts. Throws std::bad_alloc.
class Sha256 {
 public:
  Sha256();
  void add(Bytes bytes);
  void add(std::string_view text);
  /// Of all that was added; call it once.
  [[nodiscard]] Digest finish();

 private:
  struct Context;  // of the library
  struct Free {
    void operator()(Context* context) const;
  };
  std::unique_ptr<Context, Free> context_;
};

[[nodiscard]] Digest sha256_of(std::string_view text);
[[nodiscard]] Digest sha256_of(Bytes bytes);
/// Of a file's bytes. Errors: those of read_chunks.
Result<Digest> sha256_of_file(const std::filesystem::path& path);

/// 64 digits in lower case.
[[nodiscard]] std::string hex_of(const Digest& digest);
/// What hex_of writes; nothing of another text.
[[nodiscard]] std::optional<Digest> digest_of(std::string_view hex);

}  // namespace boxtree::cooker
