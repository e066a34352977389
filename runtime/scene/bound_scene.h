// SPDX-License-Identifier: MIT
// The inside of a Scene: the records of placed trees under one top-level tree, over mapped bytes,
// and the poses of those that move.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <boxtree/scene.h>

#include "format/instance_edges.h"
#include "format/scene_record.h"
#include "runtime/file/open_file.h"
#include "runtime/scene/largest.h"
#include "runtime/scene/moving_tree.h"
#include "runtime/scene/placement.h"
#include "runtime/scene/top_level.h"
#include "runtime/tree/bound_tree.h"
#include "runtime/tree/materials.h"

namespace boxtree {

/// See Scene, which documents what both have. Neither copied nor moved.
class BoundScene {
 public:
  static Result<Scene> bind(const File& file, const SceneOptions& options);
  static Result<Scene> assemble(std::span<const Tree> trees, std::span<const PlacedTree> instances,
                                std::span<const SceneLayer> layers, const Memory& memory);
  /// What all that it owns is allocated from.
  [[nodiscard]] const Memory& memory() const noexcept { return memory_; }

  /// The inside of a Scene.
  [[nodiscard]] static const BoundScene& of(const Scene& scene) noexcept { return *scene.bound_; }

  BoundScene(const BoundScene&) = delete;
  BoundScene& operator=(const BoundScene&) = delete;
  ~BoundScene() = default;

  [[nodiscard]] std::uint32_t instance_count() const noexcept { return record().instance_count; }
  [[nodiscard]] std::span<const Tree> trees() const noexcept { return trees_; }
  [[nodiscard]] QueryKinds query_kinds() const noexcept { return record().query_kinds; }

  [[nodiscard]] Result<InstanceInfo> info(std::uint32_t number) const;
  [[nodiscard]] Result<std::uint32_t> find_instance(std::string_view name) const;
  [[nodiscard]] Result<Pose> pose(std::uint32_t number) const;
  [[nodiscard]] std::string_view layer_name(std::uint32_t number) const noexcept;
  [[nodiscard]] std::uint32_t layer_count() const noexcept { return record().layer_count; }
  [[nodiscard]] Result<Triangle> triangle(const SceneFace& face, std::uint32_t half) const;
  [[nodiscard]] const InstanceEdgesView& edges() const noexcept { return edges_; }
  [[nodiscard]] std::uint32_t material(const SceneFace& face) const noexcept;
  [[nodiscard]] std::string_view material_name(std::uint32_t number) const noexcept;
  [[nodiscard]] std::uint32_t material_count() const noexcept {
    return first_materials_.empty() ? materials_.count() : first_materials_.back();
  }
  Status set_enabled(std::uint32_t instance, bool enabled);
  [[nodiscard]] bool is_enabled(std::uint32_t instance) const noexcept {
    return disabled_.empty() ? instance < instance_count()
                             : instance < disabled_.size() && !disabled_[instance];
  }
  Status set_user_data(std::uint32_t instance, std::uint64_t data);
  [[nodiscard]] std::uint64_t user_data(std::uint32_t instance) const noexcept {
    return instance < user_data_.size() ? user_data_[instance] : 0;
  }
  Status make_movable(std::uint32_t instance);
  Status update(std::uint32_t instance, const Pose& pose);
  void rebuild();

  // What the queries read. They compare in units of the scene: world coordinates times the power of
  // two of frame(), so that squares of distances neither overflow nor underflow, however large or
  // small the world is.
  struct Placed {
    const BoundTree* tree;
    Pose pose;            // to the world
    Placement placement;  // to units of the scene
    std::uint32_t id;
    std::uint32_t layer;
    InactiveEdges inactive;  // besides those of the tree
    bool at_rest = false;    // static, though it is among the moving ones; see assemble()

