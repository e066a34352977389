// SPDX-License-Identifier: MIT
// Compares and merges the meshes of a scene.
#include "cooker/import/source_scene.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <span>
#include <utility>

#include "cooker/import/hash_mix.h"
#include "runtime/file/checksum.h"

namespace boxtree::cooker {
namespace {

using Shape = std::array<std::span<const std::byte>, 4>;

Shape shape_of(const SceneMesh& mesh) {
  return {std::as_bytes(std::span(mesh.mesh.positions.f32)),
          std::as_bytes(std::span(mesh.mesh.positions.f64)),
          std::as_bytes(std::span(mesh.mesh.faces)), std::as_bytes(std::span(mesh.mesh.face_ids))};
}

bool is_equal(const SceneMesh& a, const SceneMesh& b) {
  return has_same_shape(a, b) && a.materials == b.materials;
}

}  // namespace

bool has_same_shape(const SceneMesh& a, const SceneMesh& b) {
  if (a.source_faces != b.source_faces || a.user_data != b.user_data) return false;
  if (a.mesh.moved_by_f32 != b.mesh.moved_by_f32) return false;  // they differ in the source
  const Shape of_a = shape_of(a), of_b = shape_of(b);
  for (std::size_t i = 0; i < of_a.size(); ++i) {
    if (of_a[i].size() != of_b[i].size()) return false;
    if (!of_a[i].empty() && std::memcmp(of_a[i].data(), of_b[i].data(), of_a[i].size()) != 0) {
      return false;
    }
  }
  return true;
}

MeshMerger::MeshMerger(std::vector<SceneMesh>& meshes) : meshes_(meshes) {
  for (std::uint32_t i = 0; i < meshes.size(); ++i) by_hash_.emplace(hash_of_shape(meshes[i]), i);
}

std::uint32_t MeshMerger::add(SceneMesh&& mesh) {
  const std::uint64_t hash = hash_of_shape(mesh);
  const auto [first, last] = by_hash_.equal_range(hash);
  for (auto candidate = first; candidate != last; ++candidate) {
    if (is_equal(meshes_[candidate->second], mesh)) return candidate->second;
  }
  const auto number = static_cast<std::uint32_t>(meshes_.size());
  meshes_.push_back(std::move(mesh));
  by_hash_.emplace(hash, number);
  return number;
}

std::string unnamed_material(std::uint32_t number) {
  return "material " + std::to_string(number);
}

MaterialJoin::MaterialJoin(std::vector<std::string>& materials) : all_(materials) {
  for (std::uint32_t i = 0; i < all_.size(); ++i) {
    if (all_[i] != unnamed_material(i)) by_name_.emplace(all_[i], i);
  }
}

std::vector<std::uint32_t> MaterialJoin::add(const std::vector<std::string>& materials) {
  std::vector<std::uint32_t> numbers;
  for (std::uint32_t i = 0; i < materials.size(); ++i) {
    const bool has_name = materials[i] != unnamed_material(i);
    numbers.push_back(has_name ? add_named(materials[i]) : add_unnamed());
  }
  return numbers;
}

std::uint32_t MaterialJoin::add_named(const std::string& name) {
  const auto number = static_cast<std::uint32_t>(all_.size());
  const auto [known, is_new] = by_name_.emplace(name, number);
  if (is_new) all_.push_back(name);
  return known->second;
}

// Materials without a name are never merged, because they may differ.
std::uint32_t MaterialJoin::add_unnamed() {
  const auto number = static_cast<std::uint32_t>(all_.size());
  all_.push_back(unnamed_material(number));
  return number;
}

void renumber(std::vector<FaceRun>& runs, const std::vector<std::uint32_t>& numbers) {
  for (FaceRun& run : runs) run.number = numbers[run.number];
}

std::uint64_t hash_of_shape(const SceneMesh& mesh) {
  std::uint64_t hash = mesh.source_faces;
  for (const std::span<const std::byte> bytes : shape_of(mesh)) {
    hash = hash_with(hash, checksum(bytes));
  }
  return hash;
}

}  // namespace boxtree::cooker
