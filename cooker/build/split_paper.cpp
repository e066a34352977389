// SPDX-License-Identifier: MIT
// The paper's split (Zachmann's BoxTree builder): sort by box minima on each axis, sweep, and take
// the division with the smallest faces-times-volume. It is kept to reproduce the paper's tables.
#include <vector>

#include "cooker/build/splitter.h"

namespace boxtree::cooker {
namespace {

void sort_by_minimum(std::span<FaceBox> faces, std::size_t axis) {
  std::sort(faces.begin(), faces.end(), [axis](const FaceBox& a, const FaceBox& b) {
    return a.box.low[axis] != b.box.low[axis] ? a.box.low[axis] < b.box.low[axis] : a.face < b.face;
  });
}

}  // namespace

// cost = (nL lenL + nR lenR) * area of the two other sides. The paper skips axes shorter than an
// absolute 1e-5. This code skips only axes without extent, which cannot be split.
std::optional<Split> split_paper(std::span<FaceBox> faces, const Box<float>& bounds) {
  const std::size_t n = faces.size();
  std::vector<double> right_length(n);
  double best_cost = std::numeric_limits<double>::infinity();
  std::size_t best_imbalance = 0;
  Split best{0, 0};
  std::size_t sorted_axis = 3;
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(bounds.high[k] > bounds.low[k])) continue;
    sort_by_minimum(faces, k);
    sorted_axis = k;
    const std::size_t i1 = (k + 1) % 3;
    const std::size_t i2 = (k + 2) % 3;
    const double area =
        (double{bounds.high[i1]} - bounds.low[i1]) * (double{bounds.high[i2]} - bounds.low[i2]);
    float high = faces[n - 1].box.high[k];
    for (std::size_t i = n; i-- > 1;) {
      high = std::max(high, faces[i].box.high[k]);
      right_length[i] = double{high} - faces[i].box.low[k];
    }
    high = faces[0].box.high[k];
    for (std::size_t i = 1; i < n; ++i) {
      high = std::max(high, faces[i - 1].box.high[k]);
      const double left_length = double{high} - faces[0].box.low[k];
      const double cost =
          (static_cast<double>(i) * left_length + static_cast<double>(n - i) * right_length[i]) *
          area;
      const std::size_t imbalance = i > n - i ? 2 * i - n : n - 2 * i;
      if (cost < best_cost || (cost == best_cost && imbalance < best_imbalance)) {
        best_cost = cost;
        best_imbalance = imbalance;
        best = {i, static_cast<std::uint32_t>(k)};
      }
    }
  }
  if (best.left_count == 0) return std::nullopt;
  if (best.axis != sorted_axis) sort_by_minimum(faces, best.axis);
  return best;
}

}  // namespace boxtree::cooker
