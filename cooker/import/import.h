// SPDX-License-Identifier: MIT
// Mesh files in: the only door through which source meshes enter. OBJ, OFF, PLY and STL are read by
// readers of our own, everything else by assimp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <boxtree/error.h>

#include "cooker/import/source_mesh.h"

namespace boxtree::cooker {

struct ImportOptions {
  /// [false] Drop faces with a NaN or infinite vertex, or with a vertex number out of range, and
  /// report their numbers, instead of refusing the file.
  bool skip_bad = false;
  /// [kF32] Hold positions as f32, or as f64 with all the digits of OBJ, OFF and PLY files; in
  /// other formats only node transforms gain by it.
  Precision precision = Precision::kF32;
  /// [false] Let assimp read the file in a copy of this process first (trial.h), so that a file
  /// that crashes its reader, or that it never ends with, is an error: kImportFailed. Costs a
  /// second reading. Means nothing to formats that assimp does not read. The copy is made by
  /// fork(): not for programs whose other threads hold locks that reading needs.
  bool try_first = false;
};

/// SkippedFace::mesh: of the mesh nothing is left.
inline constexpr std::uint32_t kNoMesh = 0xffffffffu;

/// A face that was not taken over, and why. Nothing is dropped without one of these.
struct SkippedFace {
  std::uint32_t face_id;
  std::string reason;
  std::uint32_t mesh = 0;  // whose face it is: of SourceScene::meshes, or kNoMesh
};

/// What import did to the source, so that nothing happens silently.
struct ImportReport {
  std::size_t meshes = 0;           // mesh instances flattened into the result
  std::size_t meshes_unplaced = 0;  // of those, meshes that no node places: taken over as they are
  std::size_t source_faces = 0;     // polygons with three corners or more, as in the file
  std::size_t source_vertices = 0;  // before welding; of formats without shared ones, corners
  std::size_t points_skipped = 0;
  std::size_t lines_skipped = 0;
  std::size_t empty_skipped = 0;  // faces without any corner
  std::size_t quads_kept = 0;
  std::size_t quads_split = 0;       // not planar or not convex
  std::size_t ngons_split = 0;       // five corners or more
  std::size_t vertices_unused = 0;   // belong to no face that was taken over; removed
  std::size_t vertices_welded = 0;   // bit-equal duplicates removed
  std::size_t degenerate_faces = 0;  // zero area; kept
  bool has_open_end = false;         // OBJ, OFF, PLY, NFF, RAW: no end of the last line; cut?
  std::vector<SkippedFace> skipped;  // only with ImportOptions::skip_bad
  std::vector<std::filesystem::path> files_read;  // the file itself and every file it refers to
  std::uint64_t content_hash = 0;  // XXH3 over the bytes of files_read, in order of first read
};

struct Imported {
  SourceMesh mesh;
  ImportReport report;
};

/// Reads `path` and flattens all its mesh instances into one mesh: instances in node order (depth
/// first), faces in source order within each; face ids count polygons of three corners
/// or more in that order. Node transforms (a file's up axis is one) are applied in double and
/// rounded once; the identity leaves every bit alone; a mirroring one turns the winding round, so
/// that faces still show their front. Vertices that are equal bit for bit are merged, unused ones
/// dropped, the others keep their order. A quad stays a quad if it is convex and as planar as its
/// rounded coordinates can tell; other polygons are split into triangles that share a face id.
/// Degenerate faces stay.
///
/// Errors name the file and the face or vertex: kFileNotFound, kFileUnreadable (a directory, a
/// pipe, no permission), kImportFailed (empty, or not what its format requires: often assimp's
/// own message), kNoFaces, kMeshNotFinite, kMeshIndexOutOfRange, kMeshTooLarge (more than 2^31-1
/// faces, or out of memory). No exception leaves it, nothing is printed by it, it reads and writes
/// no global state: safe to call from several threads, in any locale.
///
/// Decimals of OBJ, OFF, PLY and text STL are rounded once, to the nearest f32 or f64 (STL: f32).
/// Vertices and faces of these four have the order of the file, whatever the groups of an OBJ. What
/// assimp decides: positions of other formats have the digits of f32, and decimals among them can
/// be a unit in the last place off the nearest. Where one of its readers repairs silently we look
/// first ourselves: glTF. A file that was cut short is refused where its format states counts or an
/// end (of the texts that assimp reads: AC3D, ASE, DXF, MD5, SMD and those of its readers that look
/// themselves); OBJ, NFF and RAW state none, and a last line without an end is reported. A glTF
/// file with vertex numbers out of range is refused even with skip_bad, and named by its mesh:
/// assimp has dropped the faces and their numbers with them. Its other readers (3DS, LWO, DXF,
/// Unreal, ...) may still clamp a vertex number out of range.
Result<Imported> import_mesh(const std::filesystem::path& path, const ImportOptions& options = {});

}  // namespace boxtree::cooker
