// SPDX-License-Identifier: MIT
#include "cooker/shell/cook_job.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "cooker/choose/cost_file.h"
#include "cooker/import/source_files.h"
#include "cooker/reorder/reordered_mesh.h"
#include "cooker/shell/depfile.h"
#include "cooker/write/blob_writer.h"
#include "cooker/write/outputs.h"
#include "runtime/primitive/float_state.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

std::array<Output, 3> output_files(const CookJob& job) {
  return {{{job.output_stream ? fs::path() : job.output},
           {job.depfile, "--depfile"},
           {job.reordered, "--write-reordered"}}};
}

// Whether an object of the profile bounds how far vertices may move.
bool has_tolerance(const Profile& profile) {
  return std::any_of(profile.objects.begin(), profile.objects.end(),
                     [](const ProfileObject& o) { return o.needs.tolerance || o.needs.contact; });
}

class Job {
 public:
  Job(const CookJob& job, const Progress& progress)
      : job_(job), options_(job.options), progress_(progress) {
    options_.import.materials = options_.materials;
    if (job.reordered.empty()) return;
    options_.number_by_tree = true;
    options_.import.keep_polygon_corners = true;
  }

  Result<Summary> run() {
    if (Status status = check_job(job_); !status) return status.error();
    is_mesh_replaceable_ =
        !job_.reordered.empty() && is_mesh_of(job_.reordered, job_.output, options_.import);
    if (Status status = read_settings(); !status) return status.error();
    Result<CookInput> input = load();
    if (!input) return input.error();
    Result<CookedFile> cooked = cook(std::move(*input), profile_, options_, progress_);
    if (!cooked) return cooked.error();
    return write(std::move(*cooked));
  }

 private:
  Status read_settings() {
    if (!job_.costs.empty()) {
      Result<Calibration> calibration = read_costs(job_.costs);
      if (!calibration) return calibration.error();
      options_.costs = std::move(calibration->costs);
      costs_warning_ = disturbed_constants(*calibration);
    }
    if (!job_.profile.empty()) {
      Result<Profile> profile = read_profile(job_.profile);
      if (!profile) return profile.error();
      profile_ = std::move(*profile);
      if (profile_.user_data) options_.import.user_data = profile_.user_data->value;
    }
    options_.import.count_moves = options_.grid.tolerance || has_tolerance(profile_);
    return {};
  }

  // Nothing in a mesh says that a cook has written it: it is told by what stands at the output.
  [[nodiscard]] Error foreign_mesh() const {
    return {Errc::kWriteFailed,
            job_.reordered.string() +
                ": expected what an earlier cook has written with the output, or none, found "
                "another file; it would be lost: remove it, or name another"};
  }

  [[nodiscard]] Result<CookInput> load() const {
    if (!job_.profile.empty() || job_.as_scene) {
      return load_scene(job_.inputs, profile_, options_.import, progress_);
    }
    if (job_.flatten || job_.inputs.size() != 1) {
      return load_trees(job_.inputs, options_.import, progress_);
    }
    return load_file(job_.inputs.front(), options_.import, progress_);
  }

