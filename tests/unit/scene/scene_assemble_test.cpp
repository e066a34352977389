// SPDX-License-Identifier: MIT
// Scenes assembled from several files: the answers of the same scene in one file, those of each
// tree by itself, and numbers that lie.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "format/scene_record.h"
#include "tests/support/cooked.h"
#include "tests/support/infinity.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"
#include "tests/support/scenes.h"

namespace boxtree {
namespace {

using test::CookedScene;
using test::CookedTree;
using test::require;

using test::kInfinity;

// The numbers of one answer, instances by their ids; compared to the bit.
using Answer = std::vector<double>;

Answer& operator<<(Answer& answer, double number) {
  answer.push_back(number);
  return answer;
}
Answer& operator<<(Answer& answer, const Eigen::Vector3d& vector) {
  return answer << vector[0] << vector[1] << vector[2];
}
Answer& operator<<(Answer& answer, const FaceRef& face) {
  return answer << face.id << face.index;
}

void complete(const Result<Visit>& visited) {
  EXPECT_EQ(require(visited), Visit::kComplete);
}

// Answers of every kind of query of one scene, sorted as far as no order is promised.
class Answers {
 public:
  explicit Answers(const Scene& scene) : scene_(scene) {}

  [[nodiscard]] const std::vector<Answer>& all() const { return answers_; }

  void ray(const Ray& ray, LayerMask layers) {
    hit(require(closest_hit(scene_, ray, layers)));
    add({double(require(any_hit(scene_, ray, layers)).has_value())});
    SceneFaceOptions options;
    options.layers = layers;
    options.back_faces = BackFaces::kIgnore;
    const auto even = [](const SceneFace& face) { return face.face.index % 2 == 0; };
    options.filter = SceneFaceFilter(even);
    hit(require(closest_hit(scene_, ray, options)));
    std::array<SceneRayHit, 5> nearest;
    const std::size_t count = require(nearest_hits(scene_, ray, nearest));
    for (std::size_t i = 0; i < count; ++i) answers_.push_back(of(nearest[i]));
    unordered([&] {
      complete(all_hits(scene_, ray, [&](const SceneRayHit& each) {
        answers_.push_back(of(each));
        return kInfinity;
      }));
    });
  }

  void point(const Eigen::Vector3d& point, double max_distance, LayerMask layers) {
    const auto found = require(closest_point(scene_, point, max_distance, layers));
    Answer answer{double(found.has_value())};
    if (found) answer << id(found->instance) << found->face << found->distance << found->point;
    answers_.push_back(answer);
  }

  void box(const Eigen::AlignedBox3d& box, LayerMask layers) {
    faces([&](auto visit) { return overlap_box(scene_, box, visit, layers); });
    faces([&](auto visit) {
      return overlap_sphere(scene_, box.center(), box.sizes().norm() / 2, visit, layers);
    });
    const std::array<Eigen::Vector3d, 8> corners = {
        box.corner(box.BottomLeftFloor), box.corner(box.BottomRightFloor),
        box.corner(box.TopRightFloor),   box.corner(box.TopLeftFloor),
        box.corner(box.BottomLeftCeil),  box.corner(box.BottomRightCeil),
        box.corner(box.TopRightCeil),    box.corner(box.TopLeftCeil)};
    const Frustum frustum = Frustum::of(corners);
    faces([&](auto visit) { return overlap_frustum(scene_, frustum, visit, layers); });
    unordered([&] {
      complete(instances_in_frustum(
          scene_, frustum,
          [&](std::uint32_t instance) {
            add({id(instance)});
            return true;
          },
          layers));
    });
  }

  template <class Shape>
  void shape(const Shape& shape, const Motion& motion, LayerMask layers) {
    SceneFaceOptions options;
    options.layers = layers;
    const auto first = require(cast_closest(scene_, shape, motion, options));
    answers_.push_back(first ? of(*first) : Answer{});
    add({double(require(cast_any(scene_, shape, motion, options)).has_value())});
    unordered([&] {
      complete(cast_all(scene_, shape, motion, [&](const SceneCastHit& each) {
        answers_.push_back(of(each));
        return kInfinity;
      }));
    });
    unordered([&] {
      complete(collide(
          scene_, shape,
          [&](const SceneContact& each) {
            Answer answer{id(each.instance)};
            answers_.push_back(answer << each.face << each.point << each.normal << each.depth);
            return true;
          },
          layers));
    });
  }

  void body(const Tree& tree, const Pose& pose, LayerMask layers) {
    pairs([&](auto visit) { return overlap_pairs(scene_, tree, pose, visit, layers); });
    touches([&](auto visit) { return pair_contacts(scene_, tree, pose, visit, layers); });
  }

