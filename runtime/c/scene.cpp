// SPDX-License-Identifier: MIT
// Scenes, in C: made, looked at and changed. What they are queried for stands beside the same of
// trees.
#include <boxtree_c.h>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

#include <boxtree/boxtree.h>

#include "runtime/c/call.h"
#include "runtime/c/convert.h"
#include "runtime/c/handle.h"
#include "runtime/c/mesh.h"

using namespace boxtree;
using namespace boxtree::c;

namespace {

std::string_view text_of(const char* text) {
  return text == nullptr ? std::string_view() : std::string_view(text);
}

}  // namespace

bxt_status bxt_scene_bind(const bxt_file* file, const bxt_scene_options* options, bxt_scene** scene,
                          bxt_error* error) {
  if (const char* name = first_null("file", file, "scene", scene)) return refuse_null(error, name);
  bxt_scene_options read = {};
  Allocation allocation;
  if (!read_struct(options, read)) return refuse(error, "options: struct_size");
  if (!Allocation::read(read.allocator, allocation)) return refuse(error, "options: allocator");
  if (read.queries > BXT_ALL_QUERIES) return refuse(error, "options: queries");
  if (read.mesh_count > 0 && (read.meshes == nullptr || !has_size(read.meshes))) {
    return refuse(error, "options: meshes");
  }
  if (read.moving_count > 0 && read.moving == nullptr) return refuse_null(error, "options: moving");
  // No array is as long: one that is cannot be handed on.
  if (read.moving_count > PTRDIFF_MAX / sizeof(uint32_t)) {
    return refuse(error, "options: moving_count");
  }
  return guarded(error, [&] {
    Array<SceneMeshArrays> meshes(&allocation.memory());
    for (std::size_t i = 0; i < read.mesh_count; ++i) {
      bxt_scene_mesh mesh = {};
      std::optional<MeshArrays> arrays;
      if (!read_element(read.meshes, i, mesh) || !read_mesh(mesh.mesh, arrays)) {
        return refuse(error, "options: meshes");
      }
      meshes.push_back({mesh.tree, *arrays});
    }
    Result<Scene> bound = Scene::bind(
        file->inside,
        SceneOptions{.queries = static_cast<QueryKinds>(read.queries),
                     .require_face_ids = read.require_face_ids,
                     .require_active_edges = read.require_active_edges,
                     .require_materials = read.require_materials,
                     .require_user_data = read.require_user_data,
                     .require_names = read.require_names,
                     .meshes = meshes,
                     .moving = {read.moving, static_cast<std::size_t>(read.moving_count)},
                     .memory = allocation.memory()});
    if (!bound) return fail(error, bound.error());
    *scene = allocation.make<bxt_scene>(std::move(*bound));
    return bxt_status{BXT_OK};
  });
}

