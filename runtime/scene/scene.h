// SPDX-License-Identifier: MIT
// A scene of an open file, ready to be asked: placed trees under one top-level tree.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <boxtree/query.h>

#include "format/scene_record.h"
#include "runtime/scene/largest.h"
#include "runtime/scene/moving_tree.h"
#include "runtime/scene/placement.h"
#include "runtime/scene/top_level.h"
#include "runtime/tree/tree.h"

namespace boxtree {

/// Layers of a scene, as bits.
using LayerMask = std::uint32_t;
inline constexpr LayerMask kAllLayers = 0xffffffffu;

/// The application's arrays for one tree with external geometry.
struct SceneMeshArrays {
  std::uint32_t tree;
  MeshArrays arrays;
};

struct SceneOptions {
  /// What the application will ask. A kind that the profile left out is refused here, and named.
  QueryKinds queries = 0;
  /// Refuse a scene without these [default false] rather than answer kNoFaceId, kNoMaterial or an
  /// empty name later: a tree without face ids, no material at all, no instance with a name.
  bool require_face_ids = false;
  bool require_materials = false;
  bool require_names = false;
  /// For trees with external geometry.
  std::span<const SceneMeshArrays> meshes = {};
  /// Static instances that update() shall be allowed to move: doors, say. The others that move are
  /// known from the file.
  std::span<const std::uint32_t> moving = {};
};

/// What the file says of one instance.
struct InstanceInfo {
  std::string_view name;  // empty when it has none, or names were left out
  std::uint32_t tree;
  std::uint32_t id;  // number in the source, depth first
  std::uint32_t layer;
  bool moves;
};

/// One scene. Points into the bytes of its File. Instances are numbered from 0 in the order of the
/// file. Queries on a scene that is not being updated are safe from many threads at once; update()
/// needs the scene for itself. The file's bytes are never written: poses of moving instances, and
/// the tree over them, live in the Scene. Move-only.
class Scene {
 public:
  /// Checks the records of the scene and of each tree, no instance but the moving ones; cost grows
  /// with the number of trees and moving instances alone.
  /// Errors: kNoScene, kPartLeftOut (naming the part and the line of the profile),
  /// kInstanceIndex, kRecordInvalid, kSectionMissing, kSectionSize, and those of Tree::bind.
  static Result<Scene> bind(const File& file, const SceneOptions& options = {});
  /// A scene must not outlive its file.
  static Result<Scene> bind(const File&& file, const SceneOptions& options = {}) = delete;

  Scene(Scene&&) noexcept = default;
  Scene& operator=(Scene&&) noexcept = default;
  ~Scene() = default;

  [[nodiscard]] std::uint32_t instance_count() const noexcept { return record().instance_count; }
  [[nodiscard]] std::span<const Tree> trees() const noexcept { return trees_; }
  [[nodiscard]] QueryKinds query_kinds() const noexcept { return record().query_kinds; }

  /// Error: kInstanceIndex; kRecordInvalid where the bytes of the instance are corrupt.
  [[nodiscard]] Result<InstanceInfo> info(std::uint32_t number) const;
  /// The number of the instance with that name, the first if several share it; O(instances).
  /// Error: kInstanceIndex.
  [[nodiscard]] Result<std::uint32_t> find_instance(std::string_view name) const;
  /// Its pose, object space to world: as last given to update(), else as in the file. Errors as for
  /// info().
  [[nodiscard]] Result<Pose> pose(std::uint32_t number) const;
  /// Name of a layer; empty when it has none.
  [[nodiscard]] std::string_view layer_name(std::uint32_t number) const noexcept;
  [[nodiscard]] std::uint32_t layer_count() const noexcept { return record().layer_count; }

  /// The material of a face of an instance's tree; kNoMaterial without materials. Precondition: the
  /// face came from an answer for that instance.
  [[nodiscard]] std::uint32_t material(std::uint32_t number, const FaceRef& face) const noexcept;
  /// Name of a material; empty when it has none.
  [[nodiscard]] std::string_view material_name(std::uint32_t number) const noexcept;
  [[nodiscard]] std::uint32_t material_count() const noexcept { return record().material_count; }

