// SPDX-License-Identifier: MIT
// Rates each candidate by one number; the smallest wins. Only sums, products and quotients are
// used: a library's logarithm or root differs between machines.
#include "cooker/choose/choose.h"

#include <algorithm>
#include <array>
#include <limits>

#include <fmt/format.h>

#include "cooker/text/at_most.h"

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

// A candidate for each tree of a file, and the trees whose own are the largest and the slowest.
struct Reached {
  std::vector<std::size_t> candidate;
  std::size_t largest = 0, slowest = 0;
};

// What all trees of a file can keep to.
class Reachable {
 public:
  using Number = double Rated::*;

  Reachable(std::span<const Contest> trees, const std::vector<std::vector<Rated>>& rated,
            const std::vector<bool>& shares)
      : trees_(trees), rated_(rated), shares_(shares) {}

  // The candidates whose largest `least` is the least possible, while none of the other number
  // exceeds `limit`. Empty if there are none.
  [[nodiscard]] std::optional<Reached> minimum(Number least, double limit) const {
    Reached out;
    out.candidate.resize(trees_.size());
    std::vector<std::size_t> sharing;
    for (std::size_t t = 0; t < trees_.size(); ++t) {
      if (shares_[t]) {
        sharing.push_back(t);
      } else if (!minimum_of({&t, 1}, least, limit, out)) {
        return std::nullopt;
      }
    }
    if (!sharing.empty() && !minimum_of(sharing, least, limit, out)) return std::nullopt;
    for (std::size_t t = 0; t < trees_.size(); ++t) {
      if (of(out, t).bytes > of(out, out.largest).bytes) out.largest = t;
      if (of(out, t).slowdown > of(out, out.slowest).slowdown) out.slowest = t;
    }
    return out;
  }

  [[nodiscard]] const Rated& of(const Reached& reached, std::size_t tree) const {
    return rated_[tree][reached.candidate[tree]];
  }

 private:
  // Of trees that share a store.
  [[nodiscard]] bool minimum_of(std::span<const std::size_t> group, Number least, double limit,
                                Reached& out) const {
    const Number other = least == &Rated::bytes ? &Rated::slowdown : &Rated::bytes;
    double least_of_group = kInfinite;
    for (const Positioning positioning : kPositionings) {
      std::vector<std::size_t> chosen;
      double most = 0;
      for (const std::size_t t : group) {
        std::optional<std::size_t> best;
        for (std::size_t i = 0; i < rated_[t].size(); ++i) {
          const Rated& each = rated_[t][i];
          const bool fits = positioning_of(trees_[t].candidates[i].geometry) == positioning;
          if (!fits || !each.eligible || each.*other > limit) continue;
          if (!best || each.*least < rated_[t][*best].*least) best = i;
        }
        if (!best) break;
        chosen.push_back(*best);
        most = std::max(most, rated_[t][*best].*least);
      }
      if (chosen.size() < group.size() || most >= least_of_group) continue;
      least_of_group = most;
      for (std::size_t i = 0; i < group.size(); ++i) out.candidate[group[i]] = chosen[i];
    }
    return least_of_group < kInfinite;
  }

  std::span<const Contest> trees_;
  const std::vector<std::vector<Rated>>& rated_;
  const std::vector<bool>& shares_;
};

// "wide4 with geometry grid takes 6.885 B/tri, slowdown 1.1", of several trees the one that needs
// most of `least`; numbers are rounded up, so that they can be typed as budgets. `tells_others`:
// the most of the other number, too, where another tree has it.
std::string in_words(std::span<const Contest> trees, const Reachable& reachable,
                     const Reached& reached, Reachable::Number least, bool tells_others) {
  constexpr int kDigits = 4;
  const std::size_t t = least == &Rated::bytes ? reached.largest : reached.slowest;
  const Candidate& candidate = trees[t].candidates[reached.candidate[t]];
  const Rated& own = reachable.of(reached, t);
  const double bytes = reachable.of(reached, reached.largest).bytes;
  const double slowdown = reachable.of(reached, reached.slowest).slowdown;
  std::string text = fmt::format("{}{} with geometry {} takes {} B/tri, slowdown {}",
                                 trees.size() > 1 ? trees[t].mesh + ": " : "",
                                 codec_name(candidate.codec), geometry_name(candidate.geometry),
                                 at_most(own.bytes, kDigits), at_most(own.slowdown, kDigits));
  if (!tells_others) return text;
  if (bytes > own.bytes) {
    text += fmt::format(", others up to {} B/tri", at_most(bytes, kDigits));
  } else if (slowdown > own.slowdown) {
    text += fmt::format(", others up to {}", at_most(slowdown, kDigits));
  }
  return text;
}

// The remedy where bytes are too few.
constexpr const char* kFewerBytes =
    "; fewer bytes take a tolerance, or a larger one, by which vertices may move (cook --tolerance "
    "LENGTH in place of --exact, --grid-bits and --grid-step; tolerance of a profile)";

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
    return budgets_unreachable(trees, wishes, std::vector<bool>(trees.size(), true));
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

Error budgets_unreachable(std::span<const Contest> trees, std::span<const Wishes> wishes,
                          const std::vector<bool>& shares) {
  std::vector<std::vector<Rated>> rated;
  for (std::size_t t = 0; t < trees.size(); ++t) {
    rated.push_back(rate(trees[t], wishes[t]));
    const bool any_eligible = std::any_of(rated[t].begin(), rated[t].end(),
                                          [](const Rated& each) { return each.eligible; });
    if (!any_eligible) {
      return {Errc::kInternal,
              (trees.size() > 1 ? trees[t].mesh + ": " : "") + "no encoding passes its gates"};
    }
  }
  const Reachable reachable(trees, rated, shares);
  const std::optional<double> bytes = wishes.front().max_bytes_per_triangle;
  const std::optional<double> slowdown = wishes.front().max_slowdown;
  std::vector<std::string> nearest;
  const auto tell = [&](Reachable::Number least, double limit, bool tells_others) {
    const std::optional<Reached> reached = reachable.minimum(least, limit);
    if (reached) nearest.push_back(in_words(trees, reachable, *reached, least, tells_others));
  };
  // With the other budget kept; where neither can be met, without.
  if (bytes) tell(&Rated::bytes, slowdown.value_or(kInfinite), false);
  if (slowdown) tell(&Rated::slowdown, bytes.value_or(kInfinite), false);
  if (nearest.empty()) {
    tell(&Rated::bytes, kInfinite, true);
    tell(&Rated::slowdown, kInfinite, true);
  }
  if (nearest.empty()) {
    return {Errc::kBudgetUnreachable, "no geometry store is possible for all trees of the file"};
  }
  std::string wanted;
  if (bytes) wanted += fmt::format("at most {} B/tri", *bytes);
  if (slowdown) {
    wanted += fmt::format("{}a slowdown of at most {}", bytes ? " and " : "", *slowdown);
  }
  const bool is_external = std::all_of(trees.begin(), trees.end(), [](const Contest& tree) {
    return std::all_of(tree.candidates.begin(), tree.candidates.end(), [](const Candidate& each) {
      return each.geometry == GeometryId::kExternal;
    });
  });
  return {Errc::kBudgetUnreachable,
          fmt::format("wanted {}; {} (slowdown: {}){}", wanted, fmt::join(nearest, "; "),
                      kSlowdownMeaning, bytes && !is_external ? kFewerBytes : "")};
}

}  // namespace boxtree::cooker
