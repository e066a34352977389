// SPDX-License-Identifier: MIT
#include "cooker/import/recording_io.h"

#include <algorithm>
#include <cstring>
#include <locale.h>
#include <memory>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <utility>

#include <assimp/MemoryIOWrapper.h>

#include "cooker/import/source_files.h"
#include "cooker/import/text_tokens.h"
#include "cooker/text/percent.h"

namespace boxtree::cooker {

namespace fs = std::filesystem;

bool RecordingIo::Exists(const char* path) const {
  if (source_.bytes()) return is_source(path);
  std::error_code error;
  const fs::path file = found(path);
  const bool exists = fs::is_regular_file(file, error) && DefaultIOSystem::Exists(file.c_str());
  (exists ? use_.present : use_.absent).push_back(file);
  return exists;
}

fs::path RecordingIo::found(const char* path) const {
  std::error_code error;
  const std::string_view name = path;
  if (name.find('%') == std::string_view::npos || fs::is_regular_file(path, error)) return path;
  const std::string folder = source_.path().parent_path().string();
  const std::size_t kept = name.substr(0, folder.size()) == folder ? folder.size() : 0;
  fs::path file = std::string(name.substr(0, kept)) + percent_decoded(name.substr(kept));
  use_.absent.emplace_back(path);
  if (fs::is_regular_file(file, error)) return file;
  use_.absent.push_back(std::move(file));
  return path;
}

void RecordingIo::note_failure(const fs::path& file) {
  if (use_.failure) return;
  const Status status = check_source_file(SourceFile(tidied(file)), source_.path().string());
  if (!status.ok()) use_.failure = status.error();
}

namespace {

// Files of X begin with a name, a version and their kind, "xof 0303txt"; the other formats are XML.
bool is_packed(std::string_view text) {
  if (text.starts_with("xof ")) return text.find("txt") != std::string_view("xof 0303").size();
  return text.find('\0') != std::string_view::npos || text.find('<') == std::string_view::npos;
}

std::string with_blanks_behind_commas(const std::string& text) {
  std::string mended;
  mended.reserve(text.size() + text.size() / 8);
  for (std::size_t i = 0; i < text.size(); ++i) {
    mended += text[i];
    const bool is_inside = i > 0 && i + 1 < text.size();
    if (text[i] == ',' && is_inside && is_digit(text[i - 1]) && is_digit(text[i + 1])) {
      mended += ' ';
    }
  }
  return mended;
}

}  // namespace

Assimp::IOStream* RecordingIo::open_mended() const {
  Result<std::string> text = source_.read();
  if (!text.ok()) return nullptr;
  if (mends_.commas && !is_packed(*text)) text = with_blanks_behind_commas(*text);
  if (mends_.line_end && has_open_end(*text)) text->push_back('\n');
  auto bytes = std::make_unique<std::uint8_t[]>(text->size());
  std::memcpy(bytes.get(), text->data(), text->size());
  constexpr bool kOwn = true;  // the stream deletes the bytes
  return new Assimp::MemoryIOStream(bytes.release(), text->size(), kOwn);
}

Assimp::IOStream* RecordingIo::Open(const char* path, const char* mode) {
  if (std::strpbrk(mode, "wa+") != nullptr) return nullptr;
  if (source_.bytes()) {
    if (is_source(path)) {
      if (has_mends()) return open_mended();
      const auto* const data = reinterpret_cast<const std::uint8_t*>(source_.bytes()->data());
      return new Assimp::MemoryIOStream(data, source_.bytes()->size());
    }
    if (use_.inaccessible.empty()) use_.inaccessible = tidied(path);
    return nullptr;
  }
  // fopen opens directories too; a pipe would block.
  std::error_code error;
  const fs::path file = found(path);
  const bool is_regular = fs::is_regular_file(file, error);
  Assimp::IOStream* stream = nullptr;
  if (is_regular) {
    stream =
        has_mends() && is_source(path) ? open_mended() : DefaultIOSystem::Open(file.c_str(), mode);
  }
  if (stream == nullptr) {
    use_.absent.push_back(file);
    note_failure(file);
    return nullptr;
  }
  fs::path normal = tidied(file);
  if (std::find(use_.files.begin(), use_.files.end(), normal) == use_.files.end()) {
    use_.files.push_back(std::move(normal));
    use_.bytes_opened += stream->FileSize();
    if (use_.opened) use_.opened(use_.bytes_opened);
  }
  if (std::find(use_.named.begin(), use_.named.end(), file) == use_.named.end()) {
    use_.named.push_back(file);
  }
  return stream;
}

static_assert(std::is_pointer_v<locale_t>);

CLocaleScope::CLocaleScope() : locale_(newlocale(LC_ALL_MASK, "C", locale_t{})), previous_() {
  if (locale_ != nullptr) previous_ = uselocale(static_cast<locale_t>(locale_));
}

CLocaleScope::~CLocaleScope() {
  if (locale_ == nullptr) return;
  uselocale(static_cast<locale_t>(previous_));
  freelocale(static_cast<locale_t>(locale_));
}

}  // namespace boxtree::cooker
