// SPDX-License-Identifier: MIT
#include "cooker/farm/http_cache.h"

#include <algorithm>
#include <fstream>
#include <span>
#include <sstream>
#include <string_view>

#include <fmt/format.h>

#include "cooker/farm/action_result.h"
#include "cooker/import/whole_file.h"
#include "cooker/write/atomic_file.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

constexpr int kOk = 200, kNotFound = 404;

std::string entry_place(const Digest& key) {
  return "/ac/" + hex_of(key);
}

std::string output_place(const Digest& output) {
  return "/cas/" + hex_of(output);
}

// What is wrong with a URL; empty if nothing is. What follows the host is the server's to
// understand.
std::string url_fault(std::string_view scheme, std::string_view rest) {
  if (scheme != "http" && scheme != "https") {
    return fmt::format("expected http:// or https://, found {}://", scheme);
  }
  const std::string_view authority = rest.substr(0, rest.find('/'));
  const std::string_view host = authority.substr(authority.rfind('@') + 1);
  if (host.empty() || host.front() == ':') return "expected a host after ://, found none";
  const bool is_plain = std::all_of(rest.begin(), rest.end(), [](char c) {
    return c > ' ' && c <= '~' && c != '?' && c != '#' && c != '\\';
  });
  return is_plain ? "" : "expected no spaces, no ? and no # in a URL";
}

}  // namespace

Result<HttpCache> HttpCache::open(const std::string& url, const HttpLimits& limits) {
  const std::size_t scheme = url.find("://");
  if (scheme == std::string::npos) {
    return Error{Errc::kDocumentInvalid, "expected http:// or https:// at the start of a URL"};
  }
  std::string place = url;
  while (place.size() > scheme + 3 && place.back() == '/') place.pop_back();
  const std::string_view rest = std::string_view(place).substr(scheme + 3);
  if (const std::string fault = url_fault(url.substr(0, scheme), rest); !fault.empty()) {
    return Error{Errc::kDocumentInvalid, fault};
  }
  const std::size_t user_end = rest.substr(0, rest.find('/')).rfind('@') + 1;  // 0: there is none
  const std::string shown = place.substr(0, scheme + 3) + std::string(rest.substr(user_end));
  Result<HttpClient> client = HttpClient::open(limits);
  if (!client) return client.error();
  return HttpCache(std::move(*client), place, shown);
}

Result<std::optional<CookCache::Entry>> HttpCache::find(const Digest& key,
                                                        const fs::path& output) const {
  if (is_left_alone(Use::kRead)) return std::optional<Entry>();
  const std::optional<Entry> entry = read_entry(entry_place(key), key);
  if (!entry || has_output(output, *entry)) return entry;
  return read_output(*entry, output);
}

std::optional<CookCache::Entry> HttpCache::read_entry(const std::string& place,
                                                      const Digest& key) const {
  std::string body;
  bool is_too_long = false;
  const Result<int> status = client_.get(url_ + place, [&](std::string_view bytes) {
    is_too_long = bytes.size() > kMaxEntryBytes - body.size();
    if (!is_too_long) body += bytes;
    return !is_too_long;
  });
  if (is_too_long) {
    fail(Use::kRead, place,
         fmt::format("expected an entry of boxtree, of at most {} bytes, found more",
                     kMaxEntryBytes));
    return std::nullopt;
  }
  if (!status) {
    fail(Use::kRead, place, status.error().detail, false);
    return std::nullopt;
  }
  std::optional<Entry> entry;
  if (*status == kOk) entry = entry_in_action_result(body, key);
  if (entry || *status == kNotFound) {
    succeeded(Use::kRead);
  } else if (*status == kOk) {
    fail(Use::kRead, place,
         fmt::format("expected an entry of boxtree, found {} other bytes", body.size()));
  } else {
    fail(Use::kRead, place, fmt::format("expected status 200 or 404, found {}", *status));
  }
  return entry;
}