bxt_status bxt_scene_assemble(const bxt_tree* const* trees, size_t tree_count,
                              const bxt_placed_tree* instances, size_t instance_count,
                              const bxt_scene_layer* layers, size_t layer_count,
                              const bxt_allocator* allocator, bxt_scene** scene, bxt_error* error) {
  Allocation allocation;
  if (scene == nullptr) return refuse_null(error, "scene");
  if (tree_count > 0 && trees == nullptr) return refuse_null(error, "trees");
  if (instance_count > 0 && instances == nullptr) return refuse_null(error, "instances");
  if (instance_count > 0 && !has_size(instances)) return refuse(error, "instances: struct_size");
  if (layer_count > 0 && layers == nullptr) return refuse_null(error, "layers");
  if (layer_count > 0 && !has_size(layers)) return refuse(error, "layers: struct_size");
  if (!Allocation::read(allocator, allocation)) return refuse(error, "allocator");
  return guarded(error, [&] {
    Array<Tree> given_trees(&allocation.memory());
    for (std::size_t i = 0; i < tree_count; ++i) {
      if (trees[i] == nullptr) return refuse_null(error, "trees: one");
      given_trees.push_back(trees[i]->inside);
    }
    Array<PlacedTree> placed(&allocation.memory());
    for (std::size_t i = 0; i < instance_count; ++i) {
      bxt_placed_tree read = {};
      if (!read_element(instances, i, read)) return refuse(error, "instances: struct_size");
      placed.push_back({.tree = read.tree,
                        .pose = to_cpp(&read.pose),
                        .layer = read.layer,
                        .moves = read.moves,
                        .user_data = read.user_data,
                        .name = text_of(read.name)});
    }
    Array<SceneLayer> given_layers(&allocation.memory());
    for (std::size_t i = 0; i < layer_count; ++i) {
      bxt_scene_layer read = {};
      if (!read_element(layers, i, read)) return refuse(error, "layers: struct_size");
      if (read.queries > BXT_ALL_QUERIES) return refuse(error, "layers: queries");
      if (read.reserved != 0) return refuse(error, "layers: reserved");
      given_layers.push_back({.name = text_of(read.name),
                              .collides_with = read.collides_with,
                              .queries = static_cast<QueryKinds>(read.queries)});
    }
    Result<Scene> assembled =
        Scene::assemble(given_trees, placed, given_layers, allocation.memory());
    if (!assembled) return fail(error, assembled.error());
    *scene = allocation.make<bxt_scene>(std::move(*assembled));
    return bxt_status{BXT_OK};
  });
}

void bxt_scene_release(bxt_scene* scene) {
  Allocation::release(scene);
}

uint32_t bxt_scene_instance_count(const bxt_scene* scene) {
  return scene->inside.instance_count();
}

bxt_status bxt_scene_instance(const bxt_scene* scene, uint32_t number, bxt_instance* instance,
                              bxt_error* error) {
  if (const char* name = first_null("scene", scene, "instance", instance))
    return refuse_null(error, name);
  if (!has_size(instance)) return refuse(error, "instance: struct_size");
  return guarded(error, [&] {
    const Result<InstanceInfo> found = scene->inside.info(number);
    if (found) {
      write_struct(
          instance,
          {.tree = found->tree, .id = found->id, .layer = found->layer, .moves = found->moves});
    }
    return finish(found, error);
  });
}

size_t bxt_scene_instance_name(const bxt_scene* scene, uint32_t number, char* buffer,
                               size_t capacity) {
  const Result<InstanceInfo> found = scene->inside.info(number);
  return copy_text(found ? found->name : std::string_view(), buffer, capacity);
}

bxt_status bxt_scene_find_instance(const bxt_scene* scene, const char* name, uint32_t* number,
                                   bxt_error* error) {
  if (const char* null = first_null("scene", scene, "name", name, "number", number))
    return refuse_null(error, null);
  return guarded(error, [&] {
    const Result<std::uint32_t> found = scene->inside.find_instance(name);
    if (found) *number = *found;
    return finish(found, error);
  });
}

bxt_status bxt_scene_pose(const bxt_scene* scene, uint32_t number, bxt_pose* pose,
                          bxt_error* error) {
  if (const char* name = first_null("scene", scene, "pose", pose)) return refuse_null(error, name);
  return guarded(error, [&] {
    const Result<Pose> found = scene->inside.pose(number);
    if (found) *pose = to_c(*found);
    return finish(found, error);
  });
}

uint32_t bxt_scene_tree_count(const bxt_scene* scene) {
  return static_cast<uint32_t>(scene->inside.trees().size());
}

bxt_status bxt_scene_copy_tree(const bxt_scene* scene, uint32_t number,
                               const bxt_allocator* allocator, bxt_tree** tree, bxt_error* error) {
  if (const char* name = first_null("scene", scene, "tree", tree)) return refuse_null(error, name);
  Allocation allocation;
  if (!Allocation::read(allocator, allocation)) return refuse(error, "allocator");
  if (number >= scene->inside.trees().size())
    return fail(error, Errc::kTreeIndex, "the scene has no such tree");
  return guarded(error, [&] {
    *tree = allocation.make<bxt_tree>(scene->inside.trees()[number]);
    return bxt_status{BXT_OK};
  });
}

