// SPDX-License-Identifier: MIT
// What a family of queries has found: answers, wrong ones by category, the largest error.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "tests/oracle/exact/geometry.h"
#include "tests/oracle/exact/subject.h"

namespace boxtree::oracle {

class Tally {
 public:
  struct Category {
    std::uint64_t wrong = 0;
    std::string example;  // of the smallest case
    std::uint64_t example_case = 0;
    std::uint64_t example_size = 0;
    std::map<std::string, std::uint64_t> by_kind;  // of mesh
  };

  /// Where the answers that follow come from. `size`: the smaller, the better an example.
  void begin_case(std::uint64_t number, std::uint64_t size, const std::string& kind) {
    case_ = number;
    size_ = size;
    kind_ = kind;
  }

  /// One answer of one codec and store: right so far.
  void answer() {
    ++answers_;
    is_wrong_ = false;
  }
  void refused() { ++refused_; }
  /// The answer is wrong; `describe()` gives what a unit test would need.
  template <class Describe>
  void wrong(const std::string& category, Describe describe) {
    if (!is_wrong_) ++wrong_;
    is_wrong_ = true;
    Category& found = categories_[category];
    ++found.by_kind[kind_];
    if (found.wrong++ == 0 || size_ < found.example_size) {
      found.example = describe();
      found.example_case = case_;
      found.example_size = size_;
    }
  }
  /// An error in units in the last place of the largest coordinate.
  void error(double ulps) {
    if (!(ulps <= worst_)) worst_ = ulps;  // NaN stays
  }

  [[nodiscard]] std::uint64_t answers() const { return answers_; }
  [[nodiscard]] std::uint64_t wrong() const { return wrong_; }
  [[nodiscard]] std::uint64_t refused_count() const { return refused_; }
  [[nodiscard]] double worst() const { return worst_; }
  [[nodiscard]] const std::map<std::string, Category>& categories() const { return categories_; }

 private:
  std::uint64_t case_ = 0;
  std::uint64_t size_ = 0;
  std::string kind_;
  std::uint64_t answers_ = 0;
  std::uint64_t wrong_ = 0;
  std::uint64_t refused_ = 0;
  bool is_wrong_ = false;
  double worst_ = 0;
  std::map<std::string, Category> categories_;
};

// Numbers as C++ reads them back, to the bit.
[[nodiscard]] std::string text(double x);
[[nodiscard]] std::string text(const Point& p);
[[nodiscard]] std::string text(const Face& t);
[[nodiscard]] std::string text(const Pose& pose);
/// Source faces of a mesh; all of them where there are at most twelve or whole meshes are wished
/// for, else those of `faces`.
[[nodiscard]] std::string text(const cooker::SourceMesh& mesh,
                               const std::vector<std::uint32_t>& faces);
void print_whole_meshes(bool whole);

}  // namespace boxtree::oracle
