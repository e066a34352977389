// SPDX-License-Identifier: MIT
// What a tree is bound from: its record and its sections.
#pragma once

#include <string_view>

#include <boxtree/tree.h>

#include "format/bytes.h"
#include "format/tree_record.h"
#include "runtime/tree/face_numbers.h"

namespace boxtree {

/// The parts of one tree, in any memory; a missing part is empty.
struct TreeParts {
  TreeRecord record;
  std::string_view name;
  Bytes nodes;
  Bytes vertices;
  Bytes corners;
  Bytes face_ids;
  Bytes duplicates;
  Bytes active_edges = {};
  // Of its file: what its materials are called.
  Bytes materials = {};
  Bytes names = {};
  FaceNumberSections face_materials = {};
  FaceNumberSections user_data = {};
};

/// Binds a tree whose parts are not in a file (yet). Errors: as Tree::bind.
[[nodiscard]] Result<Tree> bind_parts(const TreeParts& parts, const BindOptions& options = {});

}  // namespace boxtree
