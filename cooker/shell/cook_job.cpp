// SPDX-License-Identifier: MIT
#include "cooker/shell/cook_job.h"

#include <array>
#include <optional>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "cooker/choose/cost_file.h"
#include "cooker/scene/cook_scene.h"
#include "cooker/shell/depfile.h"
#include "cooker/write/blob_writer.h"
#include "cooker/write/outputs.h"
#include "format/limits.h"
#include "runtime/primitive/float_state.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

class Job {
 public:
  Job(const CookJob& job, const Progress& progress)
      : job_(job), options_(job.options), progress_(progress) {}

  Result<Summary> run() {
    if (Status status = check_job(job_); !status) return status.error();
    if (Status status = read_settings(); !status) return status.error();
    Result<CookedFile> cooked = cook();
    if (!cooked) return cooked.error();
    return write(std::move(*cooked));
  }

 private:
  void step(const std::string& what) const {
    if (progress_) progress_(what);
  }

  Status read_settings() {
    if (!job_.costs.empty()) {
      Result<std::vector<CodecCost>> costs = read_costs(job_.costs);
      if (!costs) return costs.error();
      options_.costs = std::move(*costs);
    }
    if (!job_.profile.empty()) {
      Result<Profile> profile = read_profile(job_.profile);
      if (!profile) return profile.error();
      profile_ = std::move(*profile);
    }
    return {};
  }

  Result<CookedFile> cook() {
    if (!job_.profile.empty() || job_.as_scene) {
      Result<LoadedScene> loaded = load_scene(job_.inputs, profile_, options_.import,
                                              [this](const std::string& what) { step(what); });
      if (!loaded) return loaded.error();
      return cook_scene(std::move(*loaded), profile_, options_, progress_);
    }
    if (job_.flatten || job_.inputs.size() != 1) return cook_trees();
    return cook_as_it_is();
  }

  // The only input: a scene if it places meshes twice or more.
  Result<CookedFile> cook_as_it_is() {
    const fs::path& input = job_.inputs.front();
    step("import " + input.filename().string());
    Result<ImportedFile> imported = import_file(input, options_.import);
    if (!imported) return imported.error();
    if (auto* mesh = std::get_if<Imported>(&*imported)) {
      mesh->mesh.name = input.stem().string();
      TreesCook trees(options_, progress_);
      if (Status status = trees.add(std::move(*mesh), {}); !status) return status.error();
      return trees.finish();
    }
    LoadedScene loaded;
    loaded.scene = std::move(std::get<SourceScene>(*imported));
    loaded.imports.push_back(std::move(loaded.scene.report));
    loaded.import_names.push_back(input.filename().string());
    return cook_scene(std::move(loaded), profile_, options_, progress_);
  }

  Result<CookedFile> cook_trees() {
    // Each is a tree: told before hours of work, not after.
    if (job_.inputs.size() > kMaxTrees) {
      return Error{Errc::kMeshTooLarge,
                   fmt::format("{} inputs, each a tree: a file holds {} at most",
                               job_.inputs.size(), kMaxTrees)};
    }
    TreesCook trees(options_, progress_);
    const bool may_use_grid =
        options_.may_use_grid && (options_.try_all || may_grid_win(options_.wishes));
    const bool may_share_grid =
        job_.inputs.size() > 1 && (options_.geometry == GeometryId::kGrid || may_use_grid);
    if (may_share_grid) return cook_on_one_grid(trees);
    for (const fs::path& input : job_.inputs) {
      Result<Imported> imported = import_tree(input);
      if (!imported) return imported.error();
      if (Status status = trees.add(std::move(*imported), {}); !status) return status.error();
    }
    return trees.finish();
  }

  // One grid for all inputs, so that what touches still does: all of them are measured first.
  Result<CookedFile> cook_on_one_grid(TreesCook& trees) {
    std::vector<Imported> meshes;
    Eigen::AlignedBox3d bounds;
    for (const fs::path& input : job_.inputs) {
      Result<Imported> imported = import_tree(input);
      if (!imported) return imported.error();
      bounds.extend(bounds_of(imported->mesh));
      meshes.push_back(std::move(*imported));
    }
    const Result<Grid> chosen = choose_grid(bounds, options_.grid);
    if (!chosen && !options_.may_use_grid) return chosen.error();
    std::optional<Grid> grid;
    if (chosen) grid = *chosen;
    for (Imported& mesh : meshes) {
      if (Status status = trees.add(std::move(mesh), grid); !status) return status.error();
    }
    return trees.finish();
  }

  Result<Imported> import_tree(const fs::path& input) const {
    step("import " + input.filename().string());
    Result<Imported> imported = import_mesh(input, options_.import);
    if (imported) imported->mesh.name = input.stem().string();
    return imported;
  }

  Result<Summary> write(CookedFile cooked) {
    Summary& summary = cooked.summary;
    summary.files_read = profile_.files_read;
    for (const ImportReport& import : summary.imports) {
      summary.files_read.insert(summary.files_read.end(), import.files_read.begin(),
                                import.files_read.end());
    }
    if (!job_.costs.empty()) summary.files_read.push_back(job_.costs);
    const std::array outputs{job_.output, job_.depfile};
    if (Status status = check_outputs(outputs, summary.files_read); !status) return status.error();
    // First, so that no error of it leaves a new output without one.
    if (!job_.depfile.empty()) {
      const Status status = write_depfile(job_.depfile, job_.output, summary.files_read);
      if (!status) return status.error();
    }
    step("write " + job_.output.filename().string());
    const Result<std::uint64_t> bytes = write_parts(cooked.parts());
    if (!bytes) return bytes.error();
    summary.file_bytes = *bytes;
    if (options_.blob && summary.scene) summary.scene->why.front().bytes = *bytes;
    for (std::size_t i = 0; i < cooked.trees.size(); ++i)
      release(cooked.trees[i], summary.trees[i]);
    return std::move(summary);
  }

  [[nodiscard]] Result<std::uint64_t> write_parts(const FileParts& parts) const {
    if (options_.blob) return write_blob(job_.output, parts, *options_.blob);
    return write_file(job_.output, parts);
  }

  // Keeps what is told of a tree and gives its bytes back.
  static void release(EncodedTree& tree, CookedTree& told) {
    tree.name = std::move(told.tree.name);
    told.tree = std::move(tree);
    told.tree.nodes.bytes = {};
    told.tree.geometry.vertices = {};
    told.tree.geometry.corners = {};
    told.tree.geometry.face_ids = {};
  }

  const CookJob& job_;
  CookOptions options_;
  Profile profile_;
  const Progress& progress_;
};

}  // namespace

// What a file refers to is known, and checked, only after it was read.
Status check_job(const CookJob& job) {
  if (job.output.empty()) return Error{Errc::kWriteFailed, "the output has no name"};
  std::vector<fs::path> inputs = job.inputs;
  for (const fs::path& more : {job.profile, job.costs}) {
    if (!more.empty()) inputs.push_back(more);
  }
  return check_outputs(std::array{job.output, job.depfile}, inputs);
}

Result<Summary> cook_job(const CookJob& job, const Progress& progress) {
  const DefaultFloatState state;
  return Job(job, progress).run();
}

}  // namespace boxtree::cooker
