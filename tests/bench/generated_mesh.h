// SPDX-License-Identifier: MIT
// Large meshes for benchmarks, of exactly as many triangles as requested.
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

/// Streets of lots on hilly ground, from the centre outwards; on each lot sheds, houses or a tower,
/// whose facades are divided into cells of half a metre up to the whole wall, a quarter of them
/// turned. Vertices on the edges of walls and lots are there twice, bit for bit.
[[nodiscard]] cooker::SourceMesh make_city(std::size_t triangles, std::uint64_t seed);

}  // namespace boxtree::bench
