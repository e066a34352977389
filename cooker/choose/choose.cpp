// SPDX-License-Identifier: MIT
// One number a candidate, the smallest wins.
#include <cmath>

#include <boxtree/cooker/choose/choose.h>

namespace boxtree::cooker {
namespace {

double score(const Candidate& candidate, Goal goal) {
  const auto bytes = static_cast<double>(candidate.tree_bytes + candidate.geometry_bytes);
  // Geometric mean of the three kinds, so that none is drowned by the units of another.
  const double visits = std::cbrt(candidate.cost.ray) * std::cbrt(candidate.cost.box) *
                        std::cbrt(candidate.cost.pair);
  switch (goal) {
    case Goal::kMemory:
      return bytes;
    case Goal::kSpeed:
      return visits;
    case Goal::kBalance:
      break;
  }
  return bytes * visits;
}

const char* reason(Goal goal) {
  switch (goal) {
    case Goal::kMemory:
      return "more bytes";
    case Goal::kSpeed:
      return "more expected visits";
    case Goal::kBalance:
      break;
  }
  return "larger product of bytes and expected visits";
}

}  // namespace

std::optional<std::size_t> choose(std::span<Candidate> candidates, Goal goal) {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (!candidates[i].gates.pass()) continue;
    if (!best || score(candidates[i], goal) < score(candidates[*best], goal)) best = i;
  }
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    Candidate& candidate = candidates[i];
    candidate.rejected = i == best ? "" : reason(goal);
    if (candidate.gates.pass()) continue;
    candidate.rejected = "fails its gates: " + std::to_string(candidate.gates.missed) +
                         " faces missed, " + std::to_string(candidate.gates.escapes) +
                         " boxes escaped";
  }
  return best;
}

}  // namespace boxtree::cooker
