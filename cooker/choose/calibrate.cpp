// SPDX-License-Identifier: MIT
// Counts and times the same queries, then fits the constants.
#include "cooker/choose/calibrate.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include <boxtree/boxtree.h>

#include "cooker/choose/measure.h"
#include "cooker/choose/search.h"
#include "cooker/import/file_error.h"
#include "runtime/tree/bound_tree.h"

namespace boxtree::cooker {
namespace {

template <class Query>
double nanoseconds(const std::vector<Query>& queries, std::size_t runs, Status& status,
                   const std::function<Errc(const Query&)>& run_query) {
  const double seconds = median_seconds(runs, [&] {
    for (const Query& query : queries) {
      if (const Errc error = run_query(query); error != Errc::kOk) status = error;
    }
  });
  return 1e9 * seconds / static_cast<double>(queries.size());
}

Result<QueryCost> time_queries(const Tree& tree, const Workload& queries, std::size_t runs) {
  Status status;
  const auto go_on = [](const auto&) { return true; };
  const QueryCost cost = {
      nanoseconds<Ray>(queries.rays, runs, status,
                       [&](const Ray& ray) { return closest_hit(tree, ray).code(); }),
      nanoseconds<Eigen::AlignedBox3d>(
          queries.boxes, runs, status,
          [&](const Eigen::AlignedBox3d& box) { return overlap_box(tree, box, go_on).code(); }),
      nanoseconds<Eigen::Vector3d>(
          queries.points, runs, status,
          [&](const Eigen::Vector3d& point) { return closest_point(tree, point).code(); }),
      nanoseconds<Pose>(queries.poses, runs, status, [&](const Pose& pose) {
        return overlap_pairs(tree, Pose::Identity(), tree, pose, go_on).code();
      })};
  if (!status) return status.error();
  return cost;
}

struct Sample {
  WorkOfKinds work;
  QueryCost ns;
};

Result<Sample> sample(const SourceMesh& mesh, CodecId codec, GeometryId geometry, std::size_t runs,
                      TimedWork& timed_work) {
  SearchOptions options;
  options.codec = codec;
  options.geometry = geometry;
  Result<TriedTree> tried = try_encodings(mesh, options);
  if (!tried) return in_file(mesh.name, tried.error());
  const WorkOfKinds work = tried->contest.candidates.front().work;
  const EncodedTree encoded = tried->take(0);
  const Result<Tree> tree = bind_encoded(encoded);
  if (!tree) return tree.error();
  const Workload queries = choice_queries(bounds_of(mesh));
  const Result<QueryCost> ns = timed_work.add([&] { return time_queries(*tree, queries, runs); });
  if (!ns) return ns.error();
  return Sample{work, *ns};
}

Result<std::vector<Sample>> sample_all(
    std::span<const SourceMesh> meshes, const CodecInfo& codec, GeometryId geometry,
    std::size_t runs, TimedWork& timed_work,
    const std::function<void(const std::string& step)>& progress) {
  std::vector<Sample> samples;
  for (const SourceMesh& mesh : meshes) {
    if (mesh.faces.empty()) continue;
    if (progress) {
      progress(fmt::format("{}: {}, {} of {}", mesh.name, codec.name, geometry_name(geometry),
                           precision_name(mesh.positions.precision)));
    }
    const Result<Sample> of_mesh = sample(mesh, codec.id, geometry, runs, timed_work);
    if (!of_mesh) return of_mesh.error();
    samples.push_back(*of_mesh);
  }
  return samples;
}

// `arrays`: of the same codec and precision, or null where these are fitted.
CodecCost fit(CodecId codec, GeometryId geometry, Precision precision,
              const std::vector<Sample>& samples, const CodecCost* arrays) {
  CodecCost cost{codec, geometry, {}, precision};
  for (std::size_t kind = 0; kind < kQueryKinds; ++kind) {
    std::vector<Measured> measured;
    measured.reserve(samples.size());
    for (const Sample& of_mesh : samples) {
      measured.push_back({of_mesh.work[kind], of_mesh.ns[kind]});
    }
    cost.of_kind[kind] =
        arrays == nullptr ? fit_steps(measured) : fit_leaf(measured, arrays->of_kind[kind]);
  }
  return cost;
}

// By how many times modelled and measured times differ at most.
double worst_ratio(const CodecCost& cost, const std::vector<Sample>& samples) {
  double worst = 0;
  for (const Sample& of_mesh : samples) {
    const QueryCost modelled =
        cost_of(of_mesh.work, cost.codec, cost.geometry, cost.precision, std::span(&cost, 1));
    for (std::size_t kind = 0; kind < kQueryKinds; ++kind) {
      const double ratio = modelled[kind] / of_mesh.ns[kind];
      worst = std::max({worst, ratio, 1 / ratio});
    }
  }
  return worst;
}

// The same positions as f64.
SourceMesh in_f64(const SourceMesh& mesh) {
  SourceMesh out = mesh;
  out.positions = {};
  out.positions.precision = Precision::kF64;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const Eigen::Vector3d p = mesh.positions[i];
    out.positions.f64.insert(out.positions.f64.end(), {p[0], p[1], p[2]});
  }
  return out;
}

}  // namespace

Result<Calibration> calibrate(std::span<const SourceMesh> meshes, std::size_t runs,
                              const std::function<void(const std::string& step)>& progress) {
  if (std::all_of(meshes.begin(), meshes.end(), [](const auto& m) { return m.faces.empty(); })) {
    return Errc::kNoFaces;
  }
  std::vector<SourceMesh> doubles;
  for (const SourceMesh& mesh : meshes) doubles.push_back(in_f64(mesh));
  Calibration out;
  for (const CodecInfo& codec : kCodecs) {
    for (const Precision precision : {Precision::kF32, Precision::kF64}) {
      const std::span<const SourceMesh> sampled =
          precision == Precision::kF64 ? std::span<const SourceMesh>(doubles) : meshes;
      std::optional<CodecCost> arrays;
      for (const GeometryId geometry :
           {GeometryId::kArrays, GeometryId::kExact, GeometryId::kGrid}) {
        if (!has_cost(codec.id, geometry, precision)) continue;
        const auto samples = sample_all(sampled, codec, geometry, runs, out.timed_work, progress);
        if (!samples) return samples.error();
        const CodecCost cost =
            fit(codec.id, geometry, precision, *samples, arrays ? &*arrays : nullptr);
        if (geometry == GeometryId::kArrays) arrays = cost;
        out.worst_ratio = std::max(out.worst_ratio, worst_ratio(cost, *samples));
        out.costs.push_back(cost);
      }
    }
  }
  return out;
}

}  // namespace boxtree::cooker
