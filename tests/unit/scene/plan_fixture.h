// SPDX-License-Identifier: MIT
// Small scenes to plan, and what tests expect of decisions.
#pragma once

#include <algorithm>
#include <string>
#include <tests/unit/scene/profile_files.h>
#include <utility>
#include <vector>

#include "cooker/scene/plan.h"

namespace boxtree::cooker {

inline SceneMesh mesh_of(const std::string& name, std::size_t faces = 4) {
  SceneMesh mesh;
  mesh.mesh.name = name;
  mesh.mesh.positions.f32 = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  mesh.mesh.faces.assign(faces, Face{{0, 1, 2, kNoCorner}});
  return mesh;
}

inline SceneInstance placed(const std::string& name, std::uint32_t mesh, double scale = 1) {
  SceneInstance instance;
  instance.name = name;
  instance.mesh = mesh;
  instance.pose.linear() *= scale;
  return instance;
}

inline SourceScene scene_of(std::vector<SceneMesh> meshes, std::vector<SceneInstance> instances) {
  SourceScene scene;
  scene.meshes = std::move(meshes);
  scene.instances = std::move(instances);
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) scene.instances[i].id = i;
  return scene;
}

class PlanTest : public ProfileTest {
 protected:
  ScenePlan plan(const SourceScene& scene, std::string_view text) const {
    Result<ScenePlan> plan = plan_scene(scene, load(text));
    EXPECT_TRUE(plan.ok()) << plan.error().message();
    return plan.ok() ? std::move(plan).value() : ScenePlan();
  }
  static const Decision& decision(const ScenePlan& plan, Aspect aspect, OwnerKind kind,
                                  std::uint32_t owner) {
    static const Decision kNone = {.reason = "no such decision", .line = 0xffffffffu};
    const Decision* found = nullptr;
    for (const Decision& one : plan.decisions) {
      if (one.aspect != aspect || one.owner_kind != kind || one.owner != owner) continue;
      EXPECT_EQ(found, nullptr) << "two decisions: " << one.reason;
      found = &one;
    }
    EXPECT_NE(found, nullptr) << aspect_name(aspect) << " of " << owner;
    return found != nullptr ? *found : kNone;
  }
  static bool has_decision(const ScenePlan& plan, Aspect aspect, OwnerKind kind,
                           std::uint32_t owner) {
    return std::any_of(plan.decisions.begin(), plan.decisions.end(), [&](const Decision& one) {
      return one.aspect == aspect && one.owner_kind == kind && one.owner == owner;
    });
  }
  static void expect_decision(const ScenePlan& plan, Aspect aspect, OwnerKind kind,
                              std::uint32_t owner, bool kept, std::uint32_t line,
                              const std::string& reason) {
    const Decision& found = decision(plan, aspect, kind, owner);
    EXPECT_EQ(found.kept, kept) << found.reason;
    EXPECT_EQ(found.line, line) << found.reason;
    EXPECT_EQ(found.reason, reason);
  }
};

}  // namespace boxtree::cooker
