// SPDX-License-Identifier: MIT
// One tree with all its parts, and the records that describe it in a file.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <boxtree/tree.h>

#include "cooker/encode/encoded.h"
#include "cooker/encode/face_numbers.h"

namespace boxtree {
struct TreeRecord;
}

namespace boxtree::cooker {

/// One tree, ready to be proven and written.
struct EncodedTree {
  std::string name;
  std::array<double, 3> origin{};  // of the frame
  int scale_exponent = 0;          // of the frame
  EncodedNodes nodes;
  EncodedGeometry geometry;
  std::uint32_t face_count = 0;
  std::uint32_t triangle_count = 0;
  std::uint32_t degenerate_count = 0;
  std::uint64_t geometry_hash = 0;  // of the source mesh; a reader recognises the mesh by it
  bool faces_in_source_order = false;
  bool positions_f64 = false;
  /// The face of the source that each face is; empty if nothing needs it.
  std::vector<std::uint32_t> face_order;
  double edge_degrees = 0;  // of active edges
  EncodedFaceNumbers user_data;
  /// What both forms of numbers of its faces take, of those that are stored in the smaller one.
  std::optional<FaceNumberBytes> material_forms, user_data_forms;
};

/// The tree's record, whose claims the proof checks; its name starts at `name_offset` in the names
/// section.
[[nodiscard]] TreeRecord record_of(const EncodedTree& tree, std::uint32_t name_offset);

/// The tree as a reader binds it. It points into `tree`. Errors: as Tree::bind.
[[nodiscard]] Result<Tree> bind_encoded(const EncodedTree& tree, const BindOptions& options = {});

}  // namespace boxtree::cooker
