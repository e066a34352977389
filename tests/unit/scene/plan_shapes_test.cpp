// SPDX-License-Identifier: MIT
// Plans of scenes with meshes that differ in their materials alone.
#include <tests/unit/scene/plan_fixture.h>

namespace boxtree::cooker {
namespace {

// Three crates of one shape, in red, blue and without a material, and a box that is no crate.
SourceScene crates() {
  SourceScene scene =
      scene_of({mesh_of("red"), mesh_of("blue"), mesh_of("box", 5), mesh_of("bare")},
               {placed("Red", 0), placed("Blue", 1, 3), placed("Box", 2), placed("Bare", 3)});
  scene.materials = {"red", "blue"};
  scene.meshes[0].materials = {{0, 0}};
  scene.meshes[1].materials = {{0, 1}};
  scene.meshes[2].materials = {{0, 0}};
  return scene;
}

TEST_F(PlanTest, MeshesThatDifferInUnwantedMaterialsAreOne) {
  const ScenePlan planned = plan(crates(), R"([scene]
materials = false
tolerance = 0.3
)");
  EXPECT_EQ(planned.meshes[1].same_as, 0u);
  EXPECT_EQ(planned.meshes[3].same_as, 0u);
  EXPECT_FALSE(planned.meshes[0].same_as || planned.meshes[2].same_as) << "the box has a face more";
  EXPECT_TRUE(planned.meshes[0].kept && planned.meshes[2].kept);
  EXPECT_FALSE(planned.meshes[1].kept || planned.meshes[3].kept);
  expect_decision(planned, Aspect::kMesh, OwnerKind::kMesh, 1, false, 2,
                  "equals mesh red but for materials that no object needs");
  // Precise enough for the largest crate, whatever its colour was.
  EXPECT_EQ(planned.meshes[0].largest_scale, 3);
  ASSERT_TRUE(planned.meshes[0].tolerance.has_value());
  EXPECT_NEAR(*planned.meshes[0].tolerance, 0.1, 1e-12);
}

TEST_F(PlanTest, MeshesOfWhichSomebodyWantsMaterialsStayApart) {
  ScenePlan planned = plan(crates(), R"([scene]
materials = false
[[object]]
name = "blue"
match = ["Blue"]
materials = true
)");
  EXPECT_FALSE(planned.meshes[1].same_as);
  EXPECT_TRUE(planned.meshes[1].kept && planned.meshes[1].materials);
  EXPECT_EQ(planned.meshes[3].same_as, 0u);
  planned = plan(crates(), "");
  for (const PlannedMesh& mesh : planned.meshes) EXPECT_TRUE(mesh.kept && !mesh.same_as);
  // What is said of a mesh is said of that one.
  planned = plan(crates(), R"([scene]
materials = false
[[mesh]]
name = "blue"
external = true
)");
  EXPECT_TRUE(planned.meshes[1].kept && planned.meshes[1].external);
  EXPECT_FALSE(planned.meshes[0].external);
}

}  // namespace
}  // namespace boxtree::cooker
