// SPDX-License-Identifier: MIT
// What is shown of one tree, chosen and checked: writers only write.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <boxtree/cooker/export/decoded_faces.h>
#include <boxtree/cooker/export/tree_boxes.h>

namespace boxtree::cooker {

struct ShownTree {
  Tree tree;
  std::string name;                   // never empty
  std::optional<DecodedFaces> faces;  // nothing: boxes alone
  std::vector<BoxGroup> boxes;
};

}  // namespace boxtree::cooker
