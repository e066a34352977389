// SPDX-License-Identifier: MIT
// Any text as the JSON of a glTF file, looked at before assimp reads it: its nesting, its
// values, its counts and the user data of its primitives.
#include "cooker/import/gltf_nesting.h"

#include <string>
#include <string_view>

#include "cooker/import/gltf_stated_faces.h"
#include "cooker/import/gltf_user_data.h"
#include "cooker/import/gltf_values.h"
#include "cooker/import/import.h"
#include "cooker/text/json.h"
#include "tests/fuzz/target.h"

namespace boxtree::fuzz {
namespace {

void read_user_data(const cooker::Json& document) {
  const std::size_t primitives = cooker::names_of_primitives(document).size();
  for (const std::string& wanted : {std::string("id"), std::string(cooker::kPrimitives)}) {
    const auto numbers = cooker::numbers_of_primitives(document, wanted);
    if (!numbers) {
      const Errc code = numbers.code();
      if (code != Errc::kImportFailed && code != Errc::kMeshUnsupported) {
        finding("user data with an error of another kind");
      }
      continue;
    }
    std::size_t count = 0;
    for (const auto& of_mesh : *numbers) count += of_mesh.size();
    if (count != primitives) finding("primitives without a number");
  }
}

}  // namespace

void run(Bytes input) {
  const std::string_view text(reinterpret_cast<const char*>(input.data()), input.size());
  const auto document = cooker::parse_gltf(text);
  if (document.ok()) {
    static_cast<void>(cooker::stated_faces(*document));
    const Status values = cooker::check_values(*document);
    if (!values.ok() && values.error().code != Errc::kImportFailed) {
      finding("values with an error of another kind");
    }
    read_user_data(*document);
  }
  const Errc code = document.ok() ? Errc::kOk : document.error().code;
  if (code != Errc::kOk && code != Errc::kImportFailed) finding("an error of another kind");
}

}  // namespace boxtree::fuzz
