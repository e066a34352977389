// SPDX-License-Identifier: MIT
// Surface-area heuristic: bins for large sets (Wald, "On fast Construction of SAH-based Bounding
// Volume Hierarchies", 2007), a full sweep for small ones.
#include <array>
#include <cmath>

#include "cooker/build/full_nodes.h"
#include "cooker/build/splitter.h"

namespace boxtree::cooker {
namespace {

// For trees with one triangle per leaf: 32 bins are within 1 % of a full sweep's cost on scanned
// and CAD meshes. Below the sweep limit, sorting is cheaper than clearing bins.
constexpr std::size_t kFewBins = 32;
constexpr std::size_t kSweepLimit = 24;

// For trees with full leaves: only sets too large for UnitSweep are binned. Clearing many bins
// costs little compared with filling them, and queries visit 1 to 2 % fewer nodes.
constexpr std::size_t kManyBins = 256;

// Maps centres of one axis to bins; monotone, so that bins divide space.
template <std::size_t kBins>
struct Binning {
  double low = 0;
  double scale = 0;  // zero: all centres coincide

  [[nodiscard]] std::size_t bin(double value) const {
    const double place = (value - low) * scale;
    return std::min(kBins - 1, static_cast<std::size_t>(place));
  }
};

template <std::size_t kBins>
std::array<Binning<kBins>, 3> binnings(std::span<const FaceBox> faces) {
  std::array<double, 3> low, high;
  for (std::size_t k = 0; k < 3; ++k) low[k] = high[k] = centre(faces[0], k);
  for (const FaceBox& face : faces) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], centre(face, k));
      high[k] = std::max(high[k], centre(face, k));
    }
  }
  std::array<Binning<kBins>, 3> result;
  for (std::size_t k = 0; k < 3; ++k) {
    result[k].low = low[k];
    if (high[k] > low[k]) result[k].scale = static_cast<double>(kBins) / (high[k] - low[k]);
  }
  return result;
}

struct Bin {
  FaceBounds bounds;
  std::size_t count = 0;
};

template <std::size_t kBins>
SplitCost best_bin_boundary(const std::array<Bin, kBins>& bins, std::size_t axis) {
  std::array<double, kBins> right_cost;  // of bins [i, kBins)
  std::array<std::size_t, kBins> right_count;
  FaceBounds bounds;
  std::size_t count = 0;
  for (std::size_t i = kBins; i-- > 1;) {
    bounds.add(bins[i].bounds);
    count += bins[i].count;
    right_count[i] = count;
    right_cost[i] = count == 0 ? 0 : half_area(bounds.box()) * static_cast<double>(count);
  }
  SplitCost best;
  bounds = {};
  count = 0;
  for (std::size_t i = 1; i < kBins; ++i) {
    bounds.add(bins[i - 1].bounds);
    count += bins[i - 1].count;
    if (count == 0 || right_count[i] == 0) continue;
    const SplitCost here{half_area(bounds.box()) * static_cast<double>(count) + right_cost[i],
                         imbalance(count, right_count[i]), axis, i};
    if (here.improves_on(best)) best = here;
  }
  return best;
}

// The best division between bins, if the bins differ.
template <std::size_t kBins>
struct BinnedSplit {
  Binning<kBins> binning;
  std::size_t axis;
  std::size_t position;                   // first bin that goes right
  std::size_t left_count;                 // faces before it
  double left_area, right_area;           // of the faces on either side
  std::array<std::size_t, kBins> counts;  // of faces, along the axis
};

template <std::size_t kBins>
std::optional<BinnedSplit<kBins>> best_binned(std::span<const FaceBox> faces) {
  const std::array<Binning<kBins>, 3> binning = binnings<kBins>(faces);
  std::array<std::array<Bin, kBins>, 3> bins;
  for (const FaceBox& face : faces) {
    for (std::size_t k = 0; k < 3; ++k) {
      Bin& bin = bins[k][binning[k].bin(centre(face, k))];
      bin.bounds.add(face);
      ++bin.count;
    }
  }
  SplitCost best;
  for (std::size_t k = 0; k < 3; ++k) {
    if (binning[k].scale == 0) continue;
    const SplitCost here = best_bin_boundary(bins[k], k);
    if (here.improves_on(best)) best = here;
  }
  if (!std::isfinite(best.cost)) return std::nullopt;
  BinnedSplit<kBins> split{binning[best.axis], best.axis, best.position, 0, 0, 0, {}};
  FaceBounds left, right;
  for (std::size_t i = 0; i < kBins; ++i) {
    const Bin& bin = bins[best.axis][i];
    split.counts[i] = bin.count;
    if (i < best.position) split.left_count += bin.count;
    (i < best.position ? left : right).add(bin.bounds);
  }
  split.left_area = half_area(left.box());
  split.right_area = half_area(right.box());
  return split;
}

std::optional<Split> split_binned(std::span<FaceBox> faces) {
  const auto best = best_binned<kFewBins>(faces);
  if (!best) return std::nullopt;
  std::partition(faces.begin(), faces.end(), [&](const FaceBox& face) {
    return best->binning.bin(centre(face, best->axis)) < best->position;
  });
  return Split{best->left_count, static_cast<std::uint32_t>(best->axis)};
}

