// SPDX-License-Identifier: MIT
#include "cooker/encode/materials.h"

namespace boxtree::cooker {
namespace {

template <class T>
void append(std::vector<std::byte>& bytes, const T& value) {
  const auto* const from = reinterpret_cast<const std::byte*>(&value);
  bytes.insert(bytes.end(), from, from + sizeof(T));
}

std::vector<std::byte> encode_numbers(std::span<const std::uint32_t> numbers, std::uint8_t bytes) {
  std::vector<std::byte> out;
  for (const std::uint32_t number : numbers) {
    if (bytes == 1) {
      append(out, static_cast<std::uint8_t>(number));
    } else if (bytes == 2) {
      append(out, static_cast<std::uint16_t>(number));
    } else {
      append(out, number);
    }
  }
  return out;
}

}  // namespace

EncodedMaterials encode_materials(std::span<const std::string> materials,
                                  std::span<const TreeMaterials> of_trees, NameTable& names) {
  EncodedMaterials out;
  for (const std::string& material : materials) {
    const NameTable::Name name = names.add(material);
    append(out.names, MaterialRecord{name.offset, name.bytes});
  }
  const std::uint8_t bytes = material_number_bytes(static_cast<std::uint32_t>(materials.size()));
  for (const TreeMaterials& tree : of_trees) {
    std::vector<std::byte>& runs = out.runs.emplace_back();
    for (const MaterialRun& run : tree.runs) append(runs, run);
    out.faces.push_back(encode_numbers(tree.faces, bytes));
  }
  return out;
}

std::vector<std::uint32_t> materials_of_faces(const SourceMesh& mesh,
                                              std::span<const MaterialRun> runs) {
  std::vector<std::uint32_t> materials;
  materials.reserve(mesh.faces.size());
  std::size_t run = 0;  // ids ascend
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    while (run + 1 < runs.size() && runs[run + 1].first_face <= mesh.face_id(face)) ++run;
    materials.push_back(runs[run].material);
  }
  return materials;
}

std::vector<MaterialRun> runs_of(std::span<const std::uint32_t> ids,
                                 std::span<const std::uint32_t> materials) {
  std::vector<MaterialRun> runs;
  for (std::size_t i = 0; i < materials.size(); ++i) {
    if (!runs.empty() && runs.back().material == materials[i]) continue;
    runs.push_back({runs.empty() ? 0 : ids[i], materials[i]});  // the first starts at face 0
  }
  return runs;
}

}  // namespace boxtree::cooker
