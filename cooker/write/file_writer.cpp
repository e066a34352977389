// SPDX-License-Identifier: MIT
// Lays sections out one after the other and writes them with the header that describes them.
#include <algorithm>
#include <cstring>

#include <boxtree/cooker/proof/proof.h>
#include <boxtree/cooker/write/file_writer.h>
#include <boxtree/format/container.h>
#include <boxtree/runtime/file/checksum.h>
#include <boxtree/runtime/file/file.h>

namespace boxtree::cooker {
namespace {

// One section: what it is, and where its bytes are kept until they are written.
struct Section {
  SectionKind kind;
  std::uint32_t owner;
  Bytes bytes;
};

Bytes bytes_of(const auto& container) {
  return std::as_bytes(std::span(container));
}

// Holds the small sections and lists all; the large ones stay where the encoders put them.
class Layout {
 public:
  Layout(std::span<const EncodedTree> trees, const std::string& cook_record)
      : cook_record_(cook_record) {
    for (const EncodedTree& tree : trees) {
      records_.push_back(record_of(tree, static_cast<std::uint32_t>(names_.size())));
      certificates_.push_back(certificate_of(tree));
      names_ += tree.name;
    }
    sections_.push_back({SectionKind::kTrees, kNoOwner, bytes_of(records_)});
    add(SectionKind::kNames, kNoOwner, bytes_of(names_));
    for (std::uint32_t i = 0; i < trees.size(); ++i) {
      sections_.push_back(
          {SectionKind::kCertificate, i, bytes_of(std::span(certificates_).subspan(i, 1))});
      add(SectionKind::kNodes, i, trees[i].nodes.bytes);
      add(SectionKind::kVertices, i, trees[i].geometry.vertices);
      add(SectionKind::kCorners, i, trees[i].geometry.corners);
      add(SectionKind::kFaceIds, i, trees[i].geometry.face_ids);
    }
    add(SectionKind::kCookRecord, kNoOwner, bytes_of(cook_record_));
    place();
  }
  Layout(const Layout&) = delete;  // sections point into it
  Layout& operator=(const Layout&) = delete;

  // Calls sink(Bytes) with the file's bytes from first to last.
  template <class Sink>
  Status emit(Sink sink) const {
    static constexpr std::array<std::byte, kSectionAlignment> kZeros{};
    std::uint64_t at = sizeof(FileHeader) + table_.size() * sizeof(SectionEntry);
    if (Status status = sink(std::as_bytes(std::span(&header_, 1))); !status) return status;
    if (Status status = sink(bytes_of(table_)); !status) return status;
    for (std::size_t i = 0; i <= sections_.size(); ++i) {
      const std::uint64_t next = i < sections_.size() ? table_[i].offset : header_.file_bytes;
      if (Status status = sink(Bytes(kZeros).first(next - at)); !status) return status;
      if (i == sections_.size()) break;
      if (Status status = sink(sections_[i].bytes); !status) return status;
      at = next + sections_[i].bytes.size();
    }
    return {};
  }

  [[nodiscard]] std::uint64_t file_bytes() const { return header_.file_bytes; }

 private:
  void add(SectionKind kind, std::uint32_t owner, Bytes bytes) {
    if (!bytes.empty()) sections_.push_back({kind, owner, bytes});
  }

  void place() {
    std::uint64_t at = sizeof(FileHeader) + sections_.size() * sizeof(SectionEntry);
    for (const Section& section : sections_) {
      SectionEntry entry{};
      entry.kind = static_cast<std::uint32_t>(section.kind);
      const bool informative = section.kind == SectionKind::kCertificate ||
                               section.kind == SectionKind::kNames ||
                               section.kind == SectionKind::kCookRecord;
      entry.flags = informative ? 0 : kSectionRequired;
      entry.owner = section.owner;
      entry.offset = align_up(at, kSectionAlignment);
      entry.size = section.bytes.size();
      entry.checksum = checksum(section.bytes);
      table_.push_back(entry);
      at = entry.offset + entry.size;
    }
    header_ = make_header(table_, 0, checksum);
  }

  std::vector<TreeRecord> records_;
  std::vector<CertificateRecord> certificates_;
  std::string names_;
  std::string cook_record_;
  std::vector<Section> sections_;
  std::vector<SectionEntry> table_;
  FileHeader header_{};
};

}  // namespace

std::vector<std::byte> serialize(std::span<const EncodedTree> trees,
                                 const std::string& cook_record) {
  const Layout layout(trees, cook_record);
  std::vector<std::byte> out(layout.file_bytes());
  static_cast<void>(layout.emit([at = out.data()](Bytes bytes) mutable {
    at = std::copy(bytes.begin(), bytes.end(), at);
    return Status{};
  }));
  return out;
}

Status write_file(const std::filesystem::path& path, std::span<const EncodedTree> trees,
                  const std::string& cook_record) {
  if (trees.size() > kMaxTrees) {
    return Error{Errc::kMeshTooLarge, path.string() + ": " + std::to_string(trees.size()) +
                                          " trees, limit " + std::to_string(kMaxTrees)};
  }
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();
  const Layout layout(trees, cook_record);
  if (Status status = layout.emit([&](Bytes bytes) { return file->write(bytes); }); !status) {
    return status;
  }
  const Result<Mapping> written = Mapping::map(file->descriptor(), path);
  if (!written) return written.error();
  const Result<File> opened = File::open(written->bytes());
  if (!opened) return opened.error();
  if (const Findings findings = verify_file(*opened); !findings.empty()) return findings.front();
  return file->commit();
}

}  // namespace boxtree::cooker
