// SPDX-License-Identifier: MIT
// Trees, in C.
#include <boxtree_c.h>
#include <optional>
#include <utility>

#include <boxtree/boxtree.h>

#include "runtime/c/call.h"
#include "runtime/c/convert.h"
#include "runtime/c/handle.h"
#include "runtime/c/mesh.h"

using namespace boxtree;
using namespace boxtree::c;

bxt_status bxt_tree_bind(const bxt_file* file, uint32_t number, const bxt_tree_options* options,
                         bxt_tree** tree, bxt_error* error) {
  if (const char* name = first_null("file", file, "tree", tree)) return refuse_null(error, name);
  bxt_tree_options read = {};
  BindOptions required;
  Allocation allocation;
  if (!read_struct(options, read)) return refuse(error, "options: struct_size");
  if (!Allocation::read(read.allocator, allocation)) return refuse(error, "options: allocator");
  if (read.mesh != nullptr && !read_mesh(read.mesh, required.mesh))
    return refuse(error, "options: mesh");
  required.verify_mesh = read.verify_mesh;
  required.require_face_ids = read.require_face_ids;
  required.require_active_edges = read.require_active_edges;
  required.require_materials = read.require_materials;
  required.require_user_data = read.require_user_data;
  return guarded(error, [&] {
    const Result<Tree> bound = number == BXT_ONLY_TREE ? Tree::bind(file->inside, required)
                                                       : Tree::bind(file->inside, number, required);
    if (!bound) return fail(error, bound.error());
    *tree = allocation.make<bxt_tree>(*bound);
    return bxt_status{BXT_OK};
  });
}

bxt_status bxt_tree_copy_without_duplicates(const bxt_tree* tree, const bxt_allocator* allocator,
                                            bxt_tree** copy, bxt_error* error) {
  if (const char* name = first_null("tree", tree, "copy", copy)) return refuse_null(error, name);
  Allocation allocation;
  if (!Allocation::read(allocator, allocation)) return refuse(error, "allocator");
  return guarded(error, [&] {
    *copy = allocation.make<bxt_tree>(tree->inside.without_duplicates());
    return bxt_status{BXT_OK};
  });
}

void bxt_tree_release(bxt_tree* tree) {
  Allocation::release(tree);
}

size_t bxt_tree_name(const bxt_tree* tree, char* buffer, size_t capacity) {
  return copy_text(tree->inside.name(), buffer, capacity);
}

size_t bxt_tree_codec_name(const bxt_tree* tree, char* buffer, size_t capacity) {
  return copy_text(tree->inside.codec_name(), buffer, capacity);
}

uint32_t bxt_tree_face_count(const bxt_tree* tree) {
  return tree->inside.face_count();
}

uint32_t bxt_tree_triangle_count(const bxt_tree* tree) {
  return tree->inside.triangle_count();
}

bool bxt_tree_has_face_ids(const bxt_tree* tree) {
  return tree->inside.has_face_ids();
}

bool bxt_tree_has_active_edges(const bxt_tree* tree) {
  return tree->inside.has_active_edges();
}

bool bxt_tree_bounds(const bxt_tree* tree, bxt_vec3* min, bxt_vec3* max) {
  const Eigen::AlignedBox3d bounds = tree->inside.bounds();
  if (bounds.isEmpty()) return false;
  *min = to_c(bounds.min());
  *max = to_c(bounds.max());
  return true;
}

uint32_t bxt_tree_material(const bxt_tree* tree, const bxt_face* face) {
  return tree->inside.material(face_ref(*face));
}

uint32_t bxt_tree_material_count(const bxt_tree* tree) {
  return tree->inside.material_count();
}

size_t bxt_tree_material_name(const bxt_tree* tree, uint32_t material, char* buffer,
                              size_t capacity) {
  return copy_text(tree->inside.material_name(material), buffer, capacity);
}

bool bxt_tree_user_data(const bxt_tree* tree, const bxt_face* face, uint32_t* data) {
  const std::optional<std::uint32_t> found = tree->inside.user_data(face_ref(*face));
  if (found) *data = *found;
  return found.has_value();
}

bool bxt_tree_has_user_data(const bxt_tree* tree) {
  return tree->inside.has_user_data();
}

bxt_status bxt_tree_triangle(const bxt_tree* tree, const bxt_face* face, uint32_t half,
                             bxt_triangle* triangle, bxt_error* error) {
  if (const char* name = first_null("tree", tree, "face", face, "triangle", triangle))
    return refuse_null(error, name);
  return guarded(error, [&] {
    const Result<Triangle> found = tree->inside.triangle(face_ref(*face), half);
    if (found) *triangle = to_c(*found);
    return finish(found, error);
  });
}

bxt_status bxt_tree_active_edges([[maybe_unused]] const bxt_tree* tree,
                                 [[maybe_unused]] const bxt_face* face,
                                 [[maybe_unused]] uint32_t half, [[maybe_unused]] uint32_t* edges,
                                 bxt_error* error) {
#if BOXTREE_HAS_CAST_QUERIES
  if (const char* name = first_null("tree", tree, "face", face, "edges", edges))
    return refuse_null(error, name);
  return guarded(error, [&] {
    const Result<std::uint32_t> found = active_edges(tree->inside, face_ref(*face), half);
    if (found) *edges = *found;
    return finish(found, error);
  });
#else
  return fail(error, Errc::kPartLeftOut, "casts, of this library");
#endif
}

uint32_t bxt_tree_prefetch(const bxt_tree* tree, uint32_t levels) {
  return tree->inside.prefetch(levels);
}
