// SPDX-License-Identifier: MIT
// Whether a mesh is closed, as cook and info say it.
#pragma once

#include <string>

#include "cooker/cli/json_output.h"
#include "cooker/import/surface_edges.h"

namespace boxtree::cooker {

/// "closed", "no edges", or "223 open edges", "2 open, 1 non-manifold and 3 inconsistently oriented
/// edges".
[[nodiscard]] std::string surface_text(const SurfaceEdges& edges);

[[nodiscard]] Json surface_json(const SurfaceEdges& edges);
/// The other way round. Precondition: `json` is of surface_json().
[[nodiscard]] SurfaceEdges surface_of(const Json& json);

}  // namespace boxtree::cooker
