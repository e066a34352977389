// SPDX-License-Identifier: MIT
// The pipeline as one call: import -> build -> encode -> choose -> write.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cooker/choose/search.h"
#include "cooker/import/import.h"
#include "cooker/write/file_writer.h"
#include "format/blob.h"

namespace boxtree::cooker {

/// Told of all files that were read, before anything is written; an error ends the cook.
using BeforeWriting = std::function<Status(std::span<const std::filesystem::path> files_read)>;

struct CookOptions : SearchOptions {
  std::optional<BlobMethod> blob;  // compress the whole file; it must be decompressed to be asked
  bool cook_record = true;  // tool version, options and source hashes, for humans and build systems
  ImportOptions import;
  BeforeWriting before_writing;  // may be empty
};

/// A part that the options left out of the file.
struct LeftOut {
  std::string what;
  std::uint64_t bytes;
  std::string why;
};

struct CookedTree {
  EncodedTree tree;
  std::uint32_t collapsed = 0;  // triangles that lost their area on the grid; they are kept
  Contest contest;
  std::vector<LeftOut> left_out;
};

/// Tries the encodings of a mesh and keeps the one that is wished for. Preconditions and errors as
/// of try_encodings and choose.
Result<CookedTree> cook_mesh(const SourceMesh& mesh, const CookOptions& options,
                             const std::optional<Grid>& scene = {});

/// What is reported of the candidate of a tree that was chosen.
[[nodiscard]] CookedTree cooked_of(TriedTree tried, std::size_t chosen, const CookOptions& options);

/// The tree that cook_mesh makes in one codec, whatever `options` say of codecs.
Result<EncodedTree> cook_as(const SourceMesh& mesh, CodecId codec, CookOptions options = {});

struct CookReport {
  std::vector<CookedTree> trees;  // bytes of nodes and geometry already released
  std::vector<ImportReport> imports;
};

/// Told of every step ("import bunny.obj"); may be empty.
using Progress = std::function<void(const std::string& step)>;

/// What comes before writing `output`: it must be none of the files read (kWriteFailed); then
/// CookOptions::before_writing.
Status prepare_writing(const std::filesystem::path& output,
                       std::span<const std::filesystem::path> files_read,
                       const CookOptions& options);

/// Cooks each input into one tree named after its file, and writes and proves the file. On any
/// error nothing of `output` changes; kWriteFailed if it is one of the files read. Runs on the
/// threads of the enclosing oneTBB arena; the bytes written do not depend on their number, nor on
/// where the inputs lie.
Result<CookReport> cook(const std::vector<std::filesystem::path>& inputs,
                        const std::filesystem::path& output, const CookOptions& options,
                        const Progress& progress = {});

/// The same for one mesh that was imported already, under the name it has.
Result<CookReport> cook(Imported imported, const std::filesystem::path& output,
                        const CookOptions& options, const Progress& progress = {});

}  // namespace boxtree::cooker
