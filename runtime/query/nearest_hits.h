// SPDX-License-Identifier: MIT
// The first of all hits of a ray, in order: what trees and scenes share, and C callers, whose hits
// are other structs.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include <boxtree/ray.h>

namespace boxtree {

/// Whether nearest_hits() has `a` before `b`.
[[nodiscard]] bool comes_first(const Tree& tree, const RayHit& a, const RayHit& b) noexcept;

/// Room for hits in a caller's array.
template <class Hit>
class HitRoom {
 public:
  explicit HitRoom(std::span<Hit> hits) noexcept : hits_(hits) {}

  [[nodiscard]] std::size_t size() const noexcept { return hits_.size(); }
  [[nodiscard]] const Hit& read(std::size_t i) const noexcept { return hits_[i]; }
  void write(std::size_t i, const Hit& hit) const noexcept { hits_[i] = hit; }
  void move(std::size_t from, std::size_t to) const noexcept { hits_[to] = hits_[from]; }

 private:
  std::span<Hit> hits_;
};

/// Fills `room` with the first hits of `subject`, a tree or a scene, and returns how many there
/// are. `Room`: HitRoom, or what has its functions.
template <class Subject, class Room, class Options>
[[nodiscard]] Result<std::size_t> first_hits(const Subject& subject, const Ray& ray,
                                             const Room& room, const Options& options) {
  std::size_t count = 0;
  const auto keep = [&](const auto& hit) {
    std::size_t place = count;
    while (place > 0 && comes_first(subject, hit, room.read(place - 1))) --place;
    if (place < room.size()) {
      count = std::min(count + 1, room.size());
      for (std::size_t i = count - 1; i > place; --i) room.move(i - 1, i);
      room.write(place, hit);
    }
    if (count < room.size()) return ray.t_max;
    return count == 0 ? -1.0 : room.read(count - 1).t;
  };
  const Result<Visit> visited = all_hits(subject, ray, keep, options);
  if (!visited) return visited.error();
  return count;
}

}  // namespace boxtree
