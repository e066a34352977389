// SPDX-License-Identifier: MIT
// Imports mesh files; all source meshes enter here. boxtree's own readers read OBJ, OFF, PLY and
// STL, assimp the other formats.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <boxtree/error.h>

#include "cooker/import/face_materials.h"
#include "cooker/import/source_file.h"
#include "cooker/import/source_mesh.h"
#include "format/face_numbers.h"

namespace boxtree::cooker {

struct ImportOptions {
  /// [false] Drop faces with a NaN or infinite vertex, or with a vertex number out of range, and
  /// report their numbers, instead of refusing the file.
  bool skip_bad = false;
  /// [none] The command whose option --skip-bad the error of such a face names.
  const char* command = nullptr;
  /// [kF32] Precision of positions. kF64 keeps all digits of OBJ, OFF, PLY and text STL files; in
  /// other formats it only makes node transforms more exact.
  Precision precision = Precision::kF32;
  /// [false] Take kF64 for a PLY file whose coordinates are doubles, if f32 does not hold all of
  /// them.
  bool keep_doubles = false;
  /// [false] State in SourceMesh::moved_by_f32 what is too little to be told, too, for a caller
  /// that has a tolerance. Costs a second reading of texts and of doubles in PLY files.
  bool count_moves = false;
  /// [false] Let assimp read the file in a copy of this process first (trial.h). A file that
  /// crashes assimp's reader or makes it loop forever is then an error: kImportFailed. Costs a
  /// second reading. No effect on formats that assimp does not read. The copy is made by fork(): do
  /// not use it in programs whose other threads hold locks that reading needs.
  bool try_first = false;
  /// [false] Fill in SourceMesh::polygon_corners.
  bool keep_polygon_corners = false;
  /// [false] Fill in Imported::materials; scenes have theirs whatever this is. Costs a second
  /// reading of FBX files.
  bool materials = false;
  /// [none] Fill in Imported::user_data: from the property of faces with this name in a PLY file,
  /// from the groups of an OBJ file if it is kGroups, from the primitives of a glTF 2 file if it is
  /// kPrimitives, else from the number with this name in the extras of each primitive, of its
  /// material or of its mesh, the first that has it; 0 if none has. kMeshUnsupported if the file
  /// has none such.
  std::string user_data;
  /// [none] Take the ids of faces from the property of faces with this name in a PLY file, as a
  /// part of a larger mesh has them; they must not descend. kMeshUnsupported if the file has none
  /// such.
  std::string face_ids;
  /// [none] An input that is not a file. It can refer to no other.
  std::optional<SourceBytes> bytes;
};

/// ImportOptions::user_data: groups of an OBJ file, numbered in the order in which they first have
/// a face.
inline constexpr std::string_view kGroups = "groups";
/// Likewise primitives of a glTF file, numbered in the order of its meshes and of theirs, whatever
/// nodes place them.
inline constexpr std::string_view kPrimitives = "primitives";

/// SkippedFace::mesh: no face of the mesh is left.
inline constexpr std::uint32_t kNoMesh = 0xffffffffu;

/// A face that was not imported, and the reason. Every dropped face has one of these.
struct SkippedFace {
  std::uint32_t face_id;
  std::string reason;
  std::uint32_t mesh = 0;  // the mesh of the face, in SourceScene::meshes, or kNoMesh
};

/// What a source has that may be geometry and is not read.
struct Unread {
  std::string what;       // as the format calls it: "curv", "EXT_mesh_gpu_instancing"
  std::size_t count = 0;  // how often it is there
  std::size_t line = 0;   // the first, from 1; 0 in files that are no text
  std::string remedy;
};

/// All changes that import made to the source.
struct ImportReport {
  std::size_t meshes = 0;           // mesh instances flattened into the result
  std::size_t meshes_unplaced = 0;  // of those, meshes without a node: imported as they are
  std::size_t source_faces = 0;     // polygons with three corners or more, as in the file
  std::size_t source_vertices = 0;  // before welding; in formats without shared vertices, corners
  std::size_t points_skipped = 0;
  std::size_t lines_skipped = 0;
  std::size_t empty_skipped = 0;  // faces without any corner
  std::size_t quads_kept = 0;
  std::size_t quads_split = 0;       // not planar or not convex
  std::size_t ngons_split = 0;       // five corners or more
  std::size_t vertices_unused = 0;   // in no imported face; removed
  std::size_t vertices_welded = 0;   // bit-equal duplicates removed
  std::size_t degenerate_faces = 0;  // zero area; kept
  /// Text and PLY read as f32, where half of all faces or more have no area: how many fewer
  /// have none in f64.
  std::size_t flattened_by_f32 = 0;
  bool has_open_end = false;         // OBJ, OFF, PLY, NFF, RAW: the last line has no end
  /// Text and PLY read as f32, and meshes that nodes place in f32: how far a vertex was moved by
  /// that, at most; 0 if no farther than unnoticed_move (f32_digits.h). The mesh has it, too, and
  /// with ImportOptions::count_moves what is less.
  double moved_by_f32 = 0;
  F32Loss f32_loss = F32Loss::kDigits;  // of moved_by_f32
  /// With kF64: it keeps no more than kF32, since the coordinates are f32 in the file or by its
  /// reader, and nodes, if there are any, place each vertex on f32, too.
  bool has_f32_alone = false;
  bool has_no_materials = false;    // with ImportOptions::materials: no face has one
  bool has_no_groups = false;       // with kGroups: all faces are in the group without a name
  bool has_half_face = false;       // OBJ: that line is a face of two corners or fewer, left out
  std::vector<std::string> groups;  // with kGroups: names, in the order of their numbers
  std::vector<std::string> primitives;  // with kPrimitives: likewise; those of a mesh are numbered
  std::vector<Unread> unread;           // in the order of the file
  std::vector<SkippedFace> skipped;     // only with ImportOptions::skip_bad
  /// The file itself and every file it refers to; none for ImportOptions::bytes.
  std::vector<std::filesystem::path> files_read;
  /// Material libraries that the source names and that cannot be read; it is imported without them.
  std::vector<std::filesystem::path> files_missing;
  /// XXH3 over the bytes of files_read, in order of first read, or over ImportOptions::bytes.
  std::uint64_t content_hash = 0;
};

/// The file that was imported, - for ImportOptions::bytes.
[[nodiscard]] inline std::filesystem::path source_of(const ImportReport& report) {
  return report.files_read.empty() ? "-" : report.files_read.front();
}

struct Imported {
  SourceMesh mesh;
  ImportReport report;
  FaceMaterials materials;  // with ImportOptions::materials
  /// With ImportOptions::user_data: numbers by runs of faces, as SceneMesh::materials. Those below
  /// zero are the same 32 bits in two's complement.
  std::vector<FaceRun> user_data;
};

/// Reads `path` and flattens all its mesh instances into one mesh: instances in node order (depth
/// first), faces in source order within each. Face ids number polygons of three corners or more in
/// that order. Node transforms (a file's up axis is one) are applied in double and rounded once;
/// the identity changes no bit; a mirroring transform reverses the winding, so that faces keep
/// their front. Vertices that are equal bit for bit are merged, unused ones dropped, and the others
/// keep their order. A quad stays a quad if it is convex and planar up to the rounding of its
/// coordinates; other polygons are split into triangles that share a face id. Degenerate faces
/// stay.
///
/// Errors name the file and the face or vertex, all counted from 0 in every format, corners too;
/// lines are counted from 1: kFileNotFound, kFileUnreadable (a directory, a
/// pipe, no permission), kImportFailed (empty or malformed file; often assimp's own message),
/// kNoFaces, kMeshNotFinite, kMeshIndexOutOfRange, kMeshTooLarge (more than 2^31-1 faces),
/// kOutOfMemory. Throws nothing, prints nothing and uses no global state: safe to call from several
/// threads, in any locale.
///
/// Decimals of OBJ, OFF, PLY and text STL are rounded once, to the nearest f32 or f64.
/// Vertices and faces of these four keep the order of the file, whatever the groups of an OBJ. In
/// formats that assimp reads, positions have the digits of f32, and decimals can be a unit in the
/// last place off the nearest. glTF is checked before assimp's reader, which repairs it silently. A
/// truncated file is refused if its format states counts or an end (among the texts that assimp
/// reads: AC3D, ASE, DXF, MD5, SMD and those whose readers check it). OBJ, NFF and RAW state
/// neither; a last line without an end is reported. A glTF file with vertex numbers out of range is
/// refused even with skip_bad, and the error names the mesh: assimp drops such faces and their
/// numbers. Assimp's other readers (3DS, LWO, DXF, Unreal, ...) may still clamp a vertex number out
/// of range.
Result<Imported> import_mesh(const std::filesystem::path& path, const ImportOptions& options = {});

/// The files that an import of `path` reads, itself first, as ImportReport::files_read has them;
/// none for ImportOptions::bytes but those beside it. Files of assimp's formats have to be read to
/// know; of others no vertex is read. Errors: kFileNotFound, kFileUnreadable; for files of which
/// only reading tells it, those of import_mesh.
Result<std::vector<std::filesystem::path>> list_source_files(const std::filesystem::path& path,
                                                             const ImportOptions& options = {});

/// The same, and what else decides which files these are: while all named ones keep their bytes and
/// no absent one comes, the list stays. Depends on no option.
struct SourceFileList {
  std::vector<std::filesystem::path> files;   // as list_source_files() has them
  std::vector<std::filesystem::path> named;   // the names by which they were opened
  std::vector<std::filesystem::path> absent;  // looked for, and no files that can be read
  bool is_all = true;                         // false: more was looked for, and is there
};
Result<SourceFileList> find_source_files(const std::filesystem::path& path,
                                         const ImportOptions& options = {});

/// Whether a file of such a name may refer to others: only reading tells.
[[nodiscard]] bool may_refer_to_files(const std::filesystem::path& path);

/// Whether files of such a name have a node graph, as all have that assimp reads: then import_mesh
/// flattens them.
[[nodiscard]] bool has_node_graph(const std::filesystem::path& path);

/// Endings of the names of files that are read, in lower case, in order: "3ds", "obj", ...
[[nodiscard]] std::vector<std::string> mesh_endings();
/// Whether it is one of them, in any case.
[[nodiscard]] bool is_mesh_ending(std::string_view ending);

}  // namespace boxtree::cooker
