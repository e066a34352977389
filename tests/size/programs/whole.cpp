// SPDX-License-Identifier: MIT
// Runs every query there is on a file, mapped or compressed, and of its scene if it has one.
#include <boxtree/blob.h>
#include <boxtree/paper.h>

#include "queries.h"

int main(int, char** argv) {
  boxtree::use_paper_codecs();
  auto file = boxtree::File::open(argv[1]);
  if (!file && file.code() == boxtree::Errc::kFeatureUnsupported)
    file = boxtree::open_blob(argv[1]);
  if (!file) return std::puts(file.error().detail.c_str()), 1;
  return run_query(*file);
}
