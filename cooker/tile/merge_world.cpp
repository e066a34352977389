// SPDX-License-Identifier: MIT
// Records and section tables say where everything lies before a section is copied.
#include "cooker/tile/merge_world.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cooker/encode/encoded_scene.h"
#include "cooker/import/file_error.h"
#include "cooker/proof/scene_proof.h"
#include "cooker/tile/number_set.h"
#include "cooker/write/atomic_file.h"
#include "format/container.h"
#include "format/limits.h"
#include "format/scene_record.h"
#include "format/tree_record.h"
#include "runtime/file/checksum.h"
#include "runtime/file/mapping.h"
#include "runtime/file/open_file.h"
#include "runtime/primitive/float_state.h"
#include "runtime/tree/bound_tree.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

// A section of the new file: its bytes, or where they are.
struct MergedSection {
  SectionEntry entry;
  Bytes bytes;           // of the scene and the records
  std::size_t file = 0;  // else: the file that has them, and from where on
  std::uint64_t from = 0;
};

class Merge {
 public:
  Merge(std::span<const fs::path> files, const OpenInput& open, const Progress& progress)
      : files_(files), open_(open), progress_(progress) {}

  Result<MergeReport> run(const OutputTarget& to) {
    for (std::size_t i = 0; i < files_.size(); ++i) {
      announce(progress_, fmt::format("file {} of {}", i + 1, files_.size()));
      if (Status status = add_file(i); !status) return status.error();
    }
    if (Status status = add_scene(); !status) return status.error();
    Result<AtomicFile> file = AtomicFile::create(to);
    if (!file) return file.error();
    announce(progress_, "writing");
    if (Status status = write(*file); !status) return status.error();
    announce(progress_, "checking");
    const Result<Mapping> written = Mapping::map(file->descriptor(), to.title());
    if (!written) return written.error();
    if (Status status = check(written->bytes()); !status) return status.error();
    report_.bytes = written->bytes().size();
    if (Status status = file->commit(); !status) return status.error();
    return report_;
  }

 private:
  [[nodiscard]] static Error unfit(const fs::path& path, const std::string& what) {
    return {Errc::kMeshUnsupported,
            path.string() + ": expected a tile as tile and cook make it: " + what};
  }

  Status add_file(std::size_t number) {
    const fs::path& path = files_[number];
    const Result<File> opened = open_(path);
    if (!opened) return opened.error();
    const OpenFile& file = OpenFile::of(*opened);
    if (file.is_pack()) return unfit(path, "found a pack; boxtree split takes its files out");
    if (opened->tree_count() == 0) return unfit(path, "found no tree");
    for (const SectionEntry& section : file.container().sections) {
      if (section.kind == SectionKind::kScene) return unfit(path, "found a scene");
      if (section.kind == SectionKind::kMaterials) return unfit(path, "found materials");
    }
    const auto first = static_cast<std::uint32_t>(records_.size());
    if (opened->tree_count() > kMaxTrees - records_.size()) {
      return Error{Errc::kMeshTooLarge,
                   fmt::format("{}: with it there are {} trees, a file holds {}; make larger tiles",
                               path.string(), records_.size() + opened->tree_count(), kMaxTrees)};
    }
    for (std::uint32_t tree = 0; tree < opened->tree_count(); ++tree) {
      if (Status status = add_tree(path, file, tree); !status) return status;
      if (Status status = add_numbers(path, *opened, tree); !status) return status;
    }
    for (const SectionEntry& section : file.container().sections) {
      if (section.owner == kNoOwner) continue;
      MergedSection merged{section, {}, number, section.offset};
      merged.entry.owner = first + section.owner;
      of_trees_.push_back(merged);
    }
    return {};
  }

  Status add_tree(const fs::path& path, const OpenFile& file, std::uint32_t tree) {
    TreeRecord record = file.tree_record(tree);
    if (Status status = check_tree_record(record, tree); !status) {
      return in_file(path, status.error());
    }
    if (record.face_count == 0) return unfit(path, "found a tree without faces");
    if (record.geometry == GeometryId::kExternal) return unfit(path, "found external geometry");
    const bool has_ids = (record.flags & kTreeFacesInSourceOrder) != 0 ||
                         !file.section(SectionKind::kFaceIds, tree).empty();
    if (!has_ids) return unfit(path, "found no face ids");
    if (records_.empty()) first_ = record;
    const bool is_grid = record.geometry == GeometryId::kGrid;
    if (is_grid != (first_.geometry == GeometryId::kGrid) ||
        record.grid_exponent != first_.grid_exponent) {
      return unfit(path, fmt::format("its positions are on another grid than those of {}, so that "
                                     "they do not touch; cook all with --exact or one --grid-step",
                                     files_.front().string()));
    }
    const std::string_view name = file.tree_name(tree);
    record.name_offset = static_cast<std::uint32_t>(names_.size());
    record.name_bytes = static_cast<std::uint32_t>(name.size());
    names_ += name;
    records_.push_back(record);
    EncodedTree placed;
    placed.origin = record.origin;
    placed.scale_exponent = record.scale_exponent;
    placed.nodes.root_box = {record.root_low, record.root_high};
    trees_.push_back(std::move(placed));
    report_.trees += 1;
    report_.faces += record.face_count;
    report_.triangles += record.triangle_count;
    return {};
  }

