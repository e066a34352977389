// SPDX-License-Identifier: MIT
// A tree of an open file, ready to be asked: binding checks the record and its sections once, after
// which every query reads straight from the mapped bytes.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <Eigen/Geometry>

#include <boxtree/file.h>

#include "format/children.h"
#include "format/tree_record.h"
#include "runtime/tree/codecs.h"
#include "runtime/tree/geometry.h"

namespace boxtree {

/// Stands for the id of a face in trees that were cooked without ids.
inline constexpr std::uint32_t kNoFaceId = 0xffffffffu;

struct BindOptions {
  /// The application's arrays, for trees with external geometry; ignored otherwise.
  std::optional<MeshArrays> mesh;
  /// Compare the arrays' content with the hash in the file [default false]: reads all of them.
  bool verify_mesh = false;
  /// Refuse a tree without face ids [default false] rather than report kNoFaceId later.
  bool require_face_ids = false;
};

/// The parts of one tree, wherever they lie; a part that is not there is empty.
struct TreeParts {
  TreeRecord record;
  std::string_view name;
  Bytes nodes;
  Bytes vertices;
  Bytes corners;
  Bytes face_ids;
  Bytes duplicates;
};

/// Faces in a row, in a tree's own order: first to last - 1.
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
/// arrays; cheap to copy; immutable, so safe to query from many threads at once.
class Tree {
 public:
  /// Checks record and section sizes of tree `index` and prepares it for queries; cost does not
  /// depend on its size, except with BindOptions::verify_mesh.
  /// Errors: kTreeIndex, codes 30..32, kSectionMissing, kSectionSize, kPartLeftOut,
  /// kExternalMeshNeeded, kExternalMeshMismatch.
  static Result<Tree> bind(const File& file, std::uint32_t index = 0,
                           const BindOptions& options = {});
  /// A tree must not outlive its file.
  static Result<Tree> bind(const File&& file, std::uint32_t index = 0,
                           const BindOptions& options = {}) = delete;

  /// The same for parts that are not in a file (yet). `index` only serves messages.
  static Result<Tree> bind(const TreeParts& parts, std::uint32_t index, const BindOptions& options);

  [[nodiscard]] std::string_view name() const noexcept { return name_; }
  [[nodiscard]] CodecId codec() const noexcept { return record_.codec; }
  [[nodiscard]] const TreeRecord& record() const noexcept { return record_; }
  [[nodiscard]] const Frame& frame() const noexcept { return frame_; }
  [[nodiscard]] bool empty() const noexcept { return record_.root == RootKind::kEmpty; }
  /// Whether the root is a node: not so for trees without faces, or of one leaf.
  [[nodiscard]] bool has_nodes() const noexcept { return record_.root == RootKind::kSubtree; }
  /// Whether it has nodes that filters in single precision may be used for; see float_range.h.
  [[nodiscard]] bool has_float_nodes() const noexcept { return has_float_nodes_; }
  [[nodiscard]] bool has_face_ids() const noexcept;

  /// The root with its stored box. Precondition: !empty().
  [[nodiscard]] Node root() const noexcept;

  /// Decodes one node: its children and their boxes. Precondition: `node` came from root() or
  /// expand() of this tree and is not a leaf. kNodeCorrupt when its bytes contradict themselves.
  [[nodiscard]] Errc expand(const Node& node, NodeChildren& out) const noexcept;

  /// Triangles of a leaf, in tree space; TriangleBatch::face counts faces in this tree's order.
  /// kFaceOutOfRange, kVertexOutOfRange or kVertexNotFinite when its bytes are corrupt.
  [[nodiscard]] Errc leaf_triangles(const Node& leaf, TriangleBatch& out) const noexcept;

  /// The source face number of a face in this tree's order; kNoFaceId without ids.
  /// Precondition: face < record().face_count.
  [[nodiscard]] std::uint32_t face_id(std::uint32_t face) const noexcept;

  /// Whether some faces stand in no leaf because they are copies of others.
  [[nodiscard]] bool has_duplicates() const noexcept { return duplicates_ != nullptr; }
  /// The copies of a face that is in a leaf: the same triangles, to the bit, and larger ids.
  /// Visitors of the queries are told of them; traversals that read leaves themselves meet the
  /// original alone. Corrupt bytes may state any copies, for several faces the same.
  [[nodiscard]] FaceRange duplicates_of(std::uint32_t face) const noexcept;
  /// The face of which a face is a copy; itself, if it is none or copies are not known. What
  /// corrupt bytes state may be any number. Precondition: face < record().face_count.
  [[nodiscard]] std::uint32_t original_of(std::uint32_t face) const noexcept;

  /// The same tree, of whose faces visitors hear of originals alone: where copies say nothing new,
  /// as in contacts that push bodies apart.
  [[nodiscard]] Tree without_duplicates() const noexcept {
    Tree tree = *this;
    tree.duplicates_ = nullptr;
    return tree;
  }

  /// A box of tree space in object space, rounded outward: it holds every position of object space
  /// that Frame::to_tree brings into `box`.
  [[nodiscard]] Eigen::AlignedBox3d to_object(const Box<double>& box) const noexcept;

  // What the query templates read.
  [[nodiscard]] const AnyCodec& codec_view() const noexcept { return codec_; }
  [[nodiscard]] const LeafReader& leaves() const noexcept { return leaves_; }
  /// The root's reference: all nodes in the terms of the codec, or the only leaf.
  [[nodiscard]] NodeRef root_ref() const noexcept;

 private:
  Tree() = default;
  Status bind_nodes(const TreeParts& parts, const std::string& place);
  Status bind_stored_geometry(const TreeParts& parts, const std::string& place);
  Status bind_grid(const TreeParts& parts, const std::string& place);
  Status bind_external_geometry(const std::string& place, const BindOptions& options);
  Status bind_face_ids(const TreeParts& parts, const std::string& place,
                       const BindOptions& options);
  Status bind_duplicates(const TreeParts& parts, const std::string& place);

  TreeRecord record_{};
  Frame frame_;
  std::string_view name_;
  AnyCodec codec_;
  const std::byte* face_ids_ = nullptr;
  const std::byte* duplicates_ = nullptr;  // the original of each, ascending
  LeafReader leaves_;
  bool has_float_nodes_ = false;
};

}  // namespace boxtree
