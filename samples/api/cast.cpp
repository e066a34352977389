// SPDX-License-Identifier: MIT
// How far can a character, a bullet and a crate move?
//   cast level.bxt
#include <cstdio>

#include <boxtree/boxtree.h>

int main(int argument_count, char** arguments) {
  if (argument_count != 2) {
    std::fputs("usage: cast level.bxt\n", stderr);
    return 2;
  }
  const auto file = boxtree::File::open(arguments[1]);
  const auto tree = file ? boxtree::Tree::bind(*file) : file.error();
  if (!tree) {
    std::fprintf(stderr, "%s\n", tree.error().message().c_str());
    return 1;
  }

  // A character that walks 4 along x: at t_lower it touches nothing yet.
  const boxtree::Capsule body{{-2, 0, 0.4}, {-2, 0, 1.6}, 0.25};
  const boxtree::Motion walk{.direction = {4, 0, 0}, .t_max = 1};
  if (const auto hit = boxtree::cast_closest(*tree, body, walk)) {
    std::printf("walks %.3f to face %u, pushed back %.1f along x and %.1f up\n", hit->t_lower * 4,
                hit->face.id, hit->normal[0], hit->normal[2]);
  }

  // A bullet with a radius: whether it meets anything.
  const boxtree::Sphere bullet{{-2, 0, 0.6}, 0.05};
  const auto met = boxtree::cast_any(*tree, bullet, {.direction = {1, 0, 0}});
  std::printf("the bullet %s\n", met ? "hits" : "passes");

  // A turned crate that falls, and every triangle on its way. The visitor returns the t up to which
  // touches are of interest.
  boxtree::OrientedBox crate;
  crate.center = {2, 0, 3};
  crate.half_extents = {0.5, 0.5, 0.5};
  crate.rotation = {1, 0, 0, 1};  // w, x, y, z: a quarter turn about z
  int touches = 0;
  const auto visit =
      boxtree::cast_all(*tree, crate, {.direction = {0, 0, -1}}, [&](const boxtree::CastHit&) {
        ++touches;
        return 9.0;
      });
  std::printf("the crate meets %d triangles\n", touches);
  return met.ok() && visit ? 0 : 1;
}
