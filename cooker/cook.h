// SPDX-License-Identifier: MIT
// The one pipeline, in memory: a scene to the parts of a file and what is told of them. Files:
// shell/cook_job.h.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cooker/choose/search.h"
#include "cooker/encode/encoded_scene.h"
#include "cooker/import/import.h"
#include "cooker/import/surface_edges.h"
#include "cooker/scene/cook_input.h"
#include "cooker/write/file_writer.h"
#include "format/blob.h"

namespace boxtree::cooker {

struct CookOptions : SearchOptions {
  std::optional<BlobMethod> blob;  // compress the whole file; it must be decompressed to be queried
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
  SurfaceEdges edges;           // of the mesh as it was imported, without hidden faces
  std::uint32_t collapsed = 0;  // triangles that lost their area on the grid; they are kept
  Contest contest;
  std::vector<LeftOut> left_out;  // without a top level; of a scene SceneSummary::why says it
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
  std::optional<SceneSummary> scene;  // nothing without a top level
};

/// A file that was cooked and not written yet.
struct CookedFile {
  std::vector<EncodedTree> trees;
  std::optional<SceneParts> scene;  // nothing without a top level
  std::string record;
  Summary summary;  // its trees are named, and hold what they were chosen from

  [[nodiscard]] FileParts parts() const { return {trees, record, scene ? &*scene : nullptr}; }
};

/// Cooks a scene: plan -> build -> encode -> choose -> account. With a top level, `profile` decides
/// codec, goal, geometry, tolerance and face ids of each mesh, or `options` do where there is no
/// profile. Without one each mesh becomes a tree as `options` say, `profile` being none; several
/// share one geometry store and, where they may be on a grid, one grid, so that what touches still
/// does.
///
/// The bytes depend on neither threads nor folders. Errors: those of CookInput::importer,
/// plan_scene, choose_grid, try_encodings, choose and encode_scene; kBudgetUnreachable for a limit
/// of the file, naming the nearest that is possible. Meshes are freed once they are encoded; all
/// that may be chosen stays until the geometry store, which trees share, is known. Runs on the
/// threads of the enclosing oneTBB arena; may be called from several threads at once.
Result<CookedFile> cook(CookInput input, const Profile& profile, const CookOptions& options,
                        const Progress& progress = {});

/// One mesh alone: tries its encodings and keeps the one that is wished for. `scene`: as
/// try_encodings. Errors: those of try_encodings and choose.
Result<CookedTree> cook_mesh(const SourceMesh& mesh, const CookOptions& options,
                             const std::optional<Grid>& scene = {});

/// The tree that cook_mesh makes in one codec, whatever `options` say of codecs.
Result<EncodedTree> cook_as(const SourceMesh& mesh, CodecId codec, CookOptions options = {});

}  // namespace boxtree::cooker