  void contacts_among() {
    pairs([&](auto visit) { return contacts(scene_, visit); });
    touches([&](auto visit) { return pair_contacts(scene_, visit); });
    for (std::uint32_t each = 0; each < scene_.instance_count(); ++each) {
      const std::uint32_t instance = number(each);
      pairs([&](auto visit) { return contacts_of(scene_, instance, visit); });
      touches([&](auto visit) { return pair_contacts_of(scene_, instance, visit); });
    }
  }

  void what_is_known() {
    for (std::uint32_t each = 0; each < scene_.instance_count(); ++each) {
      const std::uint32_t instance = number(each);
      const InstanceInfo info = require(scene_.info(instance));
      const Pose pose = require(scene_.pose(instance));
      Answer answer{double(info.tree), double(info.layer), double(info.moves)};
      for (const double entry : pose.matrix().reshaped()) answer << entry;
      const SceneFace face{instance, {kNoFaceId, 3}};
      for (const Eigen::Vector3d& corner : require(scene_.triangle(face)).corner) answer << corner;
      answer << require(active_edges(scene_, face));
      answers_.push_back(answer);
      EXPECT_EQ(require(scene_.find_instance(info.name)), instance);
    }
  }

 private:
  void add(Answer answer) { answers_.push_back(std::move(answer)); }
  [[nodiscard]] double id(std::uint32_t instance) const {
    return instance == kNoInstance ? -1 : double(require(scene_.info(instance)).id);
  }
  // Of the instance with that id.
  [[nodiscard]] std::uint32_t number(std::uint32_t id) const {
    std::uint32_t instance = 0;
    while (require(scene_.info(instance)).id != id) ++instance;
    return instance;
  }
  [[nodiscard]] Answer of(const SceneRayHit& each) const {
    Answer answer{id(each.instance), each.t, each.u, each.v};
    return answer << each.face << each.point << each.normal;
  }
  [[nodiscard]] Answer of(const SceneCastHit& each) const {
    Answer answer{id(each.instance), each.t, each.t_lower, double(each.is_active)};
    return answer << each.face << each.point << each.normal;
  }
  void hit(const std::optional<SceneRayHit>& found) {
    answers_.push_back(found ? of(*found) : Answer{});
  }
  void hit(const SceneRayResult& found) { answers_.push_back(found ? of(*found) : Answer{}); }

  template <class Run>
  void unordered(const Run& run) {
    const auto first = static_cast<std::ptrdiff_t>(answers_.size());
    run();
    std::sort(answers_.begin() + first, answers_.end());
    add({double(answers_.size())});  // ends the list
  }
  template <class Query>
  void faces(const Query& query) {
    unordered([&] {
      complete(query([&](const SceneFace& face) {
        Answer answer{id(face.instance)};
        answers_.push_back(answer << face.face);
        return true;
      }));
    });
  }
  template <class Query>
  void pairs(const Query& query) {
    unordered([&] {
      complete(query([&](const ScenePair& pair) {
        Answer answer{id(pair.first.instance), id(pair.second.instance)};
        answers_.push_back(answer << pair.first.face << pair.second.face);
        return true;
      }));
    });
  }
  template <class Query>
  void touches(const Query& query) {
    unordered([&] {
      complete(query([&](const ScenePairContact& each) {
        Answer answer{id(each.first_instance), id(each.second_instance)};
        answers_.push_back(answer << each.faces.first << each.faces.second << each.point
                                  << each.normal << each.depth);
        return true;
      }));
    });
  }

  const Scene& scene_;
  std::vector<Answer> answers_;
};

// Files of one tree each, and instances of them: those of `parts`.
struct Tiles {
  std::vector<CookedTree> files;
  std::vector<Tree> trees;
  std::vector<PlacedTree> instances;
  std::vector<SceneLayer> layers;

  Tiles(const std::vector<cooker::SourceMesh>& meshes, const cooker::SceneParts& parts,
        CodecId codec, const cooker::CookOptions& options = {}) {
    for (const cooker::SourceMesh& mesh : meshes) {
      files.push_back(test::cook_tree(mesh, codec, options));
      trees.push_back(files.back().tree);
    }
    for (const cooker::PlacedTree& placed : parts.instances) {
      instances.push_back(
          {placed.tree, placed.pose, placed.layer, placed.moves, placed.id * 7, placed.name});
    }
    for (const cooker::SceneLayer& layer : parts.layers) {
      layers.push_back({layer.name, layer.collides_with, layer.queries});
    }
  }

