// SPDX-License-Identifier: MIT
// Checks the values of a glTF 2 document that decide geometry: assimp takes many of a wrong type,
// or out of range, for others, and then places, reads or leaves out what the file does not say.
#pragma once

#include <boxtree/error.h>

#include "cooker/text/json.h"

namespace boxtree::cooker {

/// kImportFailed with the place, what is expected and what was found. A document of glTF 1, which
/// has no lists, passes. Time: linear in the document.
Status check_values(const Json& document);

}  // namespace boxtree::cooker
