// SPDX-License-Identifier: MIT
#include "cooker/proof/pack_proof.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "cooker/proof/names.h"
#include "format/bytes.h"
#include "format/container.h"
#include "format/limits.h"
#include "format/pack.h"
#include "runtime/file/open_file.h"

namespace boxtree::cooker {
namespace {

// The rows of the trees of one member, which is their number in the pack.
struct MemberRows {
  std::uint64_t offset;
  std::uint64_t bytes;
  std::vector<std::uint32_t> rows;  // ascending
};

std::string_view member_name(const OpenFile& file, std::uint32_t tree) {
  return file.tree_name(tree).substr(0, file.pack_row(tree).member_name_bytes);
}

// In the order of offsets.
std::vector<MemberRows> members_of(const OpenFile& file) {
  std::vector<std::uint32_t> rows(file.tree_count());
  for (std::uint32_t i = 0; i < file.tree_count(); ++i) rows[i] = i;
  const auto place = [&](std::uint32_t row) {
    const PackRow stored = file.pack_row(row);
    return std::tuple(stored.offset, stored.bytes, row);
  };
  std::sort(rows.begin(), rows.end(), [&](auto a, auto b) { return place(a) < place(b); });
  std::vector<MemberRows> members;
  for (const std::uint32_t row : rows) {
    const PackRow stored = file.pack_row(row);
    if (members.empty() || members.back().offset != stored.offset ||
        members.back().bytes != stored.bytes) {
      members.push_back({stored.offset, stored.bytes, {}});
    }
    members.back().rows.push_back(row);
  }
  return members;
}

class PackCheck {
 public:
  enum class What : std::uint8_t { kIndex, kAll };

  explicit PackCheck(const OpenFile& open, What what = What::kAll) : open_(open), what_(what) {}

  Findings run_on_member(std::string_view name, std::span<const std::uint32_t> rows) {
    check_trees("member " + std::string(name), name, rows);
    return std::move(findings_);
  }

  Findings run() {
    if (open_.container().find(SectionKind::kTrees, kNoOwner) != nullptr) {
      add(Errc::kRecordInvalid,
          "a pack has no section " + std::string(section_name(SectionKind::kTrees)));
    }
    bool are_names_valid = true;
    for (std::uint32_t i = 0; i < open_.tree_count(); ++i) {
      if (!is_name_valid(i)) are_names_valid = false;
    }
    if (!are_names_valid) return std::move(findings_);  // what follows says names
    for (std::uint32_t i = 1; i < open_.tree_count(); ++i) {
      if (open_.tree_name(i - 1) >= open_.tree_name(i)) {
        add(Errc::kRecordInvalid, tree_text(i) + ": its name is not after that of the one before");
      }
    }
    check_members();
    return std::move(findings_);
  }

 private:
  void add(Errc code, std::string detail) {
    if (findings_.size() < kMaxFindings) findings_.push_back({code, std::move(detail)});
  }

  static std::string tree_text(std::uint32_t row) { return "tree " + std::to_string(row); }

  bool is_name_valid(std::uint32_t i) {
    const PackRow row = open_.pack_row(i);
    const Status status = check_text(open_.section(SectionKind::kNames), row.name_offset,
                                     row.name_bytes, tree_text(i) + ": its name");
    if (!status) {
      add(status.code(), status.error().detail);
      return false;
    }
    const std::string_view name = open_.tree_name(i);
    const std::size_t member = row.member_name_bytes;
    const bool is_whole = member == name.size();
    const bool is_prefix = member < name.size() && name.size() > member + kMemberEnd.size() &&
                           name.substr(member, kMemberEnd.size()) == kMemberEnd;
    if (member > 0 && (is_whole || is_prefix)) return true;
    add(Errc::kRecordInvalid, tree_text(i) + ": its name does not begin with that of a member");
    return false;
  }

  void check_members() {
    const Bytes members = open_.section(SectionKind::kMembers);
    std::uint64_t end = 0;
    std::string_view name_before;
    for (const MemberRows& member : members_of(open_)) {
      const std::string_view name = member_name(open_, member.rows.front());
      const std::string place = "member " + std::string(name);
      const std::uint64_t begin = align_up(end, kLargeAlignment);
      if (member.offset != begin || !in_range(member.offset, member.bytes, members.size())) {
        add(Errc::kRecordInvalid, place + ": it is not behind the member before, in the section");
        return;
      }
      if (!is_zero(members.subspan(end, begin - end))) {
        add(Errc::kPaddingNotZero, place + ": bytes before it are not zero");
      }
      end = member.offset + member.bytes;
      if (member.offset > 0 && name <= name_before) {
        add(Errc::kRecordInvalid, place + ": its name is not after that of the member before");
      }
      name_before = name;
      if (what_ == What::kAll) check_trees(place, name, member.rows);
    }
    if (end != members.size()) {
      add(Errc::kRecordInvalid, "section members has " + std::to_string(members.size() - end) +
                                    " bytes behind the last member");
    }
  }

  void check_trees(const std::string& place, std::string_view name,
                   std::span<const std::uint32_t> rows) {
    const Result<File> file = open_.open_member(rows.front());
    if (!file) {
      add(file.code(), place + ": " + file.error().detail);
      return;
    }
    std::vector<std::uint32_t> trees;
    for (const std::uint32_t row : rows) {
      trees.push_back(open_.pack_row(row).tree);
      if (member_name(open_, row) != name ||
          (open_.tree_name(row).size() == name.size()) != (file->tree_count() == 1)) {
        add(Errc::kRecordInvalid, place + ": " + tree_text(row) + " is not named as one of it");
      }
    }
    std::sort(trees.begin(), trees.end());
    bool is_each_there = trees.size() == file->tree_count();
    for (std::uint32_t i = 0; i < trees.size(); ++i) is_each_there = is_each_there && trees[i] == i;
    if (!is_each_there) add(Errc::kRecordInvalid, place + ": not each of its trees is listed once");
  }

  static bool is_zero(Bytes bytes) {
    return std::all_of(bytes.begin(), bytes.end(), [](std::byte b) { return b == std::byte{0}; });
  }

  const OpenFile& open_;
  const What what_;
  Findings findings_;
};

}  // namespace

Findings check_pack(const File& file) {
  return PackCheck(OpenFile::of(file)).run();
}

Findings check_pack_index(const File& file) {
  return PackCheck(OpenFile::of(file), PackCheck::What::kIndex).run();
}

Findings check_member(const File& file, std::string_view name,
                      std::span<const std::uint32_t> trees) {
  return PackCheck(OpenFile::of(file)).run_on_member(name, trees);
}

void for_each_member(
    const File& file,
    const std::function<void(std::string_view name, std::span<const std::uint32_t> trees)>& use) {
  const OpenFile& open = OpenFile::of(file);
  for (const MemberRows& member : members_of(open)) {
    use(member_name(open, member.rows.front()), member.rows);
  }
}

}  // namespace boxtree::cooker
