// SPDX-License-Identifier: MIT
// Names and sizes say where everything lies before a member is read.
#include "cooker/write/pack_writer.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "cooker/proof/pack_proof.h"
#include "cooker/write/atomic_file.h"
#include "format/container.h"
#include "format/limits.h"
#include "format/pack.h"
#include "runtime/file/checksum.h"
#include "runtime/file/checksum_stream.h"
#include "runtime/file/mapping.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMostNames = ~std::uint32_t{0};
constexpr std::uint64_t kMostMembers = (std::uint64_t{1} << 40) - 1;

// A tree before its name has a place.
struct NamedTree {
  std::string_view name;
  std::size_t member;
  std::uint32_t tree;
};

Error one_name(const std::string& what, std::string_view name, const PackMember& first,
               const PackMember& second) {
  if (first.path == second.path && first.offset == second.offset) {
    return {Errc::kInvalidQuery,
            fmt::format("{}: it is given twice; expected each input once", first.path.string())};
  }
  return {Errc::kInvalidQuery,
          fmt::format("two {} are named \"{}\", of {} and {}; name them after the paths of their "
                      "files: --names path",
                      what, name, first.path.string(), second.path.string())};
}

// The index, and where members lie.
struct Index {
  std::vector<PackRow> rows;
  std::string names;
  std::uint64_t members_bytes = 0;
};

// Sorts the members by their names.
Result<Index> make_index(std::vector<PackMember>& members) {
  if (members.empty()) return Error{Errc::kInvalidQuery, "expected files to pack, found none"};
  std::sort(members.begin(), members.end(), [](const PackMember& a, const PackMember& b) {
    return std::pair(std::string_view(a.name), a.path) <
           std::pair(std::string_view(b.name), b.path);
  });
  std::vector<std::uint64_t> offsets;
  std::vector<NamedTree> trees;
  Index index;
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (i > 0 && members[i - 1].name == members[i].name) {
      return one_name("files", members[i].name, members[i - 1], members[i]);
    }
    offsets.push_back(align_up(index.members_bytes, kLargeAlignment));
    index.members_bytes = offsets.back() + members[i].bytes;
    if (index.members_bytes > kMostMembers) {
      return Error{Errc::kMeshTooLarge,
                   fmt::format("the files have more than the {} bytes that a pack holds; make "
                               "several packs",
                               kMostMembers)};
    }
    for (std::uint32_t t = 0; t < members[i].trees.size(); ++t) {
      trees.push_back({members[i].trees[t], i, t});
    }
  }
  if (trees.size() > kMaxPackedTrees) {
    return Error{Errc::kMeshTooLarge, fmt::format("{} trees, a pack holds {}; make several packs",
                                                  trees.size(), kMaxPackedTrees)};
  }
  std::stable_sort(trees.begin(), trees.end(),
                   [](const NamedTree& a, const NamedTree& b) { return a.name < b.name; });
  for (std::size_t i = 0; i < trees.size(); ++i) {
    const NamedTree& tree = trees[i];
    const PackMember& member = members[tree.member];
    if (i > 0 && trees[i - 1].name == tree.name) {
      return one_name("trees", tree.name, members[trees[i - 1].member], member);
    }
    if (index.names.size() + tree.name.size() > kMostNames) {
      return Error{Errc::kMeshTooLarge, "names take more than 4 GiB; make several packs"};
    }
    index.rows.push_back({offsets[tree.member], member.bytes, tree.tree,
                          static_cast<std::uint32_t>(index.names.size()),
                          static_cast<std::uint32_t>(tree.name.size()),
                          static_cast<std::uint32_t>(member.name.size())});
    index.names += tree.name;
  }
  return index;
}

Error changed(const fs::path& path) {
  return {Errc::kFileUnreadable,
          path.string() + ": it changed while it was packed; run the command again"};
}

