// SPDX-License-Identifier: MIT
// Crates fall on stairs and hills, once on a mapped tree and once on Bullet's own triangle mesh.
//   bullet_drop [LEVEL.bxt]     path of the cooked level to write [default: level.bxt]
#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btTriangleIndexVertexArray.h>
#include <cstdio>

#include "samples/bullet_drop/drop.h"
#include "samples/bullet_drop/level_file.h"
#include "samples/bullet_drop/mapped_shape.h"

int main(int argc, char** argv) {
  if (argc > 2 || (argc == 2 && argv[1][0] == '-')) {
    std::fputs("usage: bullet_drop [LEVEL.bxt]\n", stderr);
    return 2;
  }
  const char* const path = argc > 1 ? argv[1] : "level.bxt";
  bullet_drop::Level level = bullet_drop::make_level();
  if (const auto written = bullet_drop::cook_level(level, path); !written) {
    std::fprintf(stderr, "%s\n", written.error().message().c_str());
    return 1;
  }
  const auto file = boxtree::File::open(path);
  if (!file) {
    std::fprintf(stderr, "%s\n", file.error().message().c_str());
    return 1;
  }
  const auto tree = boxtree::Tree::bind(*file);
  if (!tree) {
    std::fprintf(stderr, "%s\n", tree.error().message().c_str());
    return 1;
  }
  bullet_drop::MappedShape mapped(*tree);
  btTriangleIndexVertexArray arrays = bullet_drop::arrays_of(level);
  btBvhTriangleMeshShape own(&arrays, true);

  const auto ours = bullet_drop::drop_crates(mapped);
  const auto theirs = bullet_drop::drop_crates(own);
  std::puts("crate   at rest, mapped tree (x y z)   apart from Bullet's mesh, mm   tilt, degrees");
  bool good = true;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    const btVector3& at = ours[i].position;
    const bool rests = ours[i].at_rest && !has_fallen_through(ours[i]);
    good &= rests;
    std::printf("%5zu   %9.4f %9.4f %9.4f   %29.3f   %13.2f%s\n", i, double(at.x()), double(at.y()),
                double(at.z()), 1e3 * double((at - theirs[i].position).length()),
                double(ours[i].tilt_degrees), rests ? "" : "   does not rest on the level");
  }
  return good ? 0 : 1;
}
