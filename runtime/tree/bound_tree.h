// SPDX-License-Identifier: MIT
// The inside of a Tree: frame, codec and leaves over mapped bytes, for queries, checks and exports.
// Keeps only what these need of the record.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <Eigen/Geometry>

#include <boxtree/tree.h>

#include "format/active_edges.h"
#include "format/children.h"
#include "format/codec.h"
#include "format/face_ids.h"
#include "format/numbers.h"
#include "runtime/tree/bound_codec.h"
#include "runtime/tree/face_numbers.h"
#include "runtime/tree/geometry.h"
#include "runtime/tree/materials.h"

namespace boxtree {

struct TreeParts;
struct TreeRecord;

/// Consecutive faces, in a tree's own order: first to last - 1.
struct FaceRange {
  std::uint32_t first;
  std::uint32_t last;
};

/// A leaf or a subtree together with its decoded box, as a traversal carries it.
struct Node {
  Box<double> box;  // tree space
  NodeRef ref;
  bool is_leaf;
};

/// Children of one node; at most 8 whatever the codec.
struct NodeChildren {
  std::uint32_t count = 0;
  std::array<Node, 8> child;
};

/// One tree. Points into the bytes of its File and, with external geometry, into the application's
/// arrays; cheap to copy; immutable.
class BoundTree {
 public:
  /// See Tree::bind. `index` only serves messages.
  static Result<Tree> bind(const TreeParts& parts, std::uint32_t index, const BindOptions& options);

  /// The inside of a Tree.
  [[nodiscard]] static const BoundTree& of(const Tree& tree) noexcept;

  [[nodiscard]] std::string_view name() const noexcept { return name_; }
  [[nodiscard]] CodecId codec() const noexcept { return codec_; }
  [[nodiscard]] GeometryId geometry() const noexcept { return geometry_; }
  [[nodiscard]] std::uint32_t face_count() const noexcept { return face_count_; }
  [[nodiscard]] std::uint32_t triangle_count() const noexcept { return triangle_count_; }
  /// Numbers of nodes and of faces in leaves; these faces come first in this tree's order.
  [[nodiscard]] const TreeCounts& counts() const noexcept { return counts_; }
  [[nodiscard]] std::uint32_t node_count() const noexcept { return counts_.node_count; }
  /// Faces in no leaf: copies, after all others.
  [[nodiscard]] std::uint32_t duplicate_count() const noexcept {
    return face_count_ - counts_.faces_in_leaves;
  }
  /// Inner nodes on the longest path.
  [[nodiscard]] std::uint32_t depth() const noexcept { return depth_; }
  /// Object space is tree space times 2 to this.
  [[nodiscard]] int scale_exponent() const noexcept { return scale_exponent_; }
  /// Geometry grid: its step in object space is 2 to this; otherwise 0.
  [[nodiscard]] int grid_exponent() const noexcept { return grid_exponent_; }
  [[nodiscard]] bool has_f64_positions() const noexcept { return has_f64_positions_; }
  /// Whether faces are in the order of the source, so that their numbers are their ids.
  [[nodiscard]] bool is_in_source_order() const noexcept { return is_in_source_order_; }
  [[nodiscard]] const Frame& frame() const noexcept { return frame_; }
  [[nodiscard]] bool empty() const noexcept { return root_kind_ == RootKind::kEmpty; }
  [[nodiscard]] bool is_leaf() const noexcept { return root_kind_ == RootKind::kLeaf; }
  /// Whether the root is a node: not so for trees without faces, or of one leaf.
  [[nodiscard]] bool has_nodes() const noexcept { return root_kind_ == RootKind::kSubtree; }
  /// The root box, as it is stored.
  [[nodiscard]] const Box<double>& root_f64() const noexcept { return root_f64_; }
  /// The root box rounded outward to float. This changes nothing except where a tree of f64 is a
  /// single leaf: cookers store values of the codec's scalar.
  [[nodiscard]] const Box<float>& root_f32() const noexcept { return root_f32_; }
  [[nodiscard]] const BoxLanes& root_lanes() const noexcept { return root_lanes_; }
  /// Largest magnitude of any box coordinate, on each axis and on all.
  [[nodiscard]] const Eigen::Vector3d& max_abs() const noexcept { return max_abs_; }
  [[nodiscard]] double largest_abs() const noexcept { return largest_abs_; }
  /// Whether it has nodes that filters in single precision may be used for; see float_range.h.
  [[nodiscard]] bool has_float_nodes() const noexcept { return has_float_nodes_; }
  [[nodiscard]] bool has_face_ids() const noexcept;

  /// The root with its stored box. Precondition: !empty().
  [[nodiscard]] Node root() const noexcept;

  /// Decodes one node: its children and their boxes. Precondition: `node` came from root() or
  /// expand() of this tree and is not a leaf.
  [[nodiscard]] NodeState expand(const Node& node, NodeChildren& out) const noexcept;

  /// Triangles of a leaf, in tree space; TriangleBatch::face counts faces in this tree's order.
  /// kFaceOutOfRange, kVertexOutOfRange or kVertexNotFinite when its bytes are corrupt.
  [[nodiscard]] Errc leaf_triangles(const Node& leaf, TriangleBatch& out) const noexcept;

  /// A triangle of a face, in tree space; see Tree::triangle.
  [[nodiscard]] Result<Triangle> triangle(const FaceRef& face, std::uint32_t half) const;

