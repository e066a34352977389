// SPDX-License-Identifier: MIT
// What a viewer finds in an exported file, read from its bytes alone.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

namespace boxtree::test {

/// A group of OBJ or a mesh of glTF.
struct ViewedPart {
  std::string object;  // of OBJ, or the topmost node in glTF
  std::string name;
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  // of the topmost node
  Eigen::Affine3d pose = Eigen::Affine3d::Identity();     // of all nodes from the top down
  std::size_t mesh = 0;                                   // in glTF, where nodes may share one
  std::vector<Eigen::Vector3d> vertices;                  // before translation and pose
  std::vector<std::vector<std::uint32_t>> elements;       // corners, as places in `vertices`
  bool has_lines = false;

  [[nodiscard]] std::uint64_t box_count() const { return vertices.size() / 8; }
  /// The eight vertices of box `i`, as bounds.
  [[nodiscard]] Eigen::AlignedBox3d box(std::uint64_t i) const;
};

/// Statements o, g, v, f and l. Throws on any other, and on corners outside of their group.
[[nodiscard]] std::vector<ViewedPart> read_obj(const std::string& text);

/// Header, chunks, buffer views and accessors are checked against each other and the bytes, by
/// throwing; parts come in the order of the nodes.
[[nodiscard]] std::vector<ViewedPart> read_glb(const std::string& bytes);

/// By extension.
[[nodiscard]] std::vector<ViewedPart> read_viewer_file(const std::filesystem::path& path);

/// The document of a GLB, without checks.
[[nodiscard]] nlohmann::json glb_document(const std::string& bytes);

}  // namespace boxtree::test
