// SPDX-License-Identifier: MIT
// Binding: the checks that let queries trust counts and section sizes, and nothing else.
#include <cmath>
#include <string>

#include "format/message.h"
#include "runtime/file/open_file.h"
#include "runtime/file/section.h"
#include "runtime/tree/bound_tree.h"
#include "runtime/tree/float_range.h"
#include "runtime/tree/root_box.h"

namespace boxtree {
namespace {

// Whether a caller's own arrays can be read: after this, numbers of faces and vertices are all that
// has to be checked.
bool are_readable(const MeshArrays& mesh) {
  const std::size_t position_bytes = 3 * (mesh.positions_f64 ? sizeof(double) : sizeof(float));
  const bool is_there = mesh.corners != nullptr && mesh.positions != nullptr;
  return (mesh.corners_per_face == 3 || mesh.corners_per_face == 4) &&
         (mesh.corner_bytes == 2 || mesh.corner_bytes == 4) &&
         mesh.position_stride >= position_bytes && (is_there || mesh.face_count == 0);
}

}  // namespace

Result<Tree> Tree::bind(const File& opened, std::uint32_t index, const BindOptions& options) {
  const OpenFile& file = OpenFile::of(opened);
  if (index >= file.tree_count()) {
    return error_with(Errc::kTreeIndex, {}, "tree # of #", {index, file.tree_count()});
  }
  return BoundTree::bind(
      {file.tree_record(index), file.tree_name(index), file.section(SectionKind::kNodes, index),
       file.section(SectionKind::kVertices, index), file.section(SectionKind::kCorners, index),
       file.section(SectionKind::kFaceIds, index), file.section(SectionKind::kDuplicates, index)},
      index, options);
}

Result<Tree> Tree::bind(const File& file, const BindOptions& options) {
  if (file.has_scene() || file.tree_count() != 1) {
    return error_with(Errc::kTreeIndex, {},
                      "the file holds # trees and # scenes: say which tree, or bind the scene",
                      {file.tree_count(), file.has_scene() ? 1u : 0u});
  }
  return bind(file, 0, options);
}

Result<Tree> bind_parts(const TreeParts& parts, const BindOptions& options) {
  return BoundTree::bind(parts, 0, options);
}

Result<Tree> BoundTree::bind(const TreeParts& parts, std::uint32_t index,
                             const BindOptions& options) {
  Tree bound{BoundTree()};
  BoundTree& tree = inside(bound);
  tree.record_ = parts.record;
  if (Status status = check_tree_record(tree.record_, index); !status) return status.error();
  tree.frame_ = Frame(tree.record_);
  const Box<double> root{tree.record_.root_low, tree.record_.root_high};
  tree.reach_ = reach_of(root);
  tree.largest_reach_ = tree.reach_.maxCoeff();
  tree.root_f32_ = rounded_outward<float>(root);
  tree.name_ = parts.name;
  const std::string place = "tree " + std::to_string(index) + ": ";
  if (Status status = tree.bind_nodes(parts, place); !status) return status.error();
  const bool external = tree.record_.geometry == GeometryId::kExternal;
  if (Status status = external ? tree.bind_external_geometry(place, options)
                               : tree.bind_stored_geometry(parts, place);
      !status) {
    return status.error();
  }
  if (Status status = tree.bind_face_ids(parts, place, options); !status) return status.error();
  if (Status status = tree.bind_duplicates(parts, place); !status) return status.error();
  tree.leaves_.prepare_floats(tree.largest_reach_);
  return bound;
}

Status BoundTree::bind_nodes(const TreeParts& parts, const std::string& place) {
  if (record_.root != RootKind::kSubtree) return {};
  const std::string where = place + section_text(SectionKind::kNodes);
  if (parts.nodes.empty()) return error_with(Errc::kSectionMissing, where, " is absent");
  const Status status = bind_codec(record_, parts.nodes, functions_, nodes_);
  if (!status) return Error{status.code(), where + ": " + status.error().detail};
  has_float_nodes_ = is_in_float_range({record_.root_low, record_.root_high});
  return {};
}

Status BoundTree::bind_stored_geometry(const TreeParts& parts, const std::string& place) {
  if (record_.geometry == GeometryId::kGrid) return bind_grid(parts, place);
  const bool positions_f64 = (record_.flags & kTreePositionsF64) != 0;
  const std::size_t stride = 3 * (positions_f64 ? sizeof(double) : sizeof(float));
  const auto positions =
      sized_section(parts.vertices, SectionKind::kVertices, place, record_.vertex_count, stride);
  if (!positions) return positions.error();
  const auto corners =
      sized_section(parts.corners, SectionKind::kCorners, place, record_.face_count,
                    std::uint64_t{record_.corners_per_face} * record_.corner_bytes);
  if (!corners) return corners.error();
  leaves_ = LeafReader({*positions, stride, positions_f64, record_.vertex_count, *corners,
                        record_.corner_bytes, record_.corners_per_face, record_.face_count},
                       frame_);
  return {};
}

Status BoundTree::bind_grid(const TreeParts& parts, const std::string& place) {
  const auto clusters = sized_section(parts.corners, SectionKind::kCorners, place,
                                      clusters_of(record_.face_count), sizeof(ClusterRecord));
  if (!clusters) return clusters.error();
  if (record_.face_count > 0 && parts.vertices.empty()) {
    return error_with(Errc::kSectionMissing, place,
                      section_text(SectionKind::kVertices) + " is absent");
  }
  const GridView grid{*clusters, parts.vertices, record_.face_count, record_.corners_per_face};
  leaves_ =
      LeafReader(grid, frame_, std::ldexp(1.0, record_.grid_exponent - record_.scale_exponent));
  return {};
}

Status BoundTree::bind_external_geometry(const std::string& place, const BindOptions& options) {
  if (!options.mesh) return error_with(Errc::kExternalMeshNeeded, place, "no mesh was given");
  const MeshArrays& mesh = *options.mesh;
  if (!are_readable(mesh)) {
    return error_with(Errc::kExternalMeshMismatch, place,
                      "expected 3 or 4 corners a face, of 2 or 4 bytes, positions apart, no null");
  }
  const bool positions_f64 = (record_.flags & kTreePositionsF64) != 0;
  if (mesh.face_count != record_.face_count || mesh.positions_f64 != positions_f64) {
    const auto bits = [](bool f64) -> std::uint64_t { return f64 ? 64 : 32; };
    return error_with(
        Errc::kExternalMeshMismatch, place, "expected # faces of f# positions, given # of f#",
        {record_.face_count, bits(positions_f64), mesh.face_count, bits(mesh.positions_f64)});
  }
  if (options.verify_mesh) {
    const Result<std::uint64_t> hash = geometry_hash(mesh);
    if (!hash) return hash.error();
    if (*hash != record_.geometry_hash) {
      return error_with(Errc::kExternalMeshMismatch, place, "the mesh's content differs");
    }
  }
  leaves_ = LeafReader(mesh, frame_);
  return {};
}

Status BoundTree::bind_face_ids(const TreeParts& parts, const std::string& place,
                                const BindOptions& options) {
  const auto ids =
      sized_section(parts.face_ids, SectionKind::kFaceIds, place,
                    record_.face_id_bytes == 0 ? 0 : record_.face_count, record_.face_id_bytes);
  if (!ids) return ids.error();
  if (record_.face_id_bytes != 0) face_ids_ = {*ids, record_.face_id_bytes};
  if (record_.geometry == GeometryId::kExternal && face_ids_) leaves_.set_order(face_ids_);
  if (options.require_face_ids && !has_face_ids() && !empty()) {
    return error_with(Errc::kPartLeftOut, place, "face ids were left out when it was cooked");
  }
  return {};
}

Status BoundTree::bind_duplicates(const TreeParts& parts, const std::string& place) {
  const auto originals = sized_section(parts.duplicates, SectionKind::kDuplicates, place,
                                       record_.duplicate_count, record_.duplicate_bytes);
  if (!originals) return originals.error();
  if (record_.duplicate_count != 0) duplicates_ = {*originals, record_.duplicate_bytes};
  return {};
}

}  // namespace boxtree