  [[nodiscard]] Scene scene() const { return require(Scene::assemble(trees, instances, layers)); }
};

class SceneAssemble : public testing::TestWithParam<CodecId> {
 protected:
  SceneAssemble()
      : meshes_{test::sphere(8, 12), test::torus(10, 14), test::terrain(6, 1), test::soup(40, 3)},
        parts_(parts()),
        cooked_(test::cook_scene(meshes_, parts_, {GetParam()})),
        tiles_(meshes_, parts_, GetParam()),
        whole_(require(Scene::bind(cooked_.file))),
        assembled_(tiles_.scene()) {}

  static cooker::SceneParts parts() {
    cooker::SceneParts parts = test::random_parts(30, 4, 5, 3, 11);
    // Layer 0 and layer 2 do not collide; layer 1 answers no rays.
    parts.layers[0].collides_with = ~4u;
    parts.layers[2].collides_with = ~1u;
    parts.layers[1].queries = kAllQueries & ~kRayQueries;
    return parts;
  }

  double unit() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
  Eigen::Vector3d vector() { return {unit(), unit(), unit()}; }

  // The same random queries on both.
  void compare() {
    Answers whole(whole_), assembled(assembled_);
    for (Answers* const answers : {&whole, &assembled}) {
      random_.seed(7);
      answers->what_is_known();
      for (int i = 0; i < 25; ++i) {
        const LayerMask layers = i % 4 == 0 ? kAllLayers : static_cast<LayerMask>(i % 8);
        answers->ray({6 * vector(), vector()}, layers);
        answers->point(5 * vector(), i % 2 == 0 ? kInfinity : 1, layers);
        const Eigen::Vector3d centre = 5 * vector(), half = vector().cwiseAbs();
        answers->box({centre - half, centre + half}, layers);
        const Motion motion{vector(), 5};
        answers->shape(Sphere{centre, 0.3}, motion, layers);
        answers->shape(Capsule{centre, centre + half, 0.2}, motion, layers);
        answers->shape(OrientedBox{centre, half}, motion, layers);
        const std::array<Eigen::Vector3d, 5> points = {vector(), vector(), vector(), vector(),
                                                       vector()};
        answers->shape(ConvexHull{points, centre}, motion, layers);
        answers->body(tiles_.trees[static_cast<std::size_t>(i) % 4],
                      test::random_pose(random_, 4, i % 2 == 0), layers);
      }
      answers->contacts_among();
    }
    ASSERT_EQ(whole.all().size(), assembled.all().size());
    for (std::size_t i = 0; i < whole.all().size(); ++i) {
      ASSERT_EQ(whole.all()[i], assembled.all()[i]) << i;
    }
    EXPECT_GT(whole.all().size(), 5000u);
  }

  // The number, in the file, of the instance that is `instance` in the assembled scene.
  std::uint32_t in_file(std::uint32_t instance) const {
    return require(whole_.find_instance(require(assembled_.info(instance)).name));
  }

