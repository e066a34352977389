// SPDX-License-Identifier: MIT
// A scene cooked in several codecs, its poses under updates, and its triangles in the world.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <boxtree/boxtree.h>

#include "tests/oracle/exact/draw.h"
#include "tests/oracle/exact/subject.h"
#include "tests/support/scenes.h"

namespace boxtree::oracle {

/// The scene in one choice of codecs. Instances are told by their ids, as their numbers may differ.
struct SceneVariant {
  std::string name;
  test::CookedScene cooked;
  Scene scene;
  std::vector<std::uint32_t> number_of_id;
  std::vector<std::uint32_t> id_of_number;
};

/// A triangle of an instance, each corner brought into the world as FORMAT.md, section 11, states.
struct Placed {
  std::uint32_t id;
  std::uint32_t face;
  std::uint32_t half;
};

struct SceneSubject {
  std::vector<cooker::SourceMesh> meshes;
  std::vector<Group> trees;  // decoded triangles of each mesh
  std::vector<std::uint32_t> tree_of_id;
  std::vector<bool> moves;  // by id
  std::vector<Pose> poses;  // by id
  std::vector<SceneVariant> variants;
  double world_size = 1;
};

/// Nothing where the poses drawn cannot be cooked. Throws where the guarantees say that they can.
[[nodiscard]] std::unique_ptr<SceneSubject> draw_scene(Draw& draw);

/// Gives moving instances other poses, in every variant; returns how many were refused, by all.
/// Throws where one variant refuses what another takes, or what the guarantees allow.
[[nodiscard]] std::uint32_t update_some(Draw& draw, SceneSubject& subject, int count);

/// All triangles where they are now: a group in the world, whose faces are indices into `placed`.
struct World {
  std::vector<Placed> placed;
  Group group;
};
[[nodiscard]] World world_of(const SceneSubject& subject);

}  // namespace boxtree::oracle
