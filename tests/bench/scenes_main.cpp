// SPDX-License-Identifier: MIT
// boxtree_scenes: a level of placed props as a scene, and as one tree of all their triangles.
// Prints bytes, and times of the same queries in one run.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cooker/choose/measure.h"
#include "runtime/tree/bound_tree.h"
#include "tests/bench/generated_mesh.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/program_options.h"
#include "tests/support/require.h"
#include "tests/support/scenes.h"

namespace boxtree::bench {
namespace {

using cooker::SourceMesh;
using Eigen::Vector3d;
using test::require;

struct Arguments {
  std::uint32_t instances = 1000;
  std::uint32_t props = 20;
  double spacing = 2;  // metres between props of about 1.5 metres
  std::string codec = "wide8";
  int queries = 20000;
  int rounds = 9;
  bool json = false;
};

std::vector<SourceMesh> make_props(std::uint32_t count) {
  std::vector<SourceMesh> props;
  for (std::uint32_t i = 0; i < count; ++i) {
    switch (i % 4) {
      case 0:
        props.push_back(test::torus(30 + i, 40));
        break;
      case 1:
        props.push_back(test::sphere(20 + i, 30));
        break;
      case 2:
        props.push_back(make_terrain(1500 + 100 * i, i));
        break;
      default:
        props.push_back(make_city(1500 + 100 * i, i));
        break;
    }
  }
  return props;
}

// Rows of props, rotated about axes near the vertical, each scaled to about 1.5 metres.
cooker::SceneParts place(const std::vector<SourceMesh>& props, const Arguments& arguments) {
  std::mt19937_64 random(1);
  const auto unit = [&] { return std::uniform_real_distribution<double>(-1, 1)(random); };
  const auto side =
      static_cast<std::uint32_t>(std::ceil(std::sqrt(static_cast<double>(arguments.instances))));
  cooker::SceneParts parts;
  parts.layers.push_back({"all"});
  for (std::uint32_t i = 0; i < arguments.instances; ++i) {
    cooker::PlacedTree placed;
    placed.tree = i % static_cast<std::uint32_t>(props.size());
    placed.id = i;
    const Eigen::AlignedBox3d bounds = cooker::bounds_of(props[placed.tree]);
    const Vector3d axis = Vector3d(0.2 * unit(), 1, 0.2 * unit()).normalized();
    placed.pose.linear() = Eigen::AngleAxisd(3 * unit(), axis).toRotationMatrix() *
                           (1.5 / bounds.diagonal().norm() * (1 + 0.5 * unit()));
    const Vector3d at(arguments.spacing * (i % side) + unit(), 0.3 * unit(),
                      arguments.spacing * (i / side) + unit());
    placed.pose.translation() = at - placed.pose.linear() * bounds.center();
    parts.instances.push_back(placed);
  }
  return parts;
}

SourceMesh merge(const std::vector<SourceMesh>& props, const cooker::SceneParts& parts) {
  SourceMesh merged;
  merged.name = "merged";
  for (const cooker::PlacedTree& placed : parts.instances) {
    const SourceMesh& prop = props[placed.tree];
    const auto base = static_cast<std::uint32_t>(merged.positions.size());
    for (std::size_t v = 0; v < prop.positions.size(); ++v) {
      const Vector3d p = placed.pose * prop.positions[v];
      for (Eigen::Index k = 0; k < 3; ++k) merged.positions.f32.push_back(static_cast<float>(p[k]));
    }
    for (cooker::Face face : prop.faces) {
      for (std::uint32_t& corner : face.corner) corner += corner == cooker::kNoCorner ? 0 : base;
      merged.faces.push_back(face);
    }
  }
  return merged;
}

struct Row {
  std::string kind;
  double scene_ns = 0;  // medians of the rounds: of each variant and of their ratio
  double merged_ns = 0;
  double ratio = 0;
  std::uint64_t scene_answers = 0;
  std::uint64_t merged_answers = 0;
};

class Bench {
 public:
  Bench(const Scene& scene, const Tree& merged, const Tree& body, const Arguments& arguments)
      : scene_(scene), merged_(merged), body_(body), arguments_(arguments) {
    bounds_ = BoundTree::of(merged).to_object(BoundTree::of(merged).root().box);
    for (int i = 0; i < arguments.queries; ++i) {
      const Vector3d from =
          i % 2 == 0 ? Vector3d(point() + Vector3d(0, 1, 0))
                     : Vector3d(bounds_.center() + bounds_.diagonal().norm() * direction());
      rays_.push_back({from, point() - from});
      points_.push_back(point());
    }
    for (int i = 0; i < arguments.queries / 10; ++i) {
      Pose pose = test::random_pose(random_, 1, false);
      pose.linear() *= 0.5;
      pose.translation() = point();
      poses_.push_back(pose);
    }
  }

