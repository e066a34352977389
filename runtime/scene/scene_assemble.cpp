// SPDX-License-Identifier: MIT
// Assembling a scene: records as a file has them, in memory, and every instance, at rest or not, in
// the tree over moving ones, so that no query can tell.
#include <algorithm>
#include <memory>
#include <string_view>
#include <utility>

#include "format/message.h"
#include "runtime/primitive/float_state.h"
#include "runtime/scene/bound_scene.h"
#include "runtime/scene/scene_frame.h"

namespace boxtree {
namespace {

constexpr std::uint64_t kMostNameBytes = 0xffff;  // of an instance, that InstanceRecord counts
// Of all names: less than offsets lead to, so that 32-bit machines can count all records.
constexpr std::uint64_t kMostTextBytes = 1 << 30;

Error of_instance(std::size_t number, const Error& error) {
  return error_of("instance", number, error);
}

Status check(const PlacedTree& instance, std::size_t tree_count) {
  if (instance.tree >= tree_count) {
    return index_error(Errc::kTreeIndex, "tree", instance.tree, tree_count);
  }
  if (instance.layer >= kMaxLayers) {
    return index_error(Errc::kInvalidQuery, "layer", instance.layer, kMaxLayers);
  }
  if (instance.name.size() > kMostNameBytes) {
    return error_with(Errc::kInvalidQuery, {}, "a name of # bytes; expected # at most",
                      {instance.name.size(), kMostNameBytes});
  }
  return {};
}

// What the records of a scene take.
struct RecordSizes {
  std::size_t layer_count;
  std::uint64_t name_bytes;
};

Result<RecordSizes> check(std::span<const PlacedTree> instances, std::span<const SceneLayer> layers,
                          std::size_t tree_count) {
  if (instances.size() > kMaxInstances) {
    return error_with(Errc::kMeshTooLarge, {}, "# instances; expected # at most",
                      {instances.size(), kMaxInstances});
  }
  if (layers.size() > kMaxLayers) {
    return index_error(Errc::kInvalidQuery, "layer", layers.size() - 1, kMaxLayers);
  }
  RecordSizes sizes{std::max<std::size_t>(layers.size(), 1), 0};
  for (std::size_t i = 0; i < instances.size(); ++i) {
    if (Status status = check(instances[i], tree_count); !status) {
      return of_instance(i, status.error());
    }
    sizes.layer_count = std::max<std::size_t>(sizes.layer_count, instances[i].layer + 1);
    sizes.name_bytes += instances[i].name.size();
  }
  for (const SceneLayer& layer : layers) sizes.name_bytes += layer.name.size();
  if (sizes.name_bytes <= kMostTextBytes) return sizes;
  return error_with(Errc::kMeshTooLarge, {}, "# bytes of names; expected # at most",
                    {sizes.name_bytes, kMostTextBytes});
}

// Those with which the layer collides: each of two must allow the other.
LayerMask collisions_of(std::uint32_t number, const SceneLayer& layer,
                        std::span<const SceneLayer> layers) {
  LayerMask collides = layer.collides_with;
  for (std::size_t other = 0; other < layers.size(); ++other) {
    if ((layers[other].collides_with >> number & 1) == 0) collides &= ~(LayerMask{1} << other);
  }
  return collides;
}

// Records and, behind them, the names that they refer to. Precondition: there is room for all.
class RecordWriter {
 public:
  RecordWriter(std::byte* records, std::byte* names) noexcept : record_(records), names_(names) {}

  /// Returns the offset of the name.
  std::uint32_t add_name(std::string_view name) noexcept {
    if (!name.empty()) std::memcpy(names_ + name_bytes_, name.data(), name.size());
    return std::exchange(name_bytes_, name_bytes_ + static_cast<std::uint32_t>(name.size()));
  }
  template <class Record>
  void add(const Record& record) noexcept {
    std::memcpy(record_, &record, sizeof(record));
    record_ += sizeof(record);
  }

