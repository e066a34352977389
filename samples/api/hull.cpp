// SPDX-License-Identifier: MIT
// Where does a falling gem land, and what does it touch once it has sunk in?
//   hull level.bxt
#include <cstdio>
#include <vector>

#include <boxtree/boxtree.h>

int main(int argument_count, char** arguments) {
  if (argument_count != 2) {
    std::fputs("usage: hull level.bxt\n", stderr);
    return 2;
  }
  const auto file = boxtree::File::open(arguments[1]);
  const auto tree = file ? boxtree::Tree::bind(*file) : file.error();
  if (!tree) {
    std::fprintf(stderr, "%s\n", tree.error().message().c_str());
    return 1;
  }

  // Any points, in space of their own: nobody needs to compute their hull. The last one is inside.
  const std::vector<Eigen::Vector3d> points = {{0.5, 0, 0}, {-0.5, 0, 0}, {0, 0.5, 0}, {0, -0.5, 0},
                                               {0, 0, 1},   {0, 0, -1},   {0, 0, 0.25}};
  boxtree::ConvexHull gem{points};
  gem.position = {1.5, 0, 4};
  const auto hit = boxtree::cast_closest(*tree, gem, {.direction = {0, 0, -1}});
  if (!hit) return 1;
  std::printf("lands on face %u after %.3f, its middle at height %.3f\n", hit->face.id,
              hit->t_lower, gem.position[2] - hit->t_lower);

  // Lying on its side, 0.125 too low.
  gem.rotation = {1, 1, 0, 0};  // w, x, y, z: a quarter turn about x
  gem.position = {1.25, 0, 0.625};
  std::vector<boxtree::Contact> contacts;
  const auto visit = boxtree::collide(*tree, gem, [&](const boxtree::Contact& contact) {
    contacts.push_back(contact);
    return true;
  });
  if (!visit) return 1;
  for (const boxtree::Contact& contact : contacts) {
    std::printf("face %u: out by %.3f along (%.1f, %.1f, %.1f)\n", contact.face.id, contact.depth,
                contact.normal[0], contact.normal[1], contact.normal[2]);
  }
  return 0;
}
