// SPDX-License-Identifier: MIT
#include "cooker/shell/depfile.h"

#include <string>

#include "cooker/write/atomic_file.h"

namespace boxtree::cooker {
namespace {

// Spaces, '#' and '$' in names are escaped, as gcc -MD does.
std::string make_name(const std::filesystem::path& path) {
  std::string out;
  for (const char c : path.string()) {
    if (c == ' ' || c == '#' || c == '\\') out += '\\';
    if (c == '$') out += '$';
    out += c;
  }
  return out;
}

}  // namespace

Status write_depfile(const std::filesystem::path& path, const std::filesystem::path& output,
                     std::span<const std::filesystem::path> inputs) {
  std::string text = make_name(output) + ":";
  for (const std::filesystem::path& input : inputs) text += " \\\n  " + make_name(input);
  text += "\n";
  // Without a rule, make stops at an input that is no longer there; with an empty one it cooks
  // again.
  for (const std::filesystem::path& input : inputs) text += make_name(input) + ":\n";
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();
  if (Status status = file->write(std::as_bytes(std::span(text))); !status) return status;
  return file->commit();
}

}  // namespace boxtree::cooker