  std::mt19937_64 random_{5};
  std::vector<cooker::SourceMesh> meshes_;
  cooker::SceneParts parts_;
  CookedScene cooked_;
  Tiles tiles_;
  Scene whole_, assembled_;
};

TEST_P(SceneAssemble, AnswersAsTheSameSceneInOneFile) {
  compare();
}

TEST_P(SceneAssemble, AnswersAsOneFileAfterInstancesMoved) {
  for (std::uint32_t i = 0; i < assembled_.instance_count(); i += 5) {
    ASSERT_TRUE(require(assembled_.info(i)).moves);
    const Pose pose = test::random_pose(random_, 4, true);
    ASSERT_TRUE(assembled_.update(i, pose).ok());
    ASSERT_TRUE(whole_.update(in_file(i), pose).ok());
  }
  compare();
  assembled_.rebuild();
  compare();
}

// A static one is made movable in both; others are out of every answer.
TEST_P(SceneAssemble, AnswersAsOneFileAfterOneWasMadeMovableAndSomeDisabled) {
  const Pose pose = test::random_pose(random_, 2, false);
  const Status refused = assembled_.update(3, pose);
  EXPECT_EQ(refused.error().message(),
            "instance_static: instance 3 was bound as static; make_movable() lets it move");
  for (const auto& [scene, instance] :
       {std::pair(&assembled_, 3u), std::pair(&whole_, in_file(3))}) {
    ASSERT_TRUE(scene->make_movable(instance).ok());
    EXPECT_TRUE(require(scene->info(instance)).moves);
    ASSERT_TRUE(scene->update(instance, pose).ok());
  }
  EXPECT_EQ(assembled_.make_movable(30).code(), Errc::kInstanceIndex);
  for (const std::uint32_t instance : {0u, 1u, 5u, 8u}) {
    ASSERT_TRUE(whole_.set_enabled(in_file(instance), false).ok());
    ASSERT_TRUE(assembled_.set_enabled(instance, false).ok());
    EXPECT_FALSE(assembled_.is_enabled(instance));
  }
  compare();
}

// Rays and boxes on each tree by itself, where its pose shifts without rounding.
TEST_P(SceneAssemble, AnswersAsEachTreeByItself) {
  std::vector<PlacedTree> placed;
  std::vector<Eigen::Vector3d> shifts;
  for (std::uint32_t i = 0; i < 12; ++i) {
    shifts.emplace_back(3 * (i % 4), 2.5 * (i / 4), 0.25 * i);
    placed.push_back({i % 4, Pose(Eigen::Translation3d(shifts.back()))});
  }
  const Scene scene = require(Scene::assemble(tiles_.trees, placed));
  std::size_t hits = 0, faces = 0;
  for (int i = 0; i < 200; ++i) {
    const Ray ray{Eigen::Vector3d(4, 3, 1) + 6 * vector(), vector()};
    double nearest = kInfinity;
    std::uint32_t of = kNoInstance;
    const Eigen::Vector3d centre = Eigen::Vector3d(4, 3, 1) + 6 * vector();
    const Eigen::AlignedBox3d box((16 * centre).array().round() / 16,
                                  (16 * centre).array().round() / 16 + 0.75);
    std::vector<std::array<std::uint32_t, 2>> expected, found;
    for (std::uint32_t k = 0; k < placed.size(); ++k) {
      const Tree& tree = tiles_.trees[placed[k].tree];
      const auto hit = require(closest_hit(tree, {ray.origin - shifts[k], ray.direction}));
      if (hit && hit->t < nearest) {
        nearest = hit->t;
        of = k;
      }
      complete(overlap_box(tree, {box.min() - shifts[k], box.max() - shifts[k]},
                           [&](const FaceRef& face) {
                             expected.push_back({k, face.id});
                             return true;
                           }));
    }
    const auto hit = require(closest_hit(scene, ray));
    ASSERT_EQ(hit.has_value(), of != kNoInstance);
    if (hit) {
      ++hits;
      ASSERT_EQ(hit->instance, of);
      ASSERT_NEAR(hit->t, nearest, 1e-12 * (1 + nearest));
    }
    complete(overlap_box(scene, box, [&](const SceneFace& face) {
      found.push_back({face.instance, face.face.id});
      return true;
    }));
    std::sort(expected.begin(), expected.end());
    std::sort(found.begin(), found.end());
    ASSERT_EQ(found, expected);
    faces += found.size();
  }
  EXPECT_GT(hits, 20u);
  EXPECT_GT(faces, 20u);
}

INSTANTIATE_TEST_SUITE_P(Codecs, SceneAssemble, testing::ValuesIn(test::all_codecs()),
                         test::test_name);

// One mesh in one file, and what may be wrong with an instance of it.
struct OneTree {
  CookedTree file = test::cook_tree(test::sphere(6, 8), CodecId::kWide8);
  std::vector<Tree> trees{file.tree};

