// SPDX-License-Identifier: MIT
// Compiled on Windows, this is nothing: see stores_windows.cpp.
#ifndef _WIN32
#include "cooker/farm/folder_cache.h"

#include <array>
#include <cstdio>
#include <fcntl.h>
#include <span>
#include <string_view>
#include <sys/stat.h>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "cooker/farm/cache_size.h"
#include "cooker/farm/json_text.h"
#include "cooker/import/whole_file.h"
#include "cooker/system/write_all.h"
#include "cooker/system/write_failure.h"
#include "cooker/text/json.h"
#include "cooker/write/atomic_file.h"
#include "cooker/write/temporary_file.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxEntryBytes = std::uint64_t{64} << 20;
// Begins an entry, before the digest of the rest.
constexpr std::string_view kEntryMagic = "boxtree cache 1 ";

fs::path below(const fs::path& folder, const Digest& digest) {
  const std::string hex = hex_of(digest);
  return folder / hex.substr(0, 2) / hex;
}

void note_use(const fs::path& file) {
  // A file system that cannot says of a file less than it might: the file goes earlier.
  static_cast<void>(::utimensat(AT_FDCWD, file.c_str(), nullptr, 0));
}

std::optional<Json> checked_json(std::string_view text) {
  if (!text.starts_with(kEntryMagic)) return std::nullopt;
  text.remove_prefix(kEntryMagic.size());
  const std::size_t end = text.find('\n');
  if (end == std::string_view::npos) return std::nullopt;
  const std::optional<Digest> digest = digest_of(text.substr(0, end));
  const std::string_view rest = text.substr(end + 1);
  if (!digest || *digest != sha256_of(rest)) return std::nullopt;
  ParsedJson parsed = parse_json(rest);
  if (parsed.fault != ParsedJson::Fault::kNone) return std::nullopt;
  return std::move(parsed.value);
}

// A new file that is renamed to its place; what was there is replaced.
Status put(TemporaryFile& file, const fs::path& place) {
  std::error_code error;
  fs::create_directories(place.parent_path(), error);  // a failure is that of the rename
  if (Status status = file.add_name(); !status) return status;
  if (std::rename(file.path().c_str(), place.c_str()) != 0) return write_failure(place, "rename");
  file.release_name();
  return {};
}

}  // namespace

Result<FolderCache> FolderCache::open(const fs::path& folder, std::uint64_t most_bytes) {
  std::error_code ignored;
  if (fs::exists(folder, ignored) && !fs::is_directory(folder, ignored)) {
    return Error{Errc::kWriteFailed, folder.string() + ": expected a folder, found a file"};
  }
  for (const char* kind : {"ac", "cas"}) {
    std::error_code error;
    fs::create_directories(folder / kind, error);
    if (error) {
      return Error{Errc::kWriteFailed, (folder / kind).string() + ": " + error.message()};
    }
  }
  return FolderCache(folder, most_bytes);
}

fs::path FolderCache::entry_path(const Digest& key) const {
  return below(folder_ / "ac", key);
}

fs::path FolderCache::output_path(const Digest& output) const {
  return below(folder_ / "cas", output);
}

std::optional<CookCache::Entry> FolderCache::read_entry(const Digest& key) const {
  const fs::path place = entry_path(key);
  const Result<std::string> text = read_whole_file(place, kMaxEntryBytes);
  if (!text) return std::nullopt;  // as a rule there is none
  const std::optional<Json> json = checked_json(*text);
  if (json && text_at(*json, "key") == hex_of(key)) {
    const std::optional<Digest> output = digest_of(text_at(*json, "output"));
    const Json* const bytes = json->find("bytes");
    if (output && bytes != nullptr && bytes->is_number_unsigned()) {
      return Entry{*output, bytes->get<std::uint64_t>(), text_at(*json, "report")};
    }
  }
  note_damage(place, fmt::format("an entry of key {}", hex_of(key)));
  return std::nullopt;
}

Result<std::optional<CookCache::Entry>> FolderCache::find(const Digest& key,
                                                          const fs::path& output) const {
  std::optional<Entry> entry = read_entry(key);
  if (!entry) return std::optional<Entry>();
  const fs::path cached = output_path(entry->output);
  if (has_output(output, *entry)) {
    note_use(entry_path(key));
    note_use(cached);
    return entry;
  }
  std::error_code error;
  const std::uint64_t found_bytes = fs::file_size(cached, error);
  if (error) return std::optional<Entry>();  // removed, as keep_cache_size() does
  if (found_bytes != entry->bytes) {
    note_damage(cached, fmt::format("{} bytes, found {}", entry->bytes, found_bytes));
    return std::optional<Entry>();
  }
  Result<AtomicFile> file = AtomicFile::create(output);
  if (!file) return file.error();
  Sha256 sha;
  Status written;
  const Status read = read_chunks(cached, entry->bytes, [&](const char* bytes, std::size_t count) {
    const std::string_view chunk(bytes, count);
    sha.add(chunk);
    if (written) written = file->write(std::as_bytes(std::span(chunk)));
  });
  if (!written) return written.error();
  if (!read) {
    note(read.error());
    return std::optional<Entry>();
  }
  if (sha.finish() != entry->output) {
    note_damage(cached, "bytes of the SHA-256 that is its name");
    return std::optional<Entry>();
  }
  if (Status status = file->commit(); !status) return status.error();
  note_use(entry_path(key));
  note_use(cached);
  return entry;
}

void FolderCache::note_damage(const fs::path& file, const std::string& expected) const {
  note({Errc::kFileUnreadable,
        fmt::format("{}: damaged in the cache: expected {}; it is cooked and stored anew",
                    file.string(), expected)});
}

Result<CookCache::Entry> FolderCache::keep(const Digest& key, const fs::path& output,
                                           const std::string& report) const {
  Entry entry{{}, 0, report};
  Result<TemporaryFile> copy = TemporaryFile::create(folder_ / "cas", "incoming", kNewFileMode);
  if (!copy) return copy.error();
  Sha256 sha;
  Status written;
  const Status read = read_chunks(output, kAnyBytes, [&](const char* bytes, std::size_t count) {
    const std::string_view chunk(bytes, count);
    sha.add(chunk);
    entry.bytes += count;
    if (written && !write_all(copy->descriptor(), std::as_bytes(std::span(chunk)))) {
      written = write_failure(folder_ / "cas", "write");
    }
  });
  if (!read) return read.error();
  if (!written) return written.error();
  entry.output = sha.finish();
  if (Status status = put(*copy, output_path(entry.output)); !status) return status.error();

  const std::string json = Json{
      {"key", hex_of(key)},
      {"output", hex_of(entry.output)},
      {"bytes", entry.bytes},
      {"report", report}}.dump();
  const std::string text = fmt::format("{}{}\n{}", kEntryMagic, hex_of(sha256_of(json)), json);
  Result<TemporaryFile> file = TemporaryFile::create(folder_ / "ac", "incoming", kNewFileMode);
  if (!file) return file.error();
  if (!write_all(file->descriptor(), std::as_bytes(std::span(text)))) {
    return write_failure(entry_path(key), "write");
  }
  if (Status status = put(*file, entry_path(key)); !status) return status.error();
  if (Status status = keep_cache_size(folder_, entry.bytes + text.size(), most_bytes_); !status) {
    return status.error();
  }
  return entry;
}

}  // namespace boxtree::cooker
#endif