uint32_t bxt_scene_query_kinds(const bxt_scene* scene) {
  return scene->inside.query_kinds();
}

uint32_t bxt_scene_layer_count(const bxt_scene* scene) {
  return scene->inside.layer_count();
}

size_t bxt_scene_layer_name(const bxt_scene* scene, uint32_t layer, char* buffer, size_t capacity) {
  return copy_text(scene->inside.layer_name(layer), buffer, capacity);
}

uint32_t bxt_scene_material(const bxt_scene* scene, const bxt_face* face) {
  return scene->inside.material(scene_face(*face));
}

uint32_t bxt_scene_material_count(const bxt_scene* scene) {
  return scene->inside.material_count();
}

size_t bxt_scene_material_name(const bxt_scene* scene, uint32_t material, char* buffer,
                               size_t capacity) {
  return copy_text(scene->inside.material_name(material), buffer, capacity);
}

bxt_status bxt_scene_triangle(const bxt_scene* scene, const bxt_face* face, uint32_t half,
                              bxt_triangle* triangle, bxt_error* error) {
  if (const char* name = first_null("scene", scene, "face", face, "triangle", triangle))
    return refuse_null(error, name);
  return guarded(error, [&] {
    const Result<Triangle> found = scene->inside.triangle(scene_face(*face), half);
    if (found) *triangle = to_c(*found);
    return finish(found, error);
  });
}

bxt_status bxt_scene_active_edges(const bxt_scene* scene, const bxt_face* face, uint32_t half,
                                  uint32_t* edges, bxt_error* error) {
  if (const char* name = first_null("scene", scene, "face", face, "edges", edges))
    return refuse_null(error, name);
  return guarded(error, [&] {
    const Result<std::uint32_t> found = active_edges(scene->inside, scene_face(*face), half);
    if (found) *edges = *found;
    return finish(found, error);
  });
}

bxt_status bxt_scene_set_enabled(bxt_scene* scene, uint32_t instance, bool is_enabled,
                                 bxt_error* error) {
  if (scene == nullptr) return refuse_null(error, "scene");
  return guarded(error,
                 [&] { return finish(scene->inside.set_enabled(instance, is_enabled), error); });
}

bool bxt_scene_is_enabled(const bxt_scene* scene, uint32_t instance) {
  return scene->inside.is_enabled(instance);
}

bxt_status bxt_scene_set_user_data(bxt_scene* scene, uint32_t instance, uint64_t data,
                                   bxt_error* error) {
  if (scene == nullptr) return refuse_null(error, "scene");
  return guarded(error, [&] { return finish(scene->inside.set_user_data(instance, data), error); });
}

uint64_t bxt_scene_user_data(const bxt_scene* scene, uint32_t instance) {
  return scene->inside.user_data(instance);
}

bxt_status bxt_scene_make_movable(bxt_scene* scene, uint32_t instance, bxt_error* error) {
  if (scene == nullptr) return refuse_null(error, "scene");
  return guarded(error, [&] { return finish(scene->inside.make_movable(instance), error); });
}

bxt_status bxt_scene_update(bxt_scene* scene, uint32_t instance, const bxt_pose* pose,
                            bxt_error* error) {
  if (const char* name = first_null("scene", scene, "pose", pose)) return refuse_null(error, name);
  return guarded(error,
                 [&] { return finish(scene->inside.update(instance, to_cpp(pose)), error); });
}

bxt_status bxt_scene_rebuild(bxt_scene* scene, bxt_error* error) {
  if (scene == nullptr) return refuse_null(error, "scene");
  return guarded(error, [&] {
    scene->inside.rebuild();
    return bxt_status{BXT_OK};
  });
}
