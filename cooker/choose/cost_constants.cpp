// SPDX-License-Identifier: MIT
// Nanoseconds of a query, a node and a leaf, for rays, boxes, points and pairs, as printed by
//     boxtree bench --calibrate MESH...
// for 15 models of 1000 to 270 000 triangles and the dragon of 871 414: walks by AVX2 and leaves of
// clusters by AVX-512 (Zen 5), processor time of one thread, means of 5 such runs, which differ in
// what they call a node's and what a leaf's. Modelled and measured times differ there by at most a
// factor of 2.1, and by far less between candidates of one mesh. Of positions of f64, whose nodes
// are those of f32, a leaf's follow from the ratios of times to those of f32, means of 4 such runs
// of four models, at 5, 15, 12 and 30 nodes and 1.5, 12, 15 and 15 leaves a query.
#include <array>

#include "cooker/choose/cost.h"

namespace boxtree::cooker {
namespace {

using G = GeometryId;

constexpr std::array kMeasured = {
    CodecCost{
        CodecId::kPlainF32,
        G::kArrays,
        {{{26.8, 33.07, 22.59}, {0.0, 20.93, 55.66}, {0.0, 9.67, 158.09}, {304.5, 18.45, 122.71}}}},
    CodecCost{CodecId::kPlainF32,
              G::kGrid,
              {{{26.8, 33.07, 222.69},
                {0.0, 20.93, 234.30},
                {0.0, 9.67, 340.96},
                {304.5, 18.45, 319.03}}}},
    CodecCost{
        CodecId::kPlainF16,
        G::kArrays,
        {{{28.6, 33.06, 17.59}, {0.0, 22.77, 49.26}, {0.0, 9.45, 159.09}, {304.1, 17.98, 116.09}}}},
    CodecCost{CodecId::kPlainF16,
              G::kGrid,
              {{{28.6, 33.06, 225.32},
                {0.0, 22.77, 232.89},
                {0.0, 9.45, 346.72},
                {304.1, 17.98, 321.80}}}},
    CodecCost{
        CodecId::kPackedF32,
        G::kArrays,
        {{{1.2, 34.20, 15.40}, {0.0, 25.25, 46.47}, {0.0, 8.79, 165.71}, {311.1, 19.99, 117.69}}}},
    CodecCost{CodecId::kPackedF32,
              G::kGrid,
              {{{1.2, 34.20, 223.79},
                {0.0, 25.25, 225.45},
                {0.0, 8.79, 351.84},
                {311.1, 19.99, 320.90}}}},
    CodecCost{
        CodecId::kPackedF16,
        G::kArrays,
        {{{6.6, 34.18, 13.17}, {0.0, 26.05, 46.73}, {0.0, 5.17, 179.25}, {319.8, 20.23, 114.75}}}},
    CodecCost{CodecId::kPackedF16,
              G::kGrid,
              {{{6.6, 34.18, 217.64},
                {0.0, 26.05, 224.39},
                {0.0, 5.17, 364.94},
                {319.8, 20.23, 317.99}}}},
    CodecCost{
        CodecId::kPackedF64,
        G::kArrays,
        {{{0.0, 39.60, 0.03}, {0.0, 14.10, 59.03}, {0.0, 4.36, 203.44}, {310.6, 19.66, 98.95}}}},
    CodecCost{CodecId::kPackedF64,
              G::kGrid,
              {{{0.0, 39.60, 212.10},
                {0.0, 14.10, 238.91},
                {0.0, 4.36, 390.56},
                {310.6, 19.66, 306.98}}}},
    CodecCost{
        CodecId::kDedup,
        G::kArrays,
        {{{22.2, 35.67, 1.76}, {0.0, 25.41, 52.58}, {0.0, 6.08, 177.40}, {321.2, 19.67, 116.98}}}},
    CodecCost{CodecId::kDedup,
              G::kGrid,
              {{{22.2, 35.67, 206.48},
                {0.0, 25.41, 230.47},
                {0.0, 6.08, 362.08},
                {321.2, 19.67, 319.77}}}},
    CodecCost{CodecId::kWide8,
              G::kArrays,
              {{{49.7, 17.03, 45.52},
                {72.0, 32.32, 42.84},
                {39.4, 70.57, 32.41},
                {236.3, 39.09, 119.66}}}},
    CodecCost{CodecId::kWide8,
              G::kExact,
              {{{49.7, 17.03, 77.66},
                {72.0, 32.32, 52.37},
                {39.4, 70.57, 56.29},
                {236.3, 39.09, 145.43}}}},
    CodecCost{CodecId::kWide8,
              G::kGrid,
              {{{49.7, 17.03, 72.96},
                {72.0, 32.32, 51.04},
                {39.4, 70.57, 54.92},
                {236.3, 39.09, 147.69}}}},
    CodecCost{CodecId::kWide8,
              G::kArrays,
              {{{49.7, 17.03, 65.83},
                {72.0, 32.32, 58.90},
                {39.4, 70.57, 50.71},
                {236.3, 39.09, 151.70}}},
              Precision::kF64},
    CodecCost{CodecId::kWide8,
              G::kExact,
              {{{49.7, 17.03, 103.75},
                {72.0, 32.32, 87.46},
                {39.4, 70.57, 89.14},
                {236.3, 39.09, 194.42}}},
              Precision::kF64},
    CodecCost{CodecId::kWide4,
              G::kArrays,
              {{{47.1, 19.62, 39.75},
                {75.0, 28.09, 44.64},
                {27.1, 60.03, 40.32},
                {242.5, 37.99, 94.93}}}},
    CodecCost{CodecId::kWide4,
              G::kExact,
              {{{47.1, 19.62, 67.49},
                {75.0, 28.09, 53.92},
                {27.1, 60.03, 62.86},
                {242.5, 37.99, 112.98}}}},
    CodecCost{CodecId::kWide4,
              G::kGrid,
              {{{47.1, 19.62, 65.16},
                {75.0, 28.09, 53.13},
                {27.1, 60.03, 61.75},
                {242.5, 37.99, 117.48}}}},
    CodecCost{CodecId::kWide4,
              G::kArrays,
              {{{47.1, 19.62, 60.23},
                {75.0, 28.09, 60.12},
                {27.1, 60.03, 58.35},
                {242.5, 37.99, 122.99}}},
              Precision::kF64},
    CodecCost{CodecId::kWide4,
              G::kExact,
              {{{47.1, 19.62, 98.47},
                {75.0, 28.09, 87.64},
                {27.1, 60.03, 96.21},
                {242.5, 37.99, 160.41}}},
              Precision::kF64},
};

}  // namespace

std::span<const CodecCost> compiled_costs() noexcept {
  return kMeasured;
}

}  // namespace boxtree::cooker
