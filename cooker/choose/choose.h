// SPDX-License-Identifier: MIT
// Chooses among encodings of one tree by bytes and counted work, never by a clock.
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

/// What a choice minimises.
enum class Goal : std::uint8_t { kMemory, kSpeed, kBalance };

[[nodiscard]] const char* goal_name(Goal goal) noexcept;

/// The conditions of a choice. Among the candidates within both budgets, the goal selects the
/// fewest bytes, the least slowdown, or the smallest product of both.
struct Wishes {
  Goal goal = Goal::kBalance;
  std::optional<double> max_bytes_per_triangle;  // nodes and geometry
  std::optional<double> max_slowdown;            // see slowdowns()
  QueryKinds queries = kAllQueries;              // whose time counts; if none, all count
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
  std::string rejected;  // why it was not chosen; empty if chosen

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
  QueryKinds queries = kAllQueries;  // that count for the choice
  QueryCost baseline{};              // of wide8 with arrays, whether that was tried or not
  std::string mesh;                  // its name, for messages
};

/// Candidate::rejected of what a budget excludes: its bytes per triangle, its slowdown, the bytes
/// of the file.
inline constexpr const char* kOverBytes = "over the budget of bytes";
inline constexpr const char* kOverTime = "over the budget of time";
inline constexpr const char* kOverFileBytes = "over the budget of the file's bytes";

/// Which candidates may be chosen: those that pass their gates and that boxtree::runtime alone can
/// read. Codecs of boxtree::paper serve comparison; they are chosen only if nothing else was tried,
/// as when one was requested.
[[nodiscard]] std::vector<bool> may_be_chosen(std::span<const Candidate> candidates);

/// Which candidates choose() can still choose once other stores are tried and other trees are known
/// that share the file: of those with equal positions, the best one within the budgets.
/// Precondition: the baseline and the queries that count are entered.
[[nodiscard]] std::vector<bool> may_still_win(const Contest& tree, const Wishes& wishes);

/// Whether a tree may want a grid for itself, whatever was tried: bytes count, or no store without
/// loss is within the budgets. Preconditions: as may_still_win().
[[nodiscard]] bool may_want_grid(const Contest& tree, const Wishes& wishes);

/// What slowdowns are relative to, for texts.
inline constexpr const char* kSlowdownMeaning =
    "time over that of wide8 with arrays, mean over the kinds of queries";

/// The time of each candidate relative to wide8 with arrays: the mean, over the kinds of queries
/// that count, of the ratio of its cost to the baseline's. 1 where the baseline has no cost.
[[nodiscard]] std::vector<double> slowdowns(const Contest& tree);

/// Chooses one candidate for each of the trees that share a file, all with positions of the source
/// or all on the grid, so that surfaces that touch still touch. Fills Candidate::rejected of the
/// others; ties go to the earlier candidate. Returns the index of each tree's choice. Errors:
/// kInternal if nothing may be chosen; budgets_unreachable().
Result<std::vector<std::size_t>> choose(std::span<Contest> trees, const Wishes& wishes);

/// The same with separate wishes for each tree. The common store is the one with the least total
/// score; scores are relative to the best of each tree.
Result<std::vector<std::size_t>> choose_each(std::span<Contest> trees,
                                             std::span<const Wishes> wishes);

/// Why trees of one file cannot be chosen for within their budgets, with the nearest that they can:
/// numbers that serve as budgets as they are printed. `shares`: which trees share their store.
/// Preconditions: as many of each; every tree has the same budgets.
[[nodiscard]] Error budgets_unreachable(std::span<const Contest> trees,
                                        std::span<const Wishes> wishes,
                                        const std::vector<bool>& shares);

}  // namespace boxtree::cooker
