// SPDX-License-Identifier: MIT
// Which links of an arm touch the ground? Each is some balls, and the first face that a ball
// touches is enough.
//   overlap_batch level.bxt
#include <array>
#include <cstdio>

#include <boxtree/boxtree.h>

int main(int argument_count, char** arguments) {
  if (argument_count != 2) {
    std::fputs("usage: overlap_batch level.bxt\n", stderr);
    return 2;
  }
  const auto file = boxtree::File::open(arguments[1]);
  const auto tree = file ? boxtree::Tree::bind(*file) : file.error();
  if (!tree) {
    std::fprintf(stderr, "%s\n", tree.error().message().c_str());
    return 1;
  }

  constexpr std::size_t kLinks = 4, kBalls = 3;
  std::array<boxtree::Sphere, kLinks * kBalls> balls;  // the arm reaches down to x = 3
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const double way = static_cast<double>(i) / (kLinks * kBalls - 1);
    balls[i] = {{3 * way, 0, 1.5 * (1 - way)}, 0.125};
  }
  std::array<boxtree::VisitResult, balls.size()> visits;
  std::array<char, balls.size()> touched;
  touched.fill('-');
  const auto visitor = [&](std::size_t ball, const boxtree::FaceRef& face) {
    touched[ball] = face.id == 0 ? 'f' : 'p';  // the floor, or a plate
    return false;                              // no more faces of this ball
  };
  if (!boxtree::overlap_spheres(*tree, balls, visits, visitor).ok()) return 1;
  for (std::size_t link = 0; link < kLinks; ++link)
    std::printf("link %zu: %.*s\n", link, static_cast<int>(kBalls), &touched[link * kBalls]);
  for (const boxtree::VisitResult& visit : visits)
    if (!visit.ok()) return 1;  // each ball has a result of its own
  return 0;
}
