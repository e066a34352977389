// SPDX-License-Identifier: MIT
// A manifest: many jobs in one file, one JSON object a line.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <boxtree/error.h>

namespace boxtree::cooker {

inline constexpr std::uint64_t kMaxManifestBytes = std::uint64_t{4} << 30;

/// One line: {"inputs": ["a.obj"], "output": "a.bxt", "options": ["--exact"]}, or "profile" in
/// place of inputs, or beside them, as on the command line. Paths count from the current folder.
struct ManifestLine {
  std::size_t line = 0;  // from 1
  std::vector<std::filesystem::path> inputs;
  std::filesystem::path output;
  std::filesystem::path profile;
  std::vector<std::string> options;  // of one job, as on the command line
};

/// The jobs of a manifest, in its order; blank lines are none. All is checked before anything is
/// cooked: that each line is an object with these members and no other, that no output is that of
/// two lines, and that none is an input of another line, whose cook would come before or after.
/// Files are compared by their real names, behind links of folders and of their own. `name`: the
/// manifest, for messages. Error: kDocumentInvalid with the first fault, "jobs.jsonl:3: ...".
Result<std::vector<ManifestLine>> parse_manifest(std::string_view text, const std::string& name);

}  // namespace boxtree::cooker
