// SPDX-License-Identifier: MIT
// The level on its two ways: into a cooked file, and into Bullet's arrays. A game cooks at build
// time (samples/game); here it is done in place, so that both shapes surely have the same
// triangles.
#pragma once

#include <BulletCollision/CollisionShapes/btTriangleIndexVertexArray.h>
#include <filesystem>

#include "cooker/cook.h"
#include "samples/bullet_drop/drop.h"

namespace bullet_drop {

/// Writes the level as a file of one tree.
[[nodiscard]] boxtree::Status cook_level(const Level& level, const std::filesystem::path& path,
                                         const boxtree::cooker::CookOptions& options = {});

/// Bullet's view of the level, which must outlive it.
[[nodiscard]] btTriangleIndexVertexArray arrays_of(Level& level);

}  // namespace bullet_drop
