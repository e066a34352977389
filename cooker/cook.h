// SPDX-License-Identifier: MIT
// The pipeline in memory: turns a scene into the parts of a file and a summary. For files see
// shell/cook_job.h.
#pragma once

#include <array>
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
  std::optional<BlobMethod> blob;  // compress the whole file; queries need it decompressed
  /// Tool version, options and source hashes, for people and build systems. Without it a tree alone
  /// has no name, which is that of its source, so that the source's name changes no byte.
  bool cook_record = true;
  /// [false] Number the faces of the tree by its own order, for a mesh that is written in that
  /// order (reorder/reordered_mesh.h). The file then needs no face ids: FaceRef::id and
  /// FaceRef::index are the same. For one tree without a top level, imported with
  /// keep_polygon_corners.
  bool number_by_tree = false;
  /// [false] Keep materials of trees without a top level; import has to fill them in
  /// (ImportOptions::materials). Scenes keep theirs unless a profile leaves them out.
  bool materials = false;
  ImportOptions import;
};

/// A part that the options exclude from the file.
struct LeftOut {
  std::string what;
  std::uint64_t bytes;
  std::string why;
};

struct CookedTree {
  EncodedTree tree;
  SurfaceEdges edges;           // of the imported mesh, without hidden faces
  std::uint32_t collapsed = 0;  // triangles without area on the grid; they are kept
  Contest contest;
  std::vector<LeftOut> left_out;  // without a top level; for a scene see Summary::why
};

/// One line of --why: a part of the file, or one that was left out.
struct WhyLine {
  std::string part;   // "vertices"
  std::string owner;  // "mesh crate"; "file"
  bool kept = true;
  std::uint64_t bytes = 0;   // in the file, or what the part would take
  bool is_estimate = false;  // of a part that was never made
  std::string reason;
  std::string line;  // of the profile; empty if a default decided
};

struct SceneSummary {
  std::uint32_t instances = 0;
  std::uint32_t moving = 0;
  std::uint32_t instances_left_out = 0;
  std::uint32_t meshes = 0;  // of the source, before any is left out
  std::uint64_t placed_triangles = 0;
  std::vector<std::string> notices;
};

/// The summary of a file.
struct Summary {
  std::vector<CookedTree> trees;  // in file order; without the bytes of nodes and geometry
  std::vector<ImportReport> imports;
  std::vector<std::filesystem::path> files_read;
  std::string costs_warning;  // of the constants of a file, as disturbed_constants(); or empty
  std::uint64_t file_bytes = 0;
  std::optional<SceneSummary> scene;  // empty without a top level
  std::vector<WhyLine> why;           // the bytes of kept parts add up to the size of the file
};

/// A face of a tree: which corners it has of which source polygon. The fourth is kNoCorner for a
/// triangle.
struct SourceCorners {
  std::uint32_t polygon;
  std::array<std::uint32_t, 4> corner;
};

/// A cooked file that is not written yet.
struct CookedFile {
  std::vector<EncodedTree> trees;
  std::optional<SceneParts> scene;  // empty without a top level
  std::string record;
  Summary summary;  // its trees have names and the candidates they were chosen from
  std::vector<SourceCorners> tree_order;  // with number_by_tree: of each face of the tree
  Materials materials;                    // without a top level

  [[nodiscard]] FileParts parts() const {
    return {trees, record, scene ? &*scene : nullptr, &materials};
  }
};

/// Cooks a scene: plan -> build -> encode -> choose -> account. With a top level, `profile` decides
/// codec, goal, geometry, tolerance and face ids of each mesh; without a profile, `options` do.
/// Without a top level there is no profile: each mesh becomes a tree as `options` state. Several
/// trees then share one geometry store and, where a grid is allowed, one grid, so that surfaces
/// that touch still touch.
///
/// With CookOptions::number_by_tree, kMeshUnsupported for more than one tree or a top level.
///
/// The bytes do not depend on threads or folders. Meshes are freed once they are encoded. Until the
/// shared geometry store is chosen, the candidates that may win stay in memory; all candidates, if
/// the file has a limit of bytes. Runs on the threads of the enclosing oneTBB arena; may be called
/// from several threads at once. Errors: those of CookInput::importer, plan_scene, choose_grid,
/// try_encodings, choose and encode_scene; kBudgetUnreachable for a limit of the file, with the
/// nearest possible value.
Result<CookedFile> cook(CookInput input, const Profile& profile, const CookOptions& options,
                        const Progress& progress = {});

/// Cooks one mesh: tries its encodings and keeps the best for `options`. `scene`: as for
/// try_encodings. Errors: those of try_encodings and choose.
Result<CookedTree> cook_mesh(const SourceMesh& mesh, const CookOptions& options,
                             const std::optional<Grid>& scene = {});

/// The tree that cook_mesh makes with one codec, whatever codec `options` state.
Result<EncodedTree> cook_as(const SourceMesh& mesh, CodecId codec, CookOptions options = {});

}  // namespace boxtree::cooker
