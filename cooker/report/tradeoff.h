// SPDX-License-Identifier: MIT
// Error against time against bytes: one mesh in every encoding, each point beside what it costs and
// what it gets wrong.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "cooker/choose/cost.h"
#include "cooker/import/source_mesh.h"
#include "cooker/proof/gates.h"
#include "cooker/report/approximate.h"
#include "cooker/report/pages.h"

namespace boxtree::cooker {

/// Kinds of queries that are timed. The first three are also counted (QueryKind); of pairs the
/// first contact is timed, all contacts are counted.
inline constexpr std::size_t kTimedKinds = 4;
inline constexpr std::array<const char*, kTimedKinds> kTimedNames = {"ray", "box", "point",
                                                                     "first_contact"};

/// Codecs that are queried with allowed errors and budgets: ours and the paper's.
inline constexpr std::array kApproximateCodecs = {CodecId::kWide8, CodecId::kWide4,
                                                  CodecId::kPlainF32};

/// Bytes of one file with one tree, by what they are for.
struct ByteParts {
  std::uint64_t nodes = 0;
  std::uint64_t vertices = 0;
  std::uint64_t corners = 0;
  std::uint64_t face_ids = 0;
  std::uint64_t rest = 0;  // header, records, name, padding

  [[nodiscard]] std::uint64_t total() const { return nodes + vertices + corners + face_ids + rest; }
};

/// How far answers are from those of exact geometry; lengths as shares of the mesh's diagonal.
struct AnswerErrors {
  double distance_max = 0;       // of closest points
  double distance_median = 0;    // likewise
  double ray_median = 0;         // of the hits that both have
  double flips_per_million = 0;  // rays that hit one and miss the other
};

/// One encoding of a mesh.
struct TradePoint {
  CodecId codec{};
  GeometryId geometry = GeometryId::kExact;
  int grid_bits = 0;  // 0: every position as it was
  ByteParts bytes;
  Gates gates;
  WorkOfKinds work{};
  CodecId reference{};  // what extra work is counted against: the same mesh, exact geometry
  std::array<double, kQueryKinds> extra_nodes{};       // nodes / nodes of the reference - 1
  std::array<double, kQueryKinds> false_leaf_tests{};  // the same of leaves
  double surface_max = 0;    // no point of the surface moved farther; share of the diagonal
  double surface_rms = 0;    // over the vertices
  double surface_bound = 0;  // what the grid promises
  AnswerErrors answers;
  QueryCost modelled{};                        // by counted work; its last kind is all contacts
  std::array<KindTimes, kTimedKinds> times{};  // zero unless timed
  PageFigures pages;                           // of a file with this tree alone

  /// Of exact geometry and the codecs in kApproximateCodecs; empty otherwise.
  ApproximateFigures approximate;

  [[nodiscard]] std::string name() const;  // "wide8, grid 24"
};

struct MeshTradeoff {
  std::string name;
  std::uint64_t triangles = 0;
  std::uint64_t vertices = 0;
  double diagonal = 0;  // of the bounds, object space
  ByteParts source;     // positions and 32-bit corners, as an application holds them
  std::vector<TradePoint> points;
  bool timed = false;

  [[nodiscard]] double per_triangle(std::uint64_t bytes) const {
    return static_cast<double>(bytes) / static_cast<double>(triangles);
  }
};

struct TradeoffOptions {
  bool quick = false;  // fewer grids, fewer queries
  bool times = true;
};

/// Told of each step and of the share that is done, 0 to 1; may be empty.
using ShareProgress = std::function<void(const std::string& step, double share)>;

/// Grids that are tried, finest last.
[[nodiscard]] std::span<const int> grid_sweep(bool quick) noexcept;

/// Encodes a mesh as every codec with exact geometry and as wide8 and wide4 on each grid of the
/// sweep; a grid that double precision cannot hold is left out. The reference for work is plain-f32
/// (whose boxes are exact for f32 positions) for codecs with one triangle per leaf and wide8 for
/// those with full leaves, which stand on a tree of their own; the reference for answers is
/// plain-f32. Errors: kNoFaces, and those of cooking and queries.
Result<MeshTradeoff> measure_tradeoff(const SourceMesh& mesh, const TradeoffOptions& options,
                                      const ShareProgress& progress = {});

/// Two things of which less is better.
struct TwoCosts {
  double x = 0;
  double y = 0;
};

/// The points that no other point beats: none has as little of both and less of one. In order of
/// growing x; of equal points the first.
[[nodiscard]] std::vector<std::size_t> pareto_front(std::span<const TwoCosts> points);

}  // namespace boxtree::cooker
