// SPDX-License-Identifier: MIT
// A file of many pages.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tests/support/cooked.h"
#include "tests/support/meshes.h"

namespace boxtree::test {

inline std::string cooked_pages() {
  const std::vector<std::byte> bytes = cook_bytes(terrain(60, 1), CodecId::kWide8);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace boxtree::test
