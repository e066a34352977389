// SPDX-License-Identifier: MIT
// boxtree_coincident: the cost of queries on meshes with coincident or coplanar faces, compared
// with an ordinary mesh of as many faces.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <map>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <boxtree/boxtree.h>

#include "cooker/cook.h"
#include "runtime/tree/bound_tree.h"
#include "tests/support/coincident.h"
#include "tests/support/meshes.h"
#include "tests/support/program_options.h"
#include "tests/support/require.h"

namespace boxtree::bench {
namespace {

using cooker::SourceMesh;
using test::require;

// Directions that are the same on every machine.
std::vector<Eigen::Vector3d> directions(std::size_t count) {
  std::mt19937 random(7);
  const auto coordinate = [&] { return static_cast<double>(random()) * 0x1p-31 - 1; };
  std::vector<Eigen::Vector3d> all;
  while (all.size() < count) {
    const double x = coordinate(), y = coordinate(), z = coordinate();
    const Eigen::Vector3d v(x, y, z);
    if (v.norm() > 0.1 && v.norm() < 1) all.push_back(v.normalized());
  }
  return all;
}

// Beside the mesh along (-1, 0, 1), the normal of the plane z = x, so near that boxes overlap.
Pose beside(bool tilted) {
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(-0.01, 0, 0.01);
  if (tilted) {
    pose.linear() = Eigen::AngleAxisd(1.0 / 64, Eigen::Vector3d::UnitY()).toRotationMatrix();
  }
  return pose;
}

// Seconds per query: the least of three runs; fewer if one takes long.
template <class Body>
double seconds(std::size_t queries, const Body& body) {
  constexpr double kLong = 0.5;
  double least = 0;
  for (int run = 0; run < 3; ++run) {
    const auto start = std::chrono::steady_clock::now();
    body();
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    least = run == 0 ? taken.count() : std::min(least, taken.count());
    if (least > kLong) break;
  }
  return least / static_cast<double>(queries);
}

// Discards an answer.
template <class T>
void run(const T& result) {
  static_cast<void>(require(result));
}

using Row = std::map<std::string, double>;

Row measure(const SourceMesh& mesh, CodecId codec) {
  const cooker::EncodedTree encoded = require(cooker::cook_as(mesh, codec));
  const Tree tree = require(cooker::bind_encoded(encoded));
  const std::vector<Eigen::Vector3d> from = directions(64);
  Row row;
  row["1 ray"] = seconds(from.size(), [&] {
    for (const Eigen::Vector3d& d : from) run(closest_hit(tree, {3 * d, 0.01 * d - d}));
  });
  row["2 point"] = seconds(from.size(), [&] {
    for (const Eigen::Vector3d& d : from) run(closest_point(tree, Eigen::Vector3d(2 * d)));
  });
  const Pose at = Pose::Identity();
  // So far that ordinary meshes are apart, too.
  Pose apart = beside(true);
  apart.translation() = Eigen::Vector3d(-1.43, 0, 1.43);
  const bool is_thin = mesh.name.find("sphere") == std::string::npos && mesh.name != "plates";
  for (const bool tilted : {false, true}) {
    const Pose pose = is_thin ? beside(tilted) : apart;
    const std::string how = tilted ? " tilted" : "";
    row["3 first contact" + how] = seconds(1, [&] { run(first_contact(tree, at, tree, pose)); });
    row["4 distance" + how] = seconds(1, [&] { run(distance(tree, at, tree, pose)); });
    DistanceOptions options;
    options.relative_error = 1e-3;
    row["5 distance 1e-3" + how] =
        seconds(1, [&] { run(distance(tree, at, tree, pose, options)); });
  }
  return row;
}

void print(const std::string& mesh, CodecId codec, const Row& row, const Row& ordinary) {
  for (const auto& [query, time] : row) {
    fmt::print("{:28} {:10} {:26} {:14.3f} us {:12.2f} x\n", mesh, codec_name(codec),
               query.substr(2), 1e6 * time, time / ordinary.at(query));
  }
  static_cast<void>(std::fflush(stdout));
}

}  // namespace
}  // namespace boxtree::bench

int main(int argc, char** argv) {
  unsigned faces = 20'000;
  std::vector<std::string> codecs = {"wide8", "wide4", "plain-f32"};
  boxtree::test::ProgramOptions program("Times queries of coincident and coplanar faces.");
  program.add("--faces", faces, "Of each mesh, about").shows_default();
  program.add("--codecs", codecs, "Names of codecs").shows_default();
  if (const std::optional<int> status = program.parse(argc, argv)) return *status;
  try {
    using namespace boxtree;
    using namespace boxtree::bench;
    const auto rings = static_cast<unsigned>(std::lround(std::sqrt(faces / 4.0)));
    const SourceMesh ordinary = test::sphere(rings, 2 * rings);
    for (const std::string& name : codecs) {
      const std::optional<CodecId> codec = find_codec(name);
      if (!codec) throw std::runtime_error("no codec " + name);
      const Row base = measure(ordinary, *codec);
      print("sphere", *codec, base, base);
      for (const SourceMesh& mesh : test::coincident_kinds(faces)) {
        print(mesh.name, *codec, measure(mesh, *codec), base);
      }
    }
  } catch (const std::exception& error) {
    static_cast<void>(std::fprintf(stderr, "boxtree_coincident: %s\n", error.what()));
    return 2;
  }
  return 0;
}
