// SPDX-License-Identifier: MIT
// Information about the instances of a scene, and moving them.
#include "runtime/scene/bound_scene.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "format/message.h"
#include "runtime/primitive/float_state.h"
#include "runtime/tree/root_box.h"

namespace boxtree {
namespace {

Pose pose_of(const std::byte* numbers, std::uint32_t bytes) noexcept {
  Pose pose;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      const std::size_t i = 4 * row + column;
      pose.matrix()(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)) =
          bytes == sizeof(float) ? double{load<float>(numbers, i)} : load<double>(numbers, i);
    }
  }
  pose.makeAffine();
  return pose;
}

}  // namespace

void BoundScene::rebuild() {
  const DefaultFloatState state;
  build_over(moving_);
}

void BoundScene::build_over(const Array<Moving>& moving) {
  if (moving.empty()) return;
  Array<Box<double>> boxes(moving.size(), empty_box<double>(), &memory_);
  for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i] = to_frame(moving[i].bounds.world);
  MovingTree tree(boxes, &memory_);
  moving_tree_.swap(tree);
}

Status BoundScene::update(std::uint32_t instance, const Pose& pose) {
  const DefaultFloatState state;
  if (instance >= instance_count()) {
    return index_error(Errc::kInstanceIndex, "instance", instance, instance_count());
  }
  const Moving* found = find_moving(instance);
  if (found == nullptr || found->placed.at_rest) {
    return error_with(Errc::kInstanceStatic, {},
                      "instance # was bound as static; make_movable() lets it move", {instance});
  }
  Moving& moving = moving_[static_cast<std::size_t>(found - moving_.data())];
  const std::optional<Posed> there = posed(*moving.placed.tree, pose);
  if (!there) return invalid_pose(instance);
  moving.placed.pose = pose;
  moving.placed.placement = there->placement;
  moving.bounds = there->bounds;
  const auto number = static_cast<std::uint32_t>(found - moving_.data());
  conditions_.set(number, moving.bounds.condition);
  moving_tree_.refit(number, to_frame(moving.bounds.world));
  return {};
}

Status BoundScene::set_enabled(std::uint32_t instance, bool enabled) {
  if (instance >= instance_count()) {
    return index_error(Errc::kInstanceIndex, "instance", instance, instance_count());
  }
  if (disabled_.empty()) disabled_.resize(instance_count());
  disabled_[instance] = !enabled;
  return {};
}

Status BoundScene::set_user_data(std::uint32_t instance, std::uint64_t data) {
  if (instance >= instance_count()) {
    return index_error(Errc::kInstanceIndex, "instance", instance, instance_count());
  }
  if (user_data_.empty()) user_data_.resize(instance_count());
  user_data_[instance] = data;
  return {};
}

Result<InstanceInfo> BoundScene::info(std::uint32_t number) const {
  if (number >= instance_count()) {
    return index_error(Errc::kInstanceIndex, "instance", number, instance_count());
  }
  const std::optional<InstanceRecord> record = record_of(number);
  if (!record) return error_with(Errc::kRecordInvalid, {}, "instance #: its record", {number});
  const Moving* const moving = find_moving(number);
  return InstanceInfo{text(record->name_offset, record->name_bytes), record->tree, record->id,
                      record->layer, moving != nullptr && !moving->placed.at_rest};
}

Result<std::uint32_t> BoundScene::find_instance(std::string_view name) const {
  for (std::uint32_t i = 0; i < instance_count(); ++i) {
    const InstanceRecord record = instance(i);
    if (text(record.name_offset, record.name_bytes) == name) return i;
  }
  return Error{Errc::kInstanceIndex, "no instance is named \"" + std::string(name) + "\""};
}

Result<Pose> BoundScene::pose(std::uint32_t number) const {
  const Result<InstanceInfo> known = info(number);
  if (!known) return known.error();
  const Moving* moving = find_moving(number);
  return moving != nullptr ? moving->placed.pose : stored_pose(number);
}

std::string_view BoundScene::layer_name(std::uint32_t number) const noexcept {
  if (number >= layer_count()) return {};
  const LayerRecord record = layer(number);
  return text(record.name_offset, record.name_bytes);
}

std::uint32_t BoundScene::material(const SceneFace& of) const noexcept {
  if (of.instance >= instance_count()) return kNoMaterial;
  const std::uint32_t tree = instance(of.instance).tree;
  if (tree >= trees_.size()) return kNoMaterial;
  const std::uint32_t number = trees_[tree].material(of.face);
  if (first_materials_.empty()) return number;
  return number < trees_[tree].material_count() ? first_materials_[tree] + number : kNoMaterial;
}

