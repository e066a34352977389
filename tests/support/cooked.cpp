// SPDX-License-Identifier: MIT
// From a mesh to a bound tree, in memory.
#include "tests/support/cooked.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "format/container.h"
#include "runtime/file/checksum.h"
#include "runtime/file/open_file.h"
#include "runtime/tree/bound_tree.h"
#include "tests/support/require.h"

namespace boxtree::test {

std::vector<std::byte> cook_bytes(const cooker::SourceMesh& mesh, CodecId codec,
                                  const cooker::CookOptions& options) {
  const cooker::EncodedTree cooked = require(cooker::cook_as(mesh, codec, options));
  return cooker::serialize(std::span(&cooked, 1));
}

namespace {

std::vector<std::byte> cook_mesh_bytes(cooker::SceneMesh mesh, std::vector<std::string> materials,
                                       CodecId codec, cooker::CookOptions options) {
  const std::string name = mesh.mesh.name;
  cooker::CookInput input;
  input.has_top_level = false;
  input.imports.emplace_back();
  input.scene.meshes.push_back(std::move(mesh));
  input.scene.materials = std::move(materials);
  options.codec = codec;
  options.cook_record = false;
  cooker::CookedFile cooked = require(cooker::cook(std::move(input), {}, options));
  cooked.trees.front().name = name;  // not kept without a cook record
  return require(cooker::serialize(cooked.parts()));
}

}  // namespace

std::vector<std::byte> cook_bytes(const cooker::SourceMesh& mesh,
                                  const std::vector<FaceRun>& user_data, CodecId codec,
                                  cooker::CookOptions options) {
  return cook_mesh_bytes({mesh, {}, {}, user_data}, {}, codec, std::move(options));
}

std::vector<std::byte> cook_bytes(const cooker::SourceMesh& mesh,
                                  const cooker::FaceMaterials& materials, CodecId codec,
                                  cooker::CookOptions options) {
  options.materials = true;
  return cook_mesh_bytes({mesh, {}, materials.runs, {}}, materials.names, codec,
                         std::move(options));
}

CookedTree cook_tree(const cooker::SourceMesh& mesh, CodecId codec,
                     const cooker::CookOptions& options, const BindOptions& bind) {
  std::vector<std::byte> bytes = cook_bytes(mesh, codec, options);
  File file = require(File::open(Bytes(bytes)));
  Tree tree = require(Tree::bind(file, 0, bind));
  return {std::move(bytes), std::move(file), std::move(tree)};
}

std::vector<CodecId> all_codecs() {
  std::vector<CodecId> ids;
  for (const CodecInfo& codec : kCodecs) ids.push_back(codec.id);
  return ids;
}

std::string test_name(const testing::TestParamInfo<CodecId>& info) {
  std::string name(codec_name(info.param));
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

std::vector<Encoding> all_encodings() {
  std::vector<Encoding> all;
  for (const CodecId codec : all_codecs()) {
    all.push_back({codec, GeometryId::kExact});
    all.push_back({codec, GeometryId::kGrid});
  }
  all.push_back({CodecId::kWide8, GeometryId::kArrays});
  return all;
}

std::string encoding_name(const testing::TestParamInfo<Encoding>& info) {
  return test_name({info.param.codec, info.index}) + "_" +
         std::string(geometry_name(info.param.geometry));
}

CookedTree cook_tree(const cooker::SourceMesh& mesh, const Encoding& encoding) {
  cooker::CookOptions options;
  options.geometry = encoding.geometry;
  options.grid.bits = 16;
  return cook_tree(mesh, encoding.codec, options);
}

std::vector<Triangle> all_triangles(const Tree& tree) {
  std::vector<Triangle> triangles;
  std::vector<Node> pending{BoundTree::of(tree).root()};
  while (!pending.empty()) {
    const Node node = pending.back();
    pending.pop_back();
    if (node.is_leaf) {
      TriangleBatch batch;
      EXPECT_EQ(BoundTree::of(tree).leaf_triangles(node, batch), Errc::kOk);
      for (std::uint32_t i = 0; i < batch.count; ++i) triangles.push_back(batch.triangle(i));
      continue;
    }
    NodeChildren children;
    EXPECT_EQ(BoundTree::of(tree).expand(node, children), NodeState::kValid);
    for (std::uint32_t i = 0; i < children.count; ++i) pending.push_back(children.child[i]);
  }
  for (std::uint32_t face = BoundTree::of(tree).counts().faces_in_leaves; face < tree.face_count();
       ++face) {
    TriangleBatch batch;
    EXPECT_EQ(BoundTree::of(tree).leaves().read(face, 1, batch), Errc::kOk);
    for (std::uint32_t i = 0; i < batch.count; ++i) triangles.push_back(batch.triangle(i));
  }
  return triangles;
}

SectionEntry entry_of(const std::vector<std::byte>& file, SectionKind kind) {
  const File opened = require(File::open(Bytes(file)));
  for (const SectionEntry& entry : OpenFile::of(opened).container().sections) {
    if (entry.kind == kind) return entry;
  }
  throw std::runtime_error("no such section");
}

std::span<std::byte> section_of(std::vector<std::byte>& file, SectionKind kind) {
  const SectionEntry entry = entry_of(file, kind);
  return std::span(file).subspan(entry.offset, entry.size);
}

void edit_entry(std::vector<std::byte>& file, SectionKind kind,
                const std::function<void(SectionEntry&)>& change) {
  SectionEntry entry = entry_of(file, kind);
  const SectionRow before = entry.row();
  std::byte* at = file.data() + sizeof(FileHeader);
  while (std::memcmp(at, &before, sizeof(before)) != 0) at += sizeof(before);
  change(entry);
  const SectionRow after = entry.row();
  std::memcpy(at, &after, sizeof(after));
  repair_checksums(file);
}

std::vector<SectionEntry> sections_of(const std::vector<std::byte>& file) {
  std::vector<SectionEntry> sections;
  if (file.size() < sizeof(FileHeader)) return sections;
  const auto count = load<FileHeader>(file.data()).section_count;
  std::uint64_t end = table_end(count);
  for (std::size_t i = 0; i < count && end <= file.size(); ++i) {
    const auto row = load<SectionRow>(file.data() + sizeof(FileHeader), i);
    const SectionEntry entry = SectionEntry::of(row, end);
    end = entry.end();
    if (end <= file.size()) sections.push_back(entry);
  }
  return sections;
}

void repair_checksums(std::vector<std::byte>& bytes) {
  if (bytes.size() < sizeof(FileHeader)) return;
  const std::uint64_t end = table_end(load<FileHeader>(bytes.data()).section_count);
  if (end > bytes.size()) return;
  std::byte* at = bytes.data() + sizeof(FileHeader);
  for (const SectionEntry& entry : sections_of(bytes)) {
    const std::uint64_t sum = checksum(Bytes(bytes).subspan(entry.offset, entry.size));
    std::memcpy(at + offsetof(SectionRow, checksum), &sum, sizeof(sum));
    at += sizeof(SectionRow);
  }
  const Bytes table = Bytes(bytes).first(end).subspan(sizeof(FileHeader));
  const std::uint64_t sum = checksum(Bytes(bytes).first(offsetof(FileHeader, checksum)), table);
  std::memcpy(bytes.data() + offsetof(FileHeader, checksum), &sum, sizeof(sum));
}

}  // namespace boxtree::test
