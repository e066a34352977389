// SPDX-License-Identifier: MIT
// Runs every query there is on a mapped file.
#include "queries.h"

int main(int, char** argv) {
  const auto file = boxtree::File::open(argv[1]);
  if (!file) return std::puts(file.error().detail.c_str()), 1;
  const auto tree = boxtree::Tree::bind(*file, 0);
  if (!tree || !run_shapes(*tree)) return 1;
  return run_query(*file);
}