std::string_view BoundScene::material_name(std::uint32_t number) const noexcept {
  if (number >= material_count() || first_materials_.empty()) return materials_[number];
  const auto after = std::upper_bound(first_materials_.begin(), first_materials_.end(), number);
  const auto tree = static_cast<std::size_t>(after - first_materials_.begin()) - 1;
  return trees_[tree].material_name(number - first_materials_[tree]);
}

Result<Triangle> BoundScene::triangle(const SceneFace& face, std::uint32_t half) const {
  const DefaultFloatState state;
  const Result<InstanceInfo> known = info(face.instance);
  if (!known) return known.error();
  const BoundTree& tree = BoundTree::of(trees_[known->tree]);
  const Result<Triangle> triangle = tree.triangle(face.face, half);
  if (!triangle) return triangle;
  const Moving* moving = find_moving(face.instance);
  const Pose pose = moving != nullptr ? moving->placed.pose : stored_pose(face.instance);
  return Placement::map_to_world(tree.frame(), pose).apply(*triangle);
}

std::optional<PlacementBounds> BoundScene::Placed::bounds() const noexcept {
  return placement.bounds(root_box<double>(*tree));
}

std::optional<InstanceRecord> BoundScene::record_of(std::uint32_t number) const noexcept {
  const InstanceRecord record = instance(number);
  if (record.tree >= trees_.size() || record.layer >= layer_count()) return std::nullopt;
  return record;
}

std::optional<BoundScene::Placed> BoundScene::place(std::uint32_t number) const noexcept {
  const std::optional<InstanceRecord> record = record_of(number);
  return record ? place(number, *record) : std::nullopt;
}

std::optional<BoundScene::Placed> BoundScene::place(std::uint32_t number,
                                                    const InstanceRecord& record) const noexcept {
  const BoundTree& tree = BoundTree::of(trees_[record.tree]);
  const Pose pose = stored_pose(number);
  const std::optional<Placement> placement = place_in_units(tree, pose);
  if (!placement) return std::nullopt;
  return Placed{&tree, pose, *placement, record.id, record.layer, edges_.of_instance(number)};
}

std::optional<BoundScene::Placed> BoundScene::place_now(std::uint32_t number) const noexcept {
  const Moving* moving = find_moving(number);
  return moving != nullptr ? moving->placed : place(number);
}

bool BoundScene::is_detached(std::uint32_t number) const noexcept {
  return has_detached_ && find_moving(number) != nullptr;
}

LayerRecord BoundScene::layer(std::uint32_t number) const noexcept {
  return load<LayerRecord>(layers_, number);
}

std::optional<Placement> BoundScene::place_in_units(const BoundTree& tree,
                                                    const Pose& pose) const noexcept {
  Pose scaled = pose;
  scaled.affine() *= frame_.inverse_scale;
  return is_within_range(pose.translation()) ? Placement::make(tree, scaled) : std::nullopt;
}

Error BoundScene::invalid_pose(std::uint32_t instance) {
  return error_with(Errc::kInvalidPose, {},
                    "instance #: its pose is not finite, not invertible or leads beyond 2^200 or "
                    "2^185 extents of the scene",
                    {instance});
}

std::optional<BoundScene::Posed> BoundScene::posed(const BoundTree& tree,
                                                   const Pose& pose) const noexcept {
  const std::optional<Placement> placement = place_in_units(tree, pose);
  if (!placement) return std::nullopt;
  const auto bounds = placement->bounds(root_box<double>(tree));
  if (!bounds || !(to_world(bounds->magnitude) <= kMaxCoordinate)) return std::nullopt;
  return Posed{*placement, *bounds};
}

Box<double> BoundScene::to_frame(const Box<double>& units) const noexcept {
  const Eigen::Vector3d low = to_frame(Eigen::Vector3d(units.low[0], units.low[1], units.low[2]));
  const Eigen::Vector3d high =
      to_frame(Eigen::Vector3d(units.high[0], units.high[1], units.high[2]));
  return {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
}

std::string_view BoundScene::text(std::uint32_t offset, std::uint32_t size) const noexcept {
  if (!in_range(offset, size, names_.size())) return {};
  return {reinterpret_cast<const char*>(names_.data()) + offset, size};
}

InstanceRecord BoundScene::instance(std::uint32_t number) const noexcept {
  return load<InstanceRecord>(instances_, number);
}

Pose BoundScene::stored_pose(std::uint32_t number) const noexcept {
  return pose_of(poses_ + std::size_t{number} * kNumbersOfPose * record().pose_bytes,
                 record().pose_bytes);
}

const BoundScene::Moving* BoundScene::find_moving(std::uint32_t number) const noexcept {
  const auto place = std::lower_bound(
      moving_.begin(), moving_.end(), number,
      [](const Moving& moving, std::uint32_t value) { return moving.instance < value; });
  return place != moving_.end() && place->instance == number ? &*place : nullptr;
}

}  // namespace boxtree
