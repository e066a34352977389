// SPDX-License-Identifier: MIT
// Rays in the scene of any file.
#include "tests/fuzz/tree_target.h"

namespace boxtree::fuzz {

void run(Bytes input) {
  query_scene(input, [](const Scene& scene, const QueryInput& query, const auto& check) {
    const Ray ray{query.vector(0), query.vector(3)};
    const LayerMask layers = query.option(1) == 0 ? kAllLayers : query.option(1);
    const auto closest = closest_hit(scene, ray, layers, query.limits());
    const auto any = any_hit(scene, ray, layers, query.limits());
    check(closest);
    check(any);
    if (closest.ok() && any.ok() && closest.has_value() != any.has_value()) {
      finding("closest_hit and any_hit differ");
    }
    // What an answer names is there.
    if (closest.has_value()) {
      const std::uint32_t instance = closest->instance;
      const Result<InstanceInfo> info = scene.info(instance);
      if (!info) finding("a hit names no instance");
      static_cast<void>(scene.trees()[info->tree].user_data(closest->face));
      static_cast<void>(scene.material_name(scene.material({instance, closest->face})));
    }
  });
}

}  // namespace boxtree::fuzz
