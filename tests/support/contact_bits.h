// SPDX-License-Identifier: MIT
// What a contact says, bit for bit.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include <boxtree/boxtree.h>

namespace boxtree::test {

/// Of a contact that names a face of the source, which all encodings name alike.
using ContactBits = std::vector<std::uint64_t>;

[[nodiscard]] inline ContactBits bits_of(const Contact& contact) {
  ContactBits bits = {contact.face.id,
                      contact.triangle,
                      static_cast<std::uint64_t>(contact.feature),
                      contact.feature_index,
                      contact.is_active ? 1u : 0u,
                      std::bit_cast<std::uint64_t>(contact.depth)};
  for (const Eigen::Vector3d& v : {contact.point, contact.normal, contact.face_normal}) {
    for (const double x : v) bits.push_back(std::bit_cast<std::uint64_t>(x));
  }
  return bits;
}

}  // namespace boxtree::test
