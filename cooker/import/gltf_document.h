// SPDX-License-Identifier: MIT
// The document of a glTF file, and values of it that may be of any type.
#pragma once

#include <cstdint>
#include <string>

#include <boxtree/error.h>

#include "cooker/import/source_file.h"
#include "cooker/text/json.h"

namespace boxtree::cooker {

/// The document of a .gltf or .glb file; null for others. Errors: as parse_gltf.
Result<Json> read_gltf(const SourceFile& source);

/// The value of a key that is an array; an empty one if there is none such.
[[nodiscard]] const Json& array_at(const Json& object, const char* key);

/// The value of a key that is a whole number of 0 or more; `otherwise` if there is none such.
[[nodiscard]] std::uint64_t number_at(const Json& object, const char* key, std::uint64_t otherwise);

/// The element of a list, or null.
[[nodiscard]] const Json& element_at(const Json& list, std::uint64_t index);

/// Why no reader takes a .gltf or .glb file: its bytes end too early, or its JSON is none. Empty if
/// that is not the reason, and for other formats.
[[nodiscard]] std::string gltf_fault(const SourceFile& source);

}  // namespace boxtree::cooker
