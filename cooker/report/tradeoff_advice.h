// SPDX-License-Identifier: MIT
// Recommends encodings by the measured points, and explains the choice.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cooker/choose/choose.h"
#include "cooker/report/page.h"
#include "cooker/report/tradeoff.h"

namespace boxtree::cooker {

/// Largest surface error, as a share of the diagonal, of an encoding that counts as coarse (a tenth
/// of a millimetre on a metre: games, previews) or fine (a micrometre on a metre).
inline constexpr double kCoarse = 1e-4;
inline constexpr double kFine = 1e-6;

/// The recommended points of a mesh, as indices into MeshTradeoff::points.
struct Advice {
  // Surface moved by at most the tolerance, if there is one, else kCoarse or kFine.
  std::size_t smallest = 0;        // fewest bytes, kCoarse
  std::size_t balanced = 0;        // smallest product of bytes and slowdown, kFine
  std::size_t fastest_exact = 0;   // least slowdown with every position bit for bit
  std::size_t smallest_exact = 0;  // fewest bytes with every position bit for bit
};

/// Mean nanoseconds of a query of a QueryKind: measured or, without times, modelled by the counted
/// work.
[[nodiscard]] double mean_time_of(const MeshTradeoff& mesh, const TradePoint& point,
                                  std::size_t kind);

/// What the last kind of queries is called: what is timed goes deeper than what is counted.
[[nodiscard]] const char* contacts_name(const MeshTradeoff& mesh);

/// Whether slowdowns and recommendations go by counted work: without times, and where other
/// programs disturbed them.
[[nodiscard]] bool goes_by_work(const MeshTradeoff& mesh);

/// The time of each point relative to that of wide8 with arrays: the mean over the kinds of queries
/// of the ratio of both mean times, as slowdowns() has it; of modelled ones where
/// goes_by_work(). 1 where either has no time.
[[nodiscard]] std::vector<double> slowdowns_of(const MeshTradeoff& mesh);

/// Which points may be recommended: those that pass their gates, that boxtree::runtime alone reads
/// (see may_be_chosen()) and that cook_options() produce: not clusters without loss where arrays
/// are smaller, on meshes of a few faces.
[[nodiscard]] std::vector<bool> may_be_advised(const MeshTradeoff& mesh);

/// Empty if no point may be recommended. Otherwise all members are set, because exact points are
/// within every limit.
[[nodiscard]] std::optional<Advice> advise(const MeshTradeoff& mesh);

/// The point that `boxtree cook --for GOAL` chooses without budgets: by counted work, among exact
/// geometry and the default grid, or that of the tolerance. Empty if no point passes its gates.
[[nodiscard]] std::optional<std::size_t> cooks_choice(const MeshTradeoff& mesh, Goal goal);

/// A paragraph for each recommendation.
[[nodiscard]] std::vector<PageConclusion> advice_in_words(const MeshTradeoff& mesh);

/// What to say of times that other programs disturbed; empty for others, and without times.
[[nodiscard]] std::string disturbance_in_words(const MeshTradeoff& mesh);

/// A time of the mesh: behind ~ where it was measured and disturbed.
[[nodiscard]] std::string time_in_words(const MeshTradeoff& mesh, double nanoseconds);

/// The command that cooks a point, run where the source of the mesh is; MESH and FILE.bxt stand for
/// the names of one without a source.
[[nodiscard]] std::string cook_command(const MeshTradeoff& mesh, const TradePoint& point);

/// " --f64 --skip-bad": the options of a cook that reads the mesh as the report did.
[[nodiscard]] std::string import_options(const MeshTradeoff& mesh);

/// The options of `boxtree cook` that produce a file of a point's bytes: the first input is one
/// tree, and no record of the cook follows.
[[nodiscard]] std::string cook_options(const MeshTradeoff& mesh, const TradePoint& point);

/// "820 ns", "3.4 µs".
[[nodiscard]] std::string time_in_words(double nanoseconds);

/// "0", "3.5e-05 of the diagonal (0.000213 units of the mesh)".
[[nodiscard]] std::string move_in_words(const MeshTradeoff& mesh, double share);

}  // namespace boxtree::cooker
