// SPDX-License-Identifier: MIT
// Stands something on the level, and do two points see each other?
//   ray level.bxt
#include <cstdio>

#include <boxtree/boxtree.h>

using Eigen::Vector3d;

int main(int argument_count, char** arguments) {
  if (argument_count != 2) {
    std::fputs("usage: ray level.bxt\n", stderr);
    return 2;
  }
  const auto file = boxtree::File::open(arguments[1]);
  const auto tree = file ? boxtree::Tree::bind(*file) : file.error();
  if (!tree) {
    std::fprintf(stderr, "%s\n", tree.error().message().c_str());
    return 1;
  }

  const boxtree::Ray down{.origin = {2.5, 0, 10}, .direction = {0, 0, -1}};
  const auto hit = boxtree::closest_hit(*tree, down);
  if (!hit.ok()) return 1;  // an error; a miss is ok() and false
  if (hit)
    std::printf("t %g, normal (%g, %g, %g)\n", hit->t, hit->normal[0], hit->normal[1],
                hit->normal[2]);

  // A segment: t runs from 0 at the eye to 1 at the goal.
  const Vector3d eye(2.5, 0, 2);
  for (const Vector3d& goal : {Vector3d(2.5, 0, 0.125), Vector3d(-2, 0, 1)}) {
    const bool is_hidden = bool(boxtree::any_hit(*tree, {eye, goal - eye, 0, 1}));
    std::printf("goal at x %g: %s\n", goal[0], is_hidden ? "hidden" : "seen");
  }
  return 0;
}
