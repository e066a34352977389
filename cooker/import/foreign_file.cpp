// SPDX-License-Identifier: MIT
// Files that are mistaken for meshes, by their first bytes: PNG (W3C, 5.2), JPEG (ITU T.81,
// B.1.1.3), GIF89a, TIFF 6.0, WebP (RFC 9649), PDF (ISO 32000, 7.5.2), gzip (RFC 1952), pointers of
// Git LFS, web pages; and meshes of another format than their names say.
#include "cooker/import/foreign_file.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <string>
#include <string_view>

#include "cooker/import/text_tokens.h"
#include "cooker/system/file_handle.h"
#include "format/container.h"

namespace boxtree::cooker {
namespace {

using std::string_view_literals::operator""sv;

struct Beginning {
  std::string_view bytes;  // with letters in lower case; those of the file may be capitals
  const char* what;
};

constexpr std::array kBeginnings = {
    Beginning{"\x89png\r\n\x1a\n"sv, "a picture (PNG)"},
    Beginning{"\xff\xd8\xff"sv, "a picture (JPEG)"},
    Beginning{"gif8"sv, "a picture (GIF)"},
    Beginning{"ii*\0"sv, "a picture (TIFF)"},
    Beginning{"mm\0*"sv, "a picture (TIFF)"},
    Beginning{"%pdf-"sv, "a PDF document"},
    Beginning{"\x1f\x8b\x08"sv, "a file that gzip compressed"},
    Beginning{"<!doctype html"sv, "a web page (HTML)"},
    Beginning{"<html"sv, "a web page (HTML)"},
    Beginning{"version https://git-lfs"sv,
              "a pointer of Git LFS, in the place of which `git lfs pull` "
              "puts the file"},
};
// Of formats with a magic, in lower case, and the ending of their names.
constexpr std::array kMeshes = {Beginning{"ply\n"sv, ".ply"},        Beginning{"ply\r"sv, ".ply"},
                                Beginning{"gltf\2\0\0\0"sv, ".glb"}, Beginning{"off\n"sv, ".off"},
                                Beginning{"off\r"sv, ".off"},        Beginning{"solid "sv, ".stl"}};
constexpr std::size_t kLongest = 32;  // bytes of any of them, and more

// Its first bytes; empty if it cannot be read.
std::string start_of(const SourceFile& source) {
  std::string start(kLongest, '\0');
  const FileHandle file = source.open();
  start.resize(file ? std::fread(start.data(), 1, start.size(), file.get()) : 0);
  return start;
}

}  // namespace

const char* misnamed_mesh(const SourceFile& source) {
  const std::string lower = in_lower_case(start_of(source));
  const auto* const found =
      std::find_if(kMeshes.begin(), kMeshes.end(),
                   [&lower](const Beginning& each) { return lower.starts_with(each.bytes); });
  if (found == kMeshes.end()) return nullptr;
  const bool is_named = in_lower_case(source.path().extension().string()) == found->what;
  return is_named ? nullptr : found->what;
}

const char* foreign_file(const SourceFile& source) {
  const std::string start = start_of(source);
  const std::size_t size = start.size();
  if (size >= kMagic.size() && std::memcmp(start.data(), kMagic.data(), kMagic.size()) == 0) {
    return "a cooked file, which info, verify, query, bench and export take";
  }
  const std::string lower = in_lower_case(start);
  const auto* const found =
      std::find_if(kBeginnings.begin(), kBeginnings.end(),
                   [&lower](const Beginning& each) { return lower.starts_with(each.bytes); });
  if (found != kBeginnings.end()) return found->what;
  const bool is_webp = lower.starts_with("riff") && size >= 12 && lower.substr(8, 4) == "webp";
  return is_webp ? "a picture (WebP)" : nullptr;
}

bool begins_with_mark(const SourceFile& source) {
  return start_of(source).starts_with("\xef\xbb\xbf");
}

}  // namespace boxtree::cooker
