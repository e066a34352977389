// SPDX-License-Identifier: MIT
// Meshes to trees side by side, and the record of how they were cooked.
#include <utility>

#include "cooker/cook.h"
#include "cooker/cook_record.h"
#include "runtime/primitive/float_state.h"

namespace boxtree::cooker {

Status TreesCook::add(Imported imported, const std::optional<Grid>& grid) {
  if (progress_) progress_("build " + imported.mesh.name);
  Result<TriedTree> tree = try_encodings(imported.mesh, options_, grid);
  if (!tree) return tree.error();
  contests_.push_back(std::move(tree->contest));
  tried_.push_back(std::move(*tree));
  imports_.push_back(std::move(imported.report));
  return {};
}

Result<CookedFile> TreesCook::finish() {
  const DefaultFloatState state;
  const auto chosen = choose(contests_, options_.wishes);
  if (!chosen) return chosen.error();
  CookedFile file;
  std::vector<RecordedSource> sources;
  for (std::size_t i = 0; i < tried_.size(); ++i) {
    tried_[i].contest = std::move(contests_[i]);
    CookedTree cooked = cooked_of(std::move(tried_[i]), (*chosen)[i], options_);
    file.trees.push_back(std::move(cooked.tree));
    cooked.tree.name = file.trees.back().name;
    file.summary.trees.push_back(std::move(cooked));
    sources.push_back({file.trees.back().name, imports_[i].content_hash, imports_[i].source_faces});
  }
  if (options_.cook_record) file.record = make_cook_record(options_, sources);
  file.summary.imports = std::move(imports_);
  return file;
}

}  // namespace boxtree::cooker
