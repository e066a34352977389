// SPDX-License-Identifier: MIT
// Any bytes as a mesh file of the format FUZZ_EXTENSION: an error that names the file, or a mesh
// that keeps what import promises.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "cooker/import/import.h"
#include "tests/fuzz/target.h"
#include "tests/support/temp_folder.h"

namespace boxtree::fuzz {
namespace {

using namespace boxtree::cooker;

// Groups of OBJ files; of others a property.
constexpr bool kIsObj = std::string_view(FUZZ_EXTENSION) == "obj";
constexpr std::string_view kUserData = kIsObj ? std::string_view(kGroups) : "flags";

void check_mesh(const SourceMesh& mesh, const ImportReport& report) {
  if (mesh.faces.empty()) finding("a mesh without faces");
  for (const Face& face : mesh.faces) {
    for (std::size_t i = 0; i < (face.is_quad() ? 4u : 3u); ++i) {
      if (face.corner[i] >= mesh.positions.size()) finding("a corner without a vertex");
    }
  }
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    if (!mesh.positions[i].allFinite()) finding("a vertex that is not finite");
  }
  if (report.files_read.empty()) finding("a mesh from no file");
}

// Numbers by runs of faces of the source, those that were left out, too; each less than `end`.
void check_runs(const std::vector<FaceRun>& runs, const Imported& imported, std::size_t end) {
  std::uint32_t last = imported.mesh.face_id(imported.mesh.faces.size() - 1);
  for (const SkippedFace& skipped : imported.report.skipped) last = std::max(last, skipped.face_id);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (runs[i].first_face > last) finding("a run of no face");
    if (i > 0 && runs[i].first_face <= runs[i - 1].first_face) finding("runs that do not ascend");
    if (runs[i].number != kNoMaterial && runs[i].number >= end) finding("a run of no material");
  }
}

}  // namespace

void run(Bytes input) {
  static const test::TempFolder folder;
  const std::string_view text(reinterpret_cast<const char*>(input.data()), input.size());
  const auto path = folder.write("mesh." FUZZ_EXTENSION, text);
  for (const bool skip_bad : {false, true}) {
    ImportOptions options;
    options.skip_bad = skip_bad;
    options.precision = input.size() % 2 == 0 ? Precision::kF32 : Precision::kF64;
    options.materials = input.size() % 4 >= 2;
    options.keep_polygon_corners = input.size() % 8 >= 4;
    if (input.size() % 16 >= 8) options.user_data = kUserData;
    const Result<Imported> imported = import_mesh(path, options);
    if (!imported) {
      const Error& error = imported.error();
      if (error.code == Errc::kInternal) finding("import ends with kInternal");
      if (error.detail.find(path.string()) == std::string::npos) {
        finding("an error that does not name its file");
      }
    } else {
      check_mesh(imported->mesh, imported->report);
      check_runs(imported->materials.runs, *imported, imported->materials.names.size());
      check_runs(imported->user_data, *imported, std::numeric_limits<std::size_t>::max());
      if (!skip_bad && !imported->report.skipped.empty()) finding("faces left out unbidden");
    }
  }
}

}  // namespace boxtree::fuzz
