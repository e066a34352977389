// SPDX-License-Identifier: MIT
// Rates each candidate by one number; the smallest wins. Only sums, products and quotients are
// used: a library's logarithm or root differs between machines.
#include "cooker/choose/choose.h"

#include <algorithm>
#include <array>
#include <limits>

#include <fmt/format.h>

namespace boxtree::cooker {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// Geometry stores with the same positions: trees with either still touch where their meshes do.
enum class Positioning : std::uint8_t { kExternal, kLossless, kOnGrid };
constexpr std::array kPositionings = {Positioning::kExternal, Positioning::kLossless,
                                      Positioning::kOnGrid};

Positioning positioning_of(GeometryId geometry) {
  if (geometry == GeometryId::kExternal) return Positioning::kExternal;
  return is_lossless(geometry) ? Positioning::kLossless : Positioning::kOnGrid;
}

struct Rated {
  double bytes = 0;  // per triangle
  double slowdown = 0;
  bool eligible = false;     // see may_be_chosen()
  double score = kInfinite;  // infinite if not eligible or over a budget
};

double score_of(double bytes, double slowdown, Goal goal) {
  switch (goal) {
    case Goal::kMemory:
      return bytes;
    case Goal::kSpeed:
      return slowdown;
    case Goal::kBalance:
      break;
  }
  return bytes * slowdown;
}

std::vector<Rated> rate(const Contest& tree, const Wishes& wishes) {
  const std::vector<double> slower = slowdowns(tree);
  const std::vector<bool> eligible = may_be_chosen(tree.candidates);
  std::vector<Rated> rated;
  for (std::size_t i = 0; i < tree.candidates.size(); ++i) {
    const Candidate& candidate = tree.candidates[i];
    Rated of{
        static_cast<double>(candidate.bytes()) / std::max(1.0, static_cast<double>(tree.triangles)),
        slower[i], eligible[i], kInfinite};
    const bool in_budget = of.bytes <= wishes.max_bytes_per_triangle.value_or(kInfinite) &&
                           of.slowdown <= wishes.max_slowdown.value_or(kInfinite);
    if (of.eligible && in_budget) of.score = score_of(of.bytes, of.slowdown, wishes.goal);
    rated.push_back(of);
  }
  return rated;
}

// The best candidate with such positions; empty if none may be chosen.
std::optional<std::size_t> best_of(const Contest& tree, const std::vector<Rated>& rated,
                                   Positioning positioning) {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < rated.size(); ++i) {
    const bool fits = positioning_of(tree.candidates[i].geometry) == positioning;
    if (!fits || rated[i].score == kInfinite) continue;
    if (!best || rated[i].score < rated[*best].score) best = i;
  }
  return best;
}

// The fewest bytes and the least slowdown possible for a tree, each with its candidate.
std::string nearest_of(const Contest& tree, const std::vector<Rated>& rated) {
  std::optional<std::size_t> smallest, fastest;
  for (std::size_t i = 0; i < rated.size(); ++i) {
    if (!rated[i].eligible) continue;
    if (!smallest || rated[i].bytes < rated[*smallest].bytes) smallest = i;
    if (!fastest || rated[i].slowdown < rated[*fastest].slowdown) fastest = i;
  }
  const auto told = [&](std::size_t i) {
    return fmt::format("{} with geometry {} takes {:.2f} B/tri, slowdown {:.2f}",
                       codec_name(tree.candidates[i].codec),
                       geometry_name(tree.candidates[i].geometry), rated[i].bytes,
                       rated[i].slowdown);
  };
  return smallest == fastest ? told(*smallest) : told(*smallest) + "; " + told(*fastest);
}

// The remedy where bytes are too few.
constexpr const char* kFewerBytes =
    "; fewer bytes take a tolerance (cook --tolerance LENGTH, tolerance of a profile), by which "
    "vertices may move";

Error refusal(const Contest& tree, const std::vector<Rated>& rated, const Wishes& wishes) {
  const bool any_eligible =
      std::any_of(rated.begin(), rated.end(), [](const Rated& each) { return each.eligible; });
  if (!any_eligible) return {Errc::kInternal, "no encoding passes its gates"};
  std::string wanted;
  if (wishes.max_bytes_per_triangle) {
    wanted += fmt::format("at most {} B/tri", *wishes.max_bytes_per_triangle);
  }
  if (wishes.max_slowdown) {
    wanted += fmt::format("{}a slowdown of at most {}", wanted.empty() ? "" : " and ",
                          *wishes.max_slowdown);
  }
  return {Errc::kBudgetUnreachable, "wanted " + wanted + "; " + nearest_of(tree, rated) +
                                        fmt::format(" (slowdown: {})", kSlowdownMeaning) +
                                        (wishes.max_bytes_per_triangle ? kFewerBytes : "")};
}

