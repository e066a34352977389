// SPDX-License-Identifier: MIT
// How much of a file queries read, in pages of 4 KiB: what a cold file costs, counted exactly and
// the same on every machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include <boxtree/error.h>

#include "format/bytes.h"
#include "runtime/tree/bound_tree.h"

namespace boxtree::cooker {

/// Pages that one query of a kind reads in a file of which nothing has been read, from opening
/// to the answer.
struct PageCount {
  std::size_t queries = 0;
  std::size_t median = 0;
  std::size_t worst = 0;
};

struct PageFigures {
  std::size_t file_pages = 0;
  std::size_t open = 0;  // header, section table, tree table: open and bind alone
  PageCount ray;         // closest hit, from outside toward random points of the bounds
  PageCount box;         // a cube as large as a leaf, in the middle of a random leaf's box
  PageCount point;       // the middle of such a box
};

/// Runs `queries` of each kind on a tree with geometry inside, a fresh file for each. Mapped
/// pages are kept from being read, and signals of those that are nevertheless are counted; so not
/// two of these at a time in one program. Errors: those of opening, binding and querying,
/// kMapFailed.
Result<PageFigures> measure_pages(const std::filesystem::path& path, std::uint32_t tree,
                                  std::size_t queries);

/// The pages of a file that `read` reads, in the order of the file; likewise.
Result<std::vector<std::size_t>> pages_read(const std::filesystem::path& path,
                                            const std::function<Status(Bytes file)>& read);

}  // namespace boxtree::cooker
