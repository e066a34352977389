// SPDX-License-Identifier: MIT
#include "runtime/scene/scene_walk.h"

namespace boxtree {

bool Admission::admits(std::uint32_t instance, std::uint32_t layer) const {
  return ((layers >> layer) & 1u) != 0 && (scene.layer(layer).query_kinds & kind) != 0 &&
         scene.is_enabled(instance) && (filter == nullptr || (*filter)(instance));
}

}  // namespace boxtree
