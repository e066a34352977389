// SPDX-License-Identifier: MIT
#include "cooker/import/face_materials.h"

#include "cooker/import/face_runs.h"

namespace boxtree::cooker {

void MaterialUse::add_face(std::uint32_t face) {
  if (!has_changed_) return;
  has_changed_ = false;
  const auto [known, is_new] =
      numbers_.try_emplace(current_, static_cast<std::uint32_t>(out_.names.size()));
  if (is_new) out_.names.push_back(current_);
  add_face_to(out_.runs, face, known->second);
}

void MaterialUse::finish() {
  if (out_.names.size() == 1 && out_.names[0] == unnamed_) out_ = {};
}

}  // namespace boxtree::cooker
