// SPDX-License-Identifier: MIT
// The faces of a source that may be larger than memory, one after the other.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>

#include <boxtree/error.h>

namespace boxtree::cooker {

using WorldCorner = std::array<float, 3>;

/// A polygon of three corners or more, with the number that import gives it. Parts of one that was
/// split share their number and come together. Valid during the call.
struct WorldFace {
  std::uint32_t id;
  std::span<const WorldCorner> corners;
  std::span<const WorldCorner> of_all_parts;  // corners of all faces with this number
};

/// Takes one face after the other; an error ends the reading.
using WorldFaceSink = std::function<Status(const WorldFace&)>;

/// How a source is read.
struct WorldReading {
  std::uint64_t memory = 0;  ///< [bytes] --memory of the command, of which reading takes half.
  bool skip_bad = false;     ///< Leave out what import_mesh calls bad; others keep their numbers.
};

/// What a source had.
struct WorldFaces {
  std::uint32_t numbers = 0;  ///< of faces, those that were skipped included
  std::uint32_t skipped = 0;
};

/// Passes each face of a mesh file to `sink`. Corners have the bits that import_mesh gives them in
/// f32.
///
/// Binary STL and PLY are read from front to back: their faces are never in memory, and of a PLY
/// file as many vertices as so much memory holds, in blocks; a file whose faces name vertices all
/// over it is read at the speed of its disk. Other files, and PLY files with strips or with lists
/// before their faces, are imported.
///
/// Errors: those of import_mesh; kMeshUnsupported for a file that has to be imported and is
/// expected to take more memory, and for a PLY file with doubles that f32 does not hold, as
/// a cook with --exact would keep them.
Result<WorldFaces> read_world_faces(const std::filesystem::path& path, const WorldReading& reading,
                                    const WorldFaceSink& sink);

}  // namespace boxtree::cooker
