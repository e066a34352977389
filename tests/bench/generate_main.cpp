// SPDX-License-Identifier: MIT
// boxtree_generate: large meshes for benchmarks, the same on every machine.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>

#include <CLI/CLI.hpp>

#include "tests/bench/generated_mesh.h"
#include "tests/bench/mesh_files.h"

int main(int argc, char** argv) {
  std::string kind;
  std::size_t triangles = 0;
  std::uint64_t seed = 1;
  std::filesystem::path path;
  CLI::App app("Writes a generated mesh as binary PLY or STL.");
  app.add_option("kind", kind, "terrain or city")
      ->required()
      ->check(CLI::IsMember({"terrain", "city"}));
  app.add_option("triangles", triangles, "How many, exactly")
      ->required()
      ->check(CLI::Range(std::size_t{1}, std::size_t{100'000'000}));
  app.add_option("output", path, "OUT.ply or OUT.stl")->required();
  app.add_option("--seed", seed, "Another mesh of the same kind")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    using namespace boxtree::bench;
    write_mesh(kind == "city" ? make_city(triangles, seed) : make_terrain(triangles, seed), path);
  } catch (const std::exception& error) {
    static_cast<void>(std::fprintf(stderr, "boxtree_generate: %s\n", error.what()));
    return 2;
  }
  return 0;
}
