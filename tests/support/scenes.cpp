// SPDX-License-Identifier: MIT
#include "tests/support/scenes.h"

#include <optional>
#include <utility>

#include <gtest/gtest.h>

#include "cooker/cook.h"
#include "cooker/encode/instance_edges.h"
#include "tests/support/require.h"

namespace boxtree::test {

Eigen::Vector3d placed(const Pose& pose, const Eigen::Vector3d& p) {
  Eigen::Vector3d out;
  for (Eigen::Index i = 0; i < 3; ++i) {
    out[i] = ((pose.translation()[i] + pose.linear()(i, 0) * p[0]) + pose.linear()(i, 1) * p[1]) +
             pose.linear()(i, 2) * p[2];
  }
  return out;
}

CookedScene cook_scene(std::vector<cooker::SourceMesh> meshes, cooker::SceneParts parts,
                       const std::vector<CodecId>& codecs, const cooker::CookOptions& options) {
  if (parts.layers.empty()) parts.layers.push_back({"all"});
  std::vector<cooker::EncodedTree> trees;
  std::optional<cooker::Grid> grid;
  if (options.geometry == GeometryId::kGrid) {
    std::vector<const cooker::SourceMesh*> all;
    for (const cooker::SourceMesh& mesh : meshes) all.push_back(&mesh);
    grid = require(cooker::choose_grid(all, options.grid));
  }
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    cooker::CookOptions of_mesh = options;
    of_mesh.codec = codecs[i % codecs.size()];
    trees.push_back(require(cooker::cook_mesh(meshes[i], of_mesh, grid)).tree);
  }
  if (options.active_edges) {
    const Status found = cooker::find_instance_edges(trees, {}, *options.active_edges, parts);
    EXPECT_TRUE(found.ok()) << found.error().message();
  }
  std::vector<std::byte> bytes = require(cooker::serialize({trees, {}, &parts}));
  File file = require(File::open(bytes));
  return {std::move(meshes), std::move(parts), std::move(bytes), std::move(file)};
}

// Random numbers are drawn inside braces, which every compiler evaluates in order: the scenes are
// the same in every build.
Pose random_pose(std::mt19937_64& random, double spread, bool unevenly) {
  const auto unit = [&] { return std::uniform_real_distribution<double>(-1, 1)(random); };
  const Eigen::Quaterniond turn = Eigen::Quaterniond{unit(), unit(), unit(), unit()}.normalized();
  Pose pose = Pose::Identity();
  pose.linear() = turn.toRotationMatrix() * std::exp2(unit());
  if (unevenly) {
    Eigen::Matrix3d shear = Eigen::Matrix3d::Identity();
    shear(0, 1) = unit();
    const Eigen::Vector3d scale(std::exp2(unit()), -std::exp2(unit()), std::exp2(unit()));
    pose.linear() = pose.linear() * shear * scale.asDiagonal();
  }
  pose.translation() = spread * Eigen::Vector3d{unit(), unit(), unit()};
  return pose;
}

std::vector<Pose> extreme_poses() {
  std::mt19937_64 random(9);
  std::vector<Pose> poses;
  for (const double scale : {1e-30, 1e-3, 1.0, 1e20}) {
    for (const double flat : {1e-15, 1e-7, 1.0, 1e7}) {
      for (const double far : {0.0, 1e3, 1e9}) {
        Pose& pose = poses.emplace_back(random_pose(random, 0, true));
        pose.linear() = scale * (pose.linear() * Eigen::Vector3d(1, flat, 1).asDiagonal());
        pose.translation() = Eigen::Vector3d(far, -far, far / 2) * scale;
      }
    }
  }
  return poses;
}

cooker::SceneParts random_parts(std::uint32_t count, std::uint32_t trees, std::uint32_t moving,
                                std::uint32_t layers, unsigned seed) {
  std::mt19937_64 random(seed);
  cooker::SceneParts parts;
  for (std::uint32_t i = 0; i < layers; ++i) parts.layers.push_back({"layer " + std::to_string(i)});
  for (std::uint32_t i = 0; i < count; ++i) {
    cooker::PlacedTree placed;
    placed.tree = i % trees;
    placed.id = i;
    placed.layer = i % layers;
    placed.moves = moving != 0 && i % moving == 0;
    placed.name = "instance " + std::to_string(i);
    placed.pose = random_pose(random, 4, i % 2 == 1);
    parts.instances.push_back(placed);
  }
  return parts;
}

std::vector<WorldTriangle> world_triangles(const CookedScene& cooked, const Scene& scene) {
  std::vector<WorldTriangle> triangles;
  for (std::uint32_t i = 0; i < scene.instance_count(); ++i) {
    const InstanceInfo info = require(scene.info(i));
    const Pose pose = require(scene.pose(i));
    const cooker::SourceMesh& mesh = cooked.meshes[info.tree];
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
      const cooker::Face& face = mesh.faces[f];
      const auto at = [&](std::size_t corner) {
        return placed(pose, mesh.positions[face.corner[corner]]);
      };
      triangles.push_back({i, info.id, f, {{at(0), at(1), at(2)}}});
      if (face.is_quad()) triangles.push_back({i, info.id, f, {{at(0), at(2), at(3)}}});
    }
  }
  return triangles;
}

}  // namespace boxtree::test
