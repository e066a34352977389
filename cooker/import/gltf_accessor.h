// SPDX-License-Identifier: MIT
// How the numbers of an accessor of glTF 2 are stored (specification, 3.6.2 and 5.1).
#pragma once

#include <cstdint>

#include "cooker/text/json.h"

namespace boxtree::cooker {

/// A value of componentType.
struct GltfComponent {
  static constexpr std::uint32_t kByte = 5120, kUnsignedByte = 5121, kShort = 5122,
                                 kUnsignedShort = 5123, kUnsignedInt = 5125, kFloat = 5126;

  std::uint32_t type;
  const char* name;
  std::uint64_t bytes;

  /// Whether numbers of vertices may be stored so.
  [[nodiscard]] bool is_unsigned() const noexcept;
};

/// Of an accessor or another object with a componentType; null if that is none.
[[nodiscard]] const GltfComponent* component_of(const Json& accessor);

/// Whether its type is that: "VEC3", "SCALAR".
[[nodiscard]] bool has_type(const Json& accessor, const char* type);

/// The accessor that `object` names by `key`; null if there is none.
[[nodiscard]] const Json& accessor_at(const Json& document, const Json& object, const char* key);

/// That of the positions of a primitive.
[[nodiscard]] const Json& positions_of(const Json& document, const Json& primitive);

}  // namespace boxtree::cooker
