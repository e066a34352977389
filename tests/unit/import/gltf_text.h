// SPDX-License-Identifier: MIT
// Small glTF files: triangles without vertex numbers, in buffers inside the text.
#pragma once

#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

namespace boxtree::cooker {

struct GltfPrimitive {
  std::vector<float> positions;  // nine to a triangle
  int material = -1;
  int mode = 4;        // triangles; 0: points
  std::string extras;  // JSON
};

inline std::string base64(std::string_view bytes) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k <= bytes.size() ? kDigits[bits >> (18 - 6 * k) & 63u] : '=';
    }
  }
  return text;
}

/// Adds up meshes; each primitive gets an accessor and a buffer of its own, even if equal to
/// others.
class GltfText {
 public:
  /// An empty name and empty extras (JSON) are left out.
  void add_mesh(const std::string& name, const std::vector<GltfPrimitive>& primitives,
                const std::string& extras = "") {
    std::string list;
    for (const GltfPrimitive& primitive : primitives) {
      const std::size_t bytes = sizeof(float) * primitive.positions.size();
      std::string data(bytes, '\0');
      std::memcpy(data.data(), primitive.positions.data(), bytes);
      append(buffers_,
             fmt::format(R"({{"byteLength":{},"uri":"data:application/octet-stream;base64,{}"}})",
                         bytes, base64(data)));
      append(views_, fmt::format(R"({{"buffer":{},"byteLength":{}}})", accessors_, bytes));
      append(accessor_list_,
             fmt::format(R"({{"bufferView":{},"componentType":5126,"count":{},"type":"VEC3"}})",
                         accessors_, primitive.positions.size() / 3));
      append(list, fmt::format(R"({{"attributes":{{"POSITION":{}}},"mode":{}{}{}}})", accessors_++,
                               primitive.mode,
                               primitive.material < 0
                                   ? std::string()
                                   : fmt::format(R"(,"material":{})", primitive.material),
                               with_extras(primitive.extras)));
    }
    append(meshes_, fmt::format(R"({{{}"primitives":[{}]{}}})",
                                name.empty() ? "" : fmt::format(R"("name":"{}",)", name), list,
                                with_extras(extras)));
  }
  /// `nodes` and `materials` are lists in JSON; node 0 is the root.
  [[nodiscard]] std::string text(const std::string& nodes,
                                 const std::string& materials = "") const {
    return fmt::format(
        R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{}],)"
        R"("meshes":[{}],"accessors":[{}],"bufferViews":[{}],"buffers":[{}]{}}})",
        nodes, meshes_, accessor_list_, views_, buffers_,
        materials.empty() ? "" : fmt::format(R"(,"materials":[{}])", materials));
  }

 private:
  static std::string with_extras(const std::string& extras) {
    return extras.empty() ? extras : R"(,"extras":)" + extras;
  }
  static void append(std::string& list, const std::string& element) {
    if (!list.empty()) list += ',';
    list += element;
  }

  std::string meshes_, accessor_list_, views_, buffers_;
  std::size_t accessors_ = 0;
};

}  // namespace boxtree::cooker