  /// What is stored of them; none where faces are in the order of the source.
  [[nodiscard]] const FaceIdView& face_ids() const noexcept { return face_ids_; }

  /// The source face number of a face in this tree's order; kNoFaceId without ids.
  /// Precondition: face < face_count().
  [[nodiscard]] std::uint32_t face_id(std::uint32_t face) const noexcept;

  /// The same for faces 8 leaf to 8 leaf + 7, in a third of the time of eight calls. Those of faces
  /// that do not exist are unspecified. Precondition: 8 leaf < face_count().
  void read_leaf_ids(std::uint32_t leaf, std::span<std::uint32_t, kLeafFaces> out) const noexcept;

  /// Whether some faces are in no leaf because they are copies of others.
  [[nodiscard]] bool has_duplicates() const noexcept { return bool{duplicates_}; }
  /// The copies of a face that is in a leaf: the same triangles, to the bit, and larger ids.
  /// Queries report them to visitors; traversals that read leaves themselves get the original only.
  /// Corrupt bytes may give any copies, and the same ones for several faces.
  [[nodiscard]] FaceRange duplicates_of(std::uint32_t face) const noexcept;
  /// The original of a face; the face itself if it is no copy or copies are unknown. Corrupt bytes
  /// may give any number. Precondition: face < face_count().
  [[nodiscard]] std::uint32_t original_of(std::uint32_t face) const noexcept;

  /// The same tree, whose visitors get originals only: for uses in which copies add nothing, such
  /// as contacts that push bodies apart.
  [[nodiscard]] Tree without_duplicates() const noexcept {
    Tree tree(*this);
    inside(tree).duplicates_ = {};
    return tree;
  }

  /// Which edges are active, or nothing.
  [[nodiscard]] const ActiveEdgesView& active_edges() const noexcept { return active_edges_; }

  /// The same face with its id, which callers who count faces may not have set. Any face.
  [[nodiscard]] FaceRef with_id(const FaceRef& face) const noexcept;

  /// The materials of its faces, or nothing, and their names.
  [[nodiscard]] bool has_materials() const noexcept { return bool{materials_}; }
  [[nodiscard]] std::uint32_t material(const FaceRef& face) const noexcept {
    return materials_.of(with_id(face), face_count_).value_or(kNoMaterial);
  }
  [[nodiscard]] const MaterialNames& material_names() const noexcept { return material_names_; }

  /// What the application stored of its faces, or nothing.
  [[nodiscard]] bool has_user_data() const noexcept { return bool{user_data_}; }
  [[nodiscard]] std::optional<std::uint32_t> user_data(const FaceRef& face) const noexcept {
    return user_data_.of(with_id(face), face_count_);
  }

  /// A box of tree space in object space, rounded outward: it holds every position of object space
  /// that Frame::to_tree brings into `box`.
  [[nodiscard]] Eigen::AlignedBox3d to_object(const Box<double>& box) const noexcept;

  // What the query templates read.
  /// The functions of its nodes' codec, or kNoCodec.
  [[nodiscard]] const CodecFunctions& codec_functions() const noexcept { return *functions_; }
  [[nodiscard]] const BoundCodec& nodes() const noexcept { return nodes_; }
  [[nodiscard]] const LeafReader& leaves() const noexcept { return leaves_; }
  /// The reference to the root: in the terms of the codec, or the only leaf.
  [[nodiscard]] NodeRef root_ref() const noexcept;

 private:
  BoundTree() = default;
  [[nodiscard]] static BoundTree& inside(Tree& tree) noexcept;
  void keep(const TreeRecord& record);
  Status bind_sections(const TreeParts& parts, const BindOptions& options);
  Status bind_nodes(const TreeParts& parts);
  Status bind_stored_geometry(const TreeParts& parts);
  Status bind_clusters(const TreeParts& parts);
  Status bind_external_geometry(const TreeParts& parts, const BindOptions& options);
  Status bind_face_ids(const TreeParts& parts);
  Status bind_duplicates(const TreeParts& parts);
  Status bind_active_edges(const TreeParts& parts);
  Status bind_face_numbers(const TreeParts& parts);
  [[nodiscard]] Status check_required(const BindOptions& options) const;

  CodecId codec_{};
  GeometryId geometry_{};
  RootKind root_kind_ = RootKind::kEmpty;
  TreeCounts counts_;
  std::uint32_t face_count_ = 0;
  std::uint32_t triangle_count_ = 0;
  std::uint32_t depth_ = 0;
  std::int32_t scale_exponent_ = 0;
  std::int32_t grid_exponent_ = 0;
  bool has_f64_positions_ = false;
  bool is_in_source_order_ = false;
  Box<double> root_f64_{};
  Frame frame_;
  std::string_view name_;
  BoundCodec nodes_;
  const CodecFunctions* functions_ = &kNoCodec;
  FaceIdView face_ids_;
  NumberView duplicates_;  // the original of each, ascending
  ActiveEdgesView active_edges_;
  LeafReader leaves_;
  // What every query needs, computed when the tree is bound.
  Eigen::Vector3d max_abs_ = Eigen::Vector3d::Zero();
  double largest_abs_ = 0;
  Box<float> root_f32_{};
  BoxLanes root_lanes_ = BoxLanes(Box<float>{});  // of root_f32_
  bool has_float_nodes_ = false;
  // What no query reads.
  FaceNumberView materials_;
  MaterialNames material_names_;
  FaceNumberView user_data_;
};

}  // namespace boxtree