  std::vector<Row> run() const { return {rays(), boxes(), spheres(), points(), pairs()}; }

 private:
  static constexpr double kHalfEdge = 0.3;  // metres, of boxes; radius of spheres

  double unit() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
  Vector3d direction() { return Vector3d(unit(), unit(), unit()).normalized(); }
  Vector3d point() {
    return bounds_.center() + 0.5 * Vector3d(unit(), unit(), unit()).cwiseProduct(bounds_.sizes());
  }
  Eigen::AlignedBox3d box(const Vector3d& middle) const {
    const Vector3d half = Vector3d::Constant(kHalfEdge);
    return {middle - half, middle + half};
  }

  // Alternates the two variants, so that temporary slowness of the machine affects both. The first
  // round only warms up. Counts the answers of the last.
  template <class OfScene, class OfTree>
  Row compare(const char* kind, std::size_t queries, OfScene of_scene, OfTree of_tree) const {
    Row row{kind};
    const double scale = 1e9 / static_cast<double>(queries);
    std::vector<double> scene, merged, ratios;
    for (int round = 0; round <= arguments_.rounds; ++round) {
      const double of_one = cooker::seconds_taken([&] { row.scene_answers = of_scene(); });
      const double of_other = cooker::seconds_taken([&] { row.merged_answers = of_tree(); });
      if (round == 0) continue;
      scene.push_back(of_one * scale);
      merged.push_back(of_other * scale);
      ratios.push_back(of_one / of_other);
    }
    row.scene_ns = cooker::median(scene);
    row.merged_ns = cooker::median(merged);
    row.ratio = cooker::median(ratios);
    return row;
  }
  // The sum of the results of `run_query` over all queries.
  template <class Queries, class RunQuery>
  static std::uint64_t sum(const Queries& queries, RunQuery run_query) {
    std::uint64_t answers = 0;
    for (const auto& query : queries) answers += run_query(query);
    return answers;
  }
  // Counts the visits of a query.
  template <class Answer, class Query>
  static std::uint64_t count(Query query) {
    std::uint64_t visited = 0;
    static_cast<void>(require(query([&](const Answer&) { return ++visited > 0; })));
    return visited;
  }

  Row rays() const {
    return compare(
        "ray", rays_.size(),
        [&] {
          return sum(rays_, [&](const Ray& ray) {
            return require(closest_hit(scene_, ray)).has_value() ? 1u : 0u;
          });
        },
        [&] {
          return sum(rays_, [&](const Ray& ray) {
            return require(closest_hit(merged_, ray)).has_value() ? 1u : 0u;
          });
        });
  }
  Row boxes() const {
    return compare(
        "box", points_.size(),
        [&] {
          return sum(points_, [&](const Vector3d& p) {
            return count<SceneFace>([&](auto visit) { return overlap_box(scene_, box(p), visit); });
          });
        },
        [&] {
          return sum(points_, [&](const Vector3d& p) {
            return count<FaceRef>([&](auto visit) { return overlap_box(merged_, box(p), visit); });
          });
        });
  }
  Row spheres() const {
    return compare(
        "sphere", points_.size(),
        [&] {
          return sum(points_, [&](const Vector3d& p) {
            return count<SceneFace>(
                [&](auto visit) { return overlap_sphere(scene_, p, kHalfEdge, visit); });
          });
        },
        [&] {
          return sum(points_, [&](const Vector3d& p) {
            return count<FaceRef>(
                [&](auto visit) { return overlap_sphere(merged_, p, kHalfEdge, visit); });
          });
        });
  }
  Row points() const {
    return compare(
        "point", points_.size(),
        [&] {
          return sum(points_, [&](const Vector3d& p) {
            return require(closest_point(scene_, p)).has_value() ? 1u : 0u;
          });
        },
        [&] {
          return sum(points_, [&](const Vector3d& p) {
            return require(closest_point(merged_, p)).has_value() ? 1u : 0u;
          });
        });
  }
  Row pairs() const {
    return compare(
        "pair", poses_.size(),
        [&] {
          return sum(poses_, [&](const Pose& pose) {
            return count<ScenePair>(
                [&](auto visit) { return overlap_pairs(scene_, body_, pose, visit); });
          });
        },
        [&] {
          return sum(poses_, [&](const Pose& pose) {
            return count<FacePair>([&](auto visit) {
              return overlap_pairs(merged_, Pose::Identity(), body_, pose, visit);
            });
          });
        });
  }

