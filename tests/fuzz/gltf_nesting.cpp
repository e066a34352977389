// SPDX-License-Identifier: MIT
// Any text as the JSON of a glTF file, looked at before assimp reads it: its nesting and its
// counts.
#include "cooker/import/gltf_nesting.h"

#include <string_view>

#include <nlohmann/json.hpp>

#include "cooker/import/gltf_faces.h"
#include "tests/fuzz/target.h"

namespace boxtree::fuzz {

void run(Bytes input) {
  const std::string_view text(reinterpret_cast<const char*>(input.data()), input.size());
  const auto document = cooker::parse_gltf(text);
  if (document.ok()) static_cast<void>(cooker::stated_faces(*document));
  const Errc code = document.ok() ? Errc::kOk : document.error().code;
  if (code != Errc::kOk && code != Errc::kImportFailed) finding("an error of another kind");
}

}  // namespace boxtree::fuzz
