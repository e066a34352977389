// SPDX-License-Identifier: MIT
// A stdio file that closes itself. Unlike streams, stdio reports the reason of errors.
#pragma once

#include <cstdio>
#include <memory>

namespace boxtree::cooker {

struct CloseFile {
  void operator()(std::FILE* file) const { static_cast<void>(std::fclose(file)); }
};

using FileHandle = std::unique_ptr<std::FILE, CloseFile>;

}  // namespace boxtree::cooker
