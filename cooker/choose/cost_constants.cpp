// SPDX-License-Identifier: MIT
// Nanoseconds of a query, a node and a leaf, for rays, boxes, points and pairs, as printed by
//     boxtree bench --calibrate MESH...
// for 16 models of 1000 to 270 000 triangles and the dragon of 871 414: walks by AVX2 and leaves of
// clusters by AVX-512 (Zen 5), processor time of one thread, medians of 3 runs. Modelled and
// measured times differ there by at most a factor of 2.7, and by far less between candidates of one
// mesh.
#include <array>

#include "cooker/choose/cost.h"

namespace boxtree::cooker {
namespace {

using G = GeometryId;

constexpr std::array kMeasured = {
    CodecCost{
        CodecId::kPlainF32,
        G::kArrays,
        {{{16.4, 30.00, 37.73}, {0.0, 21.94, 38.53}, {0.0, 28.86, 54.60}, {193.4, 18.94, 99.67}}}},
    CodecCost{CodecId::kPlainF32,
              G::kGrid,
              {{{16.4, 30.00, 216.69},
                {0.0, 21.94, 199.60},
                {0.0, 28.86, 216.48},
                {193.4, 18.94, 302.15}}}},
    CodecCost{
        CodecId::kPlainF16,
        G::kArrays,
        {{{27.0, 29.35, 34.36}, {0.0, 23.68, 33.05}, {0.0, 20.83, 87.76}, {190.0, 17.69, 98.05}}}},
    CodecCost{CodecId::kPlainF16,
              G::kGrid,
              {{{27.0, 29.35, 218.21},
                {0.0, 23.68, 192.73},
                {0.0, 20.83, 252.85},
                {190.0, 17.69, 306.79}}}},
    CodecCost{
        CodecId::kPackedF32,
        G::kArrays,
        {{{0.0, 29.65, 29.35}, {0.0, 24.65, 31.49}, {0.0, 18.54, 102.10}, {250.4, 16.95, 108.07}}}},
    CodecCost{CodecId::kPackedF32,
              G::kGrid,
              {{{0.0, 29.65, 219.61},
                {0.0, 24.65, 191.53},
                {0.0, 18.54, 267.72},
                {250.4, 16.95, 309.78}}}},
    CodecCost{
        CodecId::kPackedF16,
        G::kArrays,
        {{{41.7, 29.70, 17.87}, {0.0, 26.38, 29.53}, {0.0, 21.81, 88.39}, {213.5, 19.00, 99.94}}}},
    CodecCost{CodecId::kPackedF16,
              G::kGrid,
              {{{41.7, 29.70, 208.13},
                {0.0, 26.38, 188.66},
                {0.0, 21.81, 254.12},
                {213.5, 19.00, 309.64}}}},
    CodecCost{
        CodecId::kPackedF64,
        G::kArrays,
        {{{0.0, 36.11, 4.57}, {79.4, 13.11, 47.13}, {0.0, 19.54, 114.65}, {208.9, 17.03, 101.88}}}},
    CodecCost{CodecId::kPackedF64,
              G::kGrid,
              {{{0.0, 36.11, 191.70},
                {79.4, 13.11, 206.09},
                {0.0, 19.54, 280.15},
                {208.9, 17.03, 295.82}}}},
    CodecCost{
        CodecId::kDedup,
        G::kArrays,
        {{{30.1, 31.93, 1.12}, {0.0, 25.71, 36.22}, {0.0, 16.14, 117.79}, {225.0, 18.24, 105.82}}}},
    CodecCost{CodecId::kDedup,
              G::kGrid,
              {{{30.1, 31.93, 187.27},
                {0.0, 25.71, 194.36},
                {0.0, 16.14, 282.30},
                {225.0, 18.24, 309.59}}}},
    CodecCost{CodecId::kWide8,
              G::kArrays,
              {{{44.6, 10.22, 64.82},
                {167.6, 0.00, 41.83},
                {108.0, 44.13, 40.41},
                {152.1, 36.14, 119.45}}}},
    CodecCost{CodecId::kWide8,
              G::kExact,
              {{{44.6, 10.22, 94.38},
                {167.6, 0.00, 59.87},
                {108.0, 44.13, 62.48},
                {152.1, 36.14, 144.98}}}},
    CodecCost{CodecId::kWide8,
              G::kGrid,
              {{{44.6, 10.22, 90.09},
                {167.6, 0.00, 59.18},
                {108.0, 44.13, 60.18},
                {152.1, 36.14, 144.20}}}},
    CodecCost{CodecId::kWide4,
              G::kArrays,
              {{{46.7, 14.95, 48.65},
                {172.8, 0.85, 43.02},
                {115.8, 15.51, 61.79},
                {161.7, 35.43, 91.81}}}},
    CodecCost{CodecId::kWide4,
              G::kExact,
              {{{46.7, 14.95, 75.04},
                {172.8, 0.85, 61.24},
                {115.8, 15.51, 82.63},
                {161.7, 35.43, 116.06}}}},
    CodecCost{CodecId::kWide4,
              G::kGrid,
              {{{46.7, 14.95, 73.80},
                {172.8, 0.85, 60.14},
                {115.8, 15.51, 81.36},
                {161.7, 35.43, 118.79}}}},
};

}  // namespace

std::span<const CodecCost> compiled_costs() noexcept {
  return kMeasured;
}

}  // namespace boxtree::cooker
