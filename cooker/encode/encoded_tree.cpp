// SPDX-License-Identifier: MIT
// Makes records from encoded parts.
#include "cooker/encode/encoded_tree.h"

#include "runtime/tree/tree_parts.h"

namespace boxtree::cooker {

TreeRecord record_of(const EncodedTree& tree, std::uint32_t name_offset) {
  TreeRecord record{};
  record.codec = tree.nodes.codec;
  record.geometry = tree.geometry.geometry;
  if (tree.faces_in_source_order) record.flags |= kTreeFacesInSourceOrder;
  if (tree.positions_f64) record.flags |= kTreePositionsF64;
  record.face_count = tree.face_count;
  record.triangle_count = tree.triangle_count;
  record.node_count = tree.nodes.node_count;
  record.root = tree.nodes.root;
  record.depth = static_cast<std::uint8_t>(tree.nodes.depth);
  record.corner_bytes = tree.geometry.corner_bytes;
  record.corners_per_face = tree.geometry.corners_per_face;
  record.duplicate_bytes = tree.geometry.duplicate_bytes;
  record.duplicate_count = tree.geometry.duplicate_count;
  record.scale_exponent = static_cast<std::int16_t>(tree.scale_exponent);
  record.name_offset = name_offset;
  record.name_bytes = static_cast<std::uint32_t>(tree.name.size());
  record.origin = tree.origin;
  record.root_low = tree.nodes.root_box.low;
  record.root_high = tree.nodes.root_box.high;
  record.geometry_hash = tree.geometry_hash;
  record.grid_exponent = static_cast<std::int16_t>(tree.geometry.grid_exponent);
  record.max_vertex_error = tree.geometry.max_vertex_error;
  record.degenerate_count = tree.degenerate_count;
  return record;
}

Result<Tree> bind_encoded(const EncodedTree& tree, const BindOptions& options) {
  const EncodedGeometry& geometry = tree.geometry;
  return bind_parts(
      {record_of(tree, 0), tree.name, tree.nodes.bytes, geometry.vertices, geometry.corners,
       geometry.face_ids, geometry.duplicates, geometry.active_edges},
      options);
}

}  // namespace boxtree::cooker