std::string reason(const Candidate& candidate, const Rated& rated, const Candidate& chosen,
                   const Rated& chosen_rated, const Wishes& wishes) {
  if (!candidate.gates.pass()) {
    return fmt::format("fails its gates: {} faces missed, {} boxes escaped", candidate.gates.missed,
                       candidate.gates.escapes);
  }
  if (!is_wide(candidate.codec) && is_wide(chosen.codec)) {
    return "a codec of boxtree::paper: --codec chooses it";
  }
  if (rated.bytes > wishes.max_bytes_per_triangle.value_or(kInfinite)) return kOverBytes;
  if (rated.slowdown > wishes.max_slowdown.value_or(kInfinite)) return kOverTime;
  const bool is_placed_otherwise =
      positioning_of(candidate.geometry) != positioning_of(chosen.geometry);
  if (is_placed_otherwise && rated.score == kInfinite) return "another geometry";
  if (is_placed_otherwise && rated.score <= chosen_rated.score) {
    return fmt::format("no worse alone, but the trees of the file share geometry {}",
                       geometry_name(chosen.geometry));
  }
  switch (wishes.goal) {
    case Goal::kMemory:
      return rated.bytes > chosen_rated.bytes ? "more bytes" : "as many bytes, tried later";
    case Goal::kSpeed:
      return rated.slowdown > chosen_rated.slowdown ? "more time" : "as much time, tried later";
    case Goal::kBalance:
      break;
  }
  return rated.score > chosen_rated.score ? "larger product of bytes and time"
                                          : "the same product of bytes and time, tried later";
}

}  // namespace

const char* goal_name(Goal goal) noexcept {
  switch (goal) {
    case Goal::kMemory:
      return "memory";
    case Goal::kSpeed:
      return "speed";
    case Goal::kBalance:
      break;
  }
  return "balance";
}

std::vector<bool> may_be_chosen(std::span<const Candidate> candidates) {
  const auto passes_wide = [](const Candidate& candidate) {
    return candidate.gates.pass() && is_wide(candidate.codec);
  };
  const bool any_wide = std::any_of(candidates.begin(), candidates.end(), passes_wide);
  std::vector<bool> eligible;
  for (const Candidate& candidate : candidates) {
    eligible.push_back(any_wide ? passes_wide(candidate) : candidate.gates.pass());
  }
  return eligible;
}

std::vector<bool> may_still_win(const Contest& tree, const Wishes& wishes) {
  const std::vector<Rated> rated = rate(tree, wishes);
  std::vector<bool> may_win(rated.size(), false);
  for (const Positioning positioning : kPositionings) {
    if (const auto best = best_of(tree, rated, positioning)) may_win[*best] = true;
  }
  return may_win;
}

bool may_want_grid(const Contest& tree, const Wishes& wishes) {
  return wishes.goal != Goal::kSpeed ||
         !best_of(tree, rate(tree, wishes), Positioning::kLossless).has_value();
}

std::vector<double> slowdowns(const Contest& tree) {
  static_assert(kQueryKinds == 4 && kRayQueries == 1 && kPairQueries == 8);  // bits in their order
  const QueryKinds queries =
      (tree.queries & kAllQueries) == 0 ? QueryKinds{kAllQueries} : tree.queries;
  std::vector<double> slower;
  for (const Candidate& candidate : tree.candidates) {
    double sum = 0;
    int counted = 0;
    for (std::size_t kind = 0; kind < kQueryKinds; ++kind) {
      if (((queries >> kind) & 1u) == 0) continue;
      // Queries on an empty tree have no cost.
      sum += tree.baseline[kind] > 0 ? candidate.cost[kind] / tree.baseline[kind] : 1;
      ++counted;
    }
    slower.push_back(sum / counted);
  }
  return slower;
}

Result<std::vector<std::size_t>> choose(std::span<Contest> trees, const Wishes& wishes) {
  const std::vector<Wishes> same(trees.size(), wishes);
  return choose_each(trees, same);
}

Result<std::vector<std::size_t>> choose_each(std::span<Contest> trees,
                                             std::span<const Wishes> wishes) {
  std::vector<std::vector<Rated>> rated;
  for (std::size_t t = 0; t < trees.size(); ++t) {
    trees[t].queries = wishes[t].queries;
    rated.push_back(rate(trees[t], wishes[t]));
  }
  const auto least_score = [&](std::size_t t) {
    double least = kInfinite;
    for (const Rated& candidate : rated[t]) least = std::min(least, candidate.score);
    return least;
  };

  std::vector<std::size_t> chosen;
  double least = kInfinite;
  for (const Positioning positioning : kPositionings) {
    std::vector<std::size_t> of_store;
    double score = 0;
    for (std::size_t t = 0; t < trees.size(); ++t) {
      const auto best = best_of(trees[t], rated[t], positioning);
      if (!best) break;
      of_store.push_back(*best);
      // At least one, so that trees without faces count, too.
      const double weight = std::max(1.0, static_cast<double>(trees[t].triangles));
      const double own = least_score(t);
      score += own > 0 ? weight * (rated[t][*best].score / own) : weight;
    }
    if (of_store.size() < trees.size()) continue;
    if (chosen.empty() || score < least) {
      chosen = std::move(of_store);
      least = score;
    }
  }
  if (chosen.empty()) {
    // Report the tree for which no candidate is possible. If every tree has one, no store suits all
    // trees; then report the first tree.
    std::size_t worst = 0;
    for (std::size_t t = trees.size(); t-- > 0;) {
      const bool possible = std::any_of(rated[t].begin(), rated[t].end(),
                                        [](const Rated& j) { return j.score != kInfinite; });
      if (!possible) worst = t;
    }
    return refusal(trees[worst], rated[worst], wishes[worst]);
  }
  for (std::size_t t = 0; t < trees.size(); ++t) {
    for (std::size_t i = 0; i < trees[t].candidates.size(); ++i) {
      Candidate& candidate = trees[t].candidates[i];
      const Candidate& winner = trees[t].candidates[chosen[t]];
      candidate.rejected =
          i == chosen[t] ? ""
                         : reason(candidate, rated[t][i], winner, rated[t][chosen[t]], wishes[t]);
    }
  }
  return chosen;
}

}  // namespace boxtree::cooker
