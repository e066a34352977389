// SPDX-License-Identifier: MIT
// The scene: stairs beside terrain, and crates that fall on both.
#pragma once

#include <BulletCollision/CollisionShapes/btConcaveShape.h>
#include <array>
#include <cstdint>
#include <vector>

namespace bullet_drop {

/// The level as an application has it: positions in metres, z up, and triangles.
struct Level {
  std::vector<float> positions;  // x0 y0 z0 x1 ...
  std::vector<std::array<std::uint32_t, 3>> triangles;
};
/// Eight steps for x < 0, hills for x > 0.
[[nodiscard]] Level make_level();

/// A crate when the simulation has ended.
struct Crate {
  btVector3 start;
  btVector3 position;
  btScalar tilt_degrees;  // of its nearest axis against the vertical
  bool at_rest;           // Bullet has put it to sleep
};

/// Half an edge of a crate, metres.
inline constexpr btScalar kCrateHalf = btScalar(0.25);

/// Drops the crates, one to a place of its own, and waits ten seconds.
[[nodiscard]] std::vector<Crate> drop_crates(btConcaveShape& level);

/// Whether a crate is where there is no level any more.
[[nodiscard]] bool has_fallen_through(const Crate& crate);

}  // namespace bullet_drop
