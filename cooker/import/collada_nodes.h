// SPDX-License-Identifier: MIT
// Checks the nodes of a Collada document that its scene places.
#pragma once

#include <pugixml.hpp>
#include <string>
#include <unordered_set>

#include "cooker/import/collada_text.h"

namespace boxtree::cooker {

/// Transforms, and that instances of nodes do not nest without end and name what is there; `ids`
/// are those of geometries and controllers. Returns whether `faults` has none.
bool check_nodes(pugi::xml_node collada, const std::unordered_set<std::string>& ids,
                 ColladaFaults& faults);

}  // namespace boxtree::cooker
