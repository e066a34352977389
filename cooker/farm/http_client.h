// SPDX-License-Identifier: MIT
// GET and PUT of HTTP, by libcurl, which is loaded when the first client is opened: with its thirty
// libraries it takes 15 ms, half of what a small cook takes.
#pragma once

#include <cstdint>
#include <functional>
#include <istream>
#include <memory>
#include <string>
#include <string_view>

#include <boxtree/error.h>

namespace boxtree::cooker {

/// When a server is too slow to wait for.
struct HttpLimits {
  long connect_milliseconds = 5000;
  /// A request fails once it has moved fewer bytes for so long.
  long stall_seconds = 10;
  long slowest_bytes_per_second = 16 << 10;
};

/// Keeps connections open. Follows no redirect, and knows nothing of proxies, users or certificates
/// but what the URL and the system have. Safe for several threads.
class HttpClient {
 public:
  /// Error: kFeatureUnsupported if libcurl is not there, or this build is without it.
  static Result<HttpClient> open(const HttpLimits& limits);

  HttpClient(HttpClient&& other) noexcept;
  HttpClient& operator=(HttpClient&&) = delete;
  HttpClient(const HttpClient&) = delete;
  HttpClient& operator=(const HttpClient&) = delete;
  ~HttpClient();

  /// Takes bytes of a body. False: no more are wanted, and the request fails.
  using Sink = std::function<bool(std::string_view bytes)>;

  /// Passes the body to `sink` if the status is 200; what other answers have is not read. The
  /// status. Error: kFileUnreadable if there is no answer, or not all of it.
  [[nodiscard]] Result<int> get(const std::string& url, const Sink& sink) const;

  /// Sends `bytes` bytes of a stream that can be read again from its start. The status. Error: the
  /// same.
  [[nodiscard]] Result<int> put(const std::string& url, std::istream& body,
                                std::uint64_t bytes) const;

 private:
  struct Handles;
  explicit HttpClient(std::unique_ptr<Handles> handles);

  std::unique_ptr<Handles> handles_;
};

}  // namespace boxtree::cooker
