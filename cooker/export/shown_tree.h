// SPDX-License-Identifier: MIT
// What is shown, chosen and checked: writers only write.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <boxtree/query.h>

#include "cooker/export/decoded_faces.h"
#include "cooker/export/tree_boxes.h"

namespace boxtree::cooker {

struct ShownTree {
  Tree tree;
  std::string name;                   // never empty
  std::optional<DecodedFaces> faces;  // nothing: boxes alone
  std::vector<BoxGroup> boxes;
};

/// A tree where a scene places it.
struct ShownInstance {
  std::string name;        // never empty
  std::uint32_t tree = 0;  // in Shown::trees
  Pose pose = Pose::Identity();
};

struct Shown {
  std::vector<ShownTree> trees;
  /// Nothing: each tree once, where its own coordinates put it. Else each tree has an instance, and
  /// no pose takes anything that is shown of its tree beyond the numbers that a double holds.
  std::optional<std::vector<ShownInstance>> instances;
};

}  // namespace boxtree::cooker
