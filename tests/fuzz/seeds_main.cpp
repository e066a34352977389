// SPDX-License-Identifier: MIT
// Writes the inputs from which the targets that take .bxt files start: small files of every codec,
// store and kind of section, each with a query. From time to time, when the format gains parts.
//   seeds FOLDER    writes FOLDER/tree, FOLDER/scene and FOLDER/blob
#include <array>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <boxtree/blob.h>

#include "cooker/write/pack_writer.h"
#include "tests/fuzz/query_input.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"
#include "tests/support/scenes.h"
#include "tests/support/temp_folder.h"

namespace boxtree {
namespace {

namespace fs = std::filesystem;
using test::require;

using QueryTail = std::array<std::byte, fuzz::kQueryBytes>;

// Numbers of the size of the meshes, another set for each seed.
QueryTail query(unsigned seed) {
  std::mt19937 random(seed);
  QueryTail bytes{};
  for (std::size_t i = 0; i < 12; ++i) {
    const auto mantissa = static_cast<std::int16_t>(static_cast<int>(random() % 2048) - 512);
    std::memcpy(bytes.data() + 4 * i, &mantissa, sizeof(mantissa));
  }
  for (std::size_t i = 48; i < 60; ++i) bytes[i] = static_cast<std::byte>(random() % 4);
  bytes[60] = static_cast<std::byte>(random() % 4);  // updates of scenes
  return bytes;
}

bool write(const fs::path& folder, const std::string& name, Bytes file, unsigned seed) {
  fs::create_directories(folder);
  const QueryTail tail = query(seed);
  std::ofstream out(folder / name, std::ios::binary);
  out.write(reinterpret_cast<const char*>(file.data()), std::ssize(file));
  out.write(reinterpret_cast<const char*>(tail.data()), std::ssize(tail));
  return out.flush().good();
}

struct Kind {
  std::string name;
  cooker::SourceMesh mesh;
};

std::vector<Kind> kinds() {
  cooker::SourceMesh copies = test::city(1, 1);
  copies.faces.insert(copies.faces.end(), 3, copies.faces[1]);
  return {{"boxes", test::city(2, 1)},
          {"soup", test::soup(30, 3)},
          {"copies", copies},
          {"one", test::duplicates(1)},
          {"slivers", test::slivers(12, 5)}};
}

bool write_trees(const fs::path& folder) {
  bool good = true;
  unsigned seed = 0;
  for (const Kind& kind : kinds()) {
    for (const test::Encoding& encoding : test::all_encodings()) {
      const std::string name = kind.name + "-" + std::string(codec_name(encoding.codec)) + "-" +
                               std::string(geometry_name(encoding.geometry));
      const test::CookedTree cooked = test::cook_tree(kind.mesh, encoding);
      good = write(folder / "tree", name, cooked.bytes, ++seed) && good;
      if (kind.name != "boxes" || encoding.geometry != GeometryId::kExact) continue;
      for (const BlobMethod method : {BlobMethod::kLzma, BlobMethod::kZstd}) {
        good = write(folder / "blob", name + (method == BlobMethod::kLzma ? "-lzma" : "-zstd"),
                     require(make_blob(cooked.bytes, method)), ++seed) &&
               good;
      }
    }
  }
  return good;
}

bool write_materials(const fs::path& folder) {
  const cooker::SourceMesh mesh = test::city(1, 1);
  const cooker::FaceMaterials few{{"wood", "stone"}, {{0, 1}, {3, 0}}};
  cooker::FaceMaterials many = few;
  for (std::uint32_t face = 4; face < mesh.faces.size(); ++face)
    many.runs.push_back({face, face % 2});
  bool good = true;
  for (const cooker::FaceMaterials& each : {few, many}) {
    good = write(folder / "tree", "materials-" + std::to_string(each.runs.size()),
                 test::cook_bytes(mesh, each, CodecId::kWide8), 1) &&
           good;
    good = write(folder / "tree", "user-data-" + std::to_string(each.runs.size()),
                 test::cook_bytes(mesh, each.runs, CodecId::kWide8), 1) &&
           good;
  }
  return good;
}

// The same positions in f64, moved so that f32 does not hold them.
cooker::SourceMesh in_f64(cooker::SourceMesh mesh, double scale) {
  mesh.positions.precision = cooker::Precision::kF64;
  for (const float x : mesh.positions.f32) mesh.positions.f64.push_back(scale * (1.1 * x + 0.7));
  mesh.positions.f32.clear();
  return mesh;
}

// Stores, precisions and parts that not every codec needs a seed of.
bool write_stores(const fs::path& folder) {
  struct Store {
    const char* name;
    GeometryId geometry;
    double scale;  // of f64; 0: f32
    std::optional<double> active_edges;
  };
  bool good = true;
  unsigned seed = 100;
  for (const Store& store : {Store{"exact-f64", GeometryId::kExact, 1, {}},
                             Store{"exact-f64-huge", GeometryId::kExact, 0x1p1018, {}},
                             Store{"exact-f64-tiny", GeometryId::kExact, 0x1p-1060, {}},
                             Store{"arrays-f64", GeometryId::kArrays, 1, {}},
                             Store{"grid-f64", GeometryId::kGrid, 0x1p300, 1.0},
                             Store{"external", GeometryId::kExternal, 0, {}},
                             Store{"edges-exact", GeometryId::kExact, 0, 1.0},
                             Store{"edges-arrays", GeometryId::kArrays, 0, 1.0},
                             Store{"edges-external", GeometryId::kExternal, 0, 1.0}}) {
    for (const CodecId codec : {CodecId::kWide8, CodecId::kWide4}) {
      cooker::CookOptions options;
      options.geometry = store.geometry;
      options.grid.bits = 16;
      options.active_edges = store.active_edges;
      const cooker::SourceMesh mesh = test::city(2, 1);
      const std::vector<std::byte> bytes =
          test::cook_bytes(store.scale == 0 ? mesh : in_f64(mesh, store.scale), codec, options);
      good = write(folder / "tree", std::string(store.name) + "-" + std::string(codec_name(codec)),
                   bytes, ++seed) &&
             good;
    }
  }
  return good;
}

bool write_scenes_with_edges(const fs::path& folder) {
  bool good = true;
  for (const std::uint32_t moving : {0u, 2u}) {
    const cooker::SceneParts parts = test::random_parts(4, 2, moving, 2, 50 + moving);
    cooker::CookOptions options;
    options.active_edges = 1;
    const test::CookedScene cooked =
        test::cook_scene({test::city(1, 1), test::city(2, 3)}, parts, {CodecId::kWide8}, options);
    good = write(folder / "scene", "edges-" + std::to_string(moving) + "-moving", cooked.bytes,
                 50 + moving) &&
           good;
  }
  return good;
}

bool write_scenes(const fs::path& folder) {
  bool good = true;
  unsigned seed = 0;
  for (const CodecId codec : test::all_codecs()) {
    for (const std::uint32_t moving : {0u, 2u, 1u}) {
      cooker::SceneParts parts = test::random_parts(5, 2, moving, 2, ++seed);
      if (moving == 2) {
        parts.materials = {"wood", "stone"};
        parts.tree_materials.resize(2);
        parts.tree_materials[0].runs = {{0, 1}, {3, 0}};
      }
      const test::CookedScene cooked =
          test::cook_scene({test::city(1, 1), test::soup(9, seed)}, parts, {codec});
      const std::string name =
          std::string(codec_name(codec)) + "-" + std::to_string(moving) + "-moving";
      good = write(folder / "scene", name, cooked.bytes, seed) && good;
    }
  }
  return good;
}

// Packs of one file, of several, and of a file with several trees.
bool write_packs(const fs::path& folder) {
  const cooker::SceneParts parts = test::random_parts(4, 2, 0, 2, 60);
  const std::map<fs::path, std::vector<std::byte>> files = {
      {"city.bxt", test::cook_bytes(test::city(1, 1), CodecId::kWide8)},
      {"soup.bxt", test::cook_bytes(test::soup(9, 1), CodecId::kWide4)},
      {"scene.bxt",
       test::cook_scene({test::city(1, 1), test::soup(9, 2)}, parts, {CodecId::kWide8}).bytes}};
  const cooker::OpenInput open = [&](const fs::path& path) {
    return File::open(Bytes(files.at(path)));
  };
  bool good = true;
  unsigned seed = 60;
  for (const std::vector<fs::path>& packed :
       {std::vector<fs::path>{"city.bxt"}, {"city.bxt", "scene.bxt", "soup.bxt"}}) {
    std::vector<cooker::PackMember> members;
    for (const fs::path& path : packed) {
      members.push_back(require(list_members(path, cooker::PackNames::kPath, open)).front());
    }
    const test::TempFolder temporary;
    static_cast<void>(require(write_pack(temporary.path() / "pack.bxt", members, open)));
    const std::string bytes = test::read_text(temporary.path() / "pack.bxt");
    good = write(folder / "tree", "pack-" + std::to_string(packed.size()),
                 std::as_bytes(std::span(bytes)), ++seed) &&
           good;
  }
  return good;
}

}  // namespace
}  // namespace boxtree

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "seeds FOLDER\n");
    return 1;
  }
  return boxtree::write_trees(argv[1]) && boxtree::write_materials(argv[1]) &&
                 boxtree::write_stores(argv[1]) && boxtree::write_scenes(argv[1]) &&
                 boxtree::write_scenes_with_edges(argv[1]) && boxtree::write_packs(argv[1])
             ? 0
             : 1;
}