 private:
  std::byte* record_;
  std::byte* names_;
  std::uint32_t name_bytes_ = 0;
};

}  // namespace

Result<Scene> BoundScene::assemble(std::span<const Tree> trees,
                                   std::span<const PlacedTree> instances,
                                   std::span<const SceneLayer> layers, const Memory& memory) {
  const DefaultFloatState state;
  Owner scene = make(memory);
  scene->trees_.assign(trees.begin(), trees.end());
  if (Status status = scene->number_materials(); !status) return status.error();
  if (Status status = scene->keep_records(instances, layers); !status) return status.error();
  if (Status status = scene->place_in_frame(instances); !status) return status.error();
  scene->keep_user_data(instances);
  return Scene(std::move(scene));
}

// File after file; trees of one file have its materials in the same bytes.
Status BoundScene::number_materials() {
  std::uint64_t end = 0, first = 0;
  const MaterialNames* last = nullptr;
  first_materials_.reserve(trees_.size() + 1);
  for (const Tree& tree : trees_) {
    const MaterialNames& names = BoundTree::of(tree).material_names();
    if (last == nullptr || !names.is_same_as(*last)) {
      first = end;
      end += names.count();
    }
    last = &names;
    first_materials_.push_back(static_cast<std::uint32_t>(first));
  }
  first_materials_.push_back(static_cast<std::uint32_t>(end));
  if (end < kNoMaterial) return {};
  return error_with(Errc::kMeshTooLarge, {}, "# materials; expected # at most",
                    {end, kNoMaterial - 1});
}

Status BoundScene::keep_records(std::span<const PlacedTree> instances,
                                std::span<const SceneLayer> layers) {
  const Result<RecordSizes> sizes = check(instances, layers, trees_.size());
  if (!sizes) return sizes.error();
  const std::size_t layer_bytes = sizes->layer_count * sizeof(LayerRecord);
  const std::size_t names_at = layer_bytes + instances.size() * sizeof(InstanceRecord);
  records_.resize(names_at + static_cast<std::size_t>(sizes->name_bytes));
  layers_ = records_.data();
  instances_ = layers_ + layer_bytes;
  names_ = Bytes(records_).subspan(names_at);
  RecordWriter writer(records_.data(), records_.data() + names_at);
  for (std::uint32_t i = 0; i < sizes->layer_count; ++i) {
    const SceneLayer given = i < layers.size() ? layers[i] : SceneLayer{};
    const std::uint32_t name = writer.add_name(given.name);
    writer.add(LayerRecord{collisions_of(i, given, layers), given.queries, name,
                           static_cast<std::uint32_t>(given.name.size())});
  }
  for (std::uint32_t i = 0; i < instances.size(); ++i) {
    const PlacedTree& given = instances[i];
    const std::uint32_t name = writer.add_name(given.name);
    writer.add(InstanceRecord{given.tree, i, name, static_cast<std::uint16_t>(given.name.size()),
                              static_cast<std::uint8_t>(given.layer),
                              given.moves ? kInstanceMoves : std::uint8_t{0}});
  }
  SceneRecord& record = top_.scene;
  record.instance_count = static_cast<std::uint32_t>(instances.size());
  record.layer_count = static_cast<std::uint8_t>(sizes->layer_count);
  record.query_kinds = kAllQueries;
  return {};
}

// First in the world, for the frame around all of them.
Status BoundScene::place_in_frame(std::span<const PlacedTree> instances) {
  if (Status status = place_each(instances); !status) return status;
  Array<Box<double>> boxes(moving_.size(), empty_box<double>(), &memory_);
  for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i] = moving_[i].bounds.world;
  frame_ = frame_around(boxes, top_.scene.scale_exponent);
  if (Status status = place_each(instances); !status) return status;
  take_moving(moving_);
  return {};
}

void BoundScene::keep_user_data(std::span<const PlacedTree> instances) {
  const auto has_data = [](const PlacedTree& given) { return given.user_data != 0; };
  if (std::none_of(instances.begin(), instances.end(), has_data)) return;
  user_data_.reserve(instances.size());
  for (const PlacedTree& given : instances) user_data_.push_back(given.user_data);
}

Status BoundScene::place_each(std::span<const PlacedTree> instances) {
  moving_.clear();
  moving_.reserve(instances.size());
  for (std::uint32_t i = 0; i < instances.size(); ++i) {
    const PlacedTree& given = instances[i];
    const BoundTree& tree = BoundTree::of(trees_[given.tree]);
    const std::optional<Posed> there = posed(tree, given.pose);
    if (!there) return invalid_pose(i);
    const Placed placed{&tree, given.pose, there->placement, i, given.layer, {}, !given.moves};
    moving_.push_back({i, placed, there->bounds});
  }
  return {};
}

}  // namespace boxtree
