// SPDX-License-Identifier: MIT
// What `boxtree cook` says of what it did: tables for people, JSON for tools.
#pragma once

#include <vector>

#include "cooker/cli/output.h"
#include "cooker/scene/cook_scene.h"

namespace boxtree::cooker {

/// One entry a tree: candidates, the choice, what was left out and, where trees and imports are one
/// to one, what import did.
[[nodiscard]] Json trees_json(const CookReport& report);
[[nodiscard]] Json imports_json(const std::vector<ImportReport>& imports);
/// Counts of a scene, and every line of --why.
[[nodiscard]] Json report_json(const SceneReport& report);

/// The candidates of each tree and what import found.
void print_trees(const CookReport& report);
/// Each tree on a line, or with the table of its `candidates`; and what the scene has.
void print_scene(const SceneReport& report, bool candidates);
/// Each part, its bytes, and who decided.
void print_why(const SceneReport& report);

}  // namespace boxtree::cooker
