// SPDX-License-Identifier: MIT
// A tree of an open file, ready for queries: binding checks the record and its sections once, after
// which every query reads straight from the mapped bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <type_traits>

#include <Eigen/Geometry>

#include <boxtree/error.h>
#include <boxtree/export.h>
#include <boxtree/file.h>
#include <boxtree/kinds.h>
#include <boxtree/triangle.h>

namespace boxtree {

class BoundTree;

/// A face in an answer.
struct FaceRef {
  /// Number in the source mesh, the same for all parts of a face that import split; kNoFaceId when
  /// the file has no ids.
  std::uint32_t id = kNoFaceId;
  /// Number in the tree's own order, from 0: what Tree::triangle() takes.
  std::uint32_t index = kNoFaceId;
};

/// Where positions and corners lie, in the file or in the application's memory. A face has
/// `corners_per_face` corner numbers, 3 or 4; with 4, the last may be the missing corner.
struct MeshArrays {
  const std::byte* positions = nullptr;  ///< The first vertex.
  std::size_t position_stride = 0;       ///< Bytes from one vertex to the next.
  bool positions_f64 = false;            ///< Three doubles a vertex, otherwise three floats.
  std::uint32_t vertex_count = 0;        ///< Number of vertices.
  const std::byte* corners = nullptr;    ///< The first corner number of the first face.
  std::uint32_t corner_bytes = 0;        ///< Of one corner number: 2 or 4.
  std::uint32_t corners_per_face = 3;    ///< 3 or 4.
  std::uint32_t face_count = 0;          ///< Number of faces.
};

/// Marks the missing fourth corner of a triangle in 32-bit corner arrays with four corners a face;
/// 16-bit arrays use 0xffff.
inline constexpr std::uint32_t kMissingCorner = 0xffffffffu;

/// Describes an application's own arrays for a tree that was cooked with external geometry. They
/// must be the arrays of the source mesh (same faces, same order, same positions), must outlive the
/// tree and must not change. `Scalar`: float or double; `Corner`: 16 or 32 bits, unsigned.
template <class Scalar, class Corner>
[[nodiscard]] MeshArrays external_mesh(const Scalar* positions, std::uint32_t vertex_count,
                                       const Corner* corners, std::uint32_t face_count,
                                       std::uint32_t corners_per_face = 3) noexcept {
  static_assert(std::is_same_v<Scalar, float> || std::is_same_v<Scalar, double>);
  static_assert(std::is_same_v<Corner, std::uint16_t> || std::is_same_v<Corner, std::uint32_t>);
  return {reinterpret_cast<const std::byte*>(positions),
          3 * sizeof(Scalar),
          std::is_same_v<Scalar, double>,
          vertex_count,
          reinterpret_cast<const std::byte*>(corners),
          sizeof(Corner),
          corners_per_face,
          face_count};
}

/// How a tree is bound.
struct BindOptions {
  /// The application's arrays, for trees with external geometry; ignored otherwise.
  std::optional<MeshArrays> mesh = {};
  /// Compare the arrays' content with the hash in the file [default false]: reads all of them.
  bool verify_mesh = false;
  /// Refuse a tree without face ids [default false] rather than report kNoFaceId later.
  bool require_face_ids = false;
  /// Refuse a tree without active edges [default false] rather than call every edge active later.
  bool require_active_edges = false;
  /// Refuse a tree none of whose faces has a material [default false] rather than answer
  /// kNoMaterial later.
  bool require_materials = false;
  /// Refuse a tree whose faces have no user data [default false] rather than answer nothing later.
  bool require_user_data = false;
};

/// One tree. Points into the bytes of its File and, with external geometry, into the application's
/// arrays; cheap to copy; immutable, so safe to query from many threads at once.
class BOXTREE_API Tree {
 public:
  /// Binds the only tree of a file. kTreeIndex when the file holds several or none, or a scene:
  /// then say which tree by its number (below) or bind a Scene. Other errors as below.
  static Result<Tree> bind(const File& file, const BindOptions& options = {});

