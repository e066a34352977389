// SPDX-License-Identifier: MIT
// Gives a target the files of a corpus, one after the other, with any compiler.
//   replay FILE_OR_FOLDER...   the last line says how many; 1 when there was none
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/fuzz/target.h"

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_below(const fs::path& path) {
  std::vector<fs::path> files;
  if (fs::is_directory(path)) {
    for (const auto& entry : fs::recursive_directory_iterator(path)) {
      if (entry.is_regular_file()) files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
  } else {
    files.push_back(path);
  }
  return files;
}

}  // namespace

int main(int argc, char** argv) {
  std::size_t count = 0;
  for (int i = 1; i < argc; ++i) {
    for (const fs::path& path : files_below(argv[i])) {
      std::ifstream in(path, std::ios::binary);
      const std::vector<char> bytes(std::istreambuf_iterator<char>(in), {});
      if (in.bad()) return 1;
      std::printf("%s\n", path.c_str());
      static_cast<void>(std::fflush(stdout));  // names the input that ends the process
      boxtree::fuzz::run(std::as_bytes(std::span(bytes)));
      ++count;
    }
  }
  std::printf("%zu inputs\n", count);
  return count == 0 ? 1 : 0;
}
