// SPDX-License-Identifier: MIT
// Nanoseconds of a query, a node and a leaf, for rays, boxes, points and pairs, as printed by
//     boxtree bench --calibrate MESH...
// for eleven models of 1000 to 70 000 triangles and the dragon of 871 414: AVX2, processor time
// of one thread, medians of 3 runs. Modelled and measured times differ there by at most a factor of
// 2.0, and by far less between candidates of one mesh.
#include <array>

#include "cooker/choose/cost.h"

namespace boxtree::cooker {
namespace {

using G = GeometryId;

constexpr std::array kMeasured = {
    CodecCost{CodecId::kPlainF32,
              G::kArrays,
              {{{95.6, 41.95, 3.99},
                {69.6, 34.92, 36.45},
                {0.0, 29.43, 120.40},
                {289.2, 26.16, 171.65}}}},
    CodecCost{CodecId::kPlainF32,
              G::kGrid,
              {{{0.0, 43.28, 283.65},
                {22.1, 39.00, 281.47},
                {0.0, 27.60, 383.87},
                {248.3, 23.44, 517.85}}}},
    CodecCost{CodecId::kPlainF16,
              G::kArrays,
              {{{87.5, 38.71, 46.62},
                {122.9, 31.07, 49.28},
                {0.0, 26.97, 126.23},
                {285.0, 25.03, 191.21}}}},
    CodecCost{CodecId::kPlainF16,
              G::kGrid,
              {{{0.0, 50.70, 243.13},
                {0.0, 40.33, 295.09},
                {0.0, 6.58, 494.17},
                {279.8, 24.46, 498.51}}}},
    CodecCost{CodecId::kPackedF32,
              G::kArrays,
              {{{108.8, 43.56, 0.00},
                {32.2, 37.39, 40.37},
                {0.0, 24.32, 143.45},
                {313.7, 26.54, 185.09}}}},
    CodecCost{CodecId::kPackedF32,
              G::kGrid,
              {{{59.8, 53.07, 218.38},
                {0.0, 45.24, 278.59},
                {0.0, 8.37, 491.63},
                {281.0, 27.29, 495.42}}}},
    CodecCost{CodecId::kPackedF16,
              G::kArrays,
              {{{24.5, 44.45, 24.99},
                {87.8, 39.02, 37.47},
                {0.0, 21.02, 158.05},
                {323.8, 27.87, 188.63}}}},
    CodecCost{CodecId::kPackedF16,
              G::kGrid,
              {{{29.2, 51.65, 267.34},
                {0.0, 45.44, 294.46},
                {0.0, 28.29, 422.72},
                {334.1, 27.17, 519.65}}}},
    CodecCost{
        CodecId::kPackedF64,
        G::kArrays,
        {{{71.9, 50.17, 0.00}, {5.2, 27.22, 56.29}, {0.0, 24.32, 166.52}, {333.2, 26.06, 171.14}}}},
    CodecCost{CodecId::kPackedF64,
              G::kGrid,
              {{{0.0, 59.84, 237.37},
                {0.0, 32.84, 316.07},
                {0.0, 23.65, 461.26},
                {291.1, 25.93, 514.48}}}},
    CodecCost{
        CodecId::kDedup,
        G::kArrays,
        {{{7.7, 47.66, 3.97}, {0.0, 39.30, 45.93}, {0.0, 24.14, 161.96}, {265.7, 29.95, 162.97}}}},
    CodecCost{CodecId::kDedup,
              G::kGrid,
              {{{12.1, 58.83, 185.99},
                {0.0, 41.72, 306.57},
                {0.0, 20.08, 449.71},
                {263.3, 28.34, 500.58}}}},
    CodecCost{CodecId::kWide8,
              G::kArrays,
              {{{13.0, 28.18, 113.05},
                {105.0, 56.94, 33.83},
                {34.0, 10.60, 121.45},
                {151.4, 59.97, 168.24}}}},
    CodecCost{CodecId::kWide8,
              G::kExact,
              {{{0.0, 39.65, 241.38},
                {245.2, 109.59, 62.79},
                {0.0, 0.00, 249.17},
                {182.4, 56.37, 327.85}}}},
    CodecCost{CodecId::kWide8,
              G::kGrid,
              {{{0.0, 24.45, 258.58},
                {182.3, 125.56, 52.49},
                {0.0, 0.00, 235.88},
                {194.8, 52.45, 314.58}}}},
    CodecCost{CodecId::kWide4,
              G::kArrays,
              {{{4.7, 32.73, 100.44},
                {252.0, 20.99, 42.93},
                {65.2, 0.00, 124.31},
                {206.9, 52.32, 147.55}}}},
    CodecCost{CodecId::kWide4,
              G::kExact,
              {{{0.0, 33.99, 245.12},
                {316.0, 106.81, 64.79},
                {0.0, 0.00, 246.59},
                {208.2, 56.22, 291.85}}}},
    CodecCost{CodecId::kWide4,
              G::kGrid,
              {{{0.0, 29.85, 242.45},
                {348.1, 77.50, 71.03},
                {0.0, 0.00, 238.43},
                {221.2, 54.24, 272.31}}}},
};

}  // namespace

std::span<const CodecCost> compiled_costs() noexcept {
  return kMeasured;
}

}  // namespace boxtree::cooker
