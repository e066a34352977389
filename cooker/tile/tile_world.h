// SPDX-License-Identifier: MIT
// Cuts a world of any size into tiles that are cooked one by one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <boxtree/error.h>

#include "cooker/scene/cook_input.h"

namespace boxtree::cooker {

/// The property of faces of a tile that holds their numbers in the world.
inline constexpr const char* kTileFaceIds = "face";

struct TileOptions {
  /// Mesh files, one after the other: faces of each are numbered on from those before it.
  std::vector<std::filesystem::path> sources;
  std::filesystem::path jobs;    // the manifest to write
  std::filesystem::path folder;  // of the tiles, which is made; cooked files go beside them
  std::uint64_t triangles_per_tile = 1'000'000;
  std::uint64_t memory = std::uint64_t{1} << 30;  // [bytes] beside that of the program
  bool skip_bad = false;                          // leave bad faces out; others keep their numbers
  std::vector<std::string> cook_options;          // of each job, but --face-ids
};

struct TileReport {
  std::uint64_t faces = 0;
  std::uint64_t skipped = 0;  // bad ones
  std::uint64_t triangles = 0;
  std::uint64_t tiles = 0;
  std::uint64_t written = 0;   // of these; the others were there with the same bytes
  std::uint64_t largest = 0;   // triangles of a tile
  std::uint64_t readings = 0;  // of all sources
};

/// Writes each cell of the world (tile_cells.h) as a PLY file of its own, with positions bit for
/// bit and the numbers of faces in the world, and a manifest that cooks them. Files depend on what
/// the sources are alone, not on memory. Faces lie beside the manifest in a temporary file, of 44
/// bytes a triangle, between the last two readings.
///
/// Errors: those of read_world_faces; kNoFaces; kMeshTooLarge for more than kMaxFaces faces;
/// kMeshUnsupported for a polygon of more than 255 corners; kBudgetUnreachable where `memory` is
/// too little, with what is needed; kFileUnreadable if a source changes meanwhile; kWriteFailed,
/// also for a file in the place of a tile or of the manifest that is none.
Result<TileReport> tile_world(const TileOptions& options, const Progress& progress = {});

}  // namespace boxtree::cooker
