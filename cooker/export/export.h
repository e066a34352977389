// SPDX-License-Identifier: MIT
// Exports decoded triangles and boxes to a file for viewers, to inspect the work of a codec.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "cooker/export/decoded_faces.h"
#include "cooker/export/tree_boxes.h"
#include "cooker/write/output_target.h"
#include "runtime/scene/bound_scene.h"
#include "runtime/tree/bound_tree.h"

namespace boxtree::cooker {

struct ExportOptions {
  bool triangles = true;
  std::vector<LevelRange> levels = {{0, 3}};  // of boxes; ranges may overlap
  bool leaves = false;                        // also the boxes of all leaves
  bool solid_boxes = false;                   // boxes as faces, not as lines
  std::optional<ExportOrder> order;           // [kSource if there are face ids]
};

/// The exported parts of one tree.
struct ExportedTree {
  std::string name;
  std::uint64_t vertices = 0;  // of triangles; boxes have eight each
  std::uint64_t faces = 0;
  std::uint64_t triangles = 0;
  std::vector<BoxGroup> boxes;
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  // origin of positions; glTF only
  std::uint64_t instances = 0;                            // of this tree; 0 without a scene
};

struct ExportReport {
  std::uint64_t bytes = 0;
  std::vector<ExportedTree> trees;
  std::optional<std::uint64_t> instances;  // empty without a scene
  std::uint64_t placed_triangles = 0;      // of all instances
};

/// Whether a name is of glTF (.glb) or of OBJ (.obj). Error: kInvalidQuery for another extension.
Result<bool> is_glb_name(const std::filesystem::path& output);

/// Writes `trees` to `output`, as Wavefront OBJ or binary glTF 2.0 depending on the extension of
/// its path (.obj, .glb). Positions are in object space. On any error `output` is unchanged. Trees
/// with external geometry must be bound to their mesh, unless `triangles` is false.
///
/// Errors: kInvalidQuery for another extension, and for a range of levels that begins below the
/// deepest level of all trees; those of DecodedFaces::decode, walk_boxes and write_glb;
/// kWriteFailed.
Result<ExportReport> export_trees(std::span<const Tree> trees, const OutputTarget& output,
                                  const ExportOptions& options);

/// Writes the instances of `scene` in the order of their ids, placed by their poses. In glTF, an
/// instance is a node with a matrix, and all instances of a tree share a mesh. In OBJ, an instance
/// is an object in world coordinates; if its pose mirrors, its faces are reversed so that they keep
/// their front. Instances without a name are called "instance N", N being their number in the
/// scene. Trees without instances are left out. Boxes are the trees' boxes, transformed with them.
///
/// Precondition: `trees` are all trees of the scene's file, in its order. Shapes are read from
/// `trees`, so those of `scene` may be bound without meshes. Errors: those of export_trees;
/// kRecordInvalid with the instance for corrupt bytes, and for poses that move shapes beyond the
/// range of doubles.
Result<ExportReport> export_scene(const Scene& scene, std::span<const Tree> trees,
                                  const OutputTarget& output, const ExportOptions& options);

}  // namespace boxtree::cooker
