// SPDX-License-Identifier: MIT
// Any bytes as a blob; what comes out is opened and bound.
#include <boxtree/blob.h>

#include "tests/fuzz/query_input.h"
#include "tests/fuzz/target.h"

namespace boxtree::fuzz {

void run(Bytes bytes) {
  constexpr std::uint64_t kMemory = std::uint64_t{1} << 24;
  const Input input(bytes);
  const Result<File> file = open_blob(input.file(), kMemory);
  if (!file) return;
  const Result<Tree> tree = Tree::bind(*file);
  if (tree) static_cast<void>(any_hit(*tree, {input.query.vector(0), {0, 0, 1}}));
}

}  // namespace boxtree::fuzz
