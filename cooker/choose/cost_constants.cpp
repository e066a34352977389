// SPDX-License-Identifier: MIT
// Nanoseconds of a query, a node and a leaf, for rays, boxes, points and pairs, as printed by
//     boxtree bench --calibrate MESH...
// for eleven models of 1000 to 70 000 triangles and the dragon of 871 414: AVX2, processor time
// of one thread, medians of 3 runs. Modelled and measured times differ there by at most a factor of
// 2.1, and by far less between candidates of one mesh.
#include <array>

#include "cooker/choose/cost.h"

namespace boxtree::cooker {
namespace {

using G = GeometryId;

constexpr std::array kMeasured = {
    CodecCost{
        CodecId::kPlainF32,
        G::kArrays,
        {{{0.0, 42.98, 14.26}, {0.0, 36.72, 25.59}, {0.0, 11.18, 186.68}, {211.5, 27.24, 171.30}}}},
    CodecCost{CodecId::kPlainF32,
              G::kGrid,
              {{{0.0, 49.33, 267.67},
                {0.0, 41.44, 299.35},
                {0.0, 55.65, 325.90},
                {359.5, 22.14, 563.90}}}},
    CodecCost{CodecId::kPlainF16,
              G::kArrays,
              {{{74.1, 41.40, 5.91},
                {80.6, 32.25, 42.21},
                {0.0, 26.98, 122.40},
                {321.8, 25.07, 166.30}}}},
    CodecCost{CodecId::kPlainF16,
              G::kGrid,
              {{{50.7, 55.97, 197.40},
                {0.0, 26.73, 372.04},
                {0.0, 32.55, 425.86},
                {353.6, 24.66, 556.52}}}},
    CodecCost{CodecId::kPackedF32,
              G::kArrays,
              {{{73.5, 42.23, 0.00},
                {169.6, 28.42, 52.58},
                {0.0, 11.79, 189.16},
                {301.8, 25.74, 174.58}}}},
    CodecCost{CodecId::kPackedF32,
              G::kGrid,
              {{{0.0, 50.96, 309.30},
                {0.0, 48.97, 312.64},
                {0.0, 31.75, 446.59},
                {273.2, 27.89, 564.43}}}},
    CodecCost{CodecId::kPackedF16,
              G::kArrays,
              {{{175.9, 41.77, 8.57},
                {294.1, 24.67, 76.88},
                {0.0, 26.64, 143.57},
                {271.2, 29.79, 178.54}}}},
    CodecCost{CodecId::kPackedF16,
              G::kGrid,
              {{{36.5, 49.45, 332.50},
                {0.0, 47.81, 334.35},
                {0.0, 23.97, 479.03},
                {315.6, 28.70, 553.91}}}},
    CodecCost{CodecId::kPackedF64,
              G::kArrays,
              {{{34.8, 52.05, 0.00},
                {27.8, 30.43, 44.96},
                {0.0, 32.71, 137.22},
                {313.1, 27.29, 190.07}}}},
    CodecCost{CodecId::kPackedF64,
              G::kGrid,
              {{{89.2, 58.19, 244.66},
                {0.0, 36.14, 333.33},
                {0.0, 47.86, 398.52},
                {258.3, 27.41, 550.09}}}},
    CodecCost{CodecId::kDedup,
              G::kArrays,
              {{{46.8, 45.98, 22.90},
                {115.5, 36.75, 50.41},
                {0.0, 35.56, 108.20},
                {300.7, 28.60, 184.84}}}},
    CodecCost{CodecId::kDedup,
              G::kGrid,
              {{{1.4, 54.04, 270.62},
                {0.0, 46.25, 327.18},
                {0.0, 52.27, 362.25},
                {318.3, 28.40, 563.76}}}},
    CodecCost{CodecId::kWide8,
              G::kArrays,
              {{{16.1, 26.08, 116.92},
                {168.8, 36.98, 38.44},
                {74.0, 88.72, 56.98},
                {192.2, 51.23, 185.35}}}},
    CodecCost{CodecId::kWide8,
              G::kExact,
              {{{14.7, 23.65, 196.77},
                {272.5, 59.78, 49.65},
                {0.0, 0.00, 194.71},
                {236.0, 44.59, 282.51}}}},
    CodecCost{CodecId::kWide8,
              G::kGrid,
              {{{0.0, 30.15, 184.04},
                {296.5, 48.19, 48.42},
                {0.0, 0.00, 183.59},
                {221.6, 48.43, 257.60}}}},
    CodecCost{CodecId::kWide4,
              G::kArrays,
              {{{0.0, 32.20, 105.56},
                {179.9, 42.31, 34.64},
                {0.0, 0.00, 127.82},
                {231.2, 49.13, 163.84}}}},
    CodecCost{CodecId::kWide4,
              G::kExact,
              {{{0.0, 31.41, 193.37},
                {349.5, 60.17, 46.45},
                {0.0, 0.00, 193.35},
                {210.5, 53.69, 229.42}}}},
    CodecCost{CodecId::kWide4,
              G::kGrid,
              {{{0.0, 26.74, 178.54},
                {339.6, 39.97, 57.41},
                {32.7, 0.00, 184.98},
                {205.8, 53.18, 207.12}}}},
};

}  // namespace

std::span<const CodecCost> compiled_costs() noexcept {
  return kMeasured;
}

}  // namespace boxtree::cooker