// Calls sink(Bytes) with section members from first to last.
template <class Sink>
Status emit_members(const std::vector<PackMember>& members, const OpenInput& open, Sink sink) {
  static constexpr std::array<std::byte, kLargeAlignment> kZeros{};
  std::uint64_t end = 0;
  std::optional<File> file;
  const fs::path* opened = nullptr;
  for (const PackMember& member : members) {
    const std::uint64_t gap = align_up(end, kLargeAlignment) - end;
    if (Status status = sink(Bytes(kZeros).first(gap)); !status) return status;
    if (opened == nullptr || *opened != member.path) {
      Result<File> next = open(member.path);
      if (!next) return next.error();
      file.emplace(std::move(*next));
      opened = &member.path;
    }
    const Bytes bytes = file->bytes();
    if (!in_range(member.offset, member.bytes, bytes.size())) return changed(member.path);
    if (Status status = sink(bytes.subspan(member.offset, member.bytes)); !status) return status;
    end += gap + member.bytes;
  }
  return {};
}

// A row of the section table.
struct PackSection {
  SectionKind kind;
  std::uint64_t size;
  std::uint64_t checksum;
};

// Writes header, section table and sections: `small` in memory, and then the members.
Status write_sections(AtomicFile& file, const Index& index, std::uint64_t members_checksum,
                      const std::vector<PackMember>& members, const OpenInput& open) {
  static constexpr std::array<std::byte, kLargeAlignment> kZeros{};
  const Bytes names = std::as_bytes(std::span(index.names));
  const Bytes rows = std::as_bytes(std::span(index.rows));
  const std::array sections{
      PackSection{SectionKind::kNames, names.size(), checksum(names)},
      PackSection{SectionKind::kPack, rows.size(), checksum(rows)},
      PackSection{SectionKind::kMembers, index.members_bytes, members_checksum},
  };
  std::uint64_t end = table_end(sections.size());
  std::array<SectionEntry, sections.size()> entries;
  std::array<SectionRow, sections.size()> table{};
  for (std::size_t i = 0; i < sections.size(); ++i) {
    SectionEntry& entry = entries[i];
    entry.kind = sections[i].kind;
    entry.is_required = entry.kind != SectionKind::kNames;
    entry.offset = section_begin(end, sections[i].size);
    entry.size = sections[i].size;
    entry.checksum = sections[i].checksum;
    table[i] = entry.row();
    end = entry.end();
  }
  const FileHeader header = make_header(table, kFeaturePack, checksum);
  Status status = file.write(std::as_bytes(std::span(&header, 1)));
  if (status) status = file.write(std::as_bytes(std::span(table)));
  std::uint64_t at = table_end(sections.size());
  const auto pad = [&](std::uint64_t to) {
    if (status) status = file.write(Bytes(kZeros).first(to - at));
  };
  for (const SectionEntry& entry : entries) {
    pad(entry.offset);
    if (!status) return status;
    status = entry.kind == SectionKind::kNames ? file.write(names)
             : entry.kind == SectionKind::kPack
                 ? file.write(rows)
                 : emit_members(members, open, [&](Bytes bytes) { return file.write(bytes); });
    at = entry.end();
  }
  pad(file_end(end));
  return status;
}

}  // namespace

Result<PackReport> write_pack(const OutputTarget& to, std::vector<PackMember> members,
                              const OpenInput& open) {
  const Result<Index> index = make_index(members);
  if (!index) return index.error();
  ChecksumStream of_members;
  const Status added = emit_members(members, open, [&](Bytes bytes) {
    of_members.add(bytes);
    return Status{};
  });
  if (!added) return added.error();
  Result<AtomicFile> file = AtomicFile::create(to);
  if (!file) return file.error();
  if (Status status = write_sections(*file, *index, of_members.value(), members, open); !status) {
    return status.error();
  }
  const Result<Mapping> written = Mapping::map(file->descriptor(), to.title());
  if (!written) return written.error();
  const Result<File> opened =
      File::open(written->bytes(), {.copy = false, .verify_checksums = true});
  if (!opened) {
    return opened.code() == Errc::kChecksumMismatch ? changed("an input") : opened.error();
  }
  if (const Findings findings = check_pack(*opened); !findings.empty()) return findings.front();
  if (Status status = file->commit(); !status) return status.error();
  return PackReport{written->bytes().size(), members.size(), index->rows.size()};
}

}  // namespace boxtree::cooker