// By centre, ties by face number: a strict order, so that divisions by it are unique.
auto by_centre(std::size_t axis) {
  return [axis](const FaceBox& a, const FaceBox& b) {
    const double ca = centre(a, axis);
    const double cb = centre(b, axis);
    return ca != cb ? ca < cb : a.face < b.face;
  };
}

void sort_by_centre(std::span<FaceBox> faces, std::size_t axis) {
  std::sort(faces.begin(), faces.end(), by_centre(axis));
}

std::optional<Split> split_sweep(std::span<FaceBox> faces) {
  const std::size_t n = faces.size();
  SplitCost best;
  for (std::size_t k = 0; k < 3; ++k) {
    sort_by_centre(faces, k);
    std::array<double, kSweepLimit> right_cost;
    Box<float> box = empty_box<float>();
    for (std::size_t i = n; i-- > 1;) {
      expand(box, faces[i].box);
      right_cost[i] = half_area(box) * static_cast<double>(n - i);
    }
    box = empty_box<float>();
    for (std::size_t i = 1; i < n; ++i) {
      expand(box, faces[i - 1].box);
      const SplitCost here{half_area(box) * static_cast<double>(i) + right_cost[i],
                           imbalance(i, n - i), k, i};
      if (here.improves_on(best)) best = here;
    }
  }
  sort_by_centre(faces, best.axis);
  return Split{best.position, static_cast<std::uint32_t>(best.axis)};
}

// The first `count` faces along the axis go left. Bins divide space, so only the bin in which the
// count ends is examined face by face.
template <std::size_t kBins>
Split split_bins_at(std::span<FaceBox> faces, std::size_t count, const BinnedSplit<kBins>& bins) {
  std::size_t before = 0, bin = 0;
  while (before + bins.counts[bin] <= count) before += bins.counts[bin++];
  const auto bin_of = [&](const FaceBox& face) {
    return bins.binning.bin(centre(face, bins.axis));
  };
  const auto rest = std::partition(faces.begin(), faces.end(),
                                   [&](const FaceBox& face) { return bin_of(face) < bin; });
  if (count > before) {
    const auto above =
        std::partition(rest, faces.end(), [&](const FaceBox& face) { return bin_of(face) == bin; });
    std::nth_element(rest, rest + static_cast<std::ptrdiff_t>(count - before), above,
                     by_centre(bins.axis));
  }
  return {count, static_cast<std::uint32_t>(bins.axis)};
}

// Among seven consecutive sizes of a side there is one for each number of roots.
constexpr std::size_t kSearchSpan = (kWideChildren - 1) / 2;

// The value of roots to a side: each doubling saves one level below, hence log2.
constexpr std::array<double, kWideChildren> kLevelsOfRoots = {0, 0,         1,         1.5849625,
                                                              2, 2.3219281, 2.5849625, 2.8073549};

// The number of leaves on the left, near the best boundary between bins, whose share of the roots
// fits the areas of the two sides best.
std::size_t full_side_near(const BinnedSplit<kManyBins>& best, std::size_t leaves,
                           std::size_t roots) {
  const std::size_t near = std::clamp<std::size_t>((best.left_count + kLeafFaces / 2) / kLeafFaces,
                                                   kSearchSpan + 1, leaves - kSearchSpan - 1);
  std::size_t chosen = near;
  double highest = -1;
  for (std::size_t left = near - kSearchSpan; left <= near + kSearchSpan; ++left) {
    const std::size_t left_roots = roots_on_left(left, leaves, roots);
    if (left_roots == 0) continue;
    const double worth = best.left_area * kLevelsOfRoots[left_roots] +
                         best.right_area * kLevelsOfRoots[roots - left_roots];
    if (worth > highest) {
      highest = worth;
      chosen = left;
    }
  }
  return chosen;
}

}  // namespace

std::optional<Split> split_sah(std::span<FaceBox> faces, const Box<float>& /*bounds*/) {
  return faces.size() <= kSweepLimit ? split_sweep(faces) : split_binned(faces);
}

std::optional<Split> split_sah_full_leaves(std::span<FaceBox> faces, std::size_t roots) {
  const auto best = best_binned<kManyBins>(faces);
  if (!best) return std::nullopt;
  const std::size_t left = full_side_near(*best, leaves_of(faces.size()), roots);
  return split_bins_at(faces, left * kLeafFaces, *best);
}

std::uint32_t widest_axis(const Box<float>& bounds) {
  std::uint32_t axis = 0;
  double widest = -1;
  for (std::uint32_t k = 0; k < 3; ++k) {
    const double extent = double{bounds.high[k]} - bounds.low[k];
    if (extent > widest) {
      widest = extent;
      axis = k;
    }
  }
  return axis;
}

Split split_at(std::span<FaceBox> faces, std::size_t count, std::uint32_t axis) {
  std::nth_element(faces.begin(), faces.begin() + static_cast<std::ptrdiff_t>(count), faces.end(),
                   by_centre(axis));
  return {count, axis};
}

}  // namespace boxtree::cooker
