// SPDX-License-Identifier: MIT
// A file that is not there, and a query that makes no sense.
//   errors level.bxt
#include <cstdio>

#include <boxtree/boxtree.h>

int main(int argument_count, char** arguments) {
  if (argument_count != 2) {
    std::fputs("usage: errors level.bxt\n", stderr);
    return 2;
  }
  const auto missing = boxtree::File::open("no-such-file.bxt");
  if (!missing) std::printf("%s\n", missing.error().message().c_str());

  const auto file = boxtree::File::open(arguments[1]);
  const auto tree = file ? boxtree::Tree::bind(*file) : file.error();
  if (!tree) {
    std::fprintf(stderr, "%s\n", tree.error().message().c_str());
    return 1;
  }

  const auto hit = boxtree::closest_hit(*tree, {{0, 0, 1}, {0, 0, 0}});  // no direction
  if (!hit.ok()) {
    const boxtree::ErrcInfo& info = boxtree::error_info(hit.code());
    std::printf("%d %.*s\n", int(info.code), int(info.name.size()), info.name.data());
  }
  return 0;
}