  [[nodiscard]] std::string refusal(const PlacedTree& wrong) const {
    const std::vector<PlacedTree> instances{{}, {}, wrong};
    const Result<Scene> scene = Scene::assemble(trees, instances);
    return scene ? "none" : scene.error().message();
  }
};

TEST(SceneAssemble, KeepsWhatWasGiven) {
  const OneTree one;
  std::vector<PlacedTree> instances(40);
  for (std::uint32_t i = 0; i < instances.size(); ++i) {
    instances[i].pose.translation()[0] = i * 3.0;
    instances[i].layer = i % 5;
    instances[i].moves = i % 2 == 1;
  }
  std::string name = "gate";
  instances[7].name = name;
  instances[7].user_data = 77;
  std::string ground = "ground";
  const std::vector<SceneLayer> layers{{ground}, {"water"}};
  Scene scene = require(Scene::assemble(one.trees, instances, layers));
  name = "lost";  // was copied
  ground = "lost!!";
  EXPECT_EQ(scene.instance_count(), 40u);
  EXPECT_EQ(scene.trees().size(), 1u);
  EXPECT_EQ(scene.query_kinds(), kAllQueries);
  EXPECT_EQ(scene.layer_count(), 5u);
  EXPECT_EQ(scene.layer_name(0), "ground");
  EXPECT_EQ(scene.layer_name(1), "water");
  EXPECT_EQ(scene.layer_name(2), "");
  EXPECT_EQ(scene.layer_name(5), "");
  EXPECT_EQ(scene.material_count(), 0u);
  EXPECT_EQ(scene.material({7, {0, 0}}), kNoMaterial);
  EXPECT_EQ(scene.material_name(0), "");
  for (std::uint32_t i = 0; i < instances.size(); ++i) {
    const InstanceInfo info = require(scene.info(i));
    EXPECT_EQ(info.id, i);
    EXPECT_EQ(info.tree, 0u);
    EXPECT_EQ(info.layer, i % 5);
    EXPECT_EQ(info.moves, i % 2 == 1);
    EXPECT_EQ(info.name, i == 7 ? "gate" : "");
    EXPECT_EQ(scene.user_data(i), i == 7 ? 77u : 0u);
    EXPECT_EQ(require(scene.pose(i)).matrix(), instances[i].pose.matrix());
  }
  EXPECT_EQ(scene.info(40).code(), Errc::kInstanceIndex);
  EXPECT_EQ(require(scene.find_instance("gate")), 7u);

  // Taken over, with what it holds of its own.
  Scene other = std::move(scene);
  scene = require(Scene::assemble(one.trees, std::vector<PlacedTree>(2)));
  EXPECT_EQ(scene.instance_count(), 2u);
  EXPECT_EQ(require(other.find_instance("gate")), 7u);
  const auto hit = require(closest_hit(other, {{21, 0.1, 9}, {0, 0, -1}}));
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->instance, 7u);
  ASSERT_TRUE(other.update(7, Pose(Eigen::Translation3d(21, 0, -2))).ok());
  EXPECT_NEAR(require(closest_hit(other, {{21, 0.1, 9}, {0, 0, -1}}))->t, hit->t + 2, 1e-12);
}

TEST(SceneAssemble, NumbersThatLieAreRefusedByTheirInstance) {
  const OneTree one;
  PlacedTree wrong;
  EXPECT_EQ(one.refusal(wrong), "none");
  wrong.tree = 1;
  EXPECT_EQ(one.refusal(wrong), "tree_index: instance 2: there is no tree 1; expected 0");
  wrong = {};
  wrong.layer = 31;
  EXPECT_EQ(one.refusal(wrong), "none");
  wrong.layer = 32;
  EXPECT_EQ(one.refusal(wrong),
            "invalid_query: instance 2: there is no layer 32; expected 0 to 31");
  wrong = {};
  std::string name(0xffff, 'a');
  wrong.name = name;
  EXPECT_EQ(one.refusal(wrong), "none");
  name += 'a';
  wrong.name = name;
  EXPECT_EQ(one.refusal(wrong),
            "invalid_query: instance 2: a name of 65536 bytes; expected 65535 at most");
  const std::vector<SceneLayer> layers(33);
  EXPECT_EQ(Scene::assemble(one.trees, {}, layers).error().message(),
            "invalid_query: there is no layer 32; expected 0 to 31");
  EXPECT_EQ(Scene::assemble({}, std::vector<PlacedTree>(1)).error().message(),
            "tree_index: instance 0: there is no tree 0, nor any other");
}

TEST(SceneAssemble, MoreInstancesThanAFileMayHaveAreRefusedUnread) {
  const OneTree one;
  const PlacedTree first;
  const std::span<const PlacedTree> many(&first, std::size_t{kMaxInstances} + 1);
  EXPECT_EQ(Scene::assemble(one.trees, many).error().message(),
            "mesh_too_large: 268435456 instances; expected 268435455 at most");
}

// Names may be the same bytes many times: what they take in all is counted before it is allocated.
TEST(SceneAssemble, MoreBytesOfNamesThanOneGibAreRefused) {
  const OneTree one;
  const std::string name(0xffff, 'a');
  std::vector<PlacedTree> instances(16385);
  for (PlacedTree& each : instances) each.name = name;
  EXPECT_EQ(Scene::assemble(one.trees, instances).error().message(),
            "mesh_too_large: 1073790975 bytes of names; expected 1073741824 at most");
}

TEST(SceneAssemble, PosesThatAreNoneAreRefused) {
  const OneTree one;
  const std::string expected =
      "invalid_pose: instance 2: its pose is not finite, not invertible or leads beyond 2^200 or "
      "2^185 extents of the scene";
  PlacedTree wrong;
  wrong.pose.translation()[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(one.refusal(wrong), expected);
  wrong.pose.translation()[1] = kInfinity;
  EXPECT_EQ(one.refusal(wrong), expected);
  wrong.pose.translation()[1] = 0x1p201;
  EXPECT_EQ(one.refusal(wrong), expected);
  wrong.pose = Pose::Identity();
  wrong.pose.linear()(2, 2) = 0;
  EXPECT_EQ(one.refusal(wrong), expected);
  // Nor may update() give one, and then nothing has changed.
  std::vector<PlacedTree> instances(1);
  instances[0].moves = true;
  Scene scene = require(Scene::assemble(one.trees, instances));
  for (const double x : {0.0, 0x1p201}) {  // found by a newcomer: 1e300 is finite and invertible
    wrong.pose.translation()[0] = x;
    EXPECT_EQ(scene.update(0, wrong.pose).error().message(),
              "invalid_pose: instance 0: its pose is not finite, not invertible or leads beyond "
              "2^200 or 2^185 extents of the scene");
    if (x == 0) wrong.pose = Pose::Identity();
  }
  EXPECT_EQ(require(scene.pose(0)).matrix(), Pose::Identity().matrix());
}

TEST(SceneAssemble, NothingIsAScene) {
  const OneTree one;
  const auto none = [](const auto&) {
    ADD_FAILURE();
    return true;
  };
  for (const std::span<const Tree> trees : {std::span<const Tree>{}, std::span(one.trees)}) {
    Scene scene = require(Scene::assemble(trees, {}));
    EXPECT_EQ(scene.instance_count(), 0u);
    EXPECT_EQ(scene.layer_count(), 1u);
    EXPECT_EQ(scene.material_count(), 0u);
    EXPECT_EQ(scene.material_name(0), "");
    scene.rebuild();
    EXPECT_FALSE(require(closest_hit(scene, {{0, 0, 9}, {0, 0, -1}})));
    EXPECT_FALSE(require(closest_point(scene, {0, 0, 0})));
    EXPECT_FALSE(require(cast_closest(scene, Sphere{{0, 0, 9}, 1}, {{0, 0, -1}})));
    complete(overlap_sphere(scene, {0, 0, 0}, 9, none));
    complete(collide(scene, Sphere{{0, 0, 0}, 9}, none));
    complete(contacts(scene, none));
    complete(overlap_pairs(scene, one.trees[0], Pose::Identity(), none));
    EXPECT_EQ(contacts_of(scene, 0, none).code(), Errc::kInstanceIndex);
  }
}

// Of two tiles at rest that touch no contact is told, of a body that moves those with both,
// whatever the order in which they were given.
TEST(SceneAssemble, TilesAtRestHaveNoContactsWithEachOther) {
  const OneTree one;
  const auto met = [&](std::array<bool, 3> moves) {
    std::vector<PlacedTree> instances(3);
    for (std::size_t i = 0; i < 3; ++i) {
      instances[i].moves = moves[i];
      instances[i].pose.translation()[0] = 0.5 * static_cast<double>(i);  // spheres of radius 1
    }
    const Scene scene = require(Scene::assemble(one.trees, instances));
    std::vector<std::array<std::uint32_t, 2>> pairs;
    complete(contacts(scene, [&](const ScenePair& pair) {
      pairs.push_back({pair.first.instance, pair.second.instance});
      return true;
    }));
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
  };
  using Pairs = std::vector<std::array<std::uint32_t, 2>>;
  EXPECT_EQ(met({false, false, false}), Pairs{});
  EXPECT_EQ(met({true, false, false}), (Pairs{{0, 1}, {0, 2}}));
  EXPECT_EQ(met({false, true, false}), (Pairs{{1, 0}, {1, 2}}));
  EXPECT_EQ(met({false, false, true}), (Pairs{{2, 0}, {2, 1}}));
  EXPECT_EQ(met({true, false, true}), (Pairs{{0, 1}, {0, 2}, {2, 1}}));
}

// Two layers collide if each allows the other.
TEST(SceneAssemble, LayersCollideIfBothAllowIt) {
  const OneTree one;
  const auto touch = [&](const std::vector<SceneLayer>& layers) {
    std::vector<PlacedTree> instances(2);
    instances[1].layer = 1;
    instances[1].moves = true;
    const Scene scene = require(Scene::assemble(one.trees, instances, layers));
    bool met = false;
    static_cast<void>(
        require(contacts(scene, [&](const ScenePair&) { return met = true, false; })));
    return met;
  };
  EXPECT_TRUE(touch({}));
  EXPECT_TRUE(touch({{"a"}, {"b"}}));
  EXPECT_FALSE(touch({{"a", 1}, {"b"}}));
  EXPECT_FALSE(touch({{"a"}, {"b", 2}}));
  EXPECT_FALSE(touch({{"a", 1}}));
  EXPECT_FALSE(touch({{"a", kAllLayers, kAllQueries & ~kPairQueries}}));
}

// Materials of one file are numbered once, those of the next one after them.
TEST(SceneAssemble, MaterialsAreNumberedFileAfterFile) {
  const auto file_of = [](const std::vector<std::string>& names, std::uint32_t trees) {
    cooker::SceneParts parts = test::random_parts(2, trees, 0, 1, 1);
    parts.materials = names;
    parts.tree_materials.resize(trees);
    for (std::uint32_t tree = 0; tree < trees && !names.empty(); ++tree) {
      parts.tree_materials[tree].runs = {{0, static_cast<std::uint32_t>(names.size()) - 1}, {5, 0}};
    }
    return test::cook_scene(std::vector(trees, test::sphere(6, 8)), parts);
  };
  const CookedScene stones = file_of({"stone", "moss"}, 2), plain = file_of({}, 1),
                    woods = file_of({"wood", "bark", "moss"}, 1);
  std::vector<Tree> trees;
  for (const CookedScene* file : {&stones, &plain, &woods}) {
    for (std::uint32_t i = 0; i < file->file.tree_count(); ++i) {
      trees.push_back(require(Tree::bind(file->file, i)));
    }
  }
  std::vector<PlacedTree> instances(4);
  for (std::uint32_t i = 0; i < 4; ++i) instances[i].tree = i;
  const Scene scene = require(Scene::assemble(trees, instances));
  EXPECT_EQ(scene.material_count(), 5u);
  std::vector<std::string_view> names;
  for (std::uint32_t i = 0; i < 6; ++i) names.push_back(scene.material_name(i));
  EXPECT_EQ(names, (std::vector<std::string_view>{"stone", "moss", "wood", "bark", "moss", ""}));
  EXPECT_EQ(scene.material_name(kNoMaterial), "");
  std::vector<std::uint32_t> first, last;
  for (std::uint32_t i = 0; i < 4; ++i) {
    first.push_back(scene.material({i, {0, 0}}));
    last.push_back(scene.material({i, {9, 0}}));
  }
  EXPECT_EQ(first, (std::vector{1u, 1u, kNoMaterial, 4u}));
  EXPECT_EQ(last, (std::vector{0u, 0u, kNoMaterial, 2u}));
}

// A tree without faces is placed, and in no answer.
TEST(SceneAssemble, EmptyTreesAreInNoAnswer) {
  const CookedTree nothing = test::cook_tree({}, CodecId::kWide8);
  ASSERT_TRUE(nothing.tree.empty());
  const CookedTree sphere = test::cook_tree(test::sphere(6, 8), CodecId::kWide8);
  const std::vector<Tree> trees{nothing.tree, sphere.tree};
  std::vector<PlacedTree> instances(3);
  instances[1].tree = 1;
  instances[2].moves = true;
  const Scene scene = require(Scene::assemble(trees, instances));
  EXPECT_EQ(require(closest_hit(scene, {{0.1, 0.2, 9}, {0, 0, -1}}))->instance, 1u);
  EXPECT_EQ(require(closest_point(scene, {0, 0, 0}))->instance, 1u);
  EXPECT_EQ(require(cast_closest(scene, Sphere{{0, 0, 9}, 1}, {{0, 0, -1}}))->instance, 1u);
  const auto of_sphere = [](const auto& each) {
    EXPECT_EQ(each.instance, 1u);
    return true;
  };
  complete(overlap_sphere(scene, {0, 0, 0}, 2, of_sphere));
  complete(collide(scene, Sphere{{0, 0, 0}, 2}, of_sphere));
  const auto none = [](const auto&) {
    ADD_FAILURE();
    return true;
  };
  complete(contacts(scene, none));
  complete(contacts_of(scene, 0, none));
}

// Whatever the bytes of a tree, the scene is refused or answers.
TEST(SceneAssemble, DamagedTreesAreRefusedOrAnswered) {
  const std::vector<std::byte> whole = test::cook_bytes(test::sphere(4, 6), CodecId::kWide8);
  std::vector<PlacedTree> instances(2);
  instances[1].pose.translation()[0] = 0.5;
  instances[1].moves = true;
  std::size_t refused = 0, answered = 0;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    for (const std::byte change : {std::byte{1}, std::byte{0x80}, std::byte{0xff}}) {
      std::vector<std::byte> bytes = whole;
      bytes[i] ^= change;
      test::repair_checksums(bytes);
      const Result<File> file = File::open(bytes);
      const Result<Tree> tree = file ? Tree::bind(*file, 0) : Result<Tree>(file.error());
      const Result<Scene> scene =
          tree ? Scene::assemble(std::span(&*tree, 1), instances) : Result<Scene>(tree.error());
      if (!scene) {
        ++refused;
        continue;
      }
      ++answered;
      static_cast<void>(closest_hit(*scene, {{-9, 0.1, 0.2}, {1, 0.01, 0.02}}));
      static_cast<void>(closest_point(*scene, {0.5, 0.5, 0.5}));
      static_cast<void>(
          collide(*scene, Sphere{{0.2, 0.2, 0}, 1}, [](const auto&) { return true; }));
      static_cast<void>(contacts(*scene, [&](const ScenePair& pair) {
        EXPECT_EQ(scene->material(pair.first), kNoMaterial);
        return true;
      }));
    }
  }
  EXPECT_GT(refused, 100u);
  EXPECT_GT(answered, 100u);
}

// Worlds of any size: units of the scene keep squares of distances within the range of double.
TEST(SceneAssemble, TinyAndHugeWorldsAnswer) {
  const OneTree one;
  for (const int exponent : {-180, -60, 60, 180}) {
    SCOPED_TRACE(exponent);
    const double scale = std::ldexp(1.0, exponent);
    std::vector<PlacedTree> instances(3);
    for (std::size_t i = 0; i < 3; ++i) {
      instances[i].pose = Pose(Eigen::Scaling(scale));
      instances[i].pose.translation()[0] = 4 * scale * static_cast<double>(i);
    }
    const Scene scene = require(Scene::assemble(one.trees, instances));
    const auto hit = require(closest_hit(scene, {{4 * scale, 0, 9 * scale}, {0, 0, -scale}}));
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->instance, 1u);
    EXPECT_NEAR(hit->t, 8, 1e-12);
    const auto point = require(closest_point(scene, {8 * scale, 0, 3 * scale}));
    ASSERT_TRUE(point);
    EXPECT_EQ(point->instance, 2u);
    EXPECT_NEAR(point->distance, 2 * scale, 1e-12 * scale);
  }
}

