// SPDX-License-Identifier: MIT
// What `boxtree cook` says of what it did: tables for people, JSON for tools.
#pragma once

#include <string>
#include <vector>

#include "cooker/cli/json_output.h"
#include "cooker/cook.h"
#include "cooker/shell/cook_job.h"

namespace boxtree::cooker {

/// One entry a tree: candidates, the choice, what was left out and, where trees and imports are one
/// to one, what import did.
[[nodiscard]] Json trees_json(const Summary& summary);
[[nodiscard]] Json imports_json(const std::vector<ImportReport>& imports);
/// The trees, all warnings and every line of --why; of a scene its counts, too.
[[nodiscard]] Json summary_json(const Summary& summary);

/// What the command line adds to an error of a cook: a remedy, and the file that cannot be made,
/// `output`, where no line of the profile stands for a budget.
[[nodiscard]] Error explained(const Error& error, const CookJob& job, const std::string& output);

/// What is wrong with a source, though it could be read; each begins with its name.
[[nodiscard]] std::vector<std::string> warnings_of(const ImportReport& import);
/// Those of all sources, once each; lines of the profile without effect; trees of one name; trees
/// that a grid left little of.
[[nodiscard]] std::vector<std::string> warnings_of(const Summary& summary);

/// What was chosen for each tree, or the table of its `candidates`; and what import found.
[[nodiscard]] std::string trees_text(const Summary& summary, bool candidates);
/// The same, and what the scene has.
[[nodiscard]] std::string scene_text(const Summary& summary, bool candidates);
/// Each part, its bytes, and who decided.
[[nodiscard]] std::string why_text(const Summary& summary);

}  // namespace boxtree::cooker
