// SPDX-License-Identifier: MIT
// Cooked files by their keys on a server, by the HTTP protocol of Bazel's remote caches.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <istream>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include <boxtree/error.h>

#include "cooker/farm/cook_cache.h"
#include "cooker/farm/http_client.h"

namespace boxtree::cooker {

/// GET and PUT of URL/ac/KEY, an entry (action_result.h), and of URL/cas/DIGEST, an output, under
/// the SHA-256 of its bytes. Outputs are put before their entries. What is read is bounded before:
/// an entry by kMaxEntryBytes, an output by what its entry states and kMaxOutputBytes, and the time
/// by HttpLimits. An answer that is not what the protocol has for it, or comes late, is a failure;
/// after kMostFailures in a row of requests that read, or of those that write, no more of that kind
/// are made: a server that is away costs no more than those, on each thread.
class HttpCache final : public CookCache {
 public:
  static constexpr std::uint64_t kMaxEntryBytes = std::uint64_t{4} << 20;
  static constexpr std::uint64_t kMaxOutputBytes = std::uint64_t{64} << 30;
  static constexpr int kMostFailures = 3;

  /// Makes no request. `url`: http:// or https://, with a host, and a user and a password before it
  /// if the server wants them, which no message has. Errors: kFeatureUnsupported, as
  /// HttpClient::open; kDocumentInvalid for what is no such URL.
  static Result<HttpCache> open(const std::string& url, const HttpLimits& limits = {});

 protected:
  [[nodiscard]] Result<std::optional<Entry>> find(
      const Digest& key, const std::filesystem::path& output) const override;
  Result<Entry> keep(const Digest& key, const std::filesystem::path& output,
                     const std::string& report) const override;

 private:
  enum class Use : std::uint8_t { kRead, kWrite };
  struct Failures {
    std::mutex mutex;  // of the other
    std::array<int, 2> in_a_row{};
  };

  HttpCache(HttpClient client, std::string url, std::string shown)
      : client_(std::move(client)), url_(std::move(url)), shown_(std::move(shown)) {}

  [[nodiscard]] std::optional<Entry> read_entry(const std::string& place, const Digest& key) const;
  [[nodiscard]] Result<std::optional<Entry>> read_output(const Entry& entry,
                                                         const std::filesystem::path& output) const;
  Status put(const std::string& place, std::istream& body, std::uint64_t bytes) const;

  [[nodiscard]] bool is_left_alone(Use use) const;
  void succeeded(Use use) const;
  Error fail(Use use, const std::string& place, const std::string& what,
             bool is_answered = true) const;
  [[nodiscard]] bool count_failure(Use use) const;

  HttpClient client_;
  std::string url_;    // without a slash at its end
  std::string shown_;  // the same without user and password
  std::unique_ptr<Failures> failures_ = std::make_unique<Failures>();
};

}  // namespace boxtree::cooker
