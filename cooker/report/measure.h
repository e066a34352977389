// SPDX-License-Identifier: MIT
// Times of queries, always beside the counts of their answers.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <utility>
#include <vector>

#include <boxtree/cooker/report/workload.h>
#include <boxtree/format/result.h>

namespace boxtree::cooker {

/// The upper median. Precondition: values is not empty.
[[nodiscard]] inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The median of `runs` calls in seconds, after one call that is not counted.
template <class Body>
[[nodiscard]] double median_seconds(std::size_t runs, Body body) {
  using Clock = std::chrono::steady_clock;
  std::vector<double> seconds;
  for (std::size_t i = 0; i <= runs; ++i) {
    const Clock::time_point start = Clock::now();
    body();
    const double taken = std::chrono::duration<double>(Clock::now() - start).count();
    if (i > 0) seconds.push_back(taken);
  }
  return median(std::move(seconds));
}

/// Times of one query each, and what was answered in all of them.
struct QueryFigures {
  double ray_ns = 0;
  double box_ns = 0;
  double point_ns = 0;
  double pair_first_us = 0;
  double pair_all_us = 0;
  std::uint64_t ray_hits = 0;
  std::uint64_t box_faces = 0;
  double point_distance = 0;  // sum
  std::uint64_t pair_hits = 0;
  std::uint64_t pair_pairs = 0;
};

/// Asks one tree everything, single-threaded; pairs are the tree against itself. Errors: those of
/// the queries.
Result<QueryFigures> measure_queries(const Tree& tree, const Workload& workload, std::size_t runs);

/// From a closed file in the page cache to answers.
struct OpenFigures {
  double open_us = 0;             // open and bind
  double first_answer_us = 0;     // open, bind and one ray
  std::uint64_t page_faults = 0;  // of all of it: what the ray touched, not what the file holds
};
Result<OpenFigures> measure_open(const std::filesystem::path& path, std::uint32_t tree,
                                 std::size_t runs);

/// Bounds of a tree in object space; a point at the origin if it is empty.
[[nodiscard]] Eigen::AlignedBox3d bounds_in_object_space(const Tree& tree);

}  // namespace boxtree::cooker
