// SPDX-License-Identifier: MIT
#include "cooker/import/gltf_accessor.h"

#include <algorithm>
#include <array>
#include <string>

#include "cooker/import/gltf_document.h"
#include "cooker/import/gltf_primitives.h"

namespace boxtree::cooker {

bool GltfComponent::is_unsigned() const noexcept {
  return type == kUnsignedByte || type == kUnsignedShort || type == kUnsignedInt;
}

const GltfComponent* component_of(const Json& accessor) {
  static constexpr std::array kComponents = {
      GltfComponent{GltfComponent::kByte, "BYTE", 1},
      GltfComponent{GltfComponent::kUnsignedByte, "UNSIGNED_BYTE", 1},
      GltfComponent{GltfComponent::kShort, "SHORT", 2},
      GltfComponent{GltfComponent::kUnsignedShort, "UNSIGNED_SHORT", 2},
      GltfComponent{GltfComponent::kUnsignedInt, "UNSIGNED_INT", 4},
      GltfComponent{GltfComponent::kFloat, "FLOAT", 4},
  };
  const std::uint64_t type = number_at(accessor, "componentType", 0);
  const auto found = std::find_if(kComponents.begin(), kComponents.end(),
                                  [type](const GltfComponent& each) { return each.type == type; });
  return found == kComponents.end() ? nullptr : &*found;
}

bool has_type(const Json& accessor, const char* type) {
  const Json* const found = accessor.find("type");
  return found != nullptr && found->is_string() && found->get<std::string>() == type;
}

const Json& accessor_at(const Json& document, const Json& object, const char* key) {
  const Json& accessors = array_at(document, "accessors");
  return element_at(accessors, number_at(object, key, accessors.size()));
}

const Json& positions_of(const Json& document, const Json& primitive) {
  static const Json kNone;
  const Json* const attributes = primitive.find("attributes");
  return attributes == nullptr ? kNone : accessor_at(document, *attributes, "POSITION");
}

}  // namespace boxtree::cooker
