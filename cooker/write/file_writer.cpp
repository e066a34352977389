// SPDX-License-Identifier: MIT
// Lays out sections one after another and writes them after the header that describes them.
#include "cooker/write/file_writer.h"

#include <algorithm>
#include <cstring>

#include <boxtree/file.h>

#include "cooker/proof/proof.h"
#include "cooker/text/utf8.h"
#include "format/container.h"
#include "format/face_numbers.h"
#include "format/tree_record.h"
#include "runtime/file/checksum.h"
#include "runtime/file/mapping.h"

namespace boxtree::cooker {
namespace {

// One section: its kind, and its bytes until they are written.
struct Section {
  SectionKind kind;
  std::uint32_t owner;
  Bytes bytes;
};

Bytes bytes_of(const auto& container) {
  return std::as_bytes(std::span(container));
}

// Owns the small sections and lists all in the order of the file; the large ones stay in the
// encoders' buffers.
class Layout {
 public:
  // Precondition: `scene` is encoded from these trees, or null, and `names` are its names and those
  // of `materials`.
  Layout(const FileParts& parts, const EncodedScene* scene, const EncodedMaterials& materials,
         std::string names)
      : names_(std::move(names)), cook_record_(parts.cook_record) {
    std::uint32_t name_offset = 0;
    for (const EncodedTree& tree : parts.trees) {
      records_.push_back(record_of(tree, name_offset));
      records_.back().name_bytes = static_cast<std::uint32_t>(to_utf8(tree.name).size());
      name_offset += records_.back().name_bytes;
    }
    sections_.push_back({SectionKind::kTrees, kNoOwner, bytes_of(records_)});
    add(SectionKind::kNames, kNoOwner, bytes_of(names_));
    add(SectionKind::kCookRecord, kNoOwner, bytes_of(cook_record_));
    if (scene != nullptr) add_scene(*scene);
    add(SectionKind::kMaterials, kNoOwner, materials.names);
    if (scene != nullptr) {
      add(SectionKind::kLeftOut, kNoOwner, scene->left_out);
      add(SectionKind::kInstanceEdges, kNoOwner, scene->instance_edges);
    }
    for (std::uint32_t i = 0; i < parts.trees.size(); ++i) {
      const EncodedTree& tree = parts.trees[i];
      add(SectionKind::kNodes, i, tree.nodes.bytes);
      add(SectionKind::kVertices, i, tree.geometry.vertices);
      add(SectionKind::kCorners, i, tree.geometry.corners);
      add(SectionKind::kFaceIds, i, tree.geometry.face_ids);
      if (i < materials.of_trees.size()) {
        add_numbers(SectionKind::kMaterialRuns, i, materials.of_trees[i]);
      }
      add(SectionKind::kDuplicates, i, tree.geometry.duplicates);
      add(SectionKind::kActiveEdges, i, tree.geometry.active_edges);
      add_numbers(SectionKind::kUserDataRuns, i, tree.user_data);
    }
    place();
  }
  Layout(const Layout&) = delete;  // sections point into it
  Layout& operator=(const Layout&) = delete;

  // Calls sink(Bytes) with the file's bytes from first to last.
  template <class Sink>
  Status emit(Sink sink) const {
    static constexpr std::array<std::byte, kLargeAlignment> kZeros{};
    std::uint64_t at = table_end(table_.size());
    if (Status status = sink(std::as_bytes(std::span(&header_, 1))); !status) return status;
    if (Status status = sink(bytes_of(rows_)); !status) return status;
    for (std::size_t i = 0; i <= sections_.size(); ++i) {
      const std::uint64_t next = i < sections_.size() ? table_[i].offset : file_bytes_;
      if (Status status = sink(Bytes(kZeros).first(next - at)); !status) return status;
      if (i == sections_.size()) break;
      if (Status status = sink(sections_[i].bytes); !status) return status;
      at = next + sections_[i].bytes.size();
    }
    return {};
  }

  [[nodiscard]] std::uint64_t file_bytes() const { return file_bytes_; }
  [[nodiscard]] const std::vector<SectionEntry>& sections() const { return table_; }

 private:
  void add(SectionKind kind, std::uint32_t owner, Bytes bytes) {
    if (!bytes.empty()) sections_.push_back({kind, owner, bytes});
  }

  void add_numbers(SectionKind runs, std::uint32_t owner, const EncodedFaceNumbers& numbers) {
    add(runs, owner, numbers.runs);
    add(by_face(runs), owner, numbers.faces);
  }

  void add_scene(const EncodedScene& scene) {
    add(SectionKind::kScene, kNoOwner, scene.scene);
    add(SectionKind::kSceneNodes, kNoOwner, scene.nodes);
    add(SectionKind::kInstances, kNoOwner, scene.instances);
    add(SectionKind::kPoses, kNoOwner, scene.poses);
    add(SectionKind::kLayers, kNoOwner, scene.layers);
  }

