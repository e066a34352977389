// SPDX-License-Identifier: MIT
#include "cooker/cli/standard_streams.h"

#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <span>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "cooker/system/descriptor.h"

namespace boxtree::cooker {
namespace {

Error unreadable(const std::string& why) {
  return {Errc::kFileUnreadable, "standard input: " + why};
}

Result<std::vector<std::byte>> read_standard_input() {
  if (is_terminal(kStandardInput)) return unreadable("expected a file, found a terminal");
  std::vector<std::byte> bytes;
  std::size_t size = 0;
  while (true) {
    if (size == bytes.size()) bytes.resize(size + size / 2 + (std::size_t{1} << 16));
    const std::ptrdiff_t read = read_some(kStandardInput, std::span(bytes).subspan(size));
    if (read < 0 && errno == EINTR) continue;
    if (read < 0) return unreadable(std::generic_category().message(errno));
    if (read == 0) break;
    size += static_cast<std::size_t>(read);
    if (size > kMaxStandardInput) {
      return unreadable(fmt::format("more than {} bytes; name a file instead", kMaxStandardInput));
    }
  }
  bytes.resize(size);
  bytes.shrink_to_fit();  // held until the program ends
  return bytes;
}

}  // namespace

std::string input_name(const std::filesystem::path& path) {
  return is_standard_stream(path) ? "standard input" : path.string();
}

Result<Bytes> standard_input() {
  static const Result<std::vector<std::byte>> input = read_standard_input();
  if (!input) return input.error();
  return Bytes(*input);
}

Result<SourceBytes> standard_mesh(const std::string& format) {
  const Result<Bytes> input = standard_input();
  if (!input) return input.error();
  return SourceBytes{"-", input_name("-"), "stdin." + format, *input};
}

Result<OutputTarget> output_target(const std::filesystem::path& requested,
                                   const std::string& format) {
  if (!is_standard_stream(requested)) return OutputTarget(requested);
  if (is_terminal(kStandardOutput)) {
    return Error{Errc::kInvalidQuery,
                 "--output: expected a file or a pipe, and standard output is a terminal"};
  }
  return OutputTarget("stdout." + format, OutputStream{kStandardOutput, "standard output"});
}

// Nothing of standard error is checked: what was cooked is whole. main checks standard output.
void tell(const OutputTarget& target, const std::string& text) {
  static_cast<void>(std::fputs(text.c_str(), target.stream ? stderr : stdout));
}

}  // namespace boxtree::cooker
