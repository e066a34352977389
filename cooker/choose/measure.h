// SPDX-License-Identifier: MIT
// Measures times of queries, together with counts of their answers.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include <boxtree/error.h>

#include "cooker/choose/workload.h"
#include "cooker/system/process.h"

namespace boxtree::cooker {

/// The upper median. Precondition: values is not empty.
[[nodiscard]] inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// By which vectors the wide codecs are walked, by this build on this machine: "AVX2"; "none".
[[nodiscard]] const char* instruction_set() noexcept;

/// Processor time of one call in seconds, including the kernel, excluding other work on the machine
/// (thread_seconds).
template <class Body>
[[nodiscard]] double seconds_taken(Body body) {
  const double start = thread_seconds();
  body();
  return thread_seconds() - start;
}

/// The median of `runs` calls in seconds, after one call that is not counted.
template <class Body>
[[nodiscard]] double median_seconds(std::size_t runs, Body body) {
  body();
  std::vector<double> seconds;
  for (std::size_t i = 0; i < runs; ++i) seconds.push_back(seconds_taken(body));
  return median(std::move(seconds));
}

/// Times of one kind of queries. A query's time is the least of several runs, because other work on
/// the machine can only add to it.
struct KindTimes {
  double median_ns = 0;
  double p99_ns = 0;
  double mean_ns = 0;
};

/// The time that two readings of the clock take; it is part of every time of a single query.
[[nodiscard]] double clock_cost_ns();

/// Times each query separately. `run_query` returns an Errc; `status` receives the first error.
template <class Query, class RunQuery>
[[nodiscard]] KindTimes time_each(const std::vector<Query>& queries, std::size_t runs,
                                  Status& status, RunQuery run_query) {
  using Clock = std::chrono::steady_clock;
  if (queries.empty()) return {};
  const double clock = clock_cost_ns();
  std::vector<double> least(queries.size(), std::numeric_limits<double>::infinity());
  for (std::size_t run = 0; run < runs; ++run) {
    for (std::size_t i = 0; i < queries.size(); ++i) {
      const Clock::time_point start = Clock::now();
      const Errc error = run_query(queries[i]);
      const std::chrono::duration<double, std::nano> taken = Clock::now() - start;
      least[i] = std::min(least[i], std::max(0.0, taken.count() - clock));
      if (error != Errc::kOk && status.ok()) status = error;
    }
  }
  std::sort(least.begin(), least.end());
  return {least[least.size() / 2], least[(least.size() - 1) * 99 / 100],
          std::accumulate(least.begin(), least.end(), 0.0) / static_cast<double>(least.size())};
}

/// Mean times per query, and totals of the answers.
struct QueryFigures {
  double ray_ns = 0;
  double ray_batch_ns = 0;  // the same rays by closest_hits()
  double camera_ns = 0;
  double camera_batch_ns = 0;
  double cast_sphere_ns = 0;
  double box_ns = 0;
  double box_batch_ns = 0;  // the same boxes by overlap_boxes()
  double point_ns = 0;
  double point_batch_ns = 0;  // the same points by closest_points()
  double lattice_ns = 0;
  double lattice_batch_ns = 0;
  double ball_ns = 0;  // whether spheres around the lattice touch
  double ball_batch_ns = 0;
  double pair_first_us = 0;
  double pair_all_us = 0;
  std::uint64_t ray_hits = 0;
  std::uint64_t camera_hits = 0;
  std::uint64_t cast_sphere_hits = 0;
  std::uint64_t box_faces = 0;
  double point_distance = 0;  // sum
  std::uint64_t pair_hits = 0;
  std::uint64_t pair_pairs = 0;
};

/// Runs every kind of query on one tree in one thread; pair queries test the tree against itself.
/// Errors: those of the queries.
Result<QueryFigures> measure_queries(const Tree& tree, const Workload& workload, std::size_t runs);

/// One ray across the middle: the query that ends every time to the first answer.
Status first_query(const Tree& tree);

/// Times from a closed file in the page cache to answers.
struct OpenFigures {
  double open_us = 0;             // open and bind
  double first_answer_us = 0;     // open, bind and one ray
  std::uint64_t page_faults = 0;  // of all of it: pages that the ray touched, not the whole file
};
Result<OpenFigures> measure_open(const std::filesystem::path& path, std::uint32_t tree,
                                 std::size_t runs);

/// Bounds of a tree in object space; a point at the origin if it is empty.
[[nodiscard]] Eigen::AlignedBox3d bounds_in_object_space(const Tree& tree);

}  // namespace boxtree::cooker
