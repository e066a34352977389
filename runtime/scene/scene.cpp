// SPDX-License-Identifier: MIT
// The scene as applications see it.
#include <utility>

#include <boxtree/scene.h>

#include "runtime/scene/bound_scene.h"

namespace boxtree {

Result<Scene> Scene::bind(const File& file, const SceneOptions& options) {
  return BoundScene::bind(file, options);
}
Result<Scene> Scene::assemble(std::span<const Tree> trees, std::span<const PlacedTree> instances,
                              std::span<const SceneLayer> layers, const Memory& memory) {
  return BoundScene::assemble(trees, instances, layers, memory);
}

Scene::Scene(std::unique_ptr<BoundScene, Ends> bound) noexcept : bound_(std::move(bound)) {}
void Scene::Ends::operator()(BoundScene* bound) const noexcept {
  destroy(bound);
}
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;
Scene::~Scene() = default;

std::uint32_t Scene::instance_count() const noexcept {
  return bound_->instance_count();
}
std::span<const Tree> Scene::trees() const noexcept {
  return bound_->trees();
}
QueryKinds Scene::query_kinds() const noexcept {
  return bound_->query_kinds();
}

Result<InstanceInfo> Scene::info(std::uint32_t number) const {
  return bound_->info(number);
}
Result<std::uint32_t> Scene::find_instance(std::string_view name) const {
  return bound_->find_instance(name);
}
Result<Pose> Scene::pose(std::uint32_t number) const {
  return bound_->pose(number);
}
std::string_view Scene::layer_name(std::uint32_t number) const noexcept {
  return bound_->layer_name(number);
}
std::uint32_t Scene::layer_count() const noexcept {
  return bound_->layer_count();
}

Result<Triangle> Scene::triangle(const SceneFace& face, std::uint32_t half) const {
  return bound_->triangle(face, half);
}
std::uint32_t Scene::material(const SceneFace& face) const noexcept {
  return bound_->material(face);
}
std::string_view Scene::material_name(std::uint32_t number) const noexcept {
  return bound_->material_name(number);
}
std::uint32_t Scene::material_count() const noexcept {
  return bound_->material_count();
}

Status Scene::set_enabled(std::uint32_t instance, bool enabled) {
  return bound_->set_enabled(instance, enabled);
}
bool Scene::is_enabled(std::uint32_t instance) const noexcept {
  return bound_->is_enabled(instance);
}
Status Scene::set_user_data(std::uint32_t instance, std::uint64_t data) {
  return bound_->set_user_data(instance, data);
}
std::uint64_t Scene::user_data(std::uint32_t instance) const noexcept {
  return bound_->user_data(instance);
}

Status Scene::make_movable(std::uint32_t instance) {
  return bound_->make_movable(instance);
}
Status Scene::update(std::uint32_t instance, const Pose& pose) {
  return bound_->update(instance, pose);
}
void Scene::rebuild() {
  bound_->rebuild();
}

}  // namespace boxtree
