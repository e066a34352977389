// SPDX-License-Identifier: MIT
// A scene ready to be proven and written: encoded trees, their placements, facts about their faces,
// and the parts left out.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <boxtree/query.h>

#include "cooker/encode/encoded_tree.h"
#include "cooker/encode/materials.h"
#include "cooker/encode/top_level.h"
#include "format/scene_record.h"

namespace boxtree::cooker {

/// One instance, in the order of the source.
struct PlacedTree {
  std::uint32_t tree = 0;
  std::uint32_t id = 0;
  std::uint32_t layer = 0;
  bool moves = false;
  std::string name;  // empty when names are left out
  Pose pose = Pose::Identity();
  std::optional<std::uint32_t> edge_list;  // of SceneParts, of one at rest
  std::uint32_t line = 0;                  // of SceneParts::profile that places it; 0: none does
};

struct SceneLayer {
  std::string name;
  std::uint32_t collides_with = ~0u;  // layers; symmetric
  QueryKinds queries = kAllQueries;
};

struct LeftOutPart {
  Part part{};
  std::uint32_t owner = 0xffffffffu;  // tree, or the whole scene
  std::uint32_t line = 0;
  std::string text;
};

struct SceneParts {
  std::string profile;  // for messages; empty: none
  QueryKinds queries = kAllQueries;
  std::vector<PlacedTree> instances;
  std::vector<SceneLayer> layers;
  std::vector<std::string> materials;
  std::vector<FaceNumbers> tree_materials;  // one per tree, or empty
  std::vector<LeftOutPart> left_out;
  /// Edges that are not active where an instance is placed: entries of ListedEdges, ascending.
  std::vector<std::vector<std::uint32_t>> edge_lists;
};

/// The sections of a scene. Names are in the section that all names of a file share.
struct EncodedScene {
  std::vector<std::byte> scene;  // SceneRecord
  std::vector<std::byte> nodes;
  std::vector<std::byte> instances;
  std::vector<std::byte> poses;
  std::vector<std::byte> layers;
  std::vector<std::byte> left_out;
  EncodedMaterials materials;
  std::vector<std::byte> instance_edges;  // empty if no instance has a list
};

/// Builds the top level and lays out the sections; appends names to `names`. Instances are ordered
/// as leaves of the top level, then the moving ones by id. Poses are stored as f32 if that changes
/// no number. Deterministic. Errors: kInvalidPose with the instance; kMeshTooLarge for names of
/// more than 4 GiB, more than kMaxInstances or lists of 2^32 faces with edges. Precondition: trees
/// have faces; trees, layers and materials that are referred to exist.
Result<EncodedScene> encode_scene(std::span<const EncodedTree> trees, const SceneParts& parts,
                                  std::string& names);

}  // namespace boxtree::cooker
