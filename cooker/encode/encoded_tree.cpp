// SPDX-License-Identifier: MIT
// Makes records from encoded parts.
#include "cooker/encode/encoded_tree.h"

#include "format/certificate_record.h"
#include "runtime/tree/tree_parts.h"

namespace boxtree::cooker {

TreeRecord record_of(const EncodedTree& tree, std::uint32_t name_offset) {
  TreeRecord record{};
  record.codec = tree.nodes.codec;
  record.geometry = tree.geometry.geometry;
  record.flags = (tree.faces_in_source_order ? kTreeFacesInSourceOrder : 0) |
                 (tree.positions_f64 ? kTreePositionsF64 : 0);
  record.face_count = tree.face_count;
  record.triangle_count = tree.triangle_count;
  record.vertex_count = tree.geometry.vertex_count;
  record.node_count = tree.nodes.node_count;
  record.root = tree.nodes.root;
  record.depth = tree.nodes.depth;
  record.corner_bytes = tree.geometry.corner_bytes;
  record.corners_per_face = tree.geometry.corners_per_face;
  record.has_face_ids = tree.geometry.face_ids.empty() ? 0 : 1;
  record.duplicate_bytes = tree.geometry.duplicate_bytes;
  record.duplicate_count = tree.geometry.duplicate_count;
  record.scale_exponent = tree.scale_exponent;
  record.name_offset = name_offset;
  record.name_bytes = static_cast<std::uint32_t>(tree.name.size());
  record.origin = tree.origin;
  record.root_low = tree.nodes.root_box.low;
  record.root_high = tree.nodes.root_box.high;
  record.geometry_hash = tree.geometry_hash;
  record.grid_exponent = tree.geometry.grid_exponent;
  return record;
}

CertificateRecord certificate_of(const EncodedTree& tree) {
  CertificateRecord certificate{};
  certificate.depth = tree.nodes.depth;
  certificate.node_count = tree.nodes.node_count;
  certificate.leaf_count = tree.nodes.leaf_count;
  certificate.face_count = tree.face_count;
  certificate.shrink_count = tree.nodes.shrink_count;
  certificate.degenerate_count = tree.degenerate_count;
  certificate.max_vertex_error = tree.geometry.max_vertex_error;
  return certificate;
}

Result<Tree> bind_encoded(const EncodedTree& tree, const BindOptions& options) {
  const EncodedGeometry& geometry = tree.geometry;
  return bind_parts({record_of(tree, 0), tree.name, tree.nodes.bytes, geometry.vertices,
                     geometry.corners, geometry.face_ids, geometry.duplicates},
                    options);
}

}  // namespace boxtree::cooker
