// SPDX-License-Identifier: MIT
// Groups of faces by a hash table of their corner positions.
#include "cooker/build/duplicates.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <tuple>

#include "cooker/import/hash_mix.h"
#include "cooker/system/prefetch.h"

namespace boxtree::cooker {
namespace {

// The bits of a face's corners, one after another.
class FaceBits {
 public:
  explicit FaceBits(const MeshView& mesh)
      : mesh_(mesh),
        is_f32_(mesh.positions.precision == Precision::kF32),
        stride_(3 * (is_f32_ ? sizeof(float) : sizeof(double))) {}

  [[nodiscard]] std::uint64_t hash(std::size_t face) const {
    const std::size_t count = corners(face);
    std::uint64_t mixed = count;
    for (std::size_t i = 0; i < count; ++i) {
      const void* const position = corner(face, i);
      mixed = is_f32_ ? mix<std::uint32_t>(mixed, position) : mix<std::uint64_t>(mixed, position);
    }
    return mixed;
  }

  [[nodiscard]] bool are_same(std::size_t a, std::size_t b) const {
    const std::size_t count = corners(a);
    if (count != corners(b)) return false;
    for (std::size_t i = 0; i < count; ++i) {
      if (mesh_.faces[a].corner[i] == mesh_.faces[b].corner[i]) continue;
      if (std::memcmp(corner(a, i), corner(b, i), stride_) != 0) return false;
    }
    return true;
  }

 private:
  [[nodiscard]] std::size_t corners(std::size_t face) const {
    return mesh_.faces[face].is_quad() ? 4 : 3;
  }
  template <class Bits>
  [[nodiscard]] static std::uint64_t mix(std::uint64_t mixed, const void* position) {
    std::array<Bits, 3> bits;
    std::memcpy(bits.data(), position, sizeof(bits));
    for (const Bits x : bits) mixed = hash_with(mixed, x);
    return mixed;
  }
  [[nodiscard]] const void* corner(std::size_t face, std::size_t i) const {
    const std::size_t first = std::size_t{3} * mesh_.faces[face].corner[i];
    if (is_f32_) return mesh_.positions.f32.data() + first;
    return mesh_.positions.f64.data() + first;
  }

  MeshView mesh_;
  bool is_f32_;
  std::size_t stride_;
};

// For each face, the first face with the same corners.
std::vector<std::uint32_t> first_of_group(const MeshView& mesh) {
  constexpr std::uint32_t kFree = 0xffffffffu;
  const FaceBits bits(mesh);
  const std::size_t faces = mesh.faces.size();
  std::vector<std::uint32_t> first(faces);
  // At most half full, so that searches end. The bits of a slot that its face leaves are those of
  // its hash: others are nearly never compared, whose corners are far away in memory. All bits are
  // set in free slots only, because numbers of faces are smaller.
  std::vector<std::uint32_t> slots(std::bit_ceil(2 * faces + 1), kFree);
  const auto number_bits = static_cast<std::uint32_t>(std::bit_width(faces));
  const std::uint32_t number_mask = (std::uint32_t{1} << number_bits) - 1;
  const auto slot_of = [&](std::uint64_t hash) { return hash & (slots.size() - 1); };
  // The memory of some slots is fetched together.
  std::array<std::uint64_t, 64> hash;
  for (std::size_t begin = 0; begin < faces; begin += hash.size()) {
    const std::size_t count = std::min(hash.size(), faces - begin);
    for (std::size_t i = 0; i < count; ++i) {
      hash[i] = bits.hash(begin + i);
      prefetch(&slots[slot_of(hash[i])]);
    }
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t face = begin + i;
      const auto entry =
          static_cast<std::uint32_t>((hash[i] >> 32 & ~std::uint64_t{number_mask}) | face);
      std::size_t slot = slot_of(hash[i]);
      const auto is_other = [&](std::uint32_t met) {
        return ((met ^ entry) & ~number_mask) != 0 || !bits.are_same(met & number_mask, face);
      };
      while (slots[slot] != kFree && is_other(slots[slot])) slot = slot_of(slot + 1);
      if (slots[slot] == kFree) slots[slot] = entry;
      first[face] = slots[slot] & number_mask;
    }
  }
  return first;
}

}  // namespace

Duplicates find_duplicates(const MeshView& mesh) {
  Duplicates found;
  found.original = first_of_group(mesh);
  for (std::size_t i = 0; i < found.original.size(); ++i) found.count += found.original[i] != i;
  if (found.count == 0) return {};
  std::vector<std::uint32_t> best(found.original);  // of the group of a first face
  for (std::uint32_t i = 0; i < found.original.size(); ++i) {
    std::uint32_t& of_group = best[found.original[i]];
    if (mesh.face_id(i) < mesh.face_id(of_group)) of_group = i;
  }
  for (std::uint32_t& original : found.original) original = best[original];
  return found;
}

std::vector<std::uint32_t> append_duplicates(const MeshView& mesh, const Duplicates& duplicates,
                                             std::vector<std::uint32_t>& order) {
  std::vector<std::uint32_t> places;
  if (duplicates.count == 0) return places;
  std::vector<std::uint32_t> place(mesh.faces.size());  // of an original
  for (std::size_t i = 0; i < order.size(); ++i) place[order[i]] = static_cast<std::uint32_t>(i);
  const auto originals = static_cast<std::ptrdiff_t>(order.size());
  for (std::uint32_t i = 0; i < mesh.faces.size(); ++i) {
    if (!duplicates.is_original(i)) order.push_back(i);
  }
  const auto place_of = [&](std::uint32_t face) { return place[duplicates.original[face]]; };
  std::sort(order.begin() + originals, order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::tuple(place_of(a), mesh.face_id(a), a) <
           std::tuple(place_of(b), mesh.face_id(b), b);
  });
  places.reserve(duplicates.count);
  for (auto face = order.begin() + originals; face != order.end(); ++face) {
    places.push_back(place_of(*face));
  }
  return places;
}

}  // namespace boxtree::cooker
