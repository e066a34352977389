// SPDX-License-Identifier: MIT
// Output conventions of the command line.
#include "cooker/cli/output.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "cooker/cli/exit_status.h"
#include "cooker/import/import.h"
#include "cooker/text/utf8.h"

namespace boxtree::cooker {
namespace {

// A character that a terminal shows: no control character (C0, DEL or C1) but for line feeds, which
// messages of several lines have.
bool is_shown(std::string_view character) {
  const auto first = static_cast<unsigned char>(character[0]);
  if (first < 0x80) return first == '\n' || (0x20 <= first && first <= 0x7e);
  return first != 0xc2 || static_cast<unsigned char>(character[1]) >= 0xa0;
}

}  // namespace

// Where standard error takes nothing either, the exit status has to say it all: fmt would throw.
void complain(std::string_view what) noexcept {
  const std::string line = "boxtree: " + shown(what) + "\n";
  static_cast<void>(std::fflush(stdout));  // what was printed before stands before it
  static_cast<void>(std::fputs(line.c_str(), stderr));
}

namespace {

// Whether the message ends with a reason that another try meets again: of the system's, or that
// the name is that of something else.
bool has_lasting_reason(const Error& error) {
  static constexpr std::array<std::string_view, 5> kOfNames = {
      "not a regular file", "expected the name of a file", "not a mesh file", "name another",
      "name another output"};
  const auto ends_it = [&](std::string_view reason) { return error.detail.ends_with(reason); };
  return std::ranges::any_of(kOfNames, ends_it) ||
         std::ranges::any_of(
             std::array{EACCES, EPERM, EROFS, EISDIR, ENOTDIR, ELOOP, ENAMETOOLONG},
             [&](int reason) { return ends_it(std::generic_category().message(reason)); });
}

}  // namespace

int fail(const Error& error) {
  complain(error.message());
  return error_info(error.code).exit_status;
}

bool may_pass(const Error& error) {
  if (error.code == Errc::kOutOfMemory) return true;
  return error_info(error.code).exit_status == kExitInputOutput && !has_lasting_reason(error);
}

int usage(const std::string& what) {
  complain("usage: " + what);
  return kExitUsage;
}

void warn(const std::string& what) {
  complain("warning: " + what);
}

int fail_to_print() {
  const int error = errno;
  return fail({Errc::kWriteFailed, "standard output: " + std::generic_category().message(error)});
}

std::string mesh_name_fault(const std::filesystem::path& output, const std::string& instead) {
  const std::string ending = output.extension().string();
  if (ending.empty() || !is_mesh_ending(ending.substr(1))) return {};
  return fmt::format("{}: expected another ending than {}, which is that of a mesh, as {}",
                     output.string(), ending,
                     std::filesystem::path(output).replace_extension(instead).string());
}

std::string shown(std::string_view text) {
  std::string printable;
  while (!text.empty()) {
    const std::size_t bytes = character_bytes(text);
    if (bytes > 0 && is_shown(text)) {
      printable += text.substr(0, bytes);
    } else {
      for (const char c : text.substr(0, std::max<std::size_t>(bytes, 1))) {
        printable += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
      }
    }
    text.remove_prefix(std::max<std::size_t>(bytes, 1));
  }
  return printable;
}

}  // namespace boxtree::cooker