  const Scene& scene_;
  const Tree& merged_;
  const Tree& body_;
  const Arguments& arguments_;
  Eigen::AlignedBox3d bounds_;
  std::mt19937_64 random_{2};
  std::vector<Ray> rays_;
  std::vector<Vector3d> points_;
  std::vector<Pose> poses_;
};

void run(const Arguments& arguments) {
  const CodecId codec = arguments.codec == "wide4" ? CodecId::kWide4 : CodecId::kWide8;
  const std::vector<SourceMesh> props = make_props(arguments.props);
  const cooker::SceneParts parts = place(props, arguments);
  const SourceMesh all = merge(props, parts);
  const test::CookedScene cooked = test::cook_scene(props, parts, {codec});
  const Scene scene = require(Scene::bind(cooked.file));
  const test::CookedTree merged = test::cook_tree(all, codec);
  const test::CookedTree body = test::cook_tree(test::torus(20, 20), codec);
  const std::vector<Row> rows = Bench(scene, merged.tree, body.tree, arguments).run();
  const double share =
      static_cast<double>(cooked.bytes.size()) / static_cast<double>(merged.bytes.size());
  if (arguments.json) {
    nlohmann::ordered_json json = {{"instances", arguments.instances},
                                   {"props", arguments.props},
                                   {"triangles", all.triangle_count()},
                                   {"scene_bytes", cooked.bytes.size()},
                                   {"merged_bytes", merged.bytes.size()}};
    for (const Row& row : rows) {
      json["rows"].push_back({{"kind", row.kind},
                              {"scene_ns", row.scene_ns},
                              {"merged_ns", row.merged_ns},
                              {"ratio", row.ratio},
                              {"scene_answers", row.scene_answers},
                              {"merged_answers", row.merged_answers}});
    }
    fmt::print("{}\n", json.dump(1));
    return;
  }
  fmt::print("{} instances of {} props, {} triangles, {}: scene {} bytes, merged {} ({:.3f})\n",
             arguments.instances, arguments.props, all.triangle_count(), arguments.codec,
             cooked.bytes.size(), merged.bytes.size(), share);
  fmt::print("  {:<8} {:>10} {:>10} {:>7}  {:>10} {:>10}\n", "query", "scene ns", "merged ns",
             "ratio", "answers", "merged");
  for (const Row& row : rows) {
    fmt::print("  {:<8} {:>10.0f} {:>10.0f} {:>7.2f}  {:>10} {:>10}\n", row.kind, row.scene_ns,
               row.merged_ns, row.ratio, row.scene_answers, row.merged_answers);
  }
}

}  // namespace
}  // namespace boxtree::bench

int main(int argument_count, char** argument_values) {
  boxtree::bench::Arguments arguments;
  boxtree::test::ProgramOptions program{
      "A level of placed props as a scene and as one tree, times and bytes in one run"};
  program.add("--instances", arguments.instances).between(1, 100'000);
  program.add("--props", arguments.props).between(1, 1000);
  program.add("--spacing", arguments.spacing, "Metres between props of about 1.5 metres");
  program.add("--codec", arguments.codec).one_of({"wide8", "wide4"});
  program.add("--queries", arguments.queries).between(10, 10'000'000);
  program.add("--rounds", arguments.rounds).between(1, 1000);
  program.add_flag("--json", arguments.json);
  if (const std::optional<int> status = program.parse(argument_count, argument_values))
    return *status;
  try {
    boxtree::bench::run(arguments);
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "boxtree_scenes: {}\n", error.what());
    return 1;
  }
}
