// SPDX-License-Identifier: MIT
// Appends names to the section that all names of a file share.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <unordered_map>

#include "cooker/text/utf8.h"

namespace boxtree::cooker {

/// Equal names share their bytes, as in rows of props and lines of a profile.
class NameTable {
 public:
  struct Name {
    std::uint32_t offset;
    std::uint32_t bytes;
  };

  /// `names` must outlive this object.
  explicit NameTable(std::string& names) : names_(names) {}

  /// Names longer than `most` bytes are cut: names are only for display.
  Name add(const std::string& given, std::size_t most = std::numeric_limits<std::uint32_t>::max()) {
    const std::string name = to_utf8(given, most);
    if (name.empty()) return {0, 0};
    const auto [known, is_new] =
        offsets_.try_emplace(name, static_cast<std::uint32_t>(names_.size()));
    if (is_new) names_ += name;
    return {known->second, static_cast<std::uint32_t>(name.size())};
  }

  /// Whether offsets hold all of them.
  [[nodiscard]] bool fits() const {
    return names_.size() <= std::numeric_limits<std::uint32_t>::max();
  }

 private:
  std::string& names_;
  std::unordered_map<std::string, std::uint32_t> offsets_;
};

}  // namespace boxtree::cooker