  /// Gives a moving instance another pose and refits the tree over the moving ones; O(log) of their
  /// number, no allocation. Errors: kInstanceIndex, kInstanceStatic, kInvalidPose (then nothing
  /// has changed).
  Status update(std::uint32_t instance, const Pose& pose);
  /// Builds the tree over moving instances anew, for after many of them have gone far. Allocates.
  void rebuild();

  // What the queries read. They compare in units of the scene: world coordinates times the power of
  // two of frame(), so that squares of distances neither overflow nor underflow, however large or
  // small the world is.
  struct Placed {
    const Tree* tree;
    Pose pose;            // to the world
    Placement placement;  // to units of the scene
    std::uint32_t id;
    std::uint32_t layer;

    /// Nothing when they are beyond reach.
    [[nodiscard]] std::optional<PlacementBounds> bounds() const noexcept;
  };
  /// What the file says of an instance. Nothing where its tree or layer is not there.
  [[nodiscard]] std::optional<InstanceRecord> record_of(std::uint32_t number) const noexcept;
  /// An instance where the file has it. Nothing where its bytes are corrupt. Precondition of the
  /// second: `record` is record_of(number).
  [[nodiscard]] std::optional<Placed> place(std::uint32_t number) const noexcept;
  [[nodiscard]] std::optional<Placed> place(std::uint32_t number,
                                            const InstanceRecord& record) const noexcept;
  /// ... and where it is now, if it moves.
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
  /// Whether a leaf of the top level is an instance that moves after all.
  [[nodiscard]] bool is_detached(std::uint32_t number) const noexcept;
  [[nodiscard]] LayerRecord layer(std::uint32_t number) const noexcept;
  /// At least PlacementBounds::condition of every instance.
  [[nodiscard]] double condition() const noexcept {
    return std::max(record().condition, conditions_.of_all());
  }
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
  /// A tree placed by a pose, in units of the scene. Nothing when it is not finite, cannot be
  /// undone or leads beyond reach.
  [[nodiscard]] std::optional<Placement> place_in_units(const Tree& tree,
                                                        const Pose& pose) const noexcept;
  /// A point or box of these units in the space of both trees. Rounded to nearest, which is
  /// monotone: boxes that share a point still do.
  [[nodiscard]] Eigen::Vector3d to_frame(const Eigen::Vector3d& units) const noexcept {
    return units - to_units(frame_.origin);
  }
  [[nodiscard]] Box<double> to_frame(const Box<double>& units) const noexcept;

 private:
  Scene() = default;
  Status bind_sections(const File& file);
  Status bind_trees(const File& file, const SceneOptions& options);
  Status check_parts(const SceneOptions& options) const;
  Status check_materials(const File& file);
  Status bind_moving(const SceneOptions& options);
  [[nodiscard]] bool has_names() const noexcept;
  [[nodiscard]] Error left_out(Part part, std::uint32_t owner, const std::string& what) const;
  [[nodiscard]] std::string_view text(std::uint32_t offset, std::uint32_t size) const noexcept;
  [[nodiscard]] InstanceRecord instance(std::uint32_t number) const noexcept;
  [[nodiscard]] Pose stored_pose(std::uint32_t number) const noexcept;
  [[nodiscard]] const Moving* find_moving(std::uint32_t number) const noexcept;

  struct TreeMaterials {
    const std::byte* runs = nullptr;  // MaterialRun[], or
    std::uint32_t run_count = 0;
    const std::byte* faces = nullptr;  // a number of each face
    std::uint32_t number_bytes = 0;
  };

  TopLevel top_;
  Frame frame_;
  std::vector<Tree> trees_;
  std::vector<TreeMaterials> materials_of_tree_;
  Bytes names_;
  Bytes left_out_;
  const std::byte* instances_ = nullptr;
  const std::byte* poses_ = nullptr;
  const std::byte* layers_ = nullptr;
  const std::byte* materials_ = nullptr;
  std::vector<Moving> moving_;  // by instance
  MovingTree moving_tree_;
  Largest conditions_;  // of moving instances
  bool has_detached_ = false;
};

}  // namespace boxtree
