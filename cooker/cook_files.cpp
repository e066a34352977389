// SPDX-License-Identifier: MIT
// Files through all stages, and the record of how they were cooked.
#include <utility>

#include <fmt/format.h>

#include "cooker/cook.h"
#include "cooker/cook_record.h"
#include "cooker/write/blob_writer.h"
#include "cooker/write/outputs.h"
#include "format/limits.h"
#include "runtime/primitive/float_state.h"

namespace boxtree::cooker {
namespace {

std::string cook_record(const CookOptions& options, const std::vector<CookedTree>& trees,
                        const std::vector<ImportReport>& imports) {
  std::vector<RecordedSource> sources;
  for (std::size_t i = 0; i < imports.size(); ++i) {
    sources.push_back({trees[i].tree.name, imports[i].content_hash, imports[i].source_faces});
  }
  return make_cook_record(options, sources);
}

// One grid for all inputs, so that what touches still does. Each is imported for its bounds, and
// later again: memory, not time, is what inputs cost.
Result<Grid> scene_grid(const std::vector<std::filesystem::path>& inputs,
                        const CookOptions& options) {
  Eigen::AlignedBox3d bounds;
  for (const std::filesystem::path& input : inputs) {
    const Result<Imported> imported = import_mesh(input, options.import);
    if (!imported) return imported.error();
    bounds.extend(bounds_of(imported->mesh));
  }
  return choose_grid(bounds, options.grid);
}

// Keeps what the report tells of a tree and gives its bytes back.
void release(CookedTree& cooked) {
  cooked.tree.nodes.bytes = {};
  cooked.tree.geometry.vertices = {};
  cooked.tree.geometry.corners = {};
  cooked.tree.geometry.face_ids = {};
}

// Inputs one after the other, then the file. All that may be chosen stays until the geometry store,
// which the trees share, is known.
class FileCook {
 public:
  FileCook(const CookOptions& options, const Progress& progress)
      : options_(options), progress_(progress) {}

  void step(const std::string& what) const {
    if (progress_) progress_(what);
  }

  Status add(Imported imported, const std::optional<Grid>& scene) {
    step("build " + imported.mesh.name);
    Result<TriedTree> tree = try_encodings(imported.mesh, options_, scene);
    if (!tree) return tree.error();
    contests_.push_back(std::move(tree->contest));
    tried_.push_back(std::move(*tree));
    report_.imports.push_back(std::move(imported.report));
    return {};
  }

  Result<CookReport> write(const std::filesystem::path& output) {
    const auto chosen = choose(contests_, options_.wishes);
    if (!chosen) return chosen.error();
    std::vector<EncodedTree> trees;
    for (std::size_t i = 0; i < tried_.size(); ++i) {
      tried_[i].contest = std::move(contests_[i]);
      CookedTree cooked = cooked_of(std::move(tried_[i]), (*chosen)[i], options_);
      trees.push_back(std::move(cooked.tree));
      cooked.tree.name = trees.back().name;
      report_.trees.push_back(std::move(cooked));
    }
    std::vector<std::filesystem::path> read;
    for (const ImportReport& import : report_.imports) {
      read.insert(read.end(), import.files_read.begin(), import.files_read.end());
    }
    if (Status status = prepare_writing(output, read, options_); !status) return status.error();
    step("write " + output.filename().string());
    const std::string record = options_.cook_record
                                   ? cook_record(options_, report_.trees, report_.imports)
                                   : std::string();
    const FileParts parts{trees, record};
    const Status written =
        options_.blob ? write_blob(output, parts, *options_.blob) : write_file(output, parts);
    if (!written) return written.error();
    for (std::size_t i = 0; i < trees.size(); ++i) {
      report_.trees[i].tree = std::move(trees[i]);
      release(report_.trees[i]);
    }
    return std::move(report_);
  }

 private:
  const CookOptions& options_;
  const Progress& progress_;
  std::vector<TriedTree> tried_;
  std::vector<Contest> contests_;
  CookReport report_;
};

}  // namespace

Status prepare_writing(const std::filesystem::path& output,
                       std::span<const std::filesystem::path> files_read,
                       const CookOptions& options) {
  if (Status status = check_outputs(std::span(&output, 1), files_read); !status) return status;
  return options.before_writing ? options.before_writing(files_read) : Status();
}

Result<CookReport> cook(const std::vector<std::filesystem::path>& inputs,
                        const std::filesystem::path& output, const CookOptions& options,
                        const Progress& progress) {
  const DefaultFloatState state;
  // Each is a tree: told before hours of work, not after.
  if (inputs.size() > kMaxTrees) {
    return Error{Errc::kMeshTooLarge, fmt::format("{} inputs, each a tree: a file holds {} at most",
                                                  inputs.size(), kMaxTrees)};
  }
  FileCook file(options, progress);
  const bool is_scene =
      inputs.size() > 1 && (options.geometry == GeometryId::kGrid || options.may_use_grid);
  std::optional<Grid> scene;
  if (is_scene) {
    file.step("measure the scene");
    Result<Grid> grid = scene_grid(inputs, options);
    if (!grid && !options.may_use_grid) return grid.error();
    if (grid) scene = *grid;
  }
  for (const std::filesystem::path& input : inputs) {
    file.step("import " + input.filename().string());
    Result<Imported> imported = import_mesh(input, options.import);
    if (!imported) return imported.error();
    imported->mesh.name = input.stem().string();
    if (Status status = file.add(std::move(*imported), scene); !status) return status.error();
  }
  return file.write(output);
}

Result<CookReport> cook(Imported imported, const std::filesystem::path& output,
                        const CookOptions& options, const Progress& progress) {
  const DefaultFloatState state;
  FileCook file(options, progress);
  if (Status status = file.add(std::move(imported), {}); !status) return status.error();
  return file.write(output);
}

}  // namespace boxtree::cooker
