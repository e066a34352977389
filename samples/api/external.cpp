// SPDX-License-Identifier: MIT
// A tree without positions, over a mesh that the application has in memory anyway.
//   external crate.bxt          (cooked from samples/meshes/crate.obj with --external)
#include <cstdio>

#include <boxtree/boxtree.h>

// Positions, faces and their order are those of crate.obj.
static const float kPositions[][3] = {{-0.5, -0.5, 0}, {0.5, -0.5, 0},  {-0.5, 0.5, 0},
                                      {0.5, 0.5, 0},   {-0.5, -0.5, 1}, {0.5, -0.5, 1},
                                      {-0.5, 0.5, 1},  {0.5, 0.5, 1}};
static const std::uint16_t kQuads[][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                          {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};

int main(int argument_count, char** arguments) {
  if (argument_count != 2) {
    std::fputs("usage: external crate.bxt\n", stderr);
    return 2;
  }
  const auto file = boxtree::File::open(arguments[1]);
  if (!file) {
    std::fprintf(stderr, "%s\n", file.error().message().c_str());
    return 1;
  }
  // The arrays have to outlive the tree. verify_mesh reads all of them once: other arrays than
  // those that were cooked are an error here, and wrong answers without it.
  const auto tree = boxtree::Tree::bind(
      *file,
      {.mesh = boxtree::external_mesh(kPositions[0], 8, kQuads[0], 6, 4), .verify_mesh = true});
  if (!tree) {
    std::fprintf(stderr, "%s\n", tree.error().message().c_str());
    return 1;
  }
  const auto hit = boxtree::closest_hit(*tree, {{0.25, 0.25, 3}, {0, 0, -1}});
  if (!hit.has_value()) return 1;
  std::printf("t %g, face %u of my own arrays\n", hit->t, hit->face.id);
}