  void place() {
    std::uint64_t at = table_end(sections_.size());
    for (const Section& section : sections_) {
      SectionEntry entry;
      entry.kind = section.kind;
      const bool informative =
          section.kind == SectionKind::kNames || section.kind == SectionKind::kMaterials ||
          section.kind == SectionKind::kMaterialRuns ||
          section.kind == SectionKind::kFaceMaterials || section.kind == SectionKind::kLeftOut ||
          section.kind == SectionKind::kCookRecord || section.kind == SectionKind::kActiveEdges ||
          section.kind == SectionKind::kInstanceEdges ||
          section.kind == SectionKind::kUserDataRuns || section.kind == SectionKind::kFaceUserData;
      entry.is_required = !informative;
      entry.owner = section.owner;
      entry.offset = section_begin(at, section.bytes.size());
      entry.size = section.bytes.size();
      entry.checksum = checksum(section.bytes);
      table_.push_back(entry);
      rows_.push_back(entry.row());
      at = entry.end();
    }
    header_ = make_header(rows_, 0, checksum);
    file_bytes_ = file_end(at);
  }

  std::vector<TreeRecord> records_;
  std::string names_;
  std::string cook_record_;
  std::vector<Section> sections_;
  std::vector<SectionEntry> table_;
  std::vector<SectionRow> rows_;  // the same as stored
  FileHeader header_{};
  std::uint64_t file_bytes_ = 0;
};

std::vector<std::byte> bytes_of_file(const Layout& layout) {
  std::vector<std::byte> out(layout.file_bytes());
  static_cast<void>(layout.emit([at = out.data()](Bytes bytes) mutable {
    at = std::copy(bytes.begin(), bytes.end(), at);
    return Status{};
  }));
  return out;
}

// The names of all trees; a scene appends its own.
std::string tree_names(std::span<const EncodedTree> trees) {
  std::string names;
  for (const EncodedTree& tree : trees) names += to_utf8(tree.name);
  return names;
}

// Calls use(const Layout&) with the file's layout.
template <class Use>
Status with_layout(const FileParts& parts, Use use) {
  std::string names = tree_names(parts.trees);
  if (parts.scene == nullptr) {
    EncodedMaterials materials;
    if (parts.materials != nullptr) {
      NameTable table(names);
      materials = encode_materials(parts.materials->names, parts.materials->of_trees, table);
      if (!table.fits()) return Error{Errc::kMeshTooLarge, "names take more than 4 GiB"};
    }
    return use(Layout(parts, nullptr, materials, std::move(names)));
  }
  const Result<EncodedScene> scene = encode_scene(parts.trees, *parts.scene, names);
  if (!scene) return scene.error();
  return use(Layout(parts, &*scene, scene->materials, std::move(names)));
}

Status check_tree_count(std::size_t count) {
  if (count <= kMaxTrees) return {};
  return Error{Errc::kMeshTooLarge,
               std::to_string(count) + " trees, limit " + std::to_string(kMaxTrees)};
}

}  // namespace

Result<std::vector<std::byte>> serialize(const FileParts& parts) {
  std::vector<std::byte> out;
  const Status status = with_layout(parts, [&](const Layout& layout) {
    out = bytes_of_file(layout);
    return Status{};
  });
  if (!status) return status.error();
  return out;
}

Result<FileLayout> layout_of(const FileParts& parts) {
  FileLayout out;
  const Status status = with_layout(parts, [&](const Layout& layout) {
    out = {layout.sections(), layout.file_bytes()};
    return Status{};
  });
  if (!status) return status.error();
  return out;
}

std::vector<std::byte> serialize(std::span<const EncodedTree> trees,
                                 const std::string& cook_record) {
  return bytes_of_file(Layout({trees, cook_record}, nullptr, {}, tree_names(trees)));
}

Result<std::uint64_t> write_file(const OutputTarget& to, const FileParts& parts) {
  if (Status status = check_tree_count(parts.trees.size()); !status) return status.error();
  Result<AtomicFile> file = AtomicFile::create(to);
  if (!file) return file.error();
  if (Status status =
          with_layout(parts,
                      [&](const Layout& layout) {
                        return layout.emit([&](Bytes bytes) { return file->write(bytes); });
                      });
      !status) {
    return status.error();
  }
  const Result<Mapping> written = Mapping::map(file->descriptor(), to.title());
  if (!written) return written.error();
  const Result<File> opened = File::open(written->bytes());
  if (!opened) return opened.error();
  if (const Findings findings = verify_file(*opened); !findings.empty()) return findings.front();
  if (Status status = file->commit(); !status) return status.error();
  return std::uint64_t{written->bytes().size()};
}

}  // namespace boxtree::cooker
