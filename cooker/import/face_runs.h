// SPDX-License-Identifier: MIT
// Builds runs of faces with one number, face by face.
#pragma once

#include <cstdint>
#include <vector>

#include "format/face_numbers.h"

namespace boxtree::cooker {

/// Appends a face to `runs`, of which the first starts at face 0 whatever its id. Precondition: the
/// id is greater than those before.
inline void add_face_to(std::vector<FaceRun>& runs, std::uint32_t id, std::uint32_t number) {
  if (!runs.empty() && runs.back().number == number) return;
  runs.push_back({runs.empty() ? 0 : id, number});
}

}  // namespace boxtree::cooker
