// SPDX-License-Identifier: MIT
// Cooks a level with its profile, like `boxtree cook --profile scene.toml -o level.bxt --why`:
//   cook_level scene.toml level.bxt
#include <cstdio>
#include <filesystem>

#include "cooker/shell/cook_job.h"

namespace cooker = boxtree::cooker;

int main(int argument_count, char** arguments) {
  if (argument_count != 3) {
    std::fputs("usage: cook_level PROFILE.toml OUTPUT.bxt\n", stderr);
    return 1;
  }
  const auto cooked = cooker::cook_job({.output = arguments[2], .profile = arguments[1]});
  if (!cooked) {
    std::fprintf(stderr, "%s\n", cooked.error().message().c_str());
    return 1;
  }
  std::printf("%u instances (%u moving) of %zu meshes: %llu triangles in %llu bytes\n",
              cooked->scene->instances, cooked->scene->moving, cooked->trees.size(),
              static_cast<unsigned long long>(cooked->scene->placed_triangles),
              static_cast<unsigned long long>(cooked->file_bytes));
  for (const cooker::CookedTree& tree : cooked->trees) {
    std::printf("  %-8s %5u triangles  %s, geometry %s\n", tree.tree.name.c_str(),
                tree.tree.triangle_count, codec_name(tree.tree.nodes.codec).data(),
                geometry_name(tree.tree.geometry.geometry).data());
  }
  for (const cooker::WhyLine& line : cooked->why) {
    if (line.kept || line.bytes == 0) continue;
    std::printf("  left out: %s of %s, about %llu bytes: %s\n", line.part.c_str(),
                line.owner.c_str(), static_cast<unsigned long long>(line.bytes),
                line.line.empty() ? line.reason.c_str() : line.line.c_str());
  }
  return 0;
}
