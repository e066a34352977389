// SPDX-License-Identifier: MIT
// Binding: the checks that let queries trust counts and section sizes, and nothing else.
#include <cmath>
#include <limits>
#include <string>

#include <boxtree/runtime/tree/dispatch.h>
#include <boxtree/runtime/tree/tree.h>

namespace boxtree {
namespace {

std::size_t node_bytes(CodecId codec) {
  switch (codec) {
    case CodecId::kPlainF32:
      return sizeof(PlainNodeF32);
    case CodecId::kPlainF16:
      return sizeof(PlainNodeF16);
  }
  return 0;
}

// The section if its size is `count * element`, the only size that its record allows.
Result<Bytes> sized_section(const File& file, SectionKind kind, std::uint32_t tree,
                            std::uint64_t count, std::uint64_t element) {
  const std::string place =
      "tree " + std::to_string(tree) + ", section " + std::string(section_name(kind));
  if (file.container().find(kind, tree) == nullptr) {
    return Error{Errc::kSectionMissing, place + " is absent"};
  }
  const Bytes bytes = file.section(kind, tree);
  if (bytes.size() != count * element) {
    return Error{Errc::kSectionSize, place + " has " + std::to_string(bytes.size()) +
                                         " bytes, its record asks for " + std::to_string(count) +
                                         " x " + std::to_string(element)};
  }
  return bytes;
}

}  // namespace

Result<Tree> Tree::bind(const File& file, std::uint32_t index, const BindOptions& options) {
  if (index >= file.tree_count()) {
    return Error{Errc::kTreeIndex,
                 "tree " + std::to_string(index) + " of " + std::to_string(file.tree_count())};
  }
  Tree tree;
  tree.record_ = file.tree_record(index);
  if (Status status = check_tree_record(tree.record_, index); !status) return status.error();
  tree.frame_ = Frame(tree.record_);
  tree.name_ = file.tree_name(index);
  if (Status status = tree.bind_nodes(file, index); !status) return status.error();
  if (Status status = tree.bind_geometry(file, index, options); !status) return status.error();
  if (Status status = tree.bind_face_ids(file, index, options); !status) return status.error();
  return tree;
}

Status Tree::bind_nodes(const File& file, std::uint32_t index) {
  if (record_.root != RootKind::kSubtree) return {};
  const Result<Bytes> bytes = sized_section(file, SectionKind::kNodes, index, record_.node_count,
                                            node_bytes(record_.codec));
  if (!bytes) return bytes.error();
  nodes_ = bytes->data();
  return {};
}

Status Tree::bind_geometry(const File& file, std::uint32_t index, const BindOptions& options) {
  const bool positions_f64 = (record_.flags & kTreePositionsF64) != 0;
  MeshArrays mesh;
  if (record_.geometry == GeometryId::kExternal) {
    const std::string place = "tree " + std::to_string(index) + ": ";
    if (!options.mesh) return Error{Errc::kExternalMeshNeeded, place + "no mesh was given"};
    mesh = *options.mesh;
    if (mesh.face_count != record_.face_count || mesh.positions_f64 != positions_f64) {
      return Error{Errc::kExternalMeshMismatch,
                   place + "expected " + std::to_string(record_.face_count) + " faces of " +
                       (positions_f64 ? "f64" : "f32") + " positions, given " +
                       std::to_string(mesh.face_count) + " of " +
                       (mesh.positions_f64 ? "f64" : "f32")};
    }
    if (options.verify_mesh) {
      const Result<std::uint64_t> hash = geometry_hash(mesh);
      if (!hash) return hash.error();
      if (*hash != record_.geometry_hash) {
        return Error{Errc::kExternalMeshMismatch, place + "the mesh's content differs"};
      }
    }
  } else if (record_.face_count > 0) {
    const std::size_t stride = 3 * (positions_f64 ? sizeof(double) : sizeof(float));
    const Result<Bytes> positions =
        sized_section(file, SectionKind::kVertices, index, record_.vertex_count, stride);
    if (!positions) return positions.error();
    const Result<Bytes> corners =
        sized_section(file, SectionKind::kCorners, index, record_.face_count,
                      std::uint64_t{record_.corners_per_face} * record_.corner_bytes);
    if (!corners) return corners.error();
    mesh = {positions->data(),
            stride,
            positions_f64,
            record_.vertex_count,
            corners->data(),
            record_.corner_bytes,
            record_.corners_per_face,
            record_.face_count};
  }
  leaves_ = LeafReader(mesh, frame_);
  return {};
}

Status Tree::bind_face_ids(const File& file, std::uint32_t index, const BindOptions& options) {
  if (record_.face_id_bytes != 0) {
    const Result<Bytes> ids = sized_section(file, SectionKind::kFaceIds, index, record_.face_count,
                                            record_.face_id_bytes);
    if (!ids) return ids.error();
    face_ids_ = ids->data();
  }
  if (options.require_face_ids && !has_face_ids() && !empty()) {
    return Error{Errc::kPartLeftOut,
                 "tree " + std::to_string(index) + ": face ids were left out when it was cooked"};
  }
  return {};
}

bool Tree::has_face_ids() const noexcept {
  return face_ids_ != nullptr || (record_.flags & kTreeFacesInSourceOrder) != 0;
}

NodeRef Tree::root_ref() const noexcept {
  return record_.root == RootKind::kLeaf ? NodeRef{0, record_.face_count}
                                         : NodeRef{0, record_.node_count};
}

Node Tree::root() const noexcept {
  return {{record_.root_low, record_.root_high}, root_ref(), record_.root == RootKind::kLeaf};
}

Errc Tree::expand(const Node& node, NodeChildren& out) const noexcept {
  out.count = 0;
  return with_codec(*this, [&]<class C>(const C& codec) {
    using S = typename C::Scalar;
    Box<S> box;
    for (std::size_t k = 0; k < 3; ++k) {
      box.low[k] = static_cast<S>(node.box.low[k]);
      box.high[k] = static_cast<S>(node.box.high[k]);
    }
    typename C::Children children;
    if (!codec.expand(node.ref, box, children)) return Errc::kNodeCorrupt;
    for (std::uint32_t i = 0; i < children.count; ++i) {
      Node& child = out.child[i];
      for (std::size_t k = 0; k < 3; ++k) {
        child.box.low[k] = children.low[k][i];
        child.box.high[k] = children.high[k][i];
      }
      child.ref = children.ref[i];
      child.is_leaf = children.is_leaf(i);
    }
    out.count = children.count;
    return Errc::kOk;
  });
}

Errc Tree::leaf_triangles(const Node& leaf, TriangleBatch& out) const noexcept {
  return leaves_.read(leaf.ref.first, leaf.ref.second, out);
}

std::uint32_t Tree::face_id(std::uint32_t face) const noexcept {
  if ((record_.flags & kTreeFacesInSourceOrder) != 0) return face;
  if (face_ids_ == nullptr) return kNoFaceId;
  switch (record_.face_id_bytes) {
    case 1:
      return load<std::uint8_t>(face_ids_, face);
    case 2:
      return load<std::uint16_t>(face_ids_, face);
    default:
      return load<std::uint32_t>(face_ids_, face);
  }
}

Eigen::AlignedBox3d Tree::to_object(const Box<double>& box) const noexcept {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Eigen::Vector3d low;
  Eigen::Vector3d high;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    low[axis] = box.low[k] * frame_.scale + frame_.origin[axis];
    high[axis] = box.high[k] * frame_.scale + frame_.origin[axis];
    if (frame_.origin[axis] == 0) continue;  // scaling by a power of two did not round
    low[axis] = std::nextafter(low[axis], -kInfinity);
    high[axis] = std::nextafter(high[axis], kInfinity);
  }
  return {low, high};
}

}  // namespace boxtree
