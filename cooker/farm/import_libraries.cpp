// SPDX-License-Identifier: MIT
#include "cooker/farm/import_libraries.h"

#ifdef __linux__
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <link.h>
#include <map>
#include <set>
#include <span>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "cooker/farm/sha256.h"
#endif

namespace boxtree::cooker {

#ifdef __linux__
namespace {

// What is loaded, as the loader has it.
struct Loaded {
  std::string path;
  std::string build_id;             // hexadecimal digits; empty if it has none
  std::vector<std::string> needed;  // names of others
};

std::string hex_text(std::span<const unsigned char> bytes) {
  std::string text;
  for (const unsigned char byte : bytes) text += fmt::format("{:02x}", byte);
  return text;
}

// The id among the notes of a segment: each has three sizes, a name and a text, both padded.
std::string build_id_in(std::span<const unsigned char> notes) {
  constexpr std::string_view kGnu("GNU\0", 4);
  const auto padded = [](std::size_t size) { return (size + 3) & ~std::size_t{3}; };
  ElfW(Nhdr) head;
  while (notes.size() >= sizeof(head)) {
    std::memcpy(&head, notes.data(), sizeof(head));
    notes = notes.subspan(sizeof(head));
    const std::size_t name = padded(head.n_namesz);
    if (name > notes.size() || padded(head.n_descsz) > notes.size() - name) return {};
    const std::string_view owner(reinterpret_cast<const char*>(notes.data()), head.n_namesz);
    if (head.n_type == NT_GNU_BUILD_ID && owner == kGnu) {
      return hex_text(notes.subspan(name, head.n_descsz));
    }
    notes = notes.subspan(name + padded(head.n_descsz));
  }
  return {};
}

std::vector<std::string> needed_in(const ElfW(Dyn) * entry, ElfW(Addr) base) {
  std::vector<std::size_t> places;
  ElfW(Addr) names = 0;
  for (; entry->d_tag != DT_NULL; ++entry) {
    if (entry->d_tag == DT_NEEDED) places.push_back(entry->d_un.d_val);
    if (entry->d_tag == DT_STRTAB) names = entry->d_un.d_ptr;
  }
  std::vector<std::string> needed;
  if (names == 0) return needed;
  if (names < base) names += base;  // some loaders write the address there, others leave the offset
  for (const std::size_t place : places) {
    needed.emplace_back(reinterpret_cast<const char*>(names + place));
  }
  return needed;
}

int add_loaded(dl_phdr_info* info, std::size_t /*size*/, void* to) {
  auto& loaded = *static_cast<std::map<std::string, Loaded>*>(to);
  const std::string path = info->dlpi_name == nullptr ? "" : info->dlpi_name;
  // The program, and what the kernel maps, have no file name here; the latter's table of names is
  // not where it says.
  if (path.find('/') == std::string::npos) return 0;
  Loaded object{path, {}, {}};
  for (const ElfW(Phdr) & segment : std::span(info->dlpi_phdr, info->dlpi_phnum)) {
    const ElfW(Addr) at = info->dlpi_addr + segment.p_vaddr;
    if (segment.p_type == PT_NOTE && object.build_id.empty()) {
      object.build_id = build_id_in({reinterpret_cast<const unsigned char*>(at), segment.p_memsz});
    }
    if (segment.p_type == PT_DYNAMIC) {
      object.needed = needed_in(reinterpret_cast<const ElfW(Dyn)*>(at), info->dlpi_addr);
    }
  }
  loaded.emplace(std::filesystem::path(path).filename().string(), std::move(object));
  return 0;
}

// What every program has, and whose updates leave what a library computes as it is specified.
bool is_of_the_runtime(std::string_view name) {
  constexpr std::array<std::string_view, 7> kRuntime{"libc.", "libm.",       "libstdc++.", "libgcc",
                                                     "ld-",   "libpthread.", "libc++"};
  return std::any_of(kRuntime.begin(), kRuntime.end(),
                     [&](std::string_view start) { return name.starts_with(start); });
}

std::string id_of(const Loaded& object) {
  if (!object.build_id.empty()) return object.build_id;
  const Result<Digest> digest = sha256_of_file(object.path);
  return digest ? hex_of(*digest) : "unknown";
}

std::string read_import_libraries() {
  std::map<std::string, Loaded> loaded;
  dl_iterate_phdr(add_loaded, &loaded);
  std::set<std::string> names;
  std::vector<std::string> next;
  for (const auto& [name, object] : loaded) {
    if (name.starts_with("libassimp")) next.push_back(name);
  }
  while (!next.empty()) {
    const std::string name = std::move(next.back());
    next.pop_back();
    const auto object = loaded.find(name);
    if (object == loaded.end() || is_of_the_runtime(name) || !names.insert(name).second) continue;
    next.insert(next.end(), object->second.needed.begin(), object->second.needed.end());
  }
  std::string text;
  for (const std::string& name : names) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name, id_of(loaded.at(name)));
  }
  return text;
}

}  // namespace
#endif

const std::string& import_libraries() {
#ifdef __linux__
  static const std::string text = read_import_libraries();
#else
  static const std::string text;
#endif
  return text;
}

}  // namespace boxtree::cooker
