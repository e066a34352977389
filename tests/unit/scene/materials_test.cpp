// SPDX-License-Identifier: MIT
// Materials of faces: any number of them.
#include <string>

#include <gtest/gtest.h>

#include "cooker/proof/scene_proof.h"
#include "runtime/tree/bound_tree.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"
#include "tests/support/scenes.h"

namespace boxtree {
namespace {

TEST(Materials, NumbersOfFacesHaveAsManyBytesAsTheyTake) {
  for (const std::uint32_t count : {1u, 256u, 257u, 65536u, 65537u, 70000u}) {
    const cooker::SourceMesh mesh = test::soup(5, 1);
    const std::vector<std::uint32_t> materials{count - 1, 0, count / 2, count - 1, count / 3};
    cooker::SceneParts parts;
    parts.instances.push_back({});
    for (std::uint32_t i = 0; i < count; ++i) parts.materials.push_back(std::to_string(i) + "m");
    parts.tree_materials.push_back({{}, materials});
    const test::CookedScene cooked = test::cook_scene({mesh}, parts);
    EXPECT_TRUE(cooker::prove_scene(cooked.file).empty()) << count;
    const Scene scene = test::require(Scene::bind(cooked.file, {}));
    ASSERT_EQ(scene.material_count(), count);
    for (std::uint32_t face = 0; face < mesh.faces.size(); ++face) {
      const std::uint32_t material =
          scene.material({0, {BoundTree::of(scene.trees()[0]).face_id(face), face}});
      EXPECT_EQ(material, materials[face]) << count;
      EXPECT_EQ(scene.material_name(material), parts.materials[materials[face]]) << count;
    }
  }
}

}  // namespace
}  // namespace boxtree
