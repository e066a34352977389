// SPDX-License-Identifier: MIT
// Counts the pages of 4 KiB that queries read: the cost of a cold file, exact and the same on every
// machine.
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

/// Number of pages that one query of a kind reads in a cold file, from opening to the answer.
struct PageCount {
  std::size_t queries = 0;
  std::size_t median = 0;
  std::size_t worst = 0;
};

struct PageFigures {
  std::size_t file_pages = 0;
  std::size_t open = 0;  // header, section table, tree table: only open and bind
  PageCount ray;         // closest hit, from outside toward random points of the bounds
  PageCount box;         // a cube as large as a leaf, at the centre of a random leaf's box
  PageCount point;       // the centre of such a box
};

/// Runs `queries` of each kind on a tree with geometry inside, each on a freshly opened file.
/// Mapped pages are protected, and the signals of reads are counted, so only one such measurement
/// can run in a process at a time. Errors: those of opening, binding and querying, kMapFailed.
Result<PageFigures> measure_pages(const std::filesystem::path& path, std::uint32_t tree,
                                  std::size_t queries);

/// What Tree::prefetch() spares the first rays on a cold file, all on the same open file.
struct FirstRays {
  std::uint32_t levels = 0;      // read ahead
  std::size_t nodes = 0;         // in these levels
  std::size_t pages_before = 0;  // open, bind and prefetch
  std::size_t pages_more = 0;    // what the rays then still read
};

/// Casts `rays` rays, those of PageFigures::ray, after reading 0, 1, ... levels ahead, up to all
/// levels of the tree. Restrictions and errors as above.
Result<std::vector<FirstRays>> measure_first_rays(const std::filesystem::path& path,
                                                  std::uint32_t tree, std::size_t rays);

/// The pages of a file that `read` reads, in the order of the file. Restrictions and errors as
/// above.
Result<std::vector<std::size_t>> pages_read(const std::filesystem::path& path,
                                            const std::function<Status(Bytes file)>& read);

}  // namespace boxtree::cooker
