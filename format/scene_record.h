// SPDX-License-Identifier: MIT
// The records of a scene: placed trees, the top-level tree over them, and what was left out of the
// file because the scene does not need it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>

#include <boxtree/error.h>
#include <boxtree/kinds.h>

#include "format/children.h"
#include "format/limits.h"

namespace boxtree {

/// Layers of one scene: instances of a layer answer the same queries and collide with the same
/// layers.
inline constexpr std::uint32_t kMaxLayers = 32;

/// Instances of one scene: as many as the leaves that a wide codec can number.
inline constexpr std::uint32_t kMaxInstances = kMaxFaces / kLeafFaces;

/// SceneRecord::flags: the faces of all trees are numbered throughout, as those of one mesh that
/// was cut into tiles. Of several at one distance the face with the smallest number counts,
/// whatever instance it is of.
inline constexpr std::uint8_t kSceneFacesNumbered = 1;
inline constexpr std::uint8_t kSceneKnownFlags = 1;

/// The scene of a file; a file has at most one. The top-level tree has its own tree space, (world -
/// origin) * 2^-scale_exponent, as in TreeRecord.
struct SceneRecord {
  std::uint32_t instance_count;
  std::uint32_t static_count;  // instances 0 to static_count - 1 are the leaves of the top level
  std::uint32_t node_count;    // of section scene_nodes
  RootKind root;               // kLeaf: one static instance, which has no node
  std::array<std::uint8_t, 3> reserved2;
  std::uint32_t depth;       // inner nodes on the longest path
  std::uint8_t pose_bytes;   // of a number in section poses: 4 or 8
  std::uint8_t layer_count;  // 1 to kMaxLayers
  QueryKinds query_kinds;    // queries that the scene answers
  std::uint8_t flags;
  std::int32_t scale_exponent;
  std::uint32_t material_count;
  std::array<double, 3> origin;     // world
  std::array<double, 3> root_low;   // tree space of the top level
  std::array<double, 3> root_high;  // likewise
  double condition;                 // upper bound for the poses of static instances
  std::array<std::uint64_t, 2> reserved1;
};
static_assert(sizeof(SceneRecord) == 128 && std::is_trivially_copyable_v<SceneRecord>);
static_assert(offsetof(SceneRecord, scale_exponent) == 24 && offsetof(SceneRecord, origin) == 32);
static_assert(offsetof(SceneRecord, root_high) == 80);

/// Numbers of a pose: three rows of four.
inline constexpr std::size_t kNumbersOfPose = 12;

/// InstanceRecord::flags: the instance moves, so it is not in the top level of the file.
inline constexpr std::uint8_t kInstanceMoves = 1;
inline constexpr std::uint8_t kInstanceKnownFlags = 1;

/// One placed tree. Its pose, three rows of four numbers, is in section poses.
struct InstanceRecord {
  std::uint32_t tree;
  std::uint32_t id;           // number in the source, depth first
  std::uint32_t name_offset;  // into the names section
  std::uint16_t name_bytes;
  std::uint8_t layer;
  std::uint8_t flags;
};
static_assert(sizeof(InstanceRecord) == 16 && std::is_trivially_copyable_v<InstanceRecord>);
static_assert(offsetof(InstanceRecord, layer) == 14);

/// Queries that the instances of one layer answer, and layers that they collide with.
struct LayerRecord {
  std::uint32_t collides_with;  // bit n: contacts with layer n are requested; symmetric
  std::uint32_t query_kinds;    // QueryKinds that instances of the layer answer
  std::uint32_t name_offset;    // into the names section
  std::uint32_t name_bytes;
};
static_assert(sizeof(LayerRecord) == 16 && std::is_trivially_copyable_v<LayerRecord>);

/// Name of one material.
struct MaterialRecord {
  std::uint32_t name_offset;  // into the names section
  std::uint32_t name_bytes;
};
static_assert(sizeof(MaterialRecord) == 8 && std::is_trivially_copyable_v<MaterialRecord>);

/// Bytes of each material number: as many as the largest one takes.
[[nodiscard]] constexpr std::uint8_t material_number_bytes(std::uint32_t material_count) noexcept {
  if (material_count <= 1u << 8) return 1;
  return material_count <= 1u << 16 ? 2 : 4;
}

/// Parts that a profile can leave out. Numbers are pinned.
enum class Part : std::uint16_t {
  kFaceIds = 1,
  kMaterials = 2,
  kNames = 3,
  kRays = 4,
  kBoxes = 5,
  kPoints = 6,
  kPairs = 7,
};

/// "face ids"; "unknown" for a number this reader does not know.
[[nodiscard]] std::string_view part_name(Part part) noexcept;

/// A part that was left out, and the line of the profile that states it.
struct LeftOutRecord {
  Part part;
  std::uint16_t reserved0;
  std::uint32_t owner;        // the tree without it, or kNoOwner
  std::uint32_t line;         // of the profile, from 1; 0 when left out by an option
  std::uint32_t text_offset;  // into the names section: "scene.toml:12: face_ids = false"
  std::uint32_t text_bytes;
  std::uint32_t reserved1;
};
static_assert(sizeof(LeftOutRecord) == 24 && std::is_trivially_copyable_v<LeftOutRecord>);

/// Checks everything about a record that can be checked without its sections: counts within limits,
/// consistent root kind, finite ordered root box, reserved fields zero.
Status check_scene_record(const SceneRecord& record);

}  // namespace boxtree
