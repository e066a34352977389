// SPDX-License-Identifier: MIT
// A file of stdio that closes itself: its errors say why, which streams do not.
#pragma once

#include <cstdio>
#include <memory>

namespace boxtree::cooker {

struct CloseFile {
  void operator()(std::FILE* file) const { static_cast<void>(std::fclose(file)); }
};

using FileHandle = std::unique_ptr<std::FILE, CloseFile>;

}  // namespace boxtree::cooker
