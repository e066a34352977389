// SPDX-License-Identifier: MIT
// The account for --why: every byte of the file with its purpose and the decision behind it, and
// every part left out with its size.
#pragma once

#include <span>
#include <vector>

#include "cooker/cook.h"
#include "cooker/encode/encoded_scene.h"
#include "cooker/import/source_scene.h"
#include "cooker/scene/plan.h"

namespace boxtree::cooker {

/// The inputs and results of a cook; one tree, contest and choice for each tree of the
/// file.
struct CookedParts {
  const SourceScene& scene;  // positions and faces of meshes may be gone
  const Profile& profile;
  const ScenePlan& plan;
  std::span<const std::size_t> mesh_of_tree;
  std::span<const EncodedTree> trees;
  std::span<const Contest> contests;
  std::span<const std::size_t> chosen;
  const SceneParts* parts;  // null without a top level; then the options decide, and no plan
  const CookOptions& options;
};

/// The lines of --why. For a file that is compressed as a whole, the first line is the blob, whose
/// size is not known yet.
[[nodiscard]] std::vector<WhyLine> account(const CookedParts& cooked, const FileLayout& layout);

}  // namespace boxtree::cooker
