// SPDX-License-Identifier: MIT
// Measures one geometry store after another: the cooker's search counts its candidates, then they
// are queried here.
#include "cooker/report/tradeoff.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include <fmt/format.h>

#include <boxtree/boxtree.h>

#include "cooker/choose/measure.h"
#include "cooker/choose/search.h"
#include "cooker/import/f32_digits.h"
#include "cooker/import/file_error.h"
#include "cooker/report/scratch_file.h"
#include "cooker/write/file_writer.h"
#include "runtime/tree/bound_tree.h"

namespace boxtree::cooker {
namespace {

constexpr std::array kFullSweep = {8, 10, 12, 14, 16, 18, 21, 24, 27, 30};
constexpr std::array kQuickSweep = {10, 14, 18, 24};

struct Effort {
  WorkloadSize timed;
  WorkloadSize answered;
  WorkloadSize approximate;
  std::size_t runs;
  std::size_t cold;  // queries of a kind, each on a cold file
};
constexpr Effort kFullEffort{
    {20'000, 4'000, 4'000, 64, 0}, {200'000, 0, 20'000, 0, 0}, {0, 0, 2'000, 0, 64}, 7, 300};
constexpr Effort kQuickEffort{
    {2'000, 400, 400, 16, 0}, {20'000, 0, 2'000, 0, 0}, {0, 0, 400, 0, 16}, 3, 100};

// Where n faces cross in one place, n * n pairs touch; more than these say nothing new.
constexpr std::size_t kMostPairs = 100'000;

Result<std::array<KindTimes, kTimedKinds>> time_kinds(const Tree& tree, const Workload& queries,
                                                      std::size_t runs) {
  Status status;
  const Pose here = Pose::Identity();
  const Tree originals = tree.without_duplicates();  // as count_work() counts
  const std::array<KindTimes, kTimedKinds> times = {
      time_each(queries.rays, runs, status,
                [&](const Ray& ray) { return closest_hit(tree, ray).code(); }),
      time_each(queries.boxes, runs, status,
                [&](const Eigen::AlignedBox3d& box) {
                  return overlap_box(tree, box, [](const FaceRef&) { return true; }).code();
                }),
      time_each(queries.points, runs, status,
                [&](const Eigen::Vector3d& point) { return closest_point(tree, point).code(); }),
      time_each(queries.poses, runs, status,
                [&](const Pose& pose) {
                  std::size_t pairs = 0;
                  const auto go_on = [&](const FacePair&) { return ++pairs < kMostPairs; };
                  return overlap_pairs(originals, here, originals, pose, go_on).code();
                }),
      time_each(queries.poses, runs, status,
                [&](const Pose& pose) { return first_contact(tree, here, tree, pose).code(); }),
      time_each(queries.rays, runs, status,
                [&](const Ray& ray) {
                  return cast_closest(tree, Sphere{ray.origin, queries.cast_radius},
                                      Motion{ray.direction})
                      .code();
                }),
      time_each(queries.boxes, runs, status, [&](const Eigen::AlignedBox3d& box) {
        const Sphere inside{box.center(), box.sizes().maxCoeff() / 2};
        return collide(tree, inside, [](const Contact&) { return true; }).code();
      })};
  if (!status) return status.error();
  return times;
}

// The answers that are compared, for one geometry.
struct Answers {
  std::vector<double> ray_lengths;  // to the hit, object space; infinite without one
  std::vector<double> distances;
};

Result<Answers> answers_of(const Tree& tree, const Workload& queries) {
  Answers answers;
  answers.ray_lengths.reserve(queries.rays.size());
  answers.distances.reserve(queries.points.size());
  for (const Ray& ray : queries.rays) {
    const auto hit = closest_hit(tree, ray);
    if (!hit.ok()) return hit.error();
    answers.ray_lengths.push_back(hit.has_value() ? hit->t * ray.direction.norm()
                                                  : std::numeric_limits<double>::infinity());
  }
  for (const Eigen::Vector3d& point : queries.points) {
    const auto closest = closest_point(tree, point);
    if (!closest.ok()) return closest.error();
    answers.distances.push_back(closest.has_value() ? closest->distance
                                                    : std::numeric_limits<double>::infinity());
  }
  return answers;
}

AnswerErrors compare(const Answers& found, const Answers& exact, double diagonal) {
  AnswerErrors errors;
  std::vector<double> ray_errors;
  std::size_t flips = 0;
  for (std::size_t i = 0; i < exact.ray_lengths.size(); ++i) {
    const bool hits = std::isfinite(found.ray_lengths[i]);
    const bool should = std::isfinite(exact.ray_lengths[i]);
    if (hits != should) ++flips;
    if (hits && should) {
      ray_errors.push_back(std::abs(found.ray_lengths[i] - exact.ray_lengths[i]) / diagonal);
    }
  }
  std::vector<double> distance_errors;
  for (std::size_t i = 0; i < exact.distances.size(); ++i) {
    distance_errors.push_back(std::abs(found.distances[i] - exact.distances[i]) / diagonal);
    errors.distance_max = std::max(errors.distance_max, distance_errors.back());
  }
  if (!ray_errors.empty()) errors.ray_median = median(std::move(ray_errors));
  if (!distance_errors.empty()) errors.distance_median = median(std::move(distance_errors));
  if (!exact.ray_lengths.empty()) {
    errors.flips_per_million =
        1e6 * static_cast<double>(flips) / static_cast<double>(exact.ray_lengths.size());
  }
  return errors;
}

// Root mean square of the vertices' movement on a grid, object space.
double rms_move(const SourceMesh& mesh, const QuantisedPositions& quantised) {
  double sum = 0;
  const std::size_t count = mesh.positions.size();
  const Eigen::Vector3d origin(quantised.origin[0], quantised.origin[1], quantised.origin[2]);
  const double step = std::ldexp(1.0, quantised.step_exponent);
  for (std::size_t i = 0; i < count; ++i) {
    sum += (quantised.positions[i] * step + origin - mesh.positions[i]).squaredNorm();
  }
  return count == 0 ? 0 : std::sqrt(sum / static_cast<double>(count));
}

ByteParts bytes_of(const EncodedTree& tree, std::size_t file_bytes) {
  ByteParts parts{tree.nodes.bytes.size() + tree.geometry.duplicates.size(),
                  tree.geometry.vertices.size(), tree.geometry.corners.size(),
                  tree.geometry.face_ids.size(), 0};
  parts.rest = file_bytes - parts.total();
  return parts;
}

// One mesh: see measure_tradeoff.
class Measurement {
 public:
  Measurement(const SourceMesh& mesh, const TradeoffOptions& options, const ShareProgress& progress)
      : mesh_(mesh),
        options_(options),
        progress_(progress),
        effort_(options.quick ? kQuickEffort : kFullEffort),
        timed_(make_workload(bounds_of(mesh), effort_.timed)),
        answered_(make_workload(bounds_of(mesh), effort_.answered, 2)),
        approximate_(make_workload(bounds_of(mesh), effort_.approximate, 3)) {
    out_.name = mesh.name;
    out_.triangles = mesh.triangle_count();
    out_.vertices = mesh.positions.size();
    out_.diagonal = bounds_of(mesh).diagonal().norm();
    out_.is_f64 = mesh.positions.precision == Precision::kF64;
    const bool is_told = mesh.moved_by_f32 > unnoticed_move(mesh.positions);
    out_.moved_by_f32 = is_told ? mesh.moved_by_f32 : 0;
    out_.f32_loss = mesh.f32_loss;
    out_.tolerance = options.tolerance;
    if (options.tolerance) {
      out_.tolerance_left = in_diagonals(tolerance_left(*options.tolerance, mesh));
    }
    out_.timed = options.times;
    const std::uint64_t coordinate = mesh.positions.precision == Precision::kF64 ? 8 : 4;
    out_.source.vertices = out_.vertices * 3 * coordinate;
    out_.source.corners = out_.triangles * 3 * 4;
    const std::size_t grids = grid_sweep(options.quick).size() + (options.tolerance ? 1 : 0);
    steps_ = kCodecs.size() + 2 + kApproximateCodecs.size() + 2 * grids;
  }

  Result<MeshTradeoff> run() {
    if (Status status = measure_store({}); !status) return status.error();
    for (const SweptGrid& grid : grids()) {
      const Status status = measure_store(grid);
      // The grid is too fine for positions so far from zero.
      if (!status && status.error().code != Errc::kMeshUnsupported) return status.error();
    }
    enter_extra_work();
    return std::move(out_);
  }

 private:
  // A grid of the sweep, or that of the tolerance.
  struct SweptGrid {
    GridChoice choice;
    int bits;
  };

  // Coarsest first. Those that cannot be are left out.
  [[nodiscard]] std::vector<SweptGrid> grids() const {
    std::vector<SweptGrid> grids;
    std::optional<int> extent_exponent;
    for (const int bits : grid_sweep(options_.quick)) {
      const Result<Grid> grid = choose_grid(bounds_of(mesh_), {.bits = bits});
      if (grid && !extent_exponent) extent_exponent = grid->step_exponent + bits;
      grids.push_back({{.bits = bits}, bits});
    }
    const std::array meshes{&mesh_};
    const Result<Grid> grid = options_.tolerance && extent_exponent
                                  ? choose_grid(meshes, {.tolerance = options_.tolerance})
                                  : Errc::kMeshUnsupported;
    if (!grid) return grids;
    // A step as large as the mesh has a bit, too: 0 stands for exact positions.
    const int bits = std::max(*extent_exponent - grid->step_exponent, 1);
    const auto finer = std::find_if(grids.begin(), grids.end(),
                                    [bits](const SweptGrid& other) { return other.bits > bits; });
    grids.insert(finer, {{.tolerance = options_.tolerance}, bits});
    return grids;
  }

  void announce(const std::string& what) {
    if (progress_) {
      progress_(mesh_.name + ": " + what,
                static_cast<double>(std::min(step_, steps_)) / static_cast<double>(steps_));
    }
  }

  // All candidates with exact geometry, or those of the wide codecs on a grid.
  Status measure_store(const std::optional<SweptGrid>& swept) {
    announce(!swept                    ? "exact geometry"
             : swept->choice.tolerance ? fmt::format("tolerance of {}", *swept->choice.tolerance)
                                       : fmt::format("grid of {} bits", swept->bits));
    SearchOptions search;
    search.try_all = !swept;
    search.keep_all = true;
    search.geometry = swept ? GeometryId::kGrid : GeometryId::kExact;
    search.may_use_arrays = true;
    double rms = 0;
    double bound = 0;
    int step_exponent = 0;
    if (swept) {
      search.grid = swept->choice;
      const std::array meshes{&mesh_};
      const Result<Grid> grid = choose_grid(meshes, search.grid);
      if (!grid) return grid.error();
      step_exponent = grid->step_exponent;
      rms = rms_move(mesh_, quantise(mesh_, *grid));
      // A vertex moves at most half a step along each axis.
      bound = std::sqrt(3.0) / 2 * std::ldexp(1.0, grid->step_exponent);
    }
    Result<TriedTree> tried = try_encodings(mesh_, search);
    if (!tried) return in_file(mesh_.name, tried.error());
    const std::vector<Candidate>& candidates = tried->contest.candidates;
    if (!swept) {
      if (Status status = find_exact_answers(*tried); !status) return status;
    }
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      if (swept && !is_wide(candidates[i].codec)) continue;
      TradePoint point = point_of(candidates[i]);
      if (swept) {
        point.grid_bits = swept->bits;
        point.tolerance = swept->choice.tolerance;
        point.grid_step_exponent = step_exponent;
      }
      point.surface_rms = in_diagonals(rms);
      point.surface_bound = in_diagonals(bound);
      announce("query " + point.name());
      if (Status status = run_query(*tried, i, point); !status) return status;
      out_.points.push_back(std::move(point));
      ++step_;
    }
    return {};
  }

  [[nodiscard]] double in_diagonals(double length) const {
    return out_.diagonal > 0 ? length / out_.diagonal : 0;
  }

  [[nodiscard]] TradePoint point_of(const Candidate& candidate) const {
    TradePoint point;
    point.codec = candidate.codec;
    point.geometry = candidate.geometry;
    point.gates = candidate.gates;
    point.work = candidate.work;
    point.reference = is_wide(candidate.codec) ? CodecId::kWide8 : CodecId::kPlainF32;
    point.surface_max = in_diagonals(candidate.max_vertex_error - mesh_.moved_by_f32);
    point.modelled = candidate.cost;
    return point;
  }

  // The encoded tree of a candidate, in memory that the next candidate reuses. Without a name, as
  // `cook --strip` writes it.
  static EncodedTree& assemble(TriedTree& tried, std::size_t candidate) {
    EncodedTree& tree = tried.families[tried.nodes[candidate].family];
    tree.name.clear();
    tree.nodes = std::move(tried.nodes[candidate].nodes);
    return tree;
  }
  static void release(TriedTree& tried, std::size_t candidate) {
    tried.nodes[candidate].nodes = std::move(tried.families[tried.nodes[candidate].family].nodes);
  }

  Status find_exact_answers(TriedTree& tried) {
    const std::vector<Candidate>& candidates = tried.contest.candidates;
    const auto found = std::find_if(candidates.begin(), candidates.end(), [](const Candidate& c) {
      return c.codec == CodecId::kPlainF32;
    });
    const auto i = static_cast<std::size_t>(found - candidates.begin());
    if (found == candidates.end() || !found->gates.pass()) {
      return Error{Errc::kInternal, mesh_.name + ": nothing to compare answers with"};
    }
    const EncodedTree& encoded = assemble(tried, i);
    const Result<Tree> tree = bind_encoded(encoded);
    if (!tree) return tree.error();
    Result<Answers> answers = answers_of(*tree, answered_);
    if (!answers) return answers.error();
    exact_ = std::move(*answers);
    Result<TrueDistances> truth = true_distances(*tree, approximate_);
    if (!truth) return truth.error();
    truth_ = std::move(*truth);
    release(tried, i);
    return {};
  }

  Status run_query(TriedTree& tried, std::size_t candidate, TradePoint& point) {
    const EncodedTree& encoded = assemble(tried, candidate);
    const std::vector<std::byte> file = serialize(std::span(&encoded, 1));
    point.bytes = bytes_of(encoded, file.size());
    if (!point.gates.pass()) return {};  // listed as failed, not queried
    const Result<Tree> tree = bind_encoded(encoded);
    if (!tree) return tree.error();
    const Result<Answers> answers = answers_of(*tree, answered_);
    if (!answers) return answers.error();
    point.answers = compare(*answers, exact_, out_.diagonal > 0 ? out_.diagonal : 1);
    const Result<ScratchFile> on_disk = ScratchFile::create(file);
    if (!on_disk) return on_disk.error();
    const Result<PageFigures> pages = measure_pages(on_disk->path(), 0, effort_.cold);
    if (!pages) return pages.error();
    point.pages = *pages;
    if (options_.times) {
      const auto times =
          out_.timed_work.add([&] { return time_kinds(*tree, timed_, effort_.runs); });
      if (!times) return times.error();
      point.times = *times;
    }
    const bool is_approximated = std::find(kApproximateCodecs.begin(), kApproximateCodecs.end(),
                                           point.codec) != kApproximateCodecs.end();
    // The errors are those of either store with exact positions.
    const bool is_second = is_wide(point.codec) && point.geometry == GeometryId::kArrays;
    if (point.grid_bits != 0 || !is_approximated || is_second) return {};
    ++step_;
    announce("query " + point.name() + ", approximately");
    Result<ApproximateFigures> figures =
        measure_approximate(*tree, approximate_, truth_,
                            {options_.quick, options_.times ? effort_.runs : std::size_t{0}});
    if (!figures) return figures.error();
    point.approximate = std::move(*figures);
    return {};
  }

  void enter_extra_work() {
    for (TradePoint& point : out_.points) {
      const auto reference =
          std::find_if(out_.points.begin(), out_.points.end(), [&](const TradePoint& other) {
            return other.codec == point.reference && is_lossless(other.geometry);
          });
      const auto extra = [](double work, double of_reference) {
        return of_reference > 0 ? work / of_reference - 1 : 0;
      };
      for (std::size_t kind = 0; kind < kQueryKinds; ++kind) {
        point.extra_nodes[kind] = extra(point.work[kind].nodes, reference->work[kind].nodes);
        point.false_leaf_tests[kind] = extra(point.work[kind].leaves, reference->work[kind].leaves);
      }
    }
  }

  const SourceMesh& mesh_;
  const TradeoffOptions& options_;
  const ShareProgress& progress_;
  const Effort& effort_;
  const Workload timed_;
  const Workload answered_;
  const Workload approximate_;
  Answers exact_;
  TrueDistances truth_;
  std::size_t step_ = 0;
  std::size_t steps_ = 1;
  MeshTradeoff out_;
};

}  // namespace

std::string TradePoint::name() const {
  if (grid_bits == 0) return fmt::format("{}, {}", codec_name(codec), geometry_name(geometry));
  return tolerance ? fmt::format("{}, tolerance {}", codec_name(codec), *tolerance)
                   : fmt::format("{}, grid {}", codec_name(codec), grid_bits);
}

std::span<const int> grid_sweep(bool quick) noexcept {
  return quick ? std::span<const int>(kQuickSweep) : std::span<const int>(kFullSweep);
}

Result<MeshTradeoff> measure_tradeoff(const SourceMesh& mesh, const TradeoffOptions& options,
                                      const ShareProgress& progress) {
  if (mesh.faces.empty()) return Error{Errc::kNoFaces, mesh.name};
  return Measurement(mesh, options, progress).run();
}

std::vector<std::size_t> pareto_front(std::span<const TwoCosts> points) {
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return points[a].x != points[b].x ? points[a].x < points[b].x : points[a].y < points[b].y;
  });
  std::vector<std::size_t> front;
  for (const std::size_t i : order) {
    if (front.empty() || points[i].y < points[front.back()].y) front.push_back(i);
  }
  return front;
}

}  // namespace boxtree::cooker
