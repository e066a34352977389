// SPDX-License-Identifier: MIT
// A scene before it is cooked: its distinct meshes, and their placements.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <unordered_map>
#include <variant>
#include <vector>

#include <boxtree/query.h>

#include "cooker/import/import.h"
#include "cooker/import/source_mesh.h"
#include "format/face_numbers.h"

namespace boxtree::cooker {

/// A mesh of a scene, in its own object space. No two meshes of a scene have equal content.
struct SceneMesh {
  SourceMesh mesh;
  std::uint32_t source_faces = 0;  // polygons in the source; every SourceMesh::face_id is smaller
  /// Materials by runs of source face numbers (SourceMesh::face_id): ascending, the first run
  /// starts at face 0, neighbours differ. Numbers are indices into SourceScene::materials. Empty:
  /// none.
  std::vector<FaceRun> materials;
  std::vector<FaceRun> user_data;  // as in Imported
};

/// Whether two meshes are equal except for name and materials: positions bit for bit (-0 is not
/// +0), how far f32 moved them, faces, their numbers and user data. Equal meshes have the same
/// hash.
[[nodiscard]] bool has_same_shape(const SceneMesh& a, const SceneMesh& b);
[[nodiscard]] std::uint64_t hash_of_shape(const SceneMesh& mesh);

/// Adds meshes to a list without duplicates (equal in all but name). All material numbers refer to
/// one scene.
class MeshMerger {
 public:
  /// `meshes` contains no duplicates, must outlive this object and must not be changed by others.
  explicit MeshMerger(std::vector<SceneMesh>& meshes);

  /// The index of `mesh` in the list, or of a mesh equal to it.
  std::uint32_t add(SceneMesh&& mesh);

 private:
  std::vector<SceneMesh>& meshes_;
  std::unordered_multimap<std::uint64_t, std::uint32_t> by_hash_;
};

/// The name of a material without a name.
[[nodiscard]] std::string unnamed_material(std::uint32_t number);

/// Joins the materials of several files into one list: those of one name are one.
class MaterialJoin {
 public:
  /// `materials` must outlive this object and must not be changed by others.
  explicit MaterialJoin(std::vector<std::string>& materials);

  /// The numbers in the list of the materials of another file.
  std::vector<std::uint32_t> add(const std::vector<std::string>& materials);

 private:
  std::uint32_t add_named(const std::string& name);
  std::uint32_t add_unnamed();

  std::vector<std::string>& all_;
  std::map<std::string, std::uint32_t> by_name_;
};

/// Gives each run `numbers[material]`.
void renumber(std::vector<FaceRun>& runs, const std::vector<std::uint32_t>& numbers);

/// A placed mesh.
struct SceneInstance {
  std::string name;        // of its node, as in assimp; may be empty, need not be unique
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

/// Reads `path` as a scene. Each node of the file's graph with meshes becomes an instance; its pose
/// is the product of the transforms from the root down, in double. All meshes of a node become one,
/// with a run of faces per material. Meshes without a node become instances with an identity pose.
/// Meshes of equal content (positions bit for bit, faces, materials) are stored once, under the
/// name of the first. Vertices keep every bit, because no transform is applied to them. A mirroring
/// pose therefore does not change the winding, unlike in import_mesh: code that applies the pose
/// has to reverse faces. Face ids number the faces of three corners or more of a node's meshes in
/// order. Nodes without such faces are left out.
///
/// Materials are the names of those in use; materials with the same name become one. A material
/// without a name is called "material N", where N is its number here. Assimp gives faces without a
/// material a default one, without a name or named AI_DEFAULT_MATERIAL_NAME; a scene with no other
/// material has none. Nodes that share a mesh of an FBX file have the materials of the first.
///
/// ImportReport counts as for import_mesh. A mesh of the file in several nodes is counted once;
/// different meshes of equal content are counted each.
///
/// A file without a node graph (OBJ, PLY, STL, OFF) is one instance of the mesh that import_mesh
/// returns, named by the stem of the file's name. Errors: as for import_mesh; kImportFailed with
/// the node for a transform that is not finite or not invertible, that is, for which RelativePose
/// fails.
Result<SourceScene> import_scene(const std::filesystem::path& path,
                                 const ImportOptions& options = {});

using ImportedFile = std::variant<Imported, SourceScene>;

/// Reads `path` once: as a SourceScene, as from import_scene, if its node graph places faces twice
/// or more; otherwise as one mesh, bit for bit as from import_mesh. Errors: as for both; a pose may
/// be refused that import_mesh would flatten.
Result<ImportedFile> import_file(const std::filesystem::path& path,
                                 const ImportOptions& options = {});

}  // namespace boxtree::cooker
