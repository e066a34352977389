// SPDX-License-Identifier: MIT
// How large a section of a file is.
#pragma once

#include <cstddef>

#include <boxtree/file.h>

#include "runtime/file/open_file.h"

namespace boxtree::test {

/// Of tree 0; 0 if it has none.
[[nodiscard]] inline std::size_t section_bytes(const File& file, SectionKind kind) {
  return OpenFile::of(file).section(kind, 0).size();
}

}  // namespace boxtree::test