  Result<Summary> write(CookedFile cooked) {
    Summary& summary = cooked.summary;
    summary.files_read = profile_.files_read;
    for (const ImportReport& import : summary.imports) {
      if (job_.require_files && !import.files_missing.empty()) {
        return Error{Errc::kFileNotFound,
                     fmt::format("{}, which a mesh names and --require-files wants, is not there",
                                 import.files_missing.front().string())};
      }
      summary.files_read.insert(summary.files_read.end(), import.files_read.begin(),
                                import.files_read.end());
    }
    if (!job_.costs.empty()) summary.files_read.push_back(job_.costs);
    summary.costs_warning = std::move(costs_warning_);
    if (Status status = check_outputs(output_files(job_), summary.files_read); !status)
      return status.error();
    // Written first, so that an error in it leaves no new output without a depfile.
    if (!job_.depfile.empty()) {
      const Status status = write_depfile(job_.depfile, job_.output, summary.files_read);
      if (!status) return status.error();
    }
    // Whole before the output is replaced, and renamed after it.
    std::optional<AtomicFile> reordered;
    if (!job_.reordered.empty()) {
      announce(progress_, "write " + job_.reordered.filename().string());
      if (Status status = check_source(summary.imports.front()); !status) return status.error();
      Result<AtomicFile> mesh =
          write_reordered(job_.inputs.front(), cooked.tree_order, job_.reordered);
      if (!mesh) return mesh.error();
      if (!is_mesh_replaceable_ && mesh->loses_bytes()) return foreign_mesh();
      reordered.emplace(std::move(*mesh));
      cooked.tree_order = {};
    }
    announce(progress_, "write " + (job_.output_stream ? job_.output_stream->title
                                                       : job_.output.filename().string()));
    const Result<std::uint64_t> bytes = write_parts(cooked.parts());
    if (!bytes) return bytes.error();
    if (reordered) {
      if (Status status = reordered->commit(); !status) return status.error();
    }
    summary.file_bytes = *bytes;
    if (options_.blob) summary.why.front().bytes = *bytes;
    for (std::size_t i = 0; i < cooked.trees.size(); ++i)
      release(cooked.trees[i], summary.trees[i]);
    return std::move(summary);
  }

  // The mesh is read once more, so it has to be what was cooked.
  [[nodiscard]] Status check_source(const ImportReport& import) const {
    const Result<std::uint64_t> hash = hash_source_files(import.files_read);
    if (!hash) return hash.error();
    if (*hash == import.content_hash) return {};
    return Error{Errc::kImportFailed,
                 job_.inputs.front().string() + ": has changed while it was cooked"};
  }

  [[nodiscard]] Result<std::uint64_t> write_parts(const FileParts& parts) const {
    const OutputTarget to(job_.output, job_.output_stream);
    if (options_.blob) return write_blob(to, parts, *options_.blob);
    return write_file(to, parts);
  }

  // Moves the facts about a tree to `told` and frees its bytes.
  static void release(EncodedTree& tree, CookedTree& told) {
    tree.name = std::move(told.tree.name);
    told.tree = std::move(tree);
    told.tree.nodes.bytes = {};
    told.tree.geometry.vertices = {};
    told.tree.geometry.corners = {};
    told.tree.geometry.face_ids = {};
    told.tree.user_data = {};
  }

  const CookJob& job_;
  CookOptions options_;
  Profile profile_;
  std::string costs_warning_;
  bool is_mesh_replaceable_ = false;  // the one at the place of the reordered mesh
  const Progress& progress_;
};

}  // namespace

// Files that another file refers to are known, and checked, only after it is read.
Status check_job(const CookJob& job, std::span<const fs::path> others) {
  if (job.output.empty()) return Error{Errc::kWriteFailed, "the output has no name"};
  std::vector<fs::path> inputs = job.inputs;
  inputs.insert(inputs.end(), others.begin(), others.end());
  for (const fs::path& more : {job.profile, job.costs}) {
    if (!more.empty()) inputs.push_back(more);
  }
  if (!job.reordered.empty()) {
    if (job.inputs.size() != 1 || !job.profile.empty() || job.as_scene) {
      return Error{Errc::kMeshUnsupported,
                   job.reordered.string() + ": one input, cooked to one tree, can be reordered"};
    }
    const Status status = check_reordered_names(job.inputs.front(), job.reordered);
    if (!status) return status;
  }
  if (job.options.import.bytes) std::erase(inputs, job.options.import.bytes->input);
  return check_outputs(output_files(job), inputs);
}

Result<Summary> cook_job(const CookJob& job, const Progress& progress) {
  const DefaultFloatState state;
  return Job(job, progress).run();
}

}  // namespace boxtree::cooker
