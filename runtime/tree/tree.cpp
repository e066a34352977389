// SPDX-License-Identifier: MIT
// The tree as applications see it: a BoundTree in the storage of the Tree.
#include <algorithm>
#include <new>
#include <optional>
#include <string>

#include <boxtree/tree.h>

#include "runtime/primitive/float_state.h"
#include "runtime/tree/bound_tree.h"

namespace boxtree {

Tree::Tree(const BoundTree& bound) noexcept {
  new (storage_) BoundTree(bound);
}
Tree::Tree(const Tree& other) noexcept : Tree(BoundTree::of(other)) {}
Tree& Tree::operator=(const Tree& other) noexcept {
  if (this != &other) new (storage_) BoundTree(BoundTree::of(other));
  return *this;
}
// Holds views only: nothing to release, which operator= relies on, too.
Tree::~Tree() {
  static_assert(std::is_trivially_destructible_v<BoundTree>);
}

std::string_view Tree::name() const noexcept {
  return BoundTree::of(*this).name();
}
std::string_view Tree::codec_name() const noexcept {
  return boxtree::codec_name(BoundTree::of(*this).codec());
}
std::uint32_t Tree::face_count() const noexcept {
  return BoundTree::of(*this).face_count();
}
std::uint32_t Tree::triangle_count() const noexcept {
  return BoundTree::of(*this).triangle_count();
}
bool Tree::empty() const noexcept {
  return BoundTree::of(*this).empty();
}
bool Tree::has_face_ids() const noexcept {
  return BoundTree::of(*this).has_face_ids();
}

bool Tree::has_active_edges() const noexcept {
  return bool{BoundTree::of(*this).active_edges()};
}

std::uint32_t Tree::material(const FaceRef& face) const noexcept {
  return BoundTree::of(*this).material(face);
}
std::string_view Tree::material_name(std::uint32_t number) const noexcept {
  return BoundTree::of(*this).material_names()[number];
}
std::uint32_t Tree::material_count() const noexcept {
  return BoundTree::of(*this).material_names().count();
}
bool Tree::has_user_data() const noexcept {
  return BoundTree::of(*this).has_user_data();
}
std::optional<std::uint32_t> Tree::user_data(const FaceRef& face) const noexcept {
  return BoundTree::of(*this).user_data(face);
}

Eigen::AlignedBox3d Tree::bounds() const noexcept {
  const DefaultFloatState state;
  const BoundTree& tree = BoundTree::of(*this);
  if (tree.empty()) return {};
  return tree.to_object(tree.root_f64());
}

Result<Triangle> Tree::triangle(const FaceRef& face, std::uint32_t half) const {
  const DefaultFloatState state;
  const BoundTree& tree = BoundTree::of(*this);
  Result<Triangle> triangle = tree.triangle(face, half);
  if (!triangle) return triangle;
  for (Eigen::Vector3d& corner : triangle->corner) corner = tree.frame().to_object(corner);
  return triangle;
}

Tree Tree::without_duplicates() const noexcept {
  return BoundTree::of(*this).without_duplicates();
}

}  // namespace boxtree
