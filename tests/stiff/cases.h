// SPDX-License-Identifier: MIT
// Cases S1 to S6 of stiff contact: each runs its scene over all codecs and says what came out
// beside what is wanted.
#pragma once

#include <array>
#include <ostream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cooker/report/plot.h"
#include "tests/stiff/shape.h"

namespace boxtree::stiff {

/// One figure and its limit.
struct Row {
  enum class Limit {
    kAtMost,
    kAtLeast,  // also of controls: what must be seen to go wrong
    kNone,     // reported alone
  };
  std::string id;
  std::string setting;
  std::string what;
  double figure = 0;
  Limit relation = Limit::kNone;
  double limit = 0;

  [[nodiscard]] bool pass() const {
    // Written so that NaN fails.
    if (relation == Limit::kAtMost) return figure <= limit;
    return relation == Limit::kNone || figure >= limit;
  }
};

struct NamedPlot {
  std::string name;  // of its file
  cooker::PagePlot plot;
};

struct CaseResult {
  std::vector<Row> rows;
  std::vector<NamedPlot> plots;
};

/// Quick: fewer steps and settings, every figure of the pass still there.
struct Scale {
  bool quick = false;
};

struct CaseInfo {
  std::string_view id;
  std::string_view title;
  CaseResult (*run)(const Scale&);

  friend std::ostream& operator<<(std::ostream& out, const CaseInfo& info) {
    return out << info.title;
  }
};

[[nodiscard]] CaseResult run_rest(const Scale& scale);
[[nodiscard]] CaseResult run_bounce(const Scale& scale);
[[nodiscard]] CaseResult run_swap(const Scale& scale);
[[nodiscard]] CaseResult run_slide(const Scale& scale);
[[nodiscard]] CaseResult run_stack(const Scale& scale);
[[nodiscard]] CaseResult run_wall(const Scale& scale);

inline constexpr std::array kCases = {
    CaseInfo{"S1", "boxes at rest on stairs", run_rest},
    CaseInfo{"S2", "a ball that bounces without loss", run_bounce},
    CaseInfo{"S3", "a level swapped under resting boxes", run_swap},
    CaseInfo{"S4", "a box that slides without friction", run_slide},
    CaseInfo{"S5", "a heavy box on a light plate", run_stack},
    CaseInfo{"S6", "boxes against thin walls", run_wall},
};

/// A mesh in every codec of the registry, then without a tree.
[[nodiscard]] std::vector<Shape> all_shapes(const SourceMesh& mesh, const Store& store);

/// How many of the values differ from each other.
[[nodiscard]] std::size_t distinct(std::vector<std::uint64_t> values);

/// One hash for many.
[[nodiscard]] std::uint64_t checksum_of(const std::vector<std::uint64_t>& values);

/// "1e5" for 100000.
[[nodiscard]] std::string power_name(double value);

}  // namespace boxtree::stiff
