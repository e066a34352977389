// SPDX-License-Identifier: MIT
// A case of the robustness suite: what it checks, the resulting figure, and its limit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace boxtree::robustness {

/// Collects the results of one case.
class Run {
 public:
  /// `full`: use the counts of a documented run instead of those of a regular test run.
  explicit Run(bool full) : full_(full) {}

  [[nodiscard]] bool is_full() const { return full_; }
  [[nodiscard]] std::size_t count(std::size_t quick, std::size_t full) const {
    return full_ ? full : quick;
  }

  /// Checks one condition. `describe()` names the place; only the first failures are kept.
  template <class Describe>
  void check(bool holds, Describe describe) {
    ++checks_;
    if (holds) return;
    ++failures_;
    if (messages_.size() < kMessages) messages_.push_back(describe());
  }
  void check(bool holds, const char* what) {
    check(holds, [what] { return std::string(what); });
  }

  /// A condition without which the case would prove nothing (enough rays hit, ...). If it is false,
  /// the case itself fails; it is not counted in the figure.
  void premise(bool holds, std::string what) {
    if (!holds) broken_premises_.push_back(std::move(what));
  }

  /// For cases whose figure is a size instead of a number of failures; keeps the largest.
  void measure(double figure) {
    ++checks_;
    measured_ = true;
    if (!(figure <= worst_)) worst_ = figure;  // NaN stays
  }

  [[nodiscard]] std::uint64_t checks() const { return checks_; }
  [[nodiscard]] std::uint64_t failures() const { return failures_; }
  [[nodiscard]] double figure() const {
    return measured_ ? worst_ : static_cast<double>(failures_);
  }
  [[nodiscard]] bool passes(double limit) const {
    return checks_ > 0 && broken_premises_.empty() && figure() <= limit &&
           (!measured_ || failures_ == 0);
  }
  /// The reasons for failure, one line each.
  [[nodiscard]] std::vector<std::string> complaints() const {
    std::vector<std::string> all = broken_premises_;
    all.insert(all.end(), messages_.begin(), messages_.end());
    return all;
  }

 private:
  static constexpr std::size_t kMessages = 5;

  bool full_;
  std::uint64_t checks_ = 0;
  std::uint64_t failures_ = 0;
  bool measured_ = false;
  double worst_ = 0;
  std::vector<std::string> messages_;
  std::vector<std::string> broken_premises_;
};

struct Case {
  const char* id;    // R01..R30: the catalogue in docs/GUARANTEES.md; E01..: beyond it
  const char* name;  // as in the name of the test
  const char* what;  // the situation
  const char* unit;  // what the figure counts
  double limit;      // the largest figure that passes
  void (*run)(Run&);
};

/// Runs a case; an exception becomes a broken premise.
[[nodiscard]] Run run_case(const Case& tested, bool full);

/// All cases, in the order of their ids.
[[nodiscard]] std::vector<Case> all_cases();

// One list a theme.
[[nodiscard]] std::vector<Case> range_cases();
[[nodiscard]] std::vector<Case> scale_cases();
[[nodiscard]] std::vector<Case> ray_cases();
[[nodiscard]] std::vector<Case> cast_cases();
[[nodiscard]] std::vector<Case> pair_cases();
[[nodiscard]] std::vector<Case> pose_cases();
[[nodiscard]] std::vector<Case> degenerate_cases();
[[nodiscard]] std::vector<Case> shape_cases();
[[nodiscard]] std::vector<Case> store_cases();
[[nodiscard]] std::vector<Case> file_cases();

}  // namespace boxtree::robustness
