// SPDX-License-Identifier: MIT
// boxtree_scaling: the cost of a query as meshes grow. If cost grows by one step per level of the
// tree, times over the binary logarithm of the size form a line.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <boxtree/boxtree.h>

#include "cooker/choose/measure.h"
#include "cooker/cook.h"
#include "cooker/report/page.h"
#include "runtime/tree/bound_tree.h"
#include "tests/bench/generated_mesh.h"
#include "tests/support/program_options.h"
#include "tests/support/require.h"

namespace boxtree::bench {
namespace {

using cooker::SourceMesh;
using test::require;

struct Arguments {
  std::vector<std::filesystem::path> meshes;
  std::vector<std::size_t> sizes = {10'000,    31'623,    100'000,   316'228,
                                    1'000'000, 3'162'278, 10'000'000};
  std::string codec = "wide8";
  std::size_t runs = 5;
  std::size_t rays = 50'000;
  std::size_t poses = 200;
  std::filesystem::path html;
  bool quick = false;
  bool json = false;
};

struct Row {
  std::string mesh;
  std::size_t triangles = 0;
  double ray_ns = 0;
  double pair_first_us = 0;         // mean over poses
  double pair_first_median_us = 0;  // over the poses
  std::uint64_t ray_hits = 0;       // of one run
  std::uint64_t pair_hits = 0;      // the same
  double tree_bytes = 0;            // per triangle
  std::uint32_t depth = 0;
};

CodecId codec_of(const std::string& name) {
  return name == "wide4" ? CodecId::kWide4 : CodecId::kWide8;
}

Row measure(const std::string& name, const SourceMesh& mesh, const Arguments& arguments) {
  cooker::CookOptions options;
  options.face_ids = false;
  const cooker::EncodedTree encoded =
      require(cooker::cook_as(mesh, codec_of(arguments.codec), options));
  const Tree tree = require(cooker::bind_encoded(encoded));
  const cooker::Workload workload = cooker::make_workload(cooker::bounds_in_object_space(tree),
                                                          {arguments.rays, 0, 0, arguments.poses});

  Row row{name, mesh.triangle_count()};
  row.tree_bytes =
      static_cast<double>(encoded.nodes.bytes.size()) / static_cast<double>(row.triangles);
  row.depth = encoded.nodes.depth;
  const auto per_query = [&](std::size_t queries, auto body) {
    return cooker::median_seconds(arguments.runs, body) / static_cast<double>(queries);
  };
  row.ray_ns = 1e9 * per_query(workload.rays.size(), [&] {
                 row.ray_hits = 0;
                 for (const Ray& ray : workload.rays) {
                   row.ray_hits += require(closest_hit(tree, ray)).has_value() ? 1u : 0u;
                 }
               });
  row.pair_first_us = 1e6 * per_query(workload.poses.size(), [&] {
                        row.pair_hits = 0;
                        for (const Pose& pose : workload.poses) {
                          const auto contact = first_contact(tree, Pose::Identity(), tree, pose);
                          row.pair_hits += require(contact).has_value() ? 1u : 0u;
                        }
                      });
  // A pose takes less than the resolution of a clock.
  constexpr std::size_t kTimes = 16;
  std::vector<double> of_poses;
  for (const Pose& pose : workload.poses) {
    of_poses.push_back(1e6 * per_query(kTimes, [&] {
                         for (std::size_t i = 0; i < kTimes; ++i) {
                           static_cast<void>(
                               require(first_contact(tree, Pose::Identity(), tree, pose)));
                         }
                       }));
  }
  std::nth_element(of_poses.begin(), of_poses.begin() + std::ssize(of_poses) / 2, of_poses.end());
  row.pair_first_median_us = of_poses[of_poses.size() / 2];
  return row;
}

std::vector<Row> measure_all(const Arguments& arguments) {
  std::vector<Row> rows;
  const auto add = [&](const std::string& name, const SourceMesh& mesh) {
    rows.push_back(measure(name, mesh, arguments));
    static_cast<void>(std::fprintf(stderr, "%s, %zu triangles\n", name.c_str(), mesh.faces.size()));
  };
  for (const std::size_t size : arguments.sizes) add("terrain", make_terrain(size, 1));
  for (const std::size_t size : arguments.sizes) add("city", make_city(size, 1));
  for (const std::filesystem::path& path : arguments.meshes) {
    add(path.stem().string(), require(cooker::import_mesh(path)).mesh);
  }
  return rows;
}

// One series per mesh. `value` is the value on the other axis.
template <class Value>
cooker::PagePlot plot_of(const std::vector<Row>& rows, const std::string& title, Value value) {
  cooker::PagePlot plot{"log2 of the number of triangles", title, {}};
  for (const Row& row : rows) {
    if (plot.series.empty() || plot.series.back().name != row.mesh) {
      plot.series.push_back({row.mesh, {}});
    }
    plot.series.back().points.push_back(
        {std::log2(static_cast<double>(row.triangles)), value(row), ""});
  }
  return plot;
}

cooker::Page page_of(const std::vector<Row>& rows, const std::string& codec) {
  cooker::PageTable table;
  table.columns = {"mesh",
                   "triangles",
                   "log2",
                   "ray, ns",
                   "rays hit",
                   "first contact, us",
                   "of the median pose",
                   "contacts",
                   "nodes, B/tri",
                   "depth"};
  for (const Row& row : rows) {
    table.rows.push_back({row.mesh, fmt::format("{}", row.triangles),
                          fmt::format("{:.1f}", std::log2(static_cast<double>(row.triangles))),
                          fmt::format("{:.0f}", row.ray_ns), fmt::format("{}", row.ray_hits),
                          fmt::format("{:.2f}", row.pair_first_us),
                          fmt::format("{:.2f}", row.pair_first_median_us),
                          fmt::format("{}", row.pair_hits), fmt::format("{:.3f}", row.tree_bytes),
                          fmt::format("{}", row.depth)});
  }
  cooker::PageSection section{
      "Cost of a query against size",
      "Closest-hit rays from the sphere of twice the bounding radius toward random points of the "
      "bounds, and the first contact of a mesh with its turned copy; one thread, medians, caches "
      "as the queries before left them.",
      {table},
      {plot_of(rows, "closest-hit ray, ns", [](const Row& row) { return row.ray_ns; }),
       plot_of(rows, "first contact, mean, us", [](const Row& row) { return row.pair_first_us; }),
       plot_of(rows, "first contact, median pose, us",
               [](const Row& row) { return row.pair_first_median_us; })}};
  return {"boxtree: " + codec + " from small to large", "", {section}};
}

nlohmann::ordered_json json_of(const std::vector<Row>& rows, const std::string& codec) {
  nlohmann::ordered_json document;
  document["codec"] = codec;
  document["rows"] = nlohmann::ordered_json::array();
  for (const Row& row : rows) {
    document["rows"].push_back({{"mesh", row.mesh},
                                {"triangles", row.triangles},
                                {"ray_ns", row.ray_ns},
                                {"ray_hits", row.ray_hits},
                                {"pair_first_us", row.pair_first_us},
                                {"pair_first_median_us", row.pair_first_median_us},
                                {"pair_hits", row.pair_hits},
                                {"tree_bytes_per_triangle", row.tree_bytes},
                                {"depth", row.depth}});
  }
  return document;
}

void write_text(const std::filesystem::path& path, const std::string& text) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  bool written = file != nullptr;
  if (written) {
    written = std::fwrite(text.data(), 1, text.size(), file) == text.size();
    written &= std::fclose(file) == 0;
  }
  if (!written) throw std::runtime_error("cannot write " + path.string());
}

void run(Arguments arguments) {
  if (arguments.quick) {
    arguments.sizes = {1000, 10'000};
    arguments.runs = 1;
    arguments.rays = 500;
    arguments.poses = 20;
  }
  const std::vector<Row> rows = measure_all(arguments);
  const cooker::Page page = page_of(rows, arguments.codec);
  if (!arguments.html.empty()) write_text(arguments.html, to_html(page));
  const std::string out =
      arguments.json ? json_of(rows, arguments.codec).dump(1) + "\n" : to_text(page);
  static_cast<void>(std::fwrite(out.data(), 1, out.size(), stdout));
}

}  // namespace
}  // namespace boxtree::bench

int main(int argc, char** argv) {
  boxtree::bench::Arguments arguments;
  boxtree::test::ProgramOptions program(
      "Times of closest-hit rays and first contacts against the size of the mesh.");
  program.add("meshes", arguments.meshes, "Mesh files beside generated terrain and city");
  program.add("--sizes", arguments.sizes, "Triangles of the generated meshes").separated_by(',');
  program.add("--codec", arguments.codec, "wide8 or wide4")
      .one_of({"wide8", "wide4"})
      .shows_default();
  program.add("--runs", arguments.runs, "Runs whose median counts; one more goes before")
      .between(1, 1000)
      .shows_default();
  program.add("--html", arguments.html, "Write a page with tables and plots");
  program.add_flag("--quick", arguments.quick, "Small meshes and few queries");
  program.add_flag("--json", arguments.json, "Print one JSON document");
  if (const std::optional<int> status = program.parse(argc, argv)) return *status;
  try {
    boxtree::bench::run(arguments);
  } catch (const std::exception& error) {
    static_cast<void>(std::fprintf(stderr, "boxtree_scaling: %s\n", error.what()));
    return 2;
  }
  return 0;
}