Result<std::optional<CookCache::Entry>> HttpCache::read_output(const Entry& entry,
                                                               const fs::path& output) const {
  const std::string place = output_place(entry.output);
  if (entry.bytes > kMaxOutputBytes) return std::optional<Entry>();
  Result<AtomicFile> file = AtomicFile::create(output);
  if (!file) return file.error();
  Sha256 sha;
  Status written;
  std::uint64_t left = entry.bytes;
  bool is_too_long = false;
  const Result<int> status = client_.get(url_ + place, [&](std::string_view bytes) {
    is_too_long = bytes.size() > left;
    if (is_too_long) return false;
    left -= bytes.size();
    sha.add(bytes);
    written = file->write(std::as_bytes(std::span(bytes)));
    return static_cast<bool>(written);
  });
  if (!written) return written.error();
  if (status && *status == kNotFound) {  // a server may have room for the entry alone
    succeeded(Use::kRead);
    return std::optional<Entry>();
  }
  std::string fault;
  if (is_too_long) {
    fault = fmt::format("expected the {} bytes of its entry, found more", entry.bytes);
  } else if (!status) {
    fail(Use::kRead, place, status.error().detail, false);
    return std::optional<Entry>();
  } else if (*status != kOk) {
    fault = fmt::format("expected status 200 or 404, found {}", *status);
  } else if (left > 0) {
    fault = fmt::format("expected {} bytes, found {}", entry.bytes, entry.bytes - left);
  } else if (sha.finish() != entry.output) {
    fault = "found bytes with another SHA-256";
  }
  if (!fault.empty()) {
    fail(Use::kRead, place, fault);
    return std::optional<Entry>();
  }
  succeeded(Use::kRead);
  if (Status kept = file->commit(); !kept) return kept.error();
  return std::optional(entry);
}

Result<CookCache::Entry> HttpCache::keep(const Digest& key, const fs::path& output,
                                         const std::string& report) const {
  Entry entry{{}, 0, report};
  Sha256 sha;
  const Status read = read_chunks(output, kAnyBytes, [&](const char* bytes, std::size_t count) {
    sha.add(std::string_view(bytes, count));
    entry.bytes += count;
  });
  if (!read) return read.error();
  entry.output = sha.finish();
  if (is_left_alone(Use::kWrite)) return entry;
  const std::string result = action_result_of(key, entry);
  if (entry.bytes > kMaxOutputBytes || result.size() > kMaxEntryBytes) {
    return Error{
        Errc::kWriteFailed,
        fmt::format("{}: {} bytes, with {} of its entry, are more than the {} and {} that "
                    "are read again",
                    output.string(), entry.bytes, result.size(), kMaxOutputBytes, kMaxEntryBytes)};
  }
  // What comes to be read here, should somebody write the file now, is not what its name says, and
  // is no more than that.
  std::ifstream file(output, std::ios::binary);
  if (Status status = put(output_place(entry.output), file, entry.bytes); !status) {
    return status.error();
  }
  std::istringstream text(result);
  if (Status status = put(entry_place(key), text, result.size()); !status) return status.error();
  succeeded(Use::kWrite);
  return entry;
}

Status HttpCache::put(const std::string& place, std::istream& body, std::uint64_t bytes) const {
  const Result<int> status = client_.put(url_ + place, body, bytes);
  if (!status) return fail(Use::kWrite, place, status.error().detail, false);
  if (*status >= 200 && *status < 300) return {};
  return fail(
      Use::kWrite, place,
      fmt::format("expected a status from 200 to 299 for {} bytes, found {}", bytes, *status));
}

bool HttpCache::is_left_alone(Use use) const {
  const std::lock_guard lock(failures_->mutex);
  return failures_->in_a_row[static_cast<std::size_t>(use)] >= kMostFailures;
}

// Requests of other threads that were on their way do not bring back what is left alone.
void HttpCache::succeeded(Use use) const {
  const std::lock_guard lock(failures_->mutex);
  int& in_a_row = failures_->in_a_row[static_cast<std::size_t>(use)];
  if (in_a_row < kMostFailures) in_a_row = 0;
}

// Whether this one was one too many.
bool HttpCache::count_failure(Use use) const {
  const std::lock_guard lock(failures_->mutex);
  return ++failures_->in_a_row[static_cast<std::size_t>(use)] == kMostFailures;
}

Error HttpCache::fail(Use use, const std::string& place, const std::string& what,
                      bool is_answered) const {
  Error error{use == Use::kRead ? Errc::kFileUnreadable : Errc::kWriteFailed,
              shown_ + place + ": " + what};
  note(error);
  // Who does not answer the one does not answer the other.
  const bool ends_reads = (use == Use::kRead || !is_answered) && count_failure(Use::kRead);
  const bool ends_writes = (use == Use::kWrite || !is_answered) && count_failure(Use::kWrite);
  if (ends_reads || ends_writes) {
    const char* const left = !ends_writes  ? "looked for"
                             : !ends_reads ? "sent"
                                           : "looked for or sent";
    warn(fmt::format("{}: {} failures in a row, the last: {}; nothing more is {} there in this run",
                     shown_, kMostFailures, error.detail, left));
  }
  return error;
}

}  // namespace boxtree::cooker
