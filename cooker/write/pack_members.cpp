// SPDX-License-Identifier: MIT
#include "cooker/write/pack_members.h"

#include <map>
#include <utility>

#include <fmt/format.h>

#include "cooker/import/file_error.h"
#include "cooker/proof/pack_proof.h"
#include "cooker/system/path.h"
#include "cooker/text/utf8.h"
#include "format/pack.h"
#include "runtime/file/open_file.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

// Of a file called "rock.bxt", "rock".
std::string stem_of(const fs::path& path) {
  return to_utf8(path.stem().string());
}

// "props/rock" of "../props/./rock.bxt": what is named relative to a root, or to a folder above, by
// the rest.
std::string name_by_path(const fs::path& path) {
  fs::path name;
  for (const fs::path& part :
       (path.parent_path() / path.stem()).lexically_normal().relative_path()) {
    if (part != "..") name /= part;
  }
  return to_utf8(name.generic_string());
}

// The trees of a member, each with a name that no other of them has.
std::vector<std::string> tree_names(const File& file, const std::string& member) {
  if (file.tree_count() == 1) return {member};
  std::vector<std::string> names;
  std::map<std::string, std::uint32_t> counts;
  for (std::uint32_t i = 0; i < file.tree_count(); ++i) {
    std::string name = to_utf8(file.tree_name(i));
    if (name.empty()) name = std::to_string(i);
    if (const std::uint32_t number = ++counts[name]; number > 1) name += fmt::format("#{}", number);
    names.push_back(member + std::string(kMemberEnd) + name);
  }
  return names;
}

Result<std::vector<PackMember>> members_of_pack(const fs::path& path, const File& pack,
                                                PackNames names) {
  if (const Findings findings = check_pack(pack); !findings.empty()) return findings.front();
  const std::string before =
      names == PackNames::kPath ? name_by_path(path) + std::string(kMemberEnd) : std::string();
  std::vector<PackMember> members;
  const OpenFile& open = OpenFile::of(pack);
  const auto begin =
      static_cast<std::uint64_t>(open.section(SectionKind::kMembers).data() - pack.bytes().data());
  for_each_member(pack, [&](std::string_view name, std::span<const std::uint32_t> trees) {
    const PackRow first = open.pack_row(trees.front());
    PackMember member{path, begin + first.offset, first.bytes, before + std::string(name), {}};
    member.trees.resize(trees.size());
    for (const std::uint32_t tree : trees) {
      member.trees[open.pack_row(tree).tree] = before + std::string(pack.tree_name(tree));
    }
    members.push_back(std::move(member));
  });
  return members;
}

}  // namespace

Result<std::vector<PackMember>> list_members(const fs::path& path, PackNames names,
                                             const OpenInput& open) {
  const Result<File> file = open(path);
  if (!file) return file.error();
  if (Status status = verify_checksums(*file); !status) return in_file(path, status.error());
  if (Status status = check_padding(file->bytes(), OpenFile::of(*file).container()); !status) {
    return in_file(path, status.error());
  }
  if (file->is_pack()) {
    Result<std::vector<PackMember>> members = members_of_pack(path, *file, names);
    if (!members) return in_file(path, members.error());
    return members;
  }
  if (file->tree_count() == 0) {
    return in_file(path,
                   {Errc::kSectionMissing, "expected a file with trees, found one without any"});
  }
  PackMember member{path, 0, file->bytes().size(), {}, {}};
  if (names == PackNames::kPath) {
    member.name = name_by_path(path);
  } else {
    if (file->tree_count() == 1) member.name = to_utf8(file->tree_name(0));
    if (member.name.empty()) member.name = stem_of(path);
  }
  member.trees = tree_names(*file, member.name);
  return std::vector{std::move(member)};
}

fs::path member_path(std::string_view name) {
  constexpr std::string_view kSpecial = "<>:\"\\|?*%";
  std::string path;
  const auto encode = [&](char c) {
    path += fmt::format("%{:02X}", static_cast<unsigned>(static_cast<unsigned char>(c)));
  };
  while (true) {
    const std::string_view part = name.substr(0, name.find('/'));
    if (part.empty()) path += '%';
    for (std::size_t i = 0; i < part.size(); ++i) {
      const char c = part[i];
      const bool is_control = static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
      const bool is_dropped = i + 1 == part.size() && (c == '.' || c == ' ');  // on Windows
      if (is_control || is_dropped || kSpecial.find(c) != std::string_view::npos) {
        encode(c);
      } else {
        path += c;
      }
    }
    if (part.size() == name.size()) break;
    path += '/';
    name.remove_prefix(part.size() + 1);
  }
  return named_path(path + ".bxt");
}

}  // namespace boxtree::cooker
