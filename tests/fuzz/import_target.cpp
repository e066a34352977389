// SPDX-License-Identifier: MIT
// Any bytes as a mesh file of the format FUZZ_EXTENSION: an error that names the file, or a mesh
// that keeps what import promises.
#include <cmath>
#include <string>
#include <string_view>

#include "cooker/import/import.h"
#include "tests/fuzz/target.h"
#include "tests/support/temp_folder.h"

namespace boxtree::fuzz {
namespace {

using namespace boxtree::cooker;

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

}  // namespace

void run(Bytes input) {
  static const test::TempFolder folder;
  const std::string_view text(reinterpret_cast<const char*>(input.data()), input.size());
  const auto path = folder.write("mesh." FUZZ_EXTENSION, text);
  for (const bool skip_bad : {false, true}) {
    ImportOptions options;
    options.skip_bad = skip_bad;
    options.precision = input.size() % 2 == 0 ? Precision::kF32 : Precision::kF64;
    const Result<Imported> imported = import_mesh(path, options);
    if (!imported) {
      const Error& error = imported.error();
      if (error.code == Errc::kInternal) finding("import ends with kInternal");
      if (error.detail.find(path.string()) == std::string::npos) {
        finding("an error that does not name its file");
      }
    } else {
      check_mesh(imported->mesh, imported->report);
      if (!skip_bad && !imported->report.skipped.empty()) finding("faces left out unbidden");
    }
  }
}

}  // namespace boxtree::fuzz
