// SPDX-License-Identifier: MIT
// Any text as a Collada document, looked at before assimp reads it.
#include "cooker/import/collada_values.h"

#include <string_view>

#include "tests/fuzz/target.h"

namespace boxtree::fuzz {

void run(Bytes input) {
  const Status status = cooker::check_collada(
      std::string_view(reinterpret_cast<const char*>(input.data()), input.size()));
  if (status.ok()) return;
  const Errc code = status.error().code;
  if (code != Errc::kImportFailed && code != Errc::kMeshIndexOutOfRange) {
    finding("an error of another kind");
  }
  if (status.error().detail.empty()) finding("an error without words");
}

}  // namespace boxtree::fuzz