  /// Checks record and section sizes of tree `index` and prepares it for queries; cost does not
  /// depend on its size, except with BindOptions::verify_mesh.
  /// Errors: kTreeIndex, codes 30..32, kSectionMissing, kSectionSize, kPartLeftOut,
  /// kExternalMeshNeeded, kExternalMeshMismatch, with verify_mesh kVertexOutOfRange.
  static Result<Tree> bind(const File& file, std::uint32_t index, const BindOptions& options = {});

  // A tree must not outlive its file.
  static Result<Tree> bind(const File&& file, const BindOptions& options = {}) = delete;
  static Result<Tree> bind(const File&& file, std::uint32_t index,
                           const BindOptions& options = {}) = delete;

  /// Another handle of the same tree: a copy of some hundred bytes.
  Tree(const Tree&) noexcept;
  /// The same.
  Tree& operator=(const Tree&) noexcept;
  /// Frees nothing: the bytes are the File's.
  ~Tree();

  /// Its name in the file; empty when it has none.
  [[nodiscard]] std::string_view name() const noexcept;
  /// The name of its codec, as "wide8".
  [[nodiscard]] std::string_view codec_name() const noexcept;
  /// How many faces it has: triangles and quads.
  [[nodiscard]] std::uint32_t face_count() const noexcept;
  /// How many triangles it has; a quad counts as two.
  [[nodiscard]] std::uint32_t triangle_count() const noexcept;
  /// Whether it has no faces.
  [[nodiscard]] bool empty() const noexcept;
  /// Whether FaceRef::id is the number in the source mesh, or always kNoFaceId.
  [[nodiscard]] bool has_face_ids() const noexcept;
  /// Whether edges are known to be active or not (cook --active-edges); otherwise all are active.
  [[nodiscard]] bool has_active_edges() const noexcept;
  /// The material of a face that an answer names (cook --materials), or of {kNoFaceId, index};
  /// kNoMaterial without any.
  [[nodiscard]] std::uint32_t material(const FaceRef& face) const noexcept;
  /// Name of a material; empty when it has none.
  [[nodiscard]] std::string_view material_name(std::uint32_t number) const noexcept;
  /// How many materials its file has, numbered from 0: those of all its trees.
  [[nodiscard]] std::uint32_t material_count() const noexcept;
  /// Whether numbers of the application's own are stored of its faces (cook --user-data).
  [[nodiscard]] bool has_user_data() const noexcept;
  /// The number of a face, as of material(); nothing without any. A negative number of the source
  /// is the same 32 bits in two's complement.
  [[nodiscard]] std::optional<std::uint32_t> user_data(const FaceRef& face) const noexcept;
  /// A box around all faces, in object space, rounded outward. Empty for an empty tree.
  [[nodiscard]] Eigen::AlignedBox3d bounds() const noexcept;

  /// A triangle of a face that an answer names, in object space, as queries see it: of a file with
  /// grid geometry on the grid. `half`: 0, or 1 for the second triangle (0,2,3) of a quad.
  /// Errors: kInvalidQuery (no such face or half), kFaceOutOfRange, kVertexOutOfRange and
  /// kVertexNotFinite on corrupt bytes. Costs what reading one leaf does.
  [[nodiscard]] Result<Triangle> triangle(const FaceRef& face, std::uint32_t half = 0) const;

  /// Reads the nodes of the first `levels` levels (1: the root), so that queries of a cold file do
  /// not wait for them; leaves, and sections other than the nodes, are not read. Returns how many
  /// nodes it read: all of the tree if `levels` is its depth or more, none of a tree without nodes;
  /// fewer on corrupt bytes, which queries report. Costs some 0.1 us a node in memory, and of a
  /// cold file what reading its pages costs: a tree of full nodes has 8^(levels - 1) in the last
  /// level, each group of siblings on a page of its own at worst. Never allocates. Safe from many
  /// threads, so it may run beside queries.
  std::uint32_t prefetch(std::uint32_t levels) const noexcept;

  /// The same tree, of whose faces visitors hear of originals alone: where faces that coincide with
  /// others say nothing new, as in contacts that push bodies apart.
  [[nodiscard]] Tree without_duplicates() const noexcept;

 private:
  friend class BoundTree;
  explicit Tree(const BoundTree& bound) noexcept;

  // A BoundTree, whose definition no application needs to compile.
  static constexpr std::size_t kBytes = 784;
  alignas(16) std::byte storage_[kBytes];
};

}  // namespace boxtree
