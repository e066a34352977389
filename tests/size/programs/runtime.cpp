// SPDX-License-Identifier: MIT
// Runs every query but casts and contacts of shapes on a mapped file: what boxtree::runtime alone
// takes.
#include "queries.h"

int main(int, char** argv) {
  const auto file = boxtree::File::open(argv[1]);
  if (!file) return std::puts(file.error().detail.c_str()), 1;
  return run_query(*file);
}
