// SPDX-License-Identifier: MIT
// Choosing among encodings of the same tree, by bytes and by counted work, never by a clock.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cooker/choose/cost.h"
#include "cooker/proof/gates.h"
#include "format/scene_record.h"

namespace boxtree::cooker {

/// What the user values.
enum class Goal : std::uint8_t { kMemory, kSpeed, kBalance };

[[nodiscard]] const char* goal_name(Goal goal) noexcept;

/// What is required of a choice. Among the candidates that keep to both budgets: the fewest bytes,
/// the least slowdown, or the smallest product of both.
struct Wishes {
  Goal goal = Goal::kBalance;
  std::optional<double> max_bytes_per_triangle;  // nodes and geometry
  std::optional<double> max_slowdown;            // of the fastest candidate, see slowdowns()
  QueryKinds queries = kAllQueries;              // whose time counts; none: all
};

/// One encoding that was tried.
struct Candidate {
  CodecId codec{};
  GeometryId geometry = GeometryId::kExact;
  std::uint64_t tree_bytes = 0;
  std::uint64_t geometry_bytes = 0;
  double max_vertex_error = 0;  // object space
  WorkOfKinds work{};
  QueryCost cost{};
  Gates gates;
  std::string rejected;  // why it was not chosen; empty for the chosen one

  [[nodiscard]] std::uint64_t bytes() const { return tree_bytes + geometry_bytes; }
};

/// One encoding that cannot win, and why.
struct NotTried {
  CodecId codec{};
  GeometryId geometry = GeometryId::kExact;
  std::string why;
};

/// The candidates of one tree.
struct Contest {
  std::uint32_t triangles = 0;
  std::vector<Candidate> candidates;
  std::vector<NotTried> not_tried;
  QueryKinds queries = kAllQueries;  // that its choice counted
};

/// Which candidates may be chosen: those that pass their gates and that boxtree::runtime alone can
/// read. Codecs of boxtree::paper are there to compare with, and chosen where nothing else was
/// tried, as when one was requested.
[[nodiscard]] std::vector<bool> may_be_chosen(std::span<const Candidate> candidates);

/// How many times as long each candidate takes as the fastest one that may be chosen: the mean over
/// the kinds of queries that count of the ratios of costs, each kind against its own fastest.
[[nodiscard]] std::vector<double> slowdowns(std::span<const Candidate> candidates,
                                            QueryKinds queries = kAllQueries);

/// Chooses for trees that share a file, one candidate each, all with the same geometry store, so
/// that what touches still does. Fills Candidate::rejected of the others; ties go to the earlier
/// candidate. Returns the number of the chosen candidate of each tree. Errors: kInternal when
/// nothing may be chosen; kBudgetUnreachable, naming the nearest that is possible.
Result<std::vector<std::size_t>> choose(std::span<Contest> trees, const Wishes& wishes);

/// The same when each tree has wishes of its own, as many as trees; the store that all share is
/// the one with the least total score, scores being relative to the best of each tree.
Result<std::vector<std::size_t>> choose_each(std::span<Contest> trees,
                                             std::span<const Wishes> wishes);

}  // namespace boxtree::cooker
