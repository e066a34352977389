// SPDX-License-Identifier: MIT
#include "cooker/farm/cooker_identity.h"

#include <fmt/format.h>

#include "cooker/import/assimp_import.h"
#include "cooker/version.h"
#include "runtime/blob/compressor.h"

namespace boxtree::cooker {

std::string cooker_identity() {
  return fmt::format("boxtree {} sources {} assimp {} liblzma {} zstd {}", kVersion, kSourceDigest,
                     assimp_version(), lzma_version(), zstd_version());
}

}  // namespace boxtree::cooker
