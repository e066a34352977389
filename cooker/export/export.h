// SPDX-License-Identifier: MIT
// Decoded triangles and boxes as a file that any viewer opens: what a codec did, to look at.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "cooker/export/decoded_faces.h"
#include "cooker/export/tree_boxes.h"
#include "runtime/scene/bound_scene.h"
#include "runtime/tree/bound_tree.h"

namespace boxtree::cooker {

struct ExportOptions {
  bool triangles = true;
  std::vector<LevelRange> levels = {{0, 3}};  // of boxes; ranges may overlap
  bool leaves = false;                        // also the boxes of all leaves
  bool solid_boxes = false;                   // boxes as faces, not as lines
  std::optional<ExportOrder> order;           // [that of the source where face ids tell it]
};

/// What was written of one tree.
struct ExportedTree {
  std::string name;
  std::uint64_t vertices = 0;  // of triangles; boxes have eight each
  std::uint64_t faces = 0;
  std::uint64_t triangles = 0;
  std::vector<BoxGroup> boxes;
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  // what positions lack; glTF alone
  std::uint64_t instances = 0;                            // that place it; 0 without a scene
};

struct ExportReport {
  std::uint64_t bytes = 0;
  std::vector<ExportedTree> trees;
  std::optional<std::uint64_t> instances;  // nothing without a scene
  std::uint64_t placed_triangles = 0;      // of all instances
};

/// Writes `trees` to `output`, as Wavefront OBJ or as binary glTF 2.0 by its extension (.obj,
/// .glb). Positions are of object space. On any error nothing of `output` changes. Trees with
/// external geometry must be bound to their mesh, unless `triangles` is false.
///
/// Errors: kInvalidQuery for another extension, and for a range of levels that begins below the
/// deepest of all trees; those of DecodedFaces::decode, walk_boxes and write_glb; kWriteFailed.
Result<ExportReport> export_trees(std::span<const Tree> trees, const std::filesystem::path& output,
                                  const ExportOptions& options);

/// Writes the instances of `scene` in the order of their ids, each where its pose puts it: in glTF
/// a node with a matrix, and a mesh that all instances of a tree share; in OBJ an object in world
/// coordinates, whose faces are turned round where the pose mirrors, so that they keep their front.
/// Instances without a name are called "instance N", their number in the scene. Trees without
/// instances are left out. Boxes are those of the trees and turn with them.
///
/// Precondition: `trees` are all trees of the scene's file, in its order. They are what is read:
/// those of `scene` may be bound without meshes. Errors: those of export_trees; kRecordInvalid,
/// naming the instance, for corrupt bytes, and for poses that put shapes beyond all numbers.
Result<ExportReport> export_scene(const Scene& scene, std::span<const Tree> trees,
                                  const std::filesystem::path& output,
                                  const ExportOptions& options);

}  // namespace boxtree::cooker
