// SPDX-License-Identifier: MIT
// Bad input: meshes with NaN, infinite or out-of-range numbers, and damaged files.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>

#include <fmt/format.h>

#include "cooker/proof/proof.h"
#include "format/container.h"
#include "runtime/tree/bound_tree.h"
#include "tests/robustness/brute_force.h"
#include "tests/robustness/mesh_kinds.h"
#include "tests/support/require.h"
#include "tests/support/temp_folder.h"

namespace boxtree::robustness {
namespace {

std::string as_obj(const SourceMesh& mesh) {
  std::string text;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const Eigen::Vector3d p = mesh.positions[i];
    text += fmt::format("v {} {} {}\n", p[0], p[1], p[2]);
  }
  for (const cooker::Face& f : mesh.faces) {
    text += fmt::format("f {} {} {}\n", f.corner[0] + 1, f.corner[1] + 1, f.corner[2] + 1);
  }
  return text;
}

template <class T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

std::string as_ply(const SourceMesh& mesh) {
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float "
      "y\nproperty float z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
      mesh.positions.size(), mesh.faces.size());
  for (const float x : mesh.positions.f32) append(bytes, x);
  for (const cooker::Face& f : mesh.faces) {
    append(bytes, std::uint8_t{3});
    for (std::size_t c = 0; c < 3; ++c) append(bytes, f.corner[c]);
  }
  return bytes;
}

std::string as_stl(const SourceMesh& mesh) {
  std::string bytes(80, ' ');
  append(bytes, static_cast<std::uint32_t>(mesh.faces.size()));
  for (const cooker::Face& f : mesh.faces) {
    for (int i = 0; i < 3; ++i) append(bytes, 0.0F);  // normal
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < 3; ++k) append(bytes, mesh.positions.f32[3 * f.corner[c] + k]);
    }
    append(bytes, std::uint16_t{0});
  }
  return bytes;
}

// One bad triangle among 1000. The file is refused and the error names the triangle; with skip_bad
// it is left out and reported, and the other 999 are found in every codec.
void bad_vertices(Run& run) {
  constexpr std::uint32_t kBad = 137;
  const test::TempFolder folder;
  const SourceMesh good = test::soup(1000, 8);
  for (const double number :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
        -std::numeric_limits<double>::infinity()}) {
    SourceMesh bad = good;
    bad.positions.f32[3 * bad.faces[kBad].corner[1] + 2] = static_cast<float>(number);
    for (const auto& [name, bytes] :
         {std::pair("soup.obj", as_obj(bad)), std::pair("soup.ply", as_ply(bad)),
          std::pair("soup.stl", as_stl(bad))}) {
      const auto path = folder.write(name, bytes);
      const auto where = [&, file = name] { return fmt::format("{}, {}", file, number); };
      const auto refused = cooker::import_mesh(path);
      run.check(refused.code() == Errc::kMeshNotFinite, where);
      cooker::ImportOptions skip;
      skip.skip_bad = true;
      const auto imported = cooker::import_mesh(path, skip);
      run.check(imported.ok(), where);
      if (!imported) continue;
      run.check(imported->report.skipped.size() == 1 && imported->report.skipped[0].face_id == kBad,
                where);
      run.check(imported->mesh.faces.size() == 999, where);
      for_each_subject(imported->mesh, [&](const Subject& subject) {
        std::set<std::uint32_t> found;
        for (const DecodedTriangle& t : decoded_triangles(subject.tree())) {
          const auto& c = t.triangle.corner;
          const Eigen::Vector3d middle =
              BoundTree::of(subject.tree()).frame().to_object((c[0] + c[1] + c[2]) / 3);
          const auto visit = overlap_sphere(subject.tree(), middle, 1e-3, [&](const FaceRef& face) {
            found.insert(face.id);
            return true;
          });
          run.check(visit.ok(), where);
        }
        run.check(found.size() == 999 && !found.contains(kBad), [&] { return subject.name; });
      });
    }
  }
}

bool is_accepted(Bytes bytes) {
  const auto file = File::open(bytes);
  return file.ok() && cooker::verify_file(*file).empty();
}

// Every query must return, whatever its result.
void query_everything(Bytes bytes) {
  const auto file = File::open(bytes);
  if (!file) return;
  const auto tree = Tree::bind(*file);
  if (!tree) return;
  static_cast<void>(run_query(*tree, {{{{0.3, 0.4, 9}, {0.01, 0.02, -1}}},
                                      {{Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(9, 9, 9)}},
                                      {{{0, 0, 0}, 4}},
                                      {{3, 2, 1}},
                                      {Pose::Identity()}}));
}

void hostile_files(Run& run) {
  const SourceMesh mesh = test::city(2, 1);
  for_each_subject(mesh, [&](const Subject& subject) {
    const std::vector<std::byte> whole = subject.cooked.bytes;
    run.premise(is_accepted(whole), subject.name + ": refused undamaged");
    const auto name = [&](const char* what, std::size_t at) {
      return [&subject, what, at] { return fmt::format("{}: {} {}", subject.name, what, at); };
    };
    for (std::size_t size = 0; size < whole.size(); ++size) {
      run.check(!File::open(Bytes(whole).first(size)).ok(), name("truncated to", size));
    }
    std::vector<std::byte> bytes = whole;
    const std::size_t step = run.count(3, 1);
    for (std::size_t at = 0; at < bytes.size(); at += step) {
      for (const std::byte damage : {std::byte{0xff}, std::byte{0x01}, std::byte{0x80}}) {
        bytes[at] ^= damage;
        run.check(!is_accepted(bytes), name("damaged at", at));
        std::vector<std::byte> repaired = bytes;
        test::repair_checksums(repaired);
        query_everything(repaired);
        bytes[at] ^= damage;
      }
    }
    // The header as a machine of the other byte order would write it: the bytes of all words
    // reversed.
    for (const std::size_t width : {2u, 4u, 8u}) {
      bytes = whole;
      for (std::size_t at = 8; at + width <= sizeof(FileHeader); at += width) {
        std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                     bytes.begin() + static_cast<std::ptrdiff_t>(at + width));
      }
      run.check(!File::open(bytes).ok(), name("header turned by words of", width));
    }
  });
}

}  // namespace

std::vector<Case> file_cases() {
  return {
      {"R08", "BadVertices", "one NaN or infinite vertex among 1000 triangles: OBJ, PLY, STL",
       "wrong", 0, bad_vertices},
      {"R29", "HostileFiles", "truncated, flipped, byte-swapped files", "accepted", 0,
       hostile_files},
  };
}

}  // namespace boxtree::robustness
