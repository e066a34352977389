// SPDX-License-Identifier: MIT
// Nanoseconds of a query, a node and a leaf, for rays, boxes, points and pairs, as printed by
//     boxtree bench --calibrate MESH...
// for eleven models of 1000 to 70 000 triangles and the dragon of 871 414: AVX-512, processor time
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
        G::kExact,
        {{{23.4, 41.54, 0.00}, {0.0, 16.15, 87.91}, {0.0, 0.00, 204.73}, {184.1, 23.58, 94.85}}}},
    CodecCost{CodecId::kPlainF32,
              G::kGrid,
              {{{184.0, 46.33, 0.00},
                {0.0, 14.56, 184.18},
                {0.0, 0.00, 306.20},
                {218.4, 21.62, 225.85}}}},
    CodecCost{
        CodecId::kPlainF16,
        G::kExact,
        {{{0.0, 44.22, 0.00}, {0.0, 13.49, 107.89}, {0.0, 0.00, 223.63}, {190.5, 23.31, 109.64}}}},
    CodecCost{
        CodecId::kPlainF16,
        G::kGrid,
        {{{0.0, 57.33, 0.00}, {0.0, 11.50, 222.56}, {0.0, 0.00, 326.06}, {196.7, 22.39, 252.93}}}},
    CodecCost{
        CodecId::kPackedF32,
        G::kExact,
        {{{0.0, 48.82, 0.00}, {0.0, 22.18, 80.67}, {0.0, 0.00, 234.39}, {230.5, 22.61, 128.13}}}},
    CodecCost{
        CodecId::kPackedF32,
        G::kGrid,
        {{{6.8, 55.66, 0.00}, {0.0, 14.56, 188.25}, {0.0, 0.00, 320.68}, {178.2, 24.36, 210.38}}}},
    CodecCost{
        CodecId::kPackedF16,
        G::kExact,
        {{{0.0, 46.41, 0.00}, {0.0, 19.46, 83.41}, {0.0, 0.00, 225.19}, {207.6, 25.11, 111.28}}}},
    CodecCost{
        CodecId::kPackedF16,
        G::kGrid,
        {{{0.0, 59.12, 0.00}, {0.0, 25.65, 180.00}, {0.0, 0.00, 346.65}, {180.2, 29.65, 202.54}}}},
    CodecCost{
        CodecId::kPackedF64,
        G::kExact,
        {{{0.0, 47.88, 0.00}, {0.0, 7.73, 102.10}, {0.0, 0.00, 261.36}, {204.9, 22.25, 144.31}}}},
    CodecCost{
        CodecId::kPackedF64,
        G::kGrid,
        {{{0.0, 58.35, 0.00}, {0.0, 3.19, 217.41}, {0.0, 0.00, 349.46}, {186.0, 21.18, 246.42}}}},
    CodecCost{
        CodecId::kDedup,
        G::kExact,
        {{{0.0, 47.28, 0.00}, {0.0, 17.16, 95.42}, {0.0, 0.00, 228.87}, {237.8, 22.00, 122.51}}}},
    CodecCost{
        CodecId::kDedup,
        G::kGrid,
        {{{0.0, 56.07, 0.00}, {0.0, 19.37, 185.12}, {0.0, 0.00, 315.60}, {240.5, 21.61, 232.92}}}},
    CodecCost{
        CodecId::kWide8,
        G::kExact,
        {{{26.9, 14.87, 74.61}, {96.4, 0.00, 42.71}, {41.9, 0.00, 74.91}, {129.1, 42.08, 99.81}}}},
    CodecCost{CodecId::kWide8,
              G::kGrid,
              {{{0.0, 25.30, 142.85},
                {136.4, 4.56, 91.26},
                {0.0, 0.00, 148.62},
                {133.5, 38.58, 192.82}}}},
    CodecCost{
        CodecId::kWide4,
        G::kExact,
        {{{7.3, 19.84, 66.54}, {88.6, 0.00, 46.96}, {0.0, 0.00, 80.44}, {166.7, 35.14, 79.83}}}},
    CodecCost{CodecId::kWide4,
              G::kGrid,
              {{{0.0, 21.56, 154.92},
                {106.6, 35.53, 72.10},
                {0.0, 0.00, 147.26},
                {145.5, 38.95, 169.66}}}},
};

}  // namespace

std::span<const CodecCost> compiled_costs() noexcept {
  return kMeasured;
}

}  // namespace boxtree::cooker
