// SPDX-License-Identifier: MIT
// One scene over the tiles of a world, without cooking.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include <boxtree/error.h>

#include "cooker/scene/cook_input.h"
#include "cooker/write/output_target.h"
#include "cooker/write/pack_members.h"

namespace boxtree::cooker {

struct MergeReport {
  std::uint64_t bytes = 0;
  std::uint64_t trees = 0;
  std::uint64_t faces = 0;
  std::uint64_t triangles = 0;
};

/// Writes a file with all trees of cooked files, in the order given, and a scene that has each of
/// them once, where it is. Its faces are numbered throughout (kSceneFacesNumbered): queries name
/// faces by their numbers in the world, and settle ties by them, as in one tree. Sections of trees
/// are copied as they are. Then the file is mapped and checked (checksums, padding, prove_scene),
/// and committed to `to`: on any error before, the old file is unchanged. Trees were proven when
/// they were cooked.
///
/// Files are read one by one, twice; memory is that of records, of the section table and of a bit
/// for each face number.
///
/// Errors: those of `open`; kMeshUnsupported, with the file, for one with a scene, with materials,
/// with external geometry or without face ids, for a tree without faces, for a face number that
/// a file before has, and for positions on another grid than those of the first file; kMeshTooLarge
/// for more than kMaxTrees trees; kFileUnreadable if a file changes meanwhile; kWriteFailed.
Result<MergeReport> merge_world(const OutputTarget& to,
                                std::span<const std::filesystem::path> files, const OpenInput& open,
                                const Progress& progress = {});

}  // namespace boxtree::cooker