    /// Nothing when they are beyond kMaxCoordinate.
    [[nodiscard]] std::optional<PlacementBounds> bounds() const noexcept;
  };
  /// A tree in a pose, and where that is.
  struct Posed {
    Placement placement;
    PlacementBounds bounds;
  };
  /// The record of an instance. Nothing if its tree or layer does not exist.
  [[nodiscard]] std::optional<InstanceRecord> record_of(std::uint32_t number) const noexcept;
  /// An instance in the pose of the file. Nothing if its bytes are corrupt. Precondition of the
  /// second: `record` is record_of(number).
  [[nodiscard]] std::optional<Placed> place(std::uint32_t number) const noexcept;
  [[nodiscard]] std::optional<Placed> place(std::uint32_t number,
                                            const InstanceRecord& record) const noexcept;
  /// The same in the current pose, if it moves.
  [[nodiscard]] std::optional<Placed> place_now(std::uint32_t number) const noexcept;
  [[nodiscard]] const SceneRecord& record() const noexcept { return top_.scene; }
  [[nodiscard]] const TopLevel& top_level() const noexcept { return top_; }
  [[nodiscard]] const MovingTree& moving_tree() const noexcept { return moving_tree_; }
  [[nodiscard]] const Frame& frame() const noexcept { return frame_; }
  struct Moving {
    std::uint32_t instance;
    Placed placed;
    PlacementBounds bounds;
  };
  [[nodiscard]] std::span<const Moving> moving() const noexcept { return moving_; }
  /// Whether a leaf of the top level is an instance that was bound as moving.
  [[nodiscard]] bool is_detached(std::uint32_t number) const noexcept;
  [[nodiscard]] LayerRecord layer(std::uint32_t number) const noexcept;
  /// Of hits at one distance: whether that on the first instance, of which the source has the
  /// number `id`, comes before the other one. Faces have their ids.
  [[nodiscard]] bool comes_first(std::uint32_t id, const FaceRef& face, std::uint32_t other_id,
                                 const FaceRef& other) const noexcept {
    if ((record().flags & kSceneFacesNumbered) != 0 && face.id != other.id) {
      return face.id < other.id;
    }
    return id < other_id;
  }
  /// An upper bound of PlacementBounds::condition of all instances.
  [[nodiscard]] double condition() const noexcept {
    return std::max(record().condition, conditions_.of_all());
  }
  /// From units of the scene to the world.
  [[nodiscard]] Frame units() const noexcept { return {{0, 0, 0}, record().scale_exponent}; }
  /// World coordinates in units of the scene, and back.
  [[nodiscard]] Eigen::Vector3d to_units(const Eigen::Vector3d& world) const noexcept {
    return world * frame_.inverse_scale;
  }
  [[nodiscard]] double to_units(double length) const noexcept {
    return length * frame_.inverse_scale;
  }
  [[nodiscard]] Eigen::Vector3d to_world(const Eigen::Vector3d& units) const noexcept {
    return units * frame_.scale;
  }
  [[nodiscard]] double to_world(double length) const noexcept { return length * frame_.scale; }
  /// A tree placed by a pose, in units of the scene. Nothing if the pose is not finite, is not
  /// invertible or leads beyond kMaxCoordinate.
  [[nodiscard]] std::optional<Placement> place_in_units(const BoundTree& tree,
                                                        const Pose& pose) const noexcept;
  /// A point or box in units of the scene, moved to the space of the top-level and the moving tree.
  /// Rounded to nearest, which is monotone: boxes that share a point still do.
  [[nodiscard]] Eigen::Vector3d to_frame(const Eigen::Vector3d& units) const noexcept {
    return units - to_units(frame_.origin);
  }
  [[nodiscard]] Box<double> to_frame(const Box<double>& units) const noexcept;

 private:
  using Owner = std::unique_ptr<BoundScene, Scene::Ends>;

  explicit BoundScene(const Memory& memory) noexcept
      : memory_(memory),
        trees_(&memory_),
        records_(&memory_),
        first_materials_(&memory_),
        moving_(&memory_),
        moving_tree_(&memory_),
        conditions_(&memory_),
        disabled_(&memory_),
        user_data_(&memory_) {}
  static Owner make(const Memory& memory);
  Status bind_sections(const File& file);
  Status bind_trees(const File& file, const SceneOptions& options);
  Status check_parts(const SceneOptions& options) const;
  Status bind_moving(Array<std::uint32_t> numbers);
  Status number_materials();
  Status keep_records(std::span<const PlacedTree> instances, std::span<const SceneLayer> layers);
  Status place_in_frame(std::span<const PlacedTree> instances);
  Status place_each(std::span<const PlacedTree> instances);
  void keep_user_data(std::span<const PlacedTree> instances);
  /// Sets what moves and the tree over it; all stays as it was where memory is missing.
  void take_moving(Array<Moving>& moving);
  void build_over(const Array<Moving>& moving);
  /// Nothing if the pose is not finite, is not invertible or leads beyond kMaxCoordinate.
  [[nodiscard]] std::optional<Posed> posed(const BoundTree& tree, const Pose& pose) const noexcept;
  /// What is said then.
  static Error invalid_pose(std::uint32_t instance);
  [[nodiscard]] bool has_names() const noexcept;
  [[nodiscard]] Error left_out(Part part, std::uint32_t owner, const std::string& what) const;
  [[nodiscard]] std::string_view text(std::uint32_t offset, std::uint32_t size) const noexcept;
  [[nodiscard]] InstanceRecord instance(std::uint32_t number) const noexcept;
  [[nodiscard]] Pose stored_pose(std::uint32_t number) const noexcept;
  [[nodiscard]] const Moving* find_moving(std::uint32_t number) const noexcept;

  Memory memory_;
  TopLevel top_;
  Frame frame_;
  Array<Tree> trees_;
  Bytes names_;
  Bytes left_out_;
  InstanceEdgesView edges_;
  const std::byte* instances_ = nullptr;
  const std::byte* poses_ = nullptr;
  const std::byte* layers_ = nullptr;
  MaterialNames materials_;
  // Of a scene that a program assembled: the bytes of its records, which the pointers above lead
  // to, and of each tree the number of its file's first material, then how many there are.
  Array<std::byte> records_;
  Array<std::uint32_t> first_materials_;
  Array<Moving> moving_;  // by instance
  MovingTree moving_tree_;
  Largest conditions_;  // of moving instances
  bool has_detached_ = false;
  // Of each instance, or empty while none was set.
  Array<bool> disabled_;
  Array<std::uint64_t> user_data_;
};

}  // namespace boxtree
