// SPDX-License-Identifier: MIT
// What a cook is told and what it tells, and one mesh through the stages in memory: build -> encode
// -> choose. Scenes: scene/cook_scene.h; files: shell/cook_job.h.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cooker/choose/search.h"
#include "cooker/encode/encoded_scene.h"
#include "cooker/import/import.h"
#include "cooker/write/file_writer.h"
#include "format/blob.h"

namespace boxtree::cooker {

struct CookOptions : SearchOptions {
  std::optional<BlobMethod> blob;  // compress the whole file; it must be decompressed to be asked
  bool cook_record = true;  // tool version, options and source hashes, for humans and build systems
  ImportOptions import;
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

/// One line of --why: a part of the file, or one that is not in it.
struct WhyLine {
  std::string part;   // "vertices"
  std::string owner;  // "mesh crate"; "file"
  bool kept = true;
  std::uint64_t bytes = 0;   // in the file, or that it would have taken
  bool is_estimate = false;  // of something that was never made
  std::string reason;
  std::string line;  // of the profile, cited; empty where a default decided
};

struct SceneSummary {
  std::uint32_t instances = 0;
  std::uint32_t moving = 0;
  std::uint32_t instances_left_out = 0;
  std::uint32_t meshes = 0;  // of the source, before any was left out
  std::uint64_t placed_triangles = 0;
  std::vector<WhyLine> why;  // the bytes of what was kept add up to those of the file
  std::vector<std::string> notices;
};

/// What is told of a file.
struct Summary {
  std::vector<CookedTree> trees;  // in the order of the file; bytes of nodes and geometry released
  std::vector<ImportReport> imports;
  std::vector<std::filesystem::path> files_read;
  std::uint64_t file_bytes = 0;
  std::optional<SceneSummary> scene;  // nothing: trees side by side
};

/// A file that was cooked and not written yet.
struct CookedFile {
  std::vector<EncodedTree> trees;
  std::optional<SceneParts> scene;
  std::string record;
  Summary summary;  // its trees are named, and hold what they were chosen from

  [[nodiscard]] FileParts parts() const { return {trees, record, scene ? &*scene : nullptr}; }
};

/// Told of every step ("import bunny.obj"); may be empty.
using Progress = std::function<void(const std::string& step)>;

/// Tries the encodings of a mesh and keeps the one that is wished for. Preconditions and errors as
/// of try_encodings and choose.
Result<CookedTree> cook_mesh(const SourceMesh& mesh, const CookOptions& options,
                             const std::optional<Grid>& scene = {});

/// What is reported of the candidate of a tree that was chosen.
[[nodiscard]] CookedTree cooked_of(TriedTree tried, std::size_t chosen, const CookOptions& options);

/// The tree that cook_mesh makes in one codec, whatever `options` say of codecs.
Result<EncodedTree> cook_as(const SourceMesh& mesh, CodecId codec, CookOptions options = {});

/// Meshes to trees side by side, each as soon as it is added, so that no mesh need stay. All that
/// may be chosen stays until the geometry store, which the trees share, is known. Runs on the
/// threads of the enclosing oneTBB arena, whose number changes no byte.
class TreesCook {
 public:
  TreesCook(const CookOptions& options, const Progress& progress)
      : options_(options), progress_(progress) {}

  /// `grid`: what all trees share. Errors: as try_encodings.
  Status add(Imported imported, const std::optional<Grid>& grid);

  /// Errors: as choose.
  Result<CookedFile> finish();

 private:
  const CookOptions& options_;
  const Progress& progress_;
  std::vector<TriedTree> tried_;
  std::vector<Contest> contests_;
  std::vector<ImportReport> imports_;
};

}  // namespace boxtree::cooker
