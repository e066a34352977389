// SPDX-License-Identifier: MIT
// Large meshes for benchmarks, with exactly the requested number of triangles.
#pragma once

#include <cstddef>
#include <cstdint>

#include "cooker/import/source_mesh.h"

namespace boxtree::bench {

/// The same bits on every machine: integer hashes and the four operations, no library function that
/// may round differently. Units are metres, z is up.
///
/// A fractal height field over a square grid of one metre, in rows.
[[nodiscard]] cooker::SourceMesh make_terrain(std::size_t triangles, std::uint64_t seed);

/// Streets of lots on hilly ground, from the centre outwards. Lots have sheds, houses or a tower.
/// Facades are divided into cells from half a metre up to the whole wall; a quarter of the
/// buildings is rotated. Vertices on the edges of walls and lots exist twice, bit for bit.
[[nodiscard]] cooker::SourceMesh make_city(std::size_t triangles, std::uint64_t seed);

}  // namespace boxtree::bench
