// SPDX-License-Identifier: MIT
// A scene as it enters the pipeline: meshes that differ, and where each is placed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <unordered_map>
#include <variant>
#include <vector>

#include <boxtree/query.h>

#include "cooker/import/import.h"
#include "cooker/import/source_mesh.h"
#include "format/scene_record.h"

namespace boxtree::cooker {

/// A mesh of a scene, in its own object space: no two of a scene are equal in content.
struct SceneMesh {
  SourceMesh mesh;
  std::uint32_t source_faces = 0;  // polygons in the source: SourceMesh::face_id is below it
  /// Materials by runs of source face numbers (SourceMesh::face_id), ascending, the first from face
  /// 0 on, neighbours different; material numbers count SourceScene::materials. Empty: none.
  std::vector<MaterialRun> materials;
};

/// Whether two meshes are equal in all but name and materials: positions bit for bit (-0 is not
/// +0), faces and their numbers. Those that are have the same hash.
[[nodiscard]] bool has_same_shape(const SceneMesh& a, const SceneMesh& b);
[[nodiscard]] std::uint64_t hash_of_shape(const SceneMesh& mesh);

/// Puts meshes into a list in which no two are equal in all but name. Their material numbers are
/// those of one scene.
class MeshMerger {
 public:
  /// `meshes`, among which no two are equal, must outlive it; nobody else adds to them.
  explicit MeshMerger(std::vector<SceneMesh>& meshes);

  /// The number of `mesh` in the list, or of one that is equal to it.
  std::uint32_t add(SceneMesh&& mesh);

 private:
  std::vector<SceneMesh>& meshes_;
  std::unordered_multimap<std::uint64_t, std::uint32_t> by_hash_;
};

/// How a material without a name is called.
[[nodiscard]] std::string unnamed_material(std::uint32_t number);

/// A placed mesh.
struct SceneInstance {
  std::string name;        // of its node, as assimp has it; may be empty, need not be unique
  std::uint32_t mesh = 0;  // in SourceScene::meshes
  std::uint32_t id = 0;    // number among the instances of the source, depth first
  Pose pose = Pose::Identity();
};

struct SourceScene {
  std::string name;
  std::vector<SceneMesh> meshes;
  std::vector<SceneInstance> instances;  // by id
  std::vector<std::string> materials;    // names, in order of first use
  ImportReport report;
};

/// Reads `path` as a scene: each node of the file's graph that holds meshes becomes an instance,
/// whose pose is the product of the transforms from the root down, in double; all meshes of a node
/// become one, a run of faces for each material. Meshes without a node are instances with the
/// identity as pose. Meshes that are equal in content (positions bit for bit, faces, materials) are
/// stored once, under the name of the first. Vertices keep every bit: no transform is applied to
/// them; so a mirroring pose leaves the winding alone, other than import_mesh, and who applies it
/// has to turn faces round. Face ids count the faces of three corners or more of a node's meshes,
/// in their order. A node of whose meshes no such face is left is left out.
///
/// Materials are the names of those in use; of several with one name the first stands for all. One
/// without a name is called "material N", its number here. Faces without a material have one that
/// assimp makes up for them, without a name or with AI_DEFAULT_MATERIAL_NAME; a scene with nothing
/// else has no materials. Nodes that share a mesh of an FBX file have the materials of the first.
///
/// ImportReport counts as for import_mesh; meshes of the file that several nodes hold are counted
/// once, those that turned out to be equal each time.
///
/// A file without a node graph (OBJ, PLY, STL, OFF) is one instance, called by the stem of the
/// file's name, of what import_mesh makes of it. Errors as for import_mesh, and kInvalidPose,
/// naming the node, for a transform that is not finite or not invertible: one for which
/// RelativePose has no answer.
Result<SourceScene> import_scene(const std::filesystem::path& path,
                                 const ImportOptions& options = {});

using ImportedFile = std::variant<Imported, SourceScene>;

/// Reads `path` once, as what it is: a SourceScene, as import_scene makes it, if its node graph
/// places faces twice or more; otherwise one mesh, the very bits of import_mesh. Errors as for
/// both: of several poses one may be refused (kInvalidPose) that import_mesh would flatten.
Result<ImportedFile> import_file(const std::filesystem::path& path,
                                 const ImportOptions& options = {});

}  // namespace boxtree::cooker
