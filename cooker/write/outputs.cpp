// SPDX-License-Identifier: MIT
// Existing files are the same if device and inode are equal; new files, if their paths are. What a
// file is, its first bytes tell: those that boxtree writes alone.
#include "cooker/write/outputs.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "cooker/system/file_handle.h"
#include "cooker/system/path.h"
#include "cooker/write/atomic_file.h"
#include "format/container.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

// The canonical path of a file, whether it exists or not; empty if the system reports an error.
fs::path real_name(const fs::path& path) {
  const Result<fs::path> followed = follow_links(path);
  if (!followed.ok()) return {};
  std::error_code error;
  const fs::path absolute = fs::absolute(*followed, error);
  if (error) return {};
  const fs::path real = fs::weakly_canonical(absolute, error);
  return error ? fs::path() : real;
}

bool is_same_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  const bool are_one = is_one_file(a, b, error);
  if (!error) return are_one;
  const fs::path name = real_name(a);
  return !name.empty() && name == real_name(b);
}

// Exporters and reports write what tells them within so many bytes; make has no other mark than
// the form of all lines, of which there are few.
constexpr std::size_t kStart = 256;
constexpr std::size_t kMostOfDepfile = std::size_t{1} << 24;

// The first bytes of a regular file; empty if it has none or cannot be read.
std::string start_of(const fs::path& path, std::size_t most) {
  std::error_code error;
  if (!fs::is_regular_file(status_of(path, error))) return {};
  const std::uintmax_t bytes = size_of_file(path, error);
  if (error) return {};
  std::string start(static_cast<std::size_t>(std::min<std::uintmax_t>(bytes, most)), '\0');
  const FileHandle file = open_to_read(path);
  start.resize(file ? std::fread(start.data(), 1, start.size(), file.get()) : 0);
  return start;
}

// One rule, whose inputs have a line each, then rules without anything, as write_depfile has them
// (versions before the first release had none of these).
bool is_depfile(std::string_view text) {
  constexpr std::string_view kGoesOn = " \\";
  bool is_first = true;
  bool is_input = false;  // the line is one of the rule
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) return false;
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end + 1);
    const bool goes_on = line.ends_with(kGoesOn);
    if (goes_on) line.remove_suffix(kGoesOn.size());
    const bool fits = is_input ? line.starts_with("  ") && line.size() > 2 && line[2] != ' '
                               : line.size() > 1 && line.ends_with(':') && goes_on == is_first;
    if (!fits) return false;
    is_input = goes_on;
    is_first = false;
  }
  return !is_input;
}

bool is_page(std::string_view start) {
  if (!start.starts_with("<!DOCTYPE html>")) return false;
  for (const std::string_view mark :
       {R"(<meta name="generator" content="boxtree report">)", "<title>Which encoding for ",
        "<title>Compression of the BoxTree data structure"}) {  // titles: before the first release
    if (start.find(mark) != std::string_view::npos) return true;
  }
  return false;
}

// The first line of a journal is that of an output or of a file, and may be cut short.
bool is_journal(std::string_view start) {
  for (const std::string_view mark : {R"({"file":")", R"({"output":")"}) {
    if (start.starts_with(mark) || mark.starts_with(start)) return true;
  }
  return false;
}

bool begins_as(OutputKind kind, std::string_view start) {
  switch (kind) {
    case OutputKind::kCooked:
      return start.starts_with(
          std::string_view(reinterpret_cast<const char*>(kMagic.data()), kMagic.size()));
    case OutputKind::kShownObj:
      return start.starts_with("# boxtree ");
    case OutputKind::kShownGlb:
      return start.find(R"("generator":"boxtree )") != std::string_view::npos;
    case OutputKind::kReportPage:
      return is_page(start);
    case OutputKind::kReportCsv:
      return start.starts_with("mesh,triangles,codec,");
    case OutputKind::kReportJson:
      return start.starts_with('{') &&
             start.find(R"("command": "boxtree report)") != std::string_view::npos;
    case OutputKind::kDepfile:
      return is_depfile(start);
    case OutputKind::kJournal:
      return is_journal(start);
  }
  return false;
}

const char* name_of(OutputKind kind) {
  switch (kind) {
    case OutputKind::kCooked:
      return "a cooked file";
    case OutputKind::kShownObj:
    case OutputKind::kShownGlb:
      return "what an export has written";
    case OutputKind::kReportPage:
      return "a report's page";
    case OutputKind::kReportCsv:
      return "CSV of a report";
    case OutputKind::kReportJson:
      return "JSON of a report";
    case OutputKind::kDepfile:
      return "a depfile of a cook";
    case OutputKind::kJournal:
      return "a journal of cooks";
  }
  return "";
}

}  // namespace

Status check_outputs(std::span<const Output> outputs, std::span<const fs::path> inputs) {
  const auto shown = [](const Output& output) {
    const std::string option = output.option;
    return option.empty() ? output.path.string() : option + " " + output.path.string();
  };
  const auto refuse = [&](const Output& output, const std::string& other) {
    return Error{Errc::kWriteFailed,
                 fmt::format("{}: is the same file as {}; it would be written over: name another "
                             "output",
                             shown(output), other)};
  };
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const Output& output = outputs[i];
    if (output.path.empty()) continue;
    for (const fs::path& input : inputs) {
      if (is_same_file(output.path, input)) return refuse(output, "the input " + input.string());
    }
    for (const Output& earlier : outputs.first(i)) {
      if (!earlier.path.empty() && is_same_file(output.path, earlier.path)) {
        return refuse(output, "the output " + shown(earlier));
      }
    }
  }
  return {};
}

Status check_replaced(const fs::path& output, OutputKind kind) {
  const std::string start =
      start_of(output, kind == OutputKind::kDepfile ? kMostOfDepfile : kStart);
  if (start.empty() || begins_as(kind, start)) return {};
  return Error{Errc::kWriteFailed,
               fmt::format("{}: expected {} there, or none, found another file; "
                           "it would be lost: remove it, or name another",
                           output.string(), name_of(kind))};
}

}  // namespace boxtree::cooker
