// SPDX-License-Identifier: MIT
// Plans of small scenes: what is kept, what is dropped, and the line that says so.
#include <tests/unit/scene/plan_fixture.h>

#include <Eigen/Geometry>

namespace boxtree::cooker {
namespace {

// Ground and two trees, a hero, and a mesh that nobody places.
SourceScene forest() {
  SourceScene scene = scene_of(
      {mesh_of("ground"), mesh_of("tree"), mesh_of("hero"), mesh_of("unused")},
      {placed("Ground", 0), placed("Tree_1", 1), placed("Tree_2", 1, 2), placed("Hero", 2)});
  scene.materials = {"bark"};
  scene.meshes[1].materials = {{0, 0}};
  return scene;
}

constexpr QueryKinds kRayAndBox = kRayQueries | kBoxQueries;

TEST_F(PlanTest, WithoutAProfileEverythingStaysAndNothingMoves) {
  const auto plan = plan_scene(forest());
  ASSERT_TRUE(plan.ok());
  ASSERT_EQ(plan->layers.size(), 1u);
  EXPECT_EQ(plan->layers[0].name, "other");
  EXPECT_EQ(plan->layers[0].queries, kAllQueries);
  EXPECT_FALSE(plan->layers[0].moves);
  EXPECT_EQ(plan->layers[0].collides_with, 1u) << "what is moved after all meets the rest";
  EXPECT_EQ(plan->queries, kAllQueries);
  for (const PlannedInstance& instance : plan->instances) {
    EXPECT_TRUE(instance.kept && instance.names);
    EXPECT_FALSE(instance.moves);
    EXPECT_EQ(instance.layer, 0u);
  }
  ASSERT_EQ(plan->meshes.size(), 4u);
  for (std::size_t mesh = 0; mesh < 3; ++mesh) {
    const PlannedMesh& planned = plan->meshes[mesh];
    EXPECT_TRUE(planned.kept && planned.face_ids && planned.names);
    EXPECT_EQ(planned.materials, mesh == 1) << "only where the source has some";
    EXPECT_FALSE(planned.external || planned.exact || planned.codec || planned.tolerance);
    EXPECT_TRUE(planned.default_precision);
    EXPECT_EQ(planned.goal, Goal::kBalance);
    EXPECT_EQ(planned.queries, kAllQueries);
    EXPECT_TRUE(planned.hidden_faces.empty());
  }
  EXPECT_TRUE(plan->material_names);
  EXPECT_TRUE(plan->notices.empty());
  EXPECT_FALSE(plan->meshes[3].kept);
  expect_decision(*plan, Aspect::kMesh, OwnerKind::kMesh, 3, false, 0, "it has no instances");
  for (const Decision& one : plan->decisions) {
    EXPECT_EQ(one.line, 0u);
    const bool is_unused_mesh = one.aspect == Aspect::kMesh && one.owner == 3;
    EXPECT_EQ(one.kept, one.aspect != Aspect::kContacts && !is_unused_mesh) << one.reason;
  }
}

TEST_F(PlanTest, AnEmptySceneHasALayer) {
  const auto plan = plan_scene(SourceScene());
  ASSERT_TRUE(plan.ok());
  EXPECT_EQ(plan->layers.size(), 1u);
  EXPECT_EQ(plan->queries, kAllQueries);
}

TEST_F(PlanTest, TheFirstMatchDecides) {
  const ScenePlan planned = plan(forest(), R"([[object]]
name = "big"
match = ["Tree_2"]
[[object]]
name = "trees"
match = ["tree"]
[[object]]
name = "nothing"
match = ["Rock*"]
[[object]]
name = "hero"
match = ["H*"]
motion = "moving"
[[object]]
name = "unreached"
match = ["Tree*"]
)");
  const auto object = [&](std::size_t i) { return planned.instances[i].object; };
  EXPECT_EQ(object(0), 5u) << "other";
  EXPECT_EQ(object(1), 1u) << "by the name of its mesh";
  EXPECT_EQ(object(2), 0u);
  EXPECT_EQ(object(3), 3u);
  EXPECT_TRUE(planned.instances[3].moves);
  ASSERT_EQ(planned.layers.size(), 6u) << "objects without instances may get some later";
  EXPECT_EQ(planned.layers[5].name, "other");
  EXPECT_EQ(planned.instances[0].layer, 5u);
  ASSERT_EQ(planned.notices.size(), 2u);
  EXPECT_EQ(planned.notices[0],
            "scene.toml:9: match = [\"Rock*\"]: no instance is of object \"nothing\"; expected "
            "Ground, Hero, Tree_1, Tree_2, ground, hero, tree or unused");
  expect_decision(planned, Aspect::kInstances, OwnerKind::kObject, 3, true, 11, "1 moving");
}

TEST_F(PlanTest, AnObjectWithoutInstancesIsToldTheNearestName) {
  const ScenePlan planned = plan(scene_of({mesh_of("crate")}, {placed("Gate A", 0)}), R"(
[[object]]
name = "gates"
match = ["gate *"]
)");
  ASSERT_EQ(planned.notices.size(), 1u);
  EXPECT_EQ(planned.notices[0],
            "scene.toml:4: match = [\"gate *\"]: no instance is of object \"gates\"; did you mean "
            "'Gate A'?");
}

// Found by a newcomer: it was told to mean the name that it matches.
TEST_F(PlanTest, AnObjectWhoseInstancesAreOfAnEarlierOneIsToldThat) {
  const ScenePlan planned = plan(scene_of({mesh_of("crate")}, {placed("own 1", 0)}), R"(
[[object]]
name = "props"
match = ["own*"]
[[object]]
name = "decor"
match = ["other", "own*"]
)");
  ASSERT_EQ(planned.notices.size(), 1u);
  EXPECT_EQ(planned.notices[0],
            "scene.toml:7: match = [\"other\", \"own*\"]: no instance is of object \"decor\": it "
            "matches \"own 1\", which is of \"props\", an object that comes first");
}

TEST_F(PlanTest, AListedInstanceMayNameItsObject) {
  const ScenePlan planned =
      plan(scene_of({mesh_of("crate")}, {placed("a", 0), placed("b", 0), placed("c", 0)}),
           R"([[mesh]]
name = "crate"
file = "crate.obj"
[[object]]
name = "all"
match = ["*"]
[[object]]
name = "loose"
motion = "moving"
[[instance]]
mesh = "crate"
[[instance]]
mesh = "crate"
object = "loose"
[[instance]]
mesh = "crate"
object = "other"
)");
  EXPECT_EQ(planned.instances[0].object, 0u);
  EXPECT_EQ(planned.instances[1].object, 1u);
  EXPECT_EQ(planned.instances[2].object, 2u);
}

TEST_F(PlanTest, CollidesWithIsSymmetricAndLeavesOutWhatNeverCollides) {
  const ScenePlan planned = plan(forest(), R"([[object]]
name = "hero"
match = ["Hero"]
motion = "moving"
[[object]]
name = "trees"
match = ["Tree*"]
[[object]]
name = "ghost"
motion = "moving"
never_collides_with = ["trees", "ghost"]
[[object]]
name = "seen"
motion = "moving"
queries = ["ray"]
)");
  ASSERT_EQ(planned.layers.size(), 5u);
  const std::uint32_t hero = 1, trees = 2, ghost = 4, other = 16;
  EXPECT_EQ(planned.layers[0].collides_with, hero | trees | ghost | other);
  EXPECT_EQ(planned.layers[1].collides_with, hero | trees | other);
  EXPECT_EQ(planned.layers[2].collides_with, hero | other);
  EXPECT_EQ(planned.layers[3].collides_with, 0u) << "answers no pairs";
  EXPECT_EQ(planned.layers[4].collides_with, hero | trees | ghost | other);
  for (std::size_t a = 0; a < 5; ++a) {
    for (std::size_t b = 0; b < 5; ++b) {
      EXPECT_EQ(planned.layers[a].collides_with >> b & 1, planned.layers[b].collides_with >> a & 1);
    }
  }
  EXPECT_EQ(std::count_if(planned.decisions.begin(), planned.decisions.end(),
                          [](const Decision& one) {
                            return one.aspect == Aspect::kContacts && one.line == 11;
                          }),
            2);
}

TEST_F(PlanTest, WhatIsLeftOutTakesItsMeshAlong) {
  const ScenePlan planned = plan(forest(), R"([[object]]
name = "trees"
match = ["Tree*"]
leave_out = true
)");
  EXPECT_TRUE(planned.instances[0].kept);
  EXPECT_FALSE(planned.instances[1].kept || planned.instances[2].kept);
  EXPECT_FALSE(planned.meshes[1].kept);
  EXPECT_FALSE(planned.material_names) << "they were the tree's";
  ASSERT_EQ(planned.layers.size(), 1u);
  expect_decision(planned, Aspect::kInstances, OwnerKind::kObject, 0, false, 4,
                  "2 static: left out");
  expect_decision(planned, Aspect::kMesh, OwnerKind::kMesh, 1, false, 4,
                  "none of its instances is kept");
  EXPECT_FALSE(has_decision(planned, Aspect::kFaceIds, OwnerKind::kMesh, 1));
}

// Found by a newcomer: a pattern that leaves out everything made an empty scene without a word.
TEST_F(PlanTest, ASceneOfWhichNothingIsKeptIsNoticed) {
  const ScenePlan planned =
      plan(forest(), "[[object]]\nname = 'all'\nmatch = ['*']\nleave_out = true\n");
  EXPECT_EQ(
      planned.notices,
      std::vector<std::string>{"scene.toml:4: leave_out = true: no instance of the scene is kept"});
}

TEST_F(PlanTest, WhatAnswersNoQueryIsDropped) {
  const ScenePlan planned = plan(forest(), R"([[object]]
name = "backdrop"
match = ["Ground"]
queries = []
[[object]]
name = "trees"
match = ["Tree_1"]
queries = ["pair"]
never_collides_with = ["other"]
)");
  EXPECT_FALSE(planned.instances[0].kept);
  EXPECT_FALSE(planned.meshes[0].kept);
  expect_decision(planned, Aspect::kInstances, OwnerKind::kObject, 0, false, 4,
                  "1 static: no query reaches them");
  EXPECT_TRUE(planned.instances[1].kept) << "a tree of another file may meet it";
}

TEST_F(PlanTest, AMeshStaysWhileOneInstanceDoes) {
  const ScenePlan planned = plan(forest(), R"([[object]]
name = "far"
match = ["Tree_2"]
leave_out = true
)");
  EXPECT_TRUE(planned.meshes[1].kept);
  EXPECT_EQ(planned.meshes[1].largest_scale, 1) << "of the instances that are kept";
}

TEST_F(PlanTest, QueriesOfTheSceneAndOfObjects) {
  const ScenePlan planned = plan(forest(), R"([scene]
queries = ["ray", "box", "point"]
[[object]]
name = "trees"
match = ["Tree*"]
queries = ["ray"]
[[object]]
name = "rest"
match = ["*"]
queries = ["ray", "box"]
)");
  EXPECT_EQ(planned.queries, kRayAndBox);
  EXPECT_EQ(planned.layers[0].queries, kRayQueries);
  EXPECT_EQ(planned.layers[1].queries, kRayAndBox);
  EXPECT_EQ(planned.meshes[0].queries, kRayAndBox);
  EXPECT_EQ(planned.meshes[1].queries, kRayQueries);
  const auto file = OwnerKind::kFile;
  expect_decision(planned, Aspect::kRay, file, 0, true, 2, "requested");
  expect_decision(planned, Aspect::kPair, file, 0, false, 2, "the scene never answers them");
  expect_decision(planned, Aspect::kPoint, file, 0, false, 10, "no object answers them");
  expect_decision(planned, Aspect::kBox, OwnerKind::kObject, 0, false, 6,
                  "its instances do not answer them");
  expect_decision(planned, Aspect::kBox, OwnerKind::kMesh, 1, false, 6,
                  "no object that uses it answers them");
  EXPECT_FALSE(has_decision(planned, Aspect::kPoint, OwnerKind::kMesh, 1)) << "said of the file";
  EXPECT_FALSE(has_decision(planned, Aspect::kBox, OwnerKind::kMesh, 0));
}

TEST_F(PlanTest, PartsAreKeptIfAnyObjectNeedsThem) {
  const ScenePlan planned = plan(forest(), R"([scene]
face_ids = false
materials = false
names = false
[[object]]
name = "near"
match = ["Tree_1"]
face_ids = true
materials = true
)");
  EXPECT_TRUE(planned.meshes[1].face_ids && planned.meshes[1].materials);
  EXPECT_FALSE(planned.meshes[0].face_ids || planned.meshes[1].names);
  EXPECT_FALSE(planned.material_names) << "materials are numbers where no object needs names";
  for (const PlannedInstance& instance : planned.instances) EXPECT_FALSE(instance.names);
  expect_decision(planned, Aspect::kFaceIds, OwnerKind::kMesh, 1, true, 8,
                  "object \"near\" needs them");
  expect_decision(planned, Aspect::kFaceIds, OwnerKind::kMesh, 0, false, 2,
                  "no object that uses it needs them");
  expect_decision(planned, Aspect::kMaterials, OwnerKind::kMesh, 1, true, 9,
                  "object \"near\" needs them");
  EXPECT_FALSE(has_decision(planned, Aspect::kMaterials, OwnerKind::kMesh, 0)) << "it has none";
  expect_decision(planned, Aspect::kNames, OwnerKind::kFile, 0, false, 4, "no object needs them");
}

TEST_F(PlanTest, NamesOfSomeObjects) {
  const ScenePlan planned = plan(forest(), R"([[object]]
name = "trees"
match = ["Tree*"]
names = false
)");
  EXPECT_TRUE(planned.instances[0].names);
  EXPECT_FALSE(planned.instances[1].names || planned.meshes[1].names || planned.material_names);
  EXPECT_TRUE(planned.meshes[0].names);
  expect_decision(planned, Aspect::kNames, OwnerKind::kObject, 0, false, 4,
                  "no object needs names of its instances");
  EXPECT_FALSE(has_decision(planned, Aspect::kNames, OwnerKind::kFile, 0));
}

TEST_F(PlanTest, PartsOfReaders) {
  EXPECT_EQ(part_of(Aspect::kFaceIds), Part::kFaceIds);
  EXPECT_EQ(part_of(Aspect::kMaterials), Part::kMaterials);
  EXPECT_EQ(part_of(Aspect::kNames), Part::kNames);
  EXPECT_EQ(part_name(part_of(Aspect::kRay).value()), aspect_name(Aspect::kRay));
  EXPECT_EQ(part_name(part_of(Aspect::kBox).value()), aspect_name(Aspect::kBox));
  EXPECT_EQ(part_name(part_of(Aspect::kPoint).value()), aspect_name(Aspect::kPoint));
  EXPECT_EQ(part_name(part_of(Aspect::kPair).value()), aspect_name(Aspect::kPair));
  EXPECT_FALSE(part_of(Aspect::kGeometry) || part_of(Aspect::kCodec) || part_of(Aspect::kMesh));
}

TEST_F(PlanTest, TheMostDemandingObjectChoosesTheCodec) {
  // Two objects share the tree; the expectation names who wins.
  const auto codec_of = [&](const std::string& first, const std::string& second) {
    const ScenePlan planned =
        plan(forest(), "[[object]]\nname = 'a'\nmatch = ['Tree_1']\n" + first +
                           "\n[[object]]\nname = 'b'\nmatch = ['Tree_2']\n" + second + "\n");
    const PlannedMesh& mesh = planned.meshes[1];
    const Decision& why = decision(planned, Aspect::kCodec, OwnerKind::kMesh, 1);
    EXPECT_TRUE(why.line == 0 || why.line == 4 || why.line == 8) << why.line;
    const std::string name(mesh.codec ? codec_name(*mesh.codec) : goal_name(mesh.goal));
    EXPECT_EQ(why.reason.rfind(name + " for object", 0), 0u) << why.reason;
    return name;
  };
  EXPECT_EQ(codec_of("codec = 'wide4'", "codec = 'wide8'"), "wide8");
  EXPECT_EQ(codec_of("codec = 'wide8'", "codec = 'wide4'"), "wide8");
  EXPECT_EQ(codec_of("codec = 'packed-f16'", "codec = 'wide4'"), "wide4");
  EXPECT_EQ(codec_of("codec = 'plain-f32'", "codec = 'packed-f32'"), "plain-f32");
  EXPECT_EQ(codec_of("codec = 'wide4'", "# says nothing"), "wide4");
  EXPECT_EQ(codec_of("for = 'memory'", "# says nothing"), "memory");
  EXPECT_EQ(codec_of("for = 'memory'", "for = 'speed'"), "speed");
  EXPECT_EQ(codec_of("for = 'memory'", "for = 'balance'"), "balance");
  EXPECT_EQ(codec_of("for = 'balance'", "codec = 'wide8'"), "wide8");
  EXPECT_EQ(codec_of("for = 'balance'", "codec = 'wide4'"), "balance");
  EXPECT_EQ(codec_of("for = 'speed'", "codec = 'wide8'"), "speed");
  EXPECT_EQ(codec_of("for = 'memory'", "codec = 'dedup'"), "dedup");
  EXPECT_EQ(codec_of("# neither", "# says anything"), "balance");
}

TEST_F(PlanTest, ToleranceOverLargestScale) {
  const ScenePlan planned = plan(forest(), "[scene]\ntolerance = 0.01\n");
  EXPECT_EQ(planned.meshes[0].tolerance, 0.01);
  EXPECT_EQ(planned.meshes[1].tolerance, 0.005) << "an instance is twice as large";
  EXPECT_EQ(planned.meshes[1].largest_scale, 2);
  EXPECT_FALSE(planned.meshes[1].default_precision);
  expect_decision(planned, Aspect::kPrecision, OwnerKind::kMesh, 1, false, 2,
                  "tolerance: at most 0.01 off in the world, 0.005 in the mesh at scale 2");
}

TEST_F(PlanTest, EachObjectsToleranceOverItsOwnScale) {
  const ScenePlan planned = plan(forest(), R"([[object]]
name = "near"
match = ["Tree_1"]
tolerance = 0.001
[[object]]
name = "far"
match = ["Tree_2"]
tolerance = 0.1
largest_scale = 400
)");
  EXPECT_EQ(planned.meshes[1].tolerance, 0.00025) << "0.1 at scale 400";
  EXPECT_EQ(planned.meshes[1].largest_scale, 400);
  expect_decision(planned, Aspect::kPrecision, OwnerKind::kMesh, 1, false, 8,
                  "tolerance: at most 0.1 off in the world, 0.00025 in the mesh at scale 400");
  EXPECT_FALSE(planned.meshes[0].tolerance);
}

TEST_F(PlanTest, ToleranceHoldsUnderShear) {
  SourceScene scene = scene_of({mesh_of("m")}, {placed("a", 0)});
  scene.instances[0].pose.linear() << 1, 1, 0, 0, 1, 0, 0, 0, -1;
  const ScenePlan planned = plan(scene, "[scene]\ntolerance = 1\n");
  // The largest singular value of this shear is the golden ratio.
  ASSERT_TRUE(planned.meshes[0].tolerance);
  EXPECT_LE(*planned.meshes[0].tolerance, 0.6180339887498949);
  EXPECT_GE(*planned.meshes[0].tolerance, 0.6179);
}

TEST_F(PlanTest, WhoStatesNoToleranceGetsNoCoarserThanByDefault) {
  const ScenePlan planned = plan(forest(), R"([[object]]
name = "far"
match = ["Tree_2"]
tolerance = 0.5
)");
  EXPECT_EQ(planned.meshes[1].tolerance, 0.25);
  EXPECT_TRUE(planned.meshes[1].default_precision);
}

TEST_F(PlanTest, ExactForOneIsExactForAll) {
  const ScenePlan planned = plan(forest(), R"([scene]
tolerance = 0.01
[[object]]
name = "near"
match = ["Tree_1"]
exact = true
)");
  EXPECT_TRUE(planned.meshes[1].exact);
  EXPECT_FALSE(planned.meshes[0].exact);
  expect_decision(planned, Aspect::kPrecision, OwnerKind::kMesh, 1, true, 6,
                  "exact for object \"near\"");
}

// sqrt(2 * 1 * 9.81 * 0.001 / 1e6) = 1.4007141e-4.
TEST_F(PlanTest, StiffContactTightensTolerance) {
  const ScenePlan planned = plan(forest(), R"([scene]
tolerance = 0.01
[contact]
stiffness = 1e6
mass = 1
[[object]]
name = "seen"
match = ["Ground"]
queries = ["ray"]
[[object]]
name = "wheels"
match = ["Hero"]
queries = ["ray"]
stiffness = 1e8
)");
  EXPECT_NEAR(planned.meshes[1].tolerance.value_or(0), 1.400714104e-4 / 2, 1e-13);
  EXPECT_EQ(planned.meshes[0].tolerance, 0.01) << "rays make no contact";
  EXPECT_NEAR(planned.meshes[2].tolerance.value_or(0), 1.400714104e-5, 1e-13)
      << "unless it says so itself";
  expect_decision(planned, Aspect::kPrecision, OwnerKind::kMesh, 1, false, 4,
                  "stiff contact: at most 0.00014 off in the world, 7e-05 in the mesh at scale 2");
  EXPECT_EQ(decision(planned, Aspect::kPrecision, OwnerKind::kMesh, 2).line, 14u);
}

TEST_F(PlanTest, SoftContactLeavesToleranceAlone) {
  const ScenePlan planned = plan(forest(), R"([scene]
tolerance = 1e-6
[contact]
stiffness = 1000
mass = 80
invisible = true
)");
  EXPECT_EQ(planned.meshes[0].tolerance, 1e-6) << "0.1 m g / k is 0.078";
}

TEST_F(PlanTest, InvisibleContactWithoutTolerance) {
  const ScenePlan planned = plan(forest(), R"([contact]
stiffness = 1e6
mass = 1
invisible = true
)");
  EXPECT_NEAR(planned.meshes[0].tolerance.value_or(0), 9.81e-7, 1e-20);
  EXPECT_TRUE(planned.meshes[0].default_precision);
}

TEST_F(PlanTest, RefusesAToleranceThatF32HasExceeded) {
  SourceScene scene = forest();
  scene.meshes[1].mesh.moved_by_f32 = 0.006;
  const auto refused = [&](std::string_view text) {
    const Result<ScenePlan> plan = plan_scene(scene, load(text));
    EXPECT_EQ(plan.code(), Errc::kMeshUnsupported) << text;
    return plan.ok() ? std::string() : plan.error().detail;
  };
  EXPECT_TRUE(refused("[scene]\ntolerance = 0.01\n")
                  .ends_with("scene.toml:2: tolerance: at most 0.01 off in the world, 0.005 in the "
                             "mesh at scale 2; f32 moves a vertex of mesh \"tree\" by up to 0.006, "
                             "farther than that; cook --f64 keeps all digits"));
  EXPECT_TRUE(refused("[contact]\nstiffness = 1e6\nmass = 1\n").find("toml:2: stiff contact: ") !=
              std::string::npos);
  scene.meshes[1].mesh.f32_loss = F32Loss::kReader;
  EXPECT_NE(refused("[scene]\ntolerance = 0.01\n").find("than that; its reader has f32 alone"),
            std::string::npos);
  plan(scene, "[scene]\ntolerance = 0.012\n");
  plan(scene, "[scene]\nexact = true\n");
  plan(scene, "[scene]\ntolerance = 0.01\nexternal = true\n");
}

TEST_F(PlanTest, ExternalOnlyIfNobodyWantsTheGeometry) {
  const ScenePlan planned = plan(forest(), R"([scene]
face_ids = false
external = true
[[object]]
name = "big"
match = ["Tree_2"]
external = false
)");
  EXPECT_TRUE(planned.meshes[0].external);
  EXPECT_TRUE(planned.meshes[0].face_ids) << "they lead into the arrays of the application";
  EXPECT_FALSE(planned.meshes[1].external);
  EXPECT_FALSE(planned.meshes[1].face_ids);
  expect_decision(planned, Aspect::kGeometry, OwnerKind::kMesh, 0, false, 3,
                  "the application has these arrays");
  expect_decision(planned, Aspect::kGeometry, OwnerKind::kMesh, 1, true, 7,
                  "object \"big\" needs it here");
  expect_decision(planned, Aspect::kFaceIds, OwnerKind::kMesh, 0, true, 3,
                  "they lead into the application's arrays");
}

TEST_F(PlanTest, WhatIsSaidOfAMeshComesFirst) {
  const ScenePlan planned = plan(forest(), R"([scene]
external = true
[[mesh]]
name = "tree"
external = false
[[mesh]]
name = "unused"
external = true
spawned_as = "shots"
[[object]]
name = "shots"
motion = "moving"
tolerance = 0.5
largest_scale = 4
)");
  EXPECT_FALSE(planned.meshes[1].external);
  EXPECT_TRUE(planned.meshes[0].external && planned.meshes[3].external);
  EXPECT_TRUE(planned.meshes[3].kept) << "placed by the program";
  EXPECT_EQ(planned.meshes[3].tolerance, 0.125);
  EXPECT_EQ(planned.meshes[3].largest_scale, 4);
  expect_decision(planned, Aspect::kMesh, OwnerKind::kMesh, 3, true, 9,
                  "the program places bodies of it");
}

TEST_F(PlanTest, WhatDoesNotApplyToBodiesOfTheProgramIsTold) {
  const std::string shots = R"([[object]]
name = "shots"
never_collides_with = ["other"]
[[mesh]]
name = "m"
spawned_as = "shots"
)";
  const ScenePlan planned = plan(scene_of({mesh_of("m")}, {}), shots);
  ASSERT_EQ(planned.notices.size(), 1u);
  EXPECT_EQ(planned.notices[0],
            "scene.toml:3: never_collides_with = [\"other\"]: object \"shots\" has no instances, "
            "and bodies that a "
            "program places have no layer: it leaves layers out of the mask that overlap_pairs() "
            "takes");
  const ScenePlan placing = plan(scene_of({mesh_of("m")}, {placed("s", 0)}),
                                 "[[object]]\nname = 'all'\nmatch = ['*']\n" + shots);
  EXPECT_EQ(placing.notices.size(), 1u) << "instances of another object do not count";
}

TEST_F(PlanTest, SpawnedAsOtherKeepsThatLayer) {
  const ScenePlan planned = plan(scene_of({mesh_of("m")}, {}), R"([[object]]
name = "a"
[[mesh]]
name = "m"
spawned_as = "other"
)");
  EXPECT_EQ(planned.layers.size(), 2u);
  EXPECT_TRUE(planned.meshes[0].kept);
  EXPECT_EQ(planned.meshes[0].largest_scale, 1);
}

TEST_F(PlanTest, HiddenFacesAreCountedBySourceNumber) {
  write("list.txt", "1-2\n7\n");
  SourceScene scene = scene_of({mesh_of("m", 6)}, {placed("a", 0)});
  scene.meshes[0].mesh.face_ids = {0, 1, 1, 4, 7, 8};  // 1 was cut in two; 2 is a point
  const ScenePlan planned = plan(scene, "[[mesh]]\nname = 'm'\nhidden_faces = 'list.txt'\n");
  EXPECT_EQ(planned.meshes[0].hidden_face_count, 3u);
  ASSERT_EQ(planned.meshes[0].hidden_faces.size(), 2u);
  expect_decision(planned, Aspect::kHiddenFaces, OwnerKind::kMesh, 0, false, 3,
                  "3 of 6 faces, which the profile gives up: queries miss them");
}

TEST_F(PlanTest, HiddenFacesThatAMeshDoesNotHave) {
  write("list.txt", "4\n");
  const auto planned =
      plan_scene(forest(), load("[[mesh]]\nname = 'tree'\nhidden_faces = 'list.txt'\n"));
  ASSERT_EQ(planned.code(), Errc::kProfileInvalid);
  EXPECT_EQ(without_folder(planned.error().detail),
            "scene.toml:3: hidden_faces: expected numbers of at most 3, the last face of mesh "
            "\"tree\", found 4");
}

TEST_F(PlanTest, MeshesThatTheSourceDoesNotHave) {
  const auto planned = plan_scene(forest(), load("\n[[mesh]]\nname = 'three'\n"));
  ASSERT_EQ(planned.code(), Errc::kProfileInvalid);
  EXPECT_EQ(without_folder(planned.error().detail),
            "scene.toml:3: name: expected a mesh of the source (nearest: \"tree\"), found "
            "\"three\"");
}

TEST_F(PlanTest, AListedMeshThatEqualsAnotherIsNoticed) {
  const ScenePlan planned = plan(scene_of({mesh_of("a")}, {placed("a", 0), placed("b", 0)}),
                                 "[[mesh]]\nname = 'a'\nfile = 'a.obj'\n"
                                 "[[mesh]]\nname = 'b'\nfile = 'b.obj'\n"
                                 "[[instance]]\nmesh = 'a'\n[[instance]]\nmesh = 'b'\n");
  ASSERT_EQ(planned.notices.size(), 1u);
  EXPECT_EQ(planned.notices[0].rfind("scene.toml:5: name = 'b': mesh \"b\" equals", 0), 0u)
      << planned.notices[0];
}

}  // namespace
}  // namespace boxtree::cooker
