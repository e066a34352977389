// SPDX-License-Identifier: MIT
// The trees, boxes and instances to export, selected and checked before writing.
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
  std::optional<DecodedFaces> faces;  // empty: only boxes
  std::vector<BoxGroup> boxes;
};

/// A tree placed by a scene.
struct ShownInstance {
  std::string name;        // never empty
  std::uint32_t tree = 0;  // index into Shown::trees
  Pose pose = Pose::Identity();
};

struct Shown {
  std::vector<ShownTree> trees;
  /// Empty: each tree once, in its own coordinates. Otherwise each tree has an instance, and no
  /// pose moves any exported part of its tree beyond the range of doubles.
  std::optional<std::vector<ShownInstance>> instances;
};

}  // namespace boxtree::cooker
