// SPDX-License-Identifier: MIT
// Which encoding to use, found in the measured points and said in words.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cooker/choose/choose.h"
#include "cooker/report/page.h"
#include "cooker/report/tradeoff.h"

namespace boxtree::cooker {

/// How far surfaces may move, as shares of the diagonal, for an encoding to be called coarse (a
/// tenth of a millimetre on a metre: games, previews) or fine (a micrometre on a metre).
inline constexpr double kCoarse = 1e-4;
inline constexpr double kFine = 1e-6;

/// The recommended points of a mesh, as places in MeshTradeoff::points.
struct Advice {
  std::size_t smallest = 0;        // fewest bytes, surface moved by at most kCoarse
  std::size_t balanced = 0;        // smallest product of bytes and slowdown, moved by at most kFine
  std::size_t fastest = 0;         // least slowdown of all
  std::size_t smallest_exact = 0;  // fewest bytes with every position bit for bit
};

/// Nanoseconds of a query of a timed kind: the measured median or, without times, what the
/// counted work is worth.
[[nodiscard]] double time_of(const MeshTradeoff& mesh, const TradePoint& point, std::size_t kind);

/// How many times as long each point takes as the fastest that passes its gates: the mean over the
/// timed kinds, each against its own fastest.
[[nodiscard]] std::vector<double> slowdowns_of(const MeshTradeoff& mesh);

/// Nothing when no point passes its gates. Exact points keep to every limit, so that each place is
/// filled otherwise.
[[nodiscard]] std::optional<Advice> advise(const MeshTradeoff& mesh);

/// What `boxtree cook --for GOAL` chooses without budgets: by counted work, among exact geometry
/// and its default grid. Nothing when no point passes its gates.
[[nodiscard]] std::optional<std::size_t> cooks_choice(const MeshTradeoff& mesh, Goal goal);

/// A paragraph for each recommendation.
[[nodiscard]] std::vector<PageConclusion> advice_in_words(const MeshTradeoff& mesh);

/// The options of `boxtree cook` that make a point.
[[nodiscard]] std::string cook_options(const TradePoint& point);

/// "820 ns", "3.4 µs".
[[nodiscard]] std::string time_in_words(double nanoseconds);

/// "0", "3.5e-05 of the diagonal (0.000213 units of the mesh)".
[[nodiscard]] std::string move_in_words(const MeshTradeoff& mesh, double share);

}  // namespace boxtree::cooker
