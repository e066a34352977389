// SPDX-License-Identifier: MIT
#include "cooker/encode/materials.h"

#include "format/scene_record.h"

namespace boxtree::cooker {

EncodedMaterials encode_materials(std::span<const std::string> materials,
                                  std::span<const FaceNumbers> of_trees, NameTable& names) {
  EncodedMaterials out;
  for (const std::string& material : materials) {
    const NameTable::Name name = names.add(material);
    const MaterialRecord record{name.offset, name.bytes};
    const auto bytes = std::as_bytes(std::span(&record, 1));
    out.names.insert(out.names.end(), bytes.begin(), bytes.end());
  }
  const std::uint8_t width = material_number_bytes(static_cast<std::uint32_t>(materials.size()));
  for (const FaceNumbers& tree : of_trees) {
    out.of_trees.push_back(encode_face_numbers(tree, width));
  }
  return out;
}

}  // namespace boxtree::cooker
