// SPDX-License-Identifier: MIT
// Any text as the JSON of a glTF file that is looked at before assimp reads it.
#include <string_view>

#include <boxtree/cooker/import/gltf_nesting.h>

#include "tests/fuzz/target.h"

namespace boxtree::fuzz {

void run(Bytes input) {
  const std::string_view text(reinterpret_cast<const char*>(input.data()), input.size());
  const Errc code = cooker::check_gltf_nesting(text).code();
  if (code != Errc::kOk && code != Errc::kImportFailed) finding("an error of another kind");
}

}  // namespace boxtree::fuzz
