// SPDX-License-Identifier: MIT
// JSON as commands print it.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "cooker/text/json.h"
#include "format/codec.h"

namespace boxtree::cooker {

/// Prints one JSON document to standard output, behind the number of the schema that all documents
/// of this program follow (docs/JSON.md): keys may be added under it, none is renamed. Bytes that
/// are no UTF-8 become U+FFFD.
void print(const Json& document);
/// What print() prints.
[[nodiscard]] std::string document_text(const Json& document);
/// What is said of each file that was named: of the only one as it is, of several as
/// {"files": [...]}, however many there is something to say of.
void print_files(std::vector<Json> documents, bool are_several);
/// The same in one line, as text.
[[nodiscard]] std::string line_of(Json value);

/// A vector as three numbers.
[[nodiscard]] Json to_json(const Eigen::Vector3d& vector);
/// The step of a tree's grid, as `cook --grid-step` takes it; null for other stores.
[[nodiscard]] Json grid_step_json(GeometryId geometry, int step_exponent);

}  // namespace boxtree::cooker
