// SPDX-License-Identifier: MIT
// Binding: the checks that let queries trust counts and section sizes, and nothing else.
#include <algorithm>
#include <cmath>
#include <string>

#include "format/face_numbers.h"
#include "format/message.h"
#include "format/numbers.h"
#include "format/pack.h"
#include "format/scene_record.h"
#include "runtime/file/open_file.h"
#include "runtime/file/section.h"
#include "runtime/tree/bound_tree.h"
#include "runtime/tree/float_range.h"
#include "runtime/tree/root_box.h"
#include "runtime/tree/tree_parts.h"

namespace boxtree {
namespace {

// Whether the caller's arrays can be read; after this, only numbers of faces and vertices have to
// be checked.
bool are_readable(const MeshArrays& mesh) {
  const std::size_t position_bytes = 3 * (mesh.positions_f64 ? sizeof(double) : sizeof(float));
  const bool is_there = mesh.corners != nullptr && mesh.positions != nullptr;
  return (mesh.corners_per_face == 3 || mesh.corners_per_face == 4) &&
         (mesh.corner_bytes == 2 || mesh.corner_bytes == 4) &&
         mesh.position_stride >= position_bytes && (is_there || mesh.face_count == 0);
}

// Precondition: the file is no pack and has that tree.
TreeParts parts_of(const OpenFile& file, std::uint32_t index, std::string_view name) {
  return {file.tree_record(index),
          name,
          file.section(SectionKind::kNodes, index),
          file.section(SectionKind::kVertices, index),
          file.section(SectionKind::kCorners, index),
          file.section(SectionKind::kFaceIds, index),
          file.section(SectionKind::kDuplicates, index),
          file.section(SectionKind::kActiveEdges, index),
          file.section(SectionKind::kMaterials),
          file.section(SectionKind::kNames),
          {file.section(SectionKind::kMaterialRuns, index),
           file.section(SectionKind::kFaceMaterials, index)},
          {file.section(SectionKind::kUserDataRuns, index),
           file.section(SectionKind::kFaceUserData, index)}};
}

}  // namespace

Result<Tree> Tree::bind(const File& opened, std::uint32_t index, const BindOptions& options) {
  const OpenFile& file = OpenFile::of(opened);
  if (index >= file.tree_count()) {
    return index_error(Errc::kTreeIndex, "tree", index, file.tree_count());
  }
  if (!file.is_pack()) {
    return BoundTree::bind(parts_of(file, index, file.tree_name(index)), index, options);
  }
  const Result<File> member = file.open_member(index);
  if (!member) return member.error();
  return BoundTree::bind(
      parts_of(OpenFile::of(*member), file.pack_row(index).tree, file.tree_name(index)), index,
      options);
}

Result<Tree> Tree::bind(const File& file, const BindOptions& options) {
  if (file.has_scene()) {
    return error_with(Errc::kTreeIndex, {},
                      "the file holds a scene: bind that, or a tree by its number; trees: #",
                      {file.tree_count()});
  }
  if (file.tree_count() != 1) {
    return error_with(Errc::kTreeIndex, {}, "the file holds # trees: say which",
                      {file.tree_count()});
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
  if (Status status = check_tree_record(parts.record, index); !status) return status.error();
  tree.keep(parts.record);
  tree.name_ = parts.name;
  if (Status status = tree.bind_sections(parts, options); !status) {
    return error_of("tree", index, status.error());
  }
  tree.leaves_.prepare_floats(tree.largest_abs_);
  return bound;
}

Status BoundTree::bind_sections(const TreeParts& parts, const BindOptions& options) {
  Status status = bind_nodes(parts);
  if (status) {
    status = geometry_ == GeometryId::kExternal ? bind_external_geometry(parts, options)
                                                : bind_stored_geometry(parts);
  }
  if (status) status = bind_face_ids(parts);
  if (status) status = bind_duplicates(parts);
  if (status) status = bind_active_edges(parts);
  if (status) status = bind_face_numbers(parts);
  if (status) status = check_required(options);
  return status;
}

void BoundTree::keep(const TreeRecord& record) {
  codec_ = record.codec;
  geometry_ = record.geometry;
  root_kind_ = record.root;
  counts_ = counts_of(record);
  face_count_ = record.face_count;
  triangle_count_ = record.triangle_count;
  depth_ = record.depth;
  scale_exponent_ = record.scale_exponent;
  grid_exponent_ = record.grid_exponent;
  has_f64_positions_ = (record.flags & kTreePositionsF64) != 0;
  is_in_source_order_ = (record.flags & kTreeFacesInSourceOrder) != 0;
  frame_ = Frame(record.origin, record.scale_exponent);
  root_f64_ = {record.root_low, record.root_high};
  root_f32_ = rounded_outward<float>(root_f64_);
  root_lanes_ = BoxLanes(root_f32_);
  max_abs_ = max_abs_of(root_f64_);
  largest_abs_ = max_abs_.maxCoeff();
}

Status BoundTree::bind_nodes(const TreeParts& parts) {
  if (!has_nodes()) return {};
  if (parts.nodes.empty()) {
    return error_with(Errc::kSectionMissing, section_text(SectionKind::kNodes), " is absent");
  }
  const Status status = bind_codec(codec_, counts_, parts.nodes, functions_, nodes_);
  if (!status) return section_error(SectionKind::kNodes, status.error());
  has_float_nodes_ = is_in_float_range(root_f64_);
  return {};
}

Status BoundTree::bind_stored_geometry(const TreeParts& parts) {
  if (has_clusters(geometry_)) return bind_clusters(parts);
  const std::size_t stride = 3 * (has_f64_positions_ ? sizeof(double) : sizeof(float));
  const std::uint64_t vertices =
      std::clamp<std::uint64_t>(parts.vertices.size() / stride, face_count_ > 0, kMaxVertices);
  const auto positions = sized_section(parts.vertices, SectionKind::kVertices, vertices, stride);
  if (!positions) return positions.error();
  const auto corners =
      sized_section(parts.corners, SectionKind::kCorners, face_count_,
                    std::uint64_t{parts.record.corners_per_face} * parts.record.corner_bytes);
  if (!corners) return corners.error();
  leaves_ =
      LeafReader({*positions, stride, has_f64_positions_, static_cast<std::uint32_t>(vertices),
                  *corners, parts.record.corner_bytes, parts.record.corners_per_face, face_count_},
                 frame_);
  return {};
}

Status BoundTree::bind_clusters(const TreeParts& parts) {
  const auto corners = sized_section(parts.corners, SectionKind::kCorners, 0, 1);
  if (!corners) return corners.error();
  // Clusters take more bytes than their table; each is looked for where it is read.
  const std::uint64_t least = cluster_table_bytes(face_count_);
  const auto clusters = sized_section(parts.vertices, SectionKind::kVertices,
                                      std::max<std::uint64_t>(parts.vertices.size(), least), 1);
  if (!clusters) return clusters.error();
  leaves_ = LeafReader({parts.vertices, face_count_, parts.record.corners_per_face,
                        numbers_of(geometry_, has_f64_positions_)},
                       frame_, std::ldexp(1.0, grid_exponent_ - scale_exponent_));
  return {};
}

Status BoundTree::bind_external_geometry(const TreeParts& parts, const BindOptions& options) {
  if (!options.mesh) return error_with(Errc::kExternalMeshNeeded, {}, "no mesh was given");
  const MeshArrays& mesh = *options.mesh;
  if (!are_readable(mesh)) {
    return error_with(Errc::kExternalMeshMismatch, {},
                      "expected 3 or 4 corners a face, of 2 or 4 bytes, positions apart, no null");
  }
  if (mesh.face_count != face_count_ || mesh.positions_f64 != has_f64_positions_) {
    const auto bits = [](bool f64) -> std::uint64_t { return f64 ? 64 : 32; };
    return error_with(
        Errc::kExternalMeshMismatch, {}, "expected # faces of f# positions, given # of f#",
        {face_count_, bits(has_f64_positions_), mesh.face_count, bits(mesh.positions_f64)});
  }
  if (options.verify_mesh) {
    const Result<std::uint64_t> hash = geometry_hash(mesh);
    if (!hash) return hash.error();
    if (*hash != parts.record.geometry_hash) {
      return error_with(Errc::kExternalMeshMismatch, {}, "the mesh's content differs");
    }
  }
  leaves_ = LeafReader(mesh, frame_);
  return {};
}

Status BoundTree::bind_face_ids(const TreeParts& parts) {
  // External faces are found by source number, or through the ids of the tree's own order.
  const bool are_needed = geometry_ == GeometryId::kExternal && face_count_ > 0;
  if (parts.face_ids.empty() ? are_needed && !is_in_source_order_
                             : is_in_source_order_ || face_count_ == 0) {
    return error_with(Errc::kRecordInvalid, {}, "face ids are not as specified");
  }
  if (!parts.face_ids.empty()) {
    // Fields take more bytes than that; each is looked for where it is read.
    const std::uint64_t bytes =
        std::max<std::uint64_t>(parts.face_ids.size(), least_id_bytes(face_count_));
    const auto ids = sized_section(parts.face_ids, SectionKind::kFaceIds, bytes, 1);
    if (!ids) return ids.error();
    face_ids_ = FaceIdView(parts.face_ids);
  }
  if (are_needed && face_ids_) leaves_.set_order(face_ids_);
  return {};
}

Status BoundTree::bind_duplicates(const TreeParts& parts) {
  const std::uint8_t width = parts.record.duplicate_bytes;
  const auto originals = sized_section(parts.duplicates, SectionKind::kDuplicates,
                                       number_array_bytes(duplicate_count(), width), 1);
  if (!originals) return originals.error();
  if (width != 0) duplicates_ = {*originals, width};
  return {};
}

Status BoundTree::bind_active_edges(const TreeParts& parts) {
  const Bytes section = parts.active_edges;
  if (section.empty()) return {};
  std::uint64_t bytes = sizeof(ActiveEdgesHeader);
  if (section.size() >= bytes) {
    bytes = active_edges_bytes(face_count_, load<ActiveEdgesHeader>(section.data()).start_count);
  }
  const auto edges = sized_section(section, SectionKind::kActiveEdges, bytes, 1);
  if (!edges) return edges.error();
  active_edges_ = ActiveEdgesView(section, face_count_);
  return {};
}

Status BoundTree::bind_face_numbers(const TreeParts& parts) {
  material_names_ = MaterialNames(parts.materials, parts.names);
  const Status status =
      materials_.bind(parts.face_materials, SectionKind::kMaterialRuns, face_count_,
                      material_number_bytes(material_names_.count()));
  if (!status) return status;
  return user_data_.bind(parts.user_data, SectionKind::kUserDataRuns, face_count_,
                         width_of_numbers(parts.user_data.faces.size(), face_count_));
}

// Precondition: all else is bound.
Status BoundTree::check_required(const BindOptions& options) const {
  const char* missing = nullptr;
  if (options.require_user_data && !user_data_) {
    missing = "--user-data, or user_data of a profile";
  }
  if (options.require_materials && !materials_) {
    missing = "--materials, or with materials = false of its profile, or its source has none";
  }
  if (options.require_active_edges && !active_edges_) {
    missing = "--active-edges, or active_edges of a profile";
  }
  if (options.require_face_ids && !has_face_ids()) {
    missing = "face ids: with --no-face-ids, or face_ids = false of its profile";
  }
  if (missing == nullptr || empty()) return {};
  return error_with(Errc::kPartLeftOut, "it was cooked without ", missing);
}

}  // namespace boxtree
