// SPDX-License-Identifier: MIT
// Measures error, time and bytes of one mesh in every encoding; each point has its costs and its
// errors.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cooker/choose/cost.h"
#include "cooker/choose/timed_work.h"
#include "cooker/import/source_mesh.h"
#include "cooker/proof/gates.h"
#include "cooker/report/approximate.h"
#include "cooker/report/pages.h"

namespace boxtree::cooker {

/// Kinds of queries that are timed. The first four are also counted (QueryKind; pairs are all
/// contacts). First contacts are what other libraries are compared by.
inline constexpr std::size_t kTimedKinds = 7;
inline constexpr std::size_t kFirstContact = 4;
inline constexpr std::array<const char*, kTimedKinds> kTimedNames = {
    "ray", "box", "point", "all_contacts", "first_contact", "cast_sphere", "collide_sphere"};

/// Codecs that are queried with allowed errors and budgets.
inline constexpr std::array kApproximateCodecs = {CodecId::kWide8, CodecId::kWide4,
                                                  CodecId::kPlainF32};

/// Bytes of one file with one tree, by purpose.
struct ByteParts {
  std::uint64_t nodes = 0;  // and duplicates
  std::uint64_t vertices = 0;
  std::uint64_t corners = 0;
  std::uint64_t face_ids = 0;
  std::uint64_t rest = 0;  // header, records, name, padding

  [[nodiscard]] std::uint64_t total() const { return nodes + vertices + corners + face_ids + rest; }
  /// Nodes and geometry, which queries need: what `cook` counts.
  [[nodiscard]] std::uint64_t queried() const { return nodes + vertices + corners; }
};

/// Differences from the answers of exact geometry; lengths as shares of the mesh's diagonal.
struct AnswerErrors {
  double distance_max = 0;       // of closest points
  double distance_median = 0;    // of closest points
  double ray_median = 0;         // of the hits that both geometries have
  double flips_per_million = 0;  // rays that hit with one geometry only
};

/// One encoding of a mesh.
struct TradePoint {
  CodecId codec{};
  GeometryId geometry = GeometryId::kExact;
  int grid_bits = 0;  // 0: exact positions
  int grid_step_exponent = 0;
  std::optional<double> tolerance;  // of TradeoffOptions, if it decided the grid
  ByteParts bytes;
  Gates gates;
  WorkOfKinds work{};
  CodecId reference{};  // baseline of extra work: the same mesh with exact geometry
  std::array<double, kQueryKinds> extra_nodes{};       // nodes / nodes of the reference - 1
  std::array<double, kQueryKinds> false_leaf_tests{};  // the same for leaves
  // Moves of the surface from where it was read, as shares of the diagonal.
  double surface_max = 0;    // largest of a point
  double surface_rms = 0;    // over the vertices
  double surface_bound = 0;  // the grid's bound
  AnswerErrors answers;
  QueryCost modelled{};                        // by counted work; the last kind is all contacts
  std::array<KindTimes, kTimedKinds> times{};  // zero unless timed
  PageFigures pages;                           // of a file with only this tree

  /// For exact geometry and the codecs in kApproximateCodecs; otherwise empty.
  ApproximateFigures approximate;

  [[nodiscard]] std::string name() const;  // "wide8, grid 24", "wide8, tolerance 0.001"
};

struct MeshTradeoff {
  std::string name;
  std::string file_name = {};  // of its source, without folders; empty if it has none
  std::uint64_t triangles = 0;
  std::uint64_t vertices = 0;
  double diagonal = 0;                  // of the bounds, object space
  std::uint64_t skipped = 0;            // bad faces that --skip-bad left out
  bool is_f64 = false;                  // its positions
  double moved_by_f32 = 0;              // ImportReport::moved_by_f32
  F32Loss f32_loss = F32Loss::kDigits;  // of moved_by_f32
  std::optional<double> tolerance;      // of TradeoffOptions
  double tolerance_left = 0;            // of it for moves of the surface; share of the diagonal
  ByteParts source;                     // positions and 32-bit corners, as in an application
  std::vector<TradePoint> points;
  bool timed = false;
  TimedWork timed_work;  // all queries of `times`

  [[nodiscard]] double per_triangle(std::uint64_t bytes) const {
    return static_cast<double>(bytes) / static_cast<double>(triangles);
  }
};

struct TradeoffOptions {
  bool quick = false;  // fewer grids, fewer queries
  bool times = true;
  std::optional<double> tolerance;  // a grid of that, too, object space
};

/// Called with each step and the share that is done, 0 to 1; may be empty.
using ShareProgress = std::function<void(const std::string& step, double share)>;

/// Grids to try, finest last.
[[nodiscard]] std::span<const int> grid_sweep(bool quick) noexcept;

/// Encodes a mesh with every codec and exact geometry, and with wide8 and wide4 on each grid of the
/// sweep and on that of a tolerance. A grid that double precision cannot hold is skipped. The
/// reference for work is plain-f32 (whose boxes are exact for f32 positions) for codecs with one
/// triangle per leaf, and wide8 for those with full leaves, whose tree differs. The reference for
/// answers is plain-f32. Errors: kNoFaces, and those of cooking and queries.
Result<MeshTradeoff> measure_tradeoff(const SourceMesh& mesh, const TradeoffOptions& options,
                                      const ShareProgress& progress = {});

/// Two costs; less is better.
struct TwoCosts {
  double x = 0;
  double y = 0;
};

/// The points that no other point beats, that is, is no worse in both costs and better in one.
/// Ordered by increasing x; of equal points the first.
[[nodiscard]] std::vector<std::size_t> pareto_front(std::span<const TwoCosts> points);

}  // namespace boxtree::cooker
