// SPDX-License-Identifier: MIT
// What `boxtree verify` says of many files, for readers in other languages to compare with.
// Standard input: for each file its size as a little-endian u32, and its bytes. Standard output: a
// line for each, "ok" or the name of the first finding and its words.
#include <cstdint>
#include <cstdio>
#include <vector>

#include "cooker/proof/proof.h"

namespace {

using namespace boxtree;

constexpr std::uint32_t kMostBytes = 1u << 24;

void print_result(Bytes bytes) {
  const Result<File> file = File::open(bytes);
  const cooker::Findings findings =
      file ? cooker::verify_file(*file) : cooker::Findings{file.error()};
  if (findings.empty()) {
    std::puts("ok");
  } else {
    const std::string_view name = error_info(findings.front().code).name;
    std::printf("%.*s: %s\n", static_cast<int>(name.size()), name.data(),
                findings.front().detail.c_str());
  }
  static_cast<void>(std::fflush(stdout));
}

}  // namespace

int main() {
  std::uint32_t size = 0;
  std::vector<std::byte> bytes;
  while (std::fread(&size, sizeof(size), 1, stdin) == 1) {
    if (size > kMostBytes) return 1;
    bytes.resize(size);
    if (size != 0 && std::fread(bytes.data(), size, 1, stdin) != 1) return 1;
    print_result(bytes);
  }
  return 0;
}
