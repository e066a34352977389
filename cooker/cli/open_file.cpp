// SPDX-License-Identifier: MIT
// Whether a file is a blob is known from its header alone.
#include "cooker/cli/open_file.h"

#include <algorithm>
#include <cerrno>
#include <vector>

#include <fmt/format.h>

#include <boxtree/blob.h>

#include "cooker/cli/exit_status.h"
#include "cooker/cli/standard_streams.h"
#include "cooker/system/input_failure.h"
#include "cooker/system/path.h"
#include "cooker/text/nearest_name.h"
#include "cooker/text/number_of.h"
#include "runtime/file/open_file.h"

namespace boxtree::cooker {
namespace {

// Of what is a file of boxtree and damaged, the remedy behind it.
Error with_remedy(const Error& error) {
  const bool is_damaged = error_info(error.code).exit_status == kExitBadInput &&
                          error.code != Errc::kBadMagic && error.code != Errc::kBlobLimit;
  if (!is_damaged) return error;
  return {error.code, error.detail + "; copy the file here again, or cook it again"};
}

// The same as below, of memory.
Result<OpenedFile> open_standard_input() {
  const Result<Bytes> input = standard_input();
  if (!input) return input.error();
  Result<File> file = File::open(*input);
  if (file) return OpenedFile{std::move(*file)};
  if (file.code() != Errc::kFeatureUnsupported) {
    return with_remedy({file.code(), "standard input: " + file.error().detail});
  }
  Result<File> blob = open_blob(*input);
  if (!blob) return with_remedy({blob.code(), "standard input: " + blob.error().detail});
  return OpenedFile{std::move(*blob), input->size()};
}

}  // namespace

Result<File> map_file(const std::filesystem::path& path) {
  Result<File> mapped = File::open(path.string());
  if (mapped.code() == Errc::kFileNotFound) return input_failure(path.string(), ENOENT);
  return mapped;
}

Result<OpenedFile> open_file(const std::filesystem::path& path) {
  if (is_standard_stream(path)) return open_standard_input();
  Result<File> mapped = map_file(path);
  if (mapped) return OpenedFile{std::move(*mapped)};
  if (mapped.code() != Errc::kFeatureUnsupported) return with_remedy(mapped.error());
  Result<File> blob = open_blob(path.string());
  if (!blob) return with_remedy(blob.error());
  std::error_code ignored;
  return OpenedFile{std::move(*blob), size_of_file(path, ignored)};
}

Result<std::uint32_t> find_tree(const File& file, const WhichTree& wanted) {
  if (wanted.empty()) return std::uint32_t{0};
  const std::string& which = wanted.text;
  const Result<std::uint32_t> named = file.find_tree(which);
  if (named && !wanted.is_number) return named;
  if (const auto index = number_of<std::uint32_t>(which)) return *index;
  std::vector<std::string> names;
  for (std::uint32_t i = 0; i < file.tree_count(); ++i) {
    if (!file.tree_name(i).empty()) names.emplace_back(file.tree_name(i));
  }
  if (names.empty() && file.tree_count() > 0) {
    return Error{Errc::kTreeIndex,
                 fmt::format("no tree is called \"{}\": trees have no names in this "
                             "file; expected a number from 0 to {}",
                             which, file.tree_count() - 1)};
  }
  const auto below = std::ranges::find_if(
      names, [&](const std::string& name) { return name.starts_with(which + "/"); });
  std::string meant =
      below == names.end()
          ? path_suggestion(which, names)
          : fmt::format(": that is a file or a scene of several, such as \"{}\"", *below);
  if (meant.empty()) meant = expected_if_few(names);
  return Error{Errc::kTreeIndex, fmt::format("no tree is called \"{}\"{}", which, meant)};
}

TreeRecord record_of(const File& file, std::uint32_t tree) {
  if (!file.is_pack()) return OpenFile::of(file).tree_record(tree);
  const Result<Member> member = file.member(tree);
  return member ? OpenFile::of(member->file).tree_record(member->tree) : TreeRecord{};
}

Error naming_mesh(const std::filesystem::path& mesh, const Error& error) {
  if (error.code != Errc::kExternalMeshMismatch || mesh.empty()) return error;
  return {error.code,
          fmt::format("{}: {} is not what the tree was cooked of; name that mesh, or the one that "
                      "--write-reordered wrote with the tree",
                      error.detail, input_name(mesh))};
}

}  // namespace boxtree::cooker
