// SPDX-License-Identifier: MIT
// Compiled on Windows, this is nothing: see stores_windows.cpp.
#ifndef _WIN32
#include "cooker/farm/journal.h"

#include <cerrno>
#include <cstdint>
#include <fcntl.h>
#include <span>
#include <string_view>
#include <sys/file.h>
#include <system_error>
#include <unistd.h>
#include <utility>

#include "cooker/farm/json_text.h"
#include "cooker/import/whole_file.h"
#include "cooker/system/write_all.h"
#include "cooker/system/write_failure.h"
#include "cooker/text/json.h"
#include "cooker/text/percent.h"
#include "cooker/write/temporary_file.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

std::optional<Journal::Entry> entry_of(const Json& line) {
  const std::optional<Digest> key = digest_of(text_at(line, "key"));
  const std::optional<Digest> output = digest_of(text_at(line, "sha256"));
  const Json* const bytes = line.find("bytes");
  if (!key || !output || bytes == nullptr || !bytes->is_number_unsigned()) return std::nullopt;
  return Journal::Entry{*key, *output, bytes->get<std::uint64_t>()};
}

}  // namespace

Result<Journal> Journal::open(const fs::path& path) {
  const int descriptor =
      ::open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, kNewFileMode);
  if (descriptor < 0) return write_failure(path, "open");
  Journal journal(path, descriptor);
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK) return write_failure(path, "flock");
    return Error{Errc::kWriteFailed,
                 path.string() + ": another process cooks these jobs now: its journal is locked"};
  }
  const Result<std::string> text = read_whole_file(path, kAnyBytes);
  if (!text) return text.error();
  journal.read(*text);
  // Else what comes next would be a part of a line that was cut short.
  if (!text->empty() && text->back() != '\n' &&
      !write_all(descriptor, std::as_bytes(std::span("\n", 1)))) {
    return write_failure(path, "write");
  }
  return journal;
}

Journal::Journal(Journal&& other) noexcept
    : path_(std::move(other.path_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      entries_(std::move(other.entries_)),
      files_(std::move(other.files_)),
      lists_(std::move(other.lists_)),
      mutex_(std::move(other.mutex_)) {}

Journal::~Journal() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void Journal::read(std::string_view text) {
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const ParsedJson line = parse_json(text.substr(0, end));
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
    if (const auto entry = entry_of(line.value)) entries_[text_at(line.value, "output")] = *entry;
    const std::optional<FileState> state = state_in(line.value);
    const std::optional<Digest> digest = cooker::digest_of(text_at(line.value, "sha256"));
    if (state && digest) files_[text_at(line.value, "file")] = {*state, *digest};
    if (line.value.contains("reads")) {
      if (auto list = file_list_in(line.value)) {
        std::string name = percent_encoded(list->opened.front().first.string());
        lists_[std::move(name)] = std::move(*list);
      }
    }
  }
}

std::optional<Journal::Entry> Journal::entry(const std::string& name) const {
  const std::lock_guard lock(*mutex_);
  const auto found = entries_.find(name);
  return found == entries_.end() ? std::nullopt : std::optional(found->second);
}

Result<Digest> Journal::digest_of(const fs::path& file, bool* is_remembered) {
  const std::string name = percent_encoded(file.string());
  const std::optional<FileState> before = state_of(file);
  if (before) {
    const std::lock_guard lock(*mutex_);
    const auto known = files_.find(name);
    if (known != files_.end() && known->second.state == *before) {
      if (is_remembered != nullptr) *is_remembered = true;
      return known->second.digest;
    }
  }
  const bool is_settled = before && before->is_settled(now_nanoseconds());
  const Result<Digest> digest = sha256_of_file(file);
  if (!digest || !is_settled || state_of(file) != before) return digest;
  const Json line = {{"file", name}, {"state", to_json(*before)}, {"sha256", hex_of(*digest)}};
  const std::lock_guard lock(*mutex_);
  if (Status status = add_line(line.dump()); !status) return status.error();
  files_[name] = {*before, *digest};
  return digest;
}

Result<std::vector<fs::path>> Journal::files_of(const fs::path& mesh, const FindFiles& find,
                                                bool* is_remembered) {
  const std::string name = percent_encoded(mesh.string());
  std::optional<FileList> known;
  {
    const std::lock_guard lock(*mutex_);
    if (const auto found = lists_.find(name); found != lists_.end()) known = found->second;
  }
  if (known && known->is_current()) {
    if (is_remembered != nullptr) *is_remembered = true;
    return std::move(known->files);
  }
  const std::int64_t began = now_nanoseconds();
  Result<SourceFileList> found = find();
  if (!found) return found.error();
  if (std::optional<FileList> list = file_list(mesh, *found, began)) {
    Json line = {{"file", name}};
    line.update(to_json(*list));
    const std::lock_guard lock(*mutex_);
    if (Status status = add_line(line.dump()); !status) return status.error();
    lists_[name] = std::move(*list);
  }
  return std::move(found->files);
}

std::optional<Journal::Entry> Journal::find(const fs::path& output, const Digest& key,
                                            bool may_remember) {
  const std::optional<Entry> known = entry(percent_encoded(output.string()));
  if (!known || known->key != key) return std::nullopt;
  std::error_code error;
  if (fs::file_size(output, error) != known->bytes || error) return std::nullopt;
  const Result<Digest> digest = may_remember ? digest_of(output) : sha256_of_file(output);
  if (!digest || *digest != known->output) return std::nullopt;
  return known;
}

Status Journal::add(const fs::path& output, const Entry& entry) {
  const std::string name = percent_encoded(output.string());
  const Json line = {{"output", name},
                     {"key", hex_of(entry.key)},
                     {"sha256", hex_of(entry.output)},
                     {"bytes", entry.bytes}};
  const std::lock_guard lock(*mutex_);
  if (Status status = add_line(line.dump()); !status) return status;
  entries_[name] = entry;
  return {};
}

// Precondition: the caller has the lock.
Status Journal::add_line(const std::string& line) {
  const std::string text = line + "\n";
  if (!write_all(descriptor_, std::as_bytes(std::span(text)))) return write_failure(path_, "write");
  return {};
}

}  // namespace boxtree::cooker
#endif