  // Queries settle ties by the numbers of faces: no two trees may have the same. Within one, the
  // parts of a polygon that import split do.
  Status add_numbers(const fs::path& path, const File& file, std::uint32_t number) {
    const Result<Tree> tree = Tree::bind(file, number);
    if (!tree) return in_file(path, tree.error());
    const std::uint32_t faces = tree->face_count();
    std::vector<std::uint32_t> ids(align_up(faces, kLeafFaces));
    for (std::uint32_t first = 0; first < faces; first += kLeafFaces) {
      BoundTree::of(*tree).read_leaf_ids(first / kLeafFaces,
                                         std::span(ids).subspan(first).first<kLeafFaces>());
    }
    ids.resize(faces);
    for (const std::uint32_t id : ids) {
      if (!numbers_.contains(id)) continue;
      return unfit(path, fmt::format("there is another face {} before this one; name each tile of "
                                     "one world once",
                                     id));
    }
    for (const std::uint32_t id : ids) numbers_.insert(id);
    return {};
  }

  Status add_scene() {
    SceneParts parts;
    parts.layers.emplace_back();
    for (std::uint32_t tree = 0; tree < records_.size(); ++tree) {
      PlacedTree& instance = parts.instances.emplace_back();
      instance.tree = instance.id = tree;
    }
    Result<EncodedScene> scene = encode_scene(trees_, parts, names_);
    if (!scene) return scene.error();
    scene_ = std::move(*scene);
    // Of merged tiles alone, so that what cooks scenes need not know of it.
    auto record = load<SceneRecord>(scene_.scene.data(), 0);
    record.flags = kSceneFacesNumbered;
    std::memcpy(scene_.scene.data(), &record, sizeof(record));
    return {};
  }

  void add(SectionKind kind, Bytes bytes) {
    if (bytes.empty()) return;
    MergedSection section;
    section.entry.kind = kind;
    section.entry.is_required = kind != SectionKind::kNames;
    section.entry.size = bytes.size();
    section.entry.checksum = checksum(bytes);
    section.bytes = bytes;
    sections_.push_back(section);
  }

  Status write(AtomicFile& file) {
    add(SectionKind::kTrees, std::as_bytes(std::span(records_)));
    add(SectionKind::kNames, std::as_bytes(std::span(names_)));
    add(SectionKind::kScene, scene_.scene);
    add(SectionKind::kSceneNodes, scene_.nodes);
    add(SectionKind::kInstances, scene_.instances);
    add(SectionKind::kPoses, scene_.poses);
    add(SectionKind::kLayers, scene_.layers);
    sections_.insert(sections_.end(), of_trees_.begin(), of_trees_.end());
    std::vector<SectionRow> table;
    std::uint64_t end = table_end(sections_.size());
    for (MergedSection& section : sections_) {
      section.entry.offset = section_begin(end, section.entry.size);
      table.push_back(section.entry.row());
      end = section.entry.end();
    }
    const FileHeader header = make_header(table, 0, checksum);
    Status status = file.write(std::as_bytes(std::span(&header, 1)));
    if (status) status = file.write(std::as_bytes(std::span(table)));
    at_ = table_end(sections_.size());
    // One file after the other: sections of trees are in their order.
    for (auto section = sections_.cbegin(); status && section != sections_.cend();) {
      if (!section->bytes.empty()) {
        status = write_section(file, *section, section->bytes);
        ++section;
        continue;
      }
      const std::size_t number = section->file;
      const Result<File> source = open_(files_[number]);
      if (!source) return source.error();
      for (; status && section != sections_.cend() && section->bytes.empty() &&
             section->file == number;
           ++section) {
        const Bytes bytes = source->bytes();
        if (!in_range(section->from, section->entry.size, bytes.size())) return changed(number);
        status = write_section(file, *section, bytes.subspan(section->from, section->entry.size));
      }
    }
    return status ? pad(file, file_end(at_)) : status;
  }

  Status write_section(AtomicFile& file, const MergedSection& section, Bytes bytes) {
    if (Status status = pad(file, section.entry.offset); !status) return status;
    at_ = section.entry.end();
    return file.write(bytes);
  }

  Status pad(AtomicFile& file, std::uint64_t to) {
    static constexpr std::array<std::byte, kLargeAlignment> kZeros{};
    return file.write(Bytes(kZeros).first(to - at_));
  }

  [[nodiscard]] Error changed(std::size_t file) const {
    return {Errc::kFileUnreadable,
            files_[file].string() + ": it changed while it was merged; run the command again"};
  }

  [[nodiscard]] Status check(Bytes written) const {
    const Result<File> opened = File::open(written, {.copy = false, .verify_checksums = true});
    if (!opened) {
      // The checksums are those that the files state.
      return opened.code() == Errc::kChecksumMismatch
                 ? Error{Errc::kChecksumMismatch,
                         "a file is damaged, or changed meanwhile: boxtree verify finds it"}
                 : opened.error();
    }
    const Status padding = check_padding(written, OpenFile::of(*opened).container());
    if (!padding) return padding;
    if (const Findings findings = prove_scene(*opened); !findings.empty()) return findings.front();
    return {};
  }

  std::span<const fs::path> files_;
  const OpenInput& open_;
  const Progress& progress_;
  std::vector<TreeRecord> records_;
  TreeRecord first_{};
  std::vector<EncodedTree> trees_;  // what a scene needs of them
  std::string names_;
  NumberSet numbers_;  // of faces
  EncodedScene scene_;
  std::vector<MergedSection> sections_, of_trees_;
  std::uint64_t at_ = 0;  // bytes written
  MergeReport report_;
};

}  // namespace

Result<MergeReport> merge_world(const OutputTarget& to, std::span<const fs::path> files,
                                const OpenInput& open, const Progress& progress) {
  const DefaultFloatState state;
  return Merge(files, open, progress).run(to);
}

}  // namespace boxtree::cooker