// The number of a tree and the names of its parts: trees that a scene file holds, too, so that
// instances of other scenes can be taken over, each under the pose of the whole.
TEST(SceneAssemble, TakesInstancesOfScenesUnderAPose) {
  const cooker::SceneParts parts = test::random_parts(9, 2, 0, 1, 4);
  const CookedScene cooked = test::cook_scene({test::sphere(6, 8), test::torus(6, 8)}, parts);
  const Scene part = require(Scene::bind(cooked.file));
  const std::array<double, 2> shifts = {0, 32};
  std::vector<Tree> trees(part.trees().begin(), part.trees().end());
  std::vector<PlacedTree> instances;
  for (const double shift : shifts) {
    for (std::uint32_t i = 0; i < part.instance_count(); ++i) {
      const InstanceInfo info = require(part.info(i));
      const Pose pose(Eigen::Translation3d(shift, 0, 0) * require(part.pose(i)));
      instances.push_back({info.tree, pose, info.layer, info.moves, 0, info.name});
    }
  }
  const Scene scene = require(Scene::assemble(trees, instances));
  std::size_t hits = 0;
  std::mt19937_64 random(3);
  const auto unit = [&] { return std::uniform_real_distribution<double>(-1, 1)(random); };
  for (int i = 0; i < 200; ++i) {
    const Ray ray{{5 * unit(), 5 * unit(), 5 * unit()}, {unit(), unit(), unit()}, 0, 9};
    const auto expected = require(closest_hit(part, ray));
    for (std::uint32_t k = 0; k < 2; ++k) {
      Ray shifted = ray;
      shifted.origin[0] += shifts[k];
      const auto hit = require(closest_hit(scene, shifted));
      ASSERT_EQ(hit.has_value(), expected.has_value());
      if (!hit) continue;
      ++hits;
      EXPECT_EQ(hit->instance, expected->instance + k * part.instance_count());
      EXPECT_EQ(hit->face.index, expected->face.index);
      EXPECT_NEAR(hit->t, expected->t, 1e-12 * (1 + expected->t));
    }
  }
  EXPECT_GT(hits, 50u);
}

// What BindOptions require is refused where the tree is bound, with what brings it back.
TEST(SceneAssemble, PartsThatWereLeftOutAreNamedWhenTheTreeIsBound) {
  cooker::CookOptions options;
  options.face_ids = false;
  const CookedTree file = test::cook_tree(test::sphere(6, 8), CodecId::kWide8, options);
  BindOptions needs;
  needs.require_face_ids = true;
  EXPECT_EQ(Tree::bind(file.file, needs).error().message(),
            "part_left_out: tree 0: it was cooked without face ids: with --no-face-ids, or "
            "face_ids = false of its profile");
  const Scene scene =
      require(Scene::assemble(std::span(&file.tree, 1), std::vector<PlacedTree>(1)));
  EXPECT_EQ(require(closest_hit(scene, {{0.1, 0.2, 9}, {0, 0, -1}}))->face.id, kNoFaceId);
}

}  // namespace
}  // namespace boxtree
