// SPDX-License-Identifier: MIT
#include "cooker/shell/depfile.h"

#include <string>
#include <string_view>

#include "cooker/write/atomic_file.h"

namespace boxtree::cooker {
namespace {

constexpr std::string_view kEscaped = " #:";  // by a backslash

// What GNU make 4.3 reads as the name again, and ninja 1.11 does, too. A backslash is one, unless
// it is before what is escaped: there make and ninja count differently.
bool has_make_name(std::string_view name) {
  if (name.find_first_of("\t\n\r;=|") != std::string_view::npos) return false;
  if (name.empty() || std::string_view(" :&\\").find(name.back()) != std::string_view::npos) {
    return false;
  }
  for (std::size_t i = 0; i + 1 < name.size(); ++i) {
    if (name[i] == '\\' && kEscaped.find(name[i + 1]) != std::string_view::npos) return false;
  }
  return true;
}

std::string make_name(std::string_view name) {
  std::string out;
  for (const char c : name) {
    if (kEscaped.find(c) != std::string_view::npos) out += '\\';
    if (c == '$') out += '$';
    out += c;
  }
  return out;
}

Error nameless(const std::filesystem::path& depfile, const std::filesystem::path& file) {
  return {Errc::kWriteFailed,
          depfile.string() + ": make cannot read the name \"" + file.string() +
              "\": expected no tab, line end, \";\", \"=\" or \"|\", no blank, \":\", \"&\" or "
              "backslash at the end, and no backslash before a blank, \"#\" or \":\""};
}

}  // namespace

Status write_depfile(const std::filesystem::path& path, const std::filesystem::path& output,
                     std::span<const std::filesystem::path> inputs) {
  if (!has_make_name(output.string())) return nameless(path, output);
  std::string text = make_name(output.string()) + ":";
  for (const std::filesystem::path& input : inputs) {
    if (!has_make_name(input.string())) return nameless(path, input);
    text += " \\\n  " + make_name(input.string());
  }
  text += "\n";
  // Without a rule, make stops at an input that is no longer there; with an empty one it cooks
  // again.
  for (const std::filesystem::path& input : inputs) text += make_name(input.string()) + ":\n";
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();
  if (Status status = file->write(std::as_bytes(std::span(text))); !status) return status;
  return file->commit();
}

}  // namespace boxtree::cooker
