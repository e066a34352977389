// SPDX-License-Identifier: MIT
#include <array>
#include <cstddef>
#include <curl/curl.h>
#include <dlfcn.h>
#include <ios>
#include <mutex>
#include <new>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cooker/farm/http_client.h"

namespace boxtree::cooker {
namespace {

// The interface of version 4, which libcurl has kept since 2006.
#ifdef __APPLE__
constexpr const char* kLibrary = "libcurl.4.dylib";
#else
constexpr const char* kLibrary = "libcurl.so.4";
#endif

// What answers with another status say is for people; so much of it is read to keep the connection.
constexpr std::size_t kMostOfOtherBodies = 64 << 10;

struct Libcurl {
  decltype(&curl_global_init) global_init;
  decltype(&curl_easy_init) easy_init;
  decltype(&curl_easy_setopt) easy_setopt;
  decltype(&curl_easy_perform) easy_perform;
  decltype(&curl_easy_getinfo) easy_getinfo;
  decltype(&curl_easy_reset) easy_reset;
  decltype(&curl_easy_cleanup) easy_cleanup;
  decltype(&curl_easy_strerror) easy_strerror;
  decltype(&curl_slist_append) slist_append;
  decltype(&curl_slist_free_all) slist_free_all;
};

std::string loading_failure() {
  const char* const reason = ::dlerror();
  return reason != nullptr ? reason : kLibrary;
}

template <class Function>
bool find(void* library, const char* name, Function*& function) {
  function = reinterpret_cast<Function*>(::dlsym(library, name));
  return function != nullptr;
}

// Loaded once, and never unloaded: threads of others may be in it.
Result<const Libcurl*> load() {
  static const Result<Libcurl> loaded = []() -> Result<Libcurl> {
    void* const library = ::dlopen(kLibrary, RTLD_NOW | RTLD_LOCAL);
    Libcurl curl{};
    const bool is_whole = library != nullptr &&
                          find(library, "curl_global_init", curl.global_init) &&
                          find(library, "curl_easy_init", curl.easy_init) &&
                          find(library, "curl_easy_setopt", curl.easy_setopt) &&
                          find(library, "curl_easy_perform", curl.easy_perform) &&
                          find(library, "curl_easy_getinfo", curl.easy_getinfo) &&
                          find(library, "curl_easy_reset", curl.easy_reset) &&
                          find(library, "curl_easy_cleanup", curl.easy_cleanup) &&
                          find(library, "curl_easy_strerror", curl.easy_strerror) &&
                          find(library, "curl_slist_append", curl.slist_append) &&
                          find(library, "curl_slist_free_all", curl.slist_free_all);
    if (!is_whole) {
      return Error{Errc::kFeatureUnsupported,
                   fmt::format("HTTP needs libcurl, which cannot be loaded: {}; install it "
                               "(Debian: libcurl4)",
                               loading_failure())};
    }
    const CURLcode code = curl.global_init(CURL_GLOBAL_DEFAULT);
    if (code != CURLE_OK) {
      return Error{Errc::kFeatureUnsupported,
                   fmt::format("libcurl does not start: {}", curl.easy_strerror(code))};
    }
    return curl;
  }();
  if (!loaded) return loaded.error();
  return &*loaded;
}

}  // namespace

// Handles of libcurl that no thread uses now: each keeps its connections.
struct HttpClient::Handles {
  Handles(const Libcurl& library, const HttpLimits& waits) : curl(library), limits(waits) {
    // Else a server would first be told of a body, and given a second to refuse it.
    headers = curl.slist_append(nullptr, "Expect:");
    if (headers == nullptr) throw std::bad_alloc();
  }
  Handles(const Handles&) = delete;
  Handles& operator=(const Handles&) = delete;
  ~Handles() {
    for (CURL* const each : idle) curl.easy_cleanup(each);
    curl.slist_free_all(headers);
  }

  CURL* take() {
    {
      const std::lock_guard lock(mutex);
      if (!idle.empty()) {
        CURL* const handle = idle.back();
        idle.pop_back();
        return handle;
      }
    }
    CURL* const handle = curl.easy_init();
    if (handle == nullptr) throw std::bad_alloc();
    return handle;
  }

  void give_back(CURL* handle) {
    curl.easy_reset(handle);
    const std::lock_guard lock(mutex);
    idle.push_back(handle);
  }

  const Libcurl& curl;
  const HttpLimits limits;
  curl_slist* headers;
  std::mutex mutex;  // of what follows
  std::vector<CURL*> idle;
};

namespace {

// One request. Errors of options are those of libcurl's version: none that is used here is new.
template <class Pool>
class Request {
 public:
  Request(Pool& pool, const std::string& url) : pool_(pool), handle_(pool.take()) {
    set(CURLOPT_ERRORBUFFER, reason_.data());
    set(CURLOPT_URL, url.c_str());
    set(CURLOPT_NOSIGNAL, 1L);
    set(CURLOPT_PROXY, "");  // not what the environment says
    set(CURLOPT_USERAGENT, "boxtree");
    set(CURLOPT_HTTPHEADER, pool.headers);
    set(CURLOPT_CONNECTTIMEOUT_MS, pool.limits.connect_milliseconds);
    set(CURLOPT_LOW_SPEED_TIME, pool.limits.stall_seconds);
    set(CURLOPT_LOW_SPEED_LIMIT, pool.limits.slowest_bytes_per_second);
    set(CURLOPT_WRITEFUNCTION, &Request::receive);
    set(CURLOPT_WRITEDATA, this);
  }
  Request(const Request&) = delete;
  Request& operator=(const Request&) = delete;
  ~Request() { pool_.give_back(handle_); }

  void receives(const HttpClient::Sink& sink) { sink_ = &sink; }

  void sends(std::istream& body, std::uint64_t bytes) {
    body_ = &body;
    set(CURLOPT_UPLOAD, 1L);
    set(CURLOPT_INFILESIZE_LARGE, static_cast<curl_off_t>(bytes));
    set(CURLOPT_READFUNCTION, &Request::send);
    set(CURLOPT_READDATA, this);
    set(CURLOPT_SEEKFUNCTION, &Request::seek);
    set(CURLOPT_SEEKDATA, this);
  }

  Result<int> run() {
    const CURLcode code = pool_.curl.easy_perform(handle_);
    // An answer that came while the body was sent, or with more to say than is read, is one.
    const bool is_answered = code == CURLE_OK || (code == CURLE_SEND_ERROR && status() >= 400) ||
                             (code == CURLE_WRITE_ERROR && has_cut_other_);
    if (is_answered) return static_cast<int>(status());
    return Error{Errc::kFileUnreadable,
                 reason_.front() != '\0' ? reason_.data() : pool_.curl.easy_strerror(code)};
  }

 private:
  template <class T>
  void set(CURLoption option, T value) {
    pool_.curl.easy_setopt(handle_, option, value);
  }

  [[nodiscard]] long status() const {
    long status = 0;
    pool_.curl.easy_getinfo(handle_, CURLINFO_RESPONSE_CODE, &status);
    return status;
  }

  bool take(std::string_view bytes) {
    if (sink_ != nullptr && status() == 200) return (*sink_)(bytes);
    other_bytes_ += bytes.size();
    has_cut_other_ = other_bytes_ > kMostOfOtherBodies;
    return !has_cut_other_;
  }

  static std::size_t receive(char* bytes, std::size_t one, std::size_t count, void* request) {
    return static_cast<Request*>(request)->take({bytes, one * count}) ? one * count : 0;
  }

  static std::size_t send(char* bytes, std::size_t one, std::size_t count, void* request) {
    std::istream& body = *static_cast<Request*>(request)->body_;
    body.read(bytes, static_cast<std::streamsize>(one * count));
    return body.bad() ? CURL_READFUNC_ABORT : static_cast<std::size_t>(body.gcount());
  }

  static int seek(void* request, curl_off_t offset, int origin) {
    std::istream& body = *static_cast<Request*>(request)->body_;
    body.clear();
    if (origin != SEEK_SET || !body.seekg(offset)) return CURL_SEEKFUNC_FAIL;
    return CURL_SEEKFUNC_OK;
  }

  Pool& pool_;
  CURL* const handle_;
  std::array<char, CURL_ERROR_SIZE> reason_{};
  const HttpClient::Sink* sink_ = nullptr;
  std::istream* body_ = nullptr;
  std::size_t other_bytes_ = 0;
  bool has_cut_other_ = false;
};

}  // namespace

HttpClient::HttpClient(std::unique_ptr<Handles> handles) : handles_(std::move(handles)) {}
HttpClient::HttpClient(HttpClient&&) noexcept = default;
HttpClient::~HttpClient() = default;

Result<HttpClient> HttpClient::open(const HttpLimits& limits) {
  const Result<const Libcurl*> library = load();
  if (!library) return library.error();
  return HttpClient(std::make_unique<Handles>(**library, limits));
}

Result<int> HttpClient::get(const std::string& url, const Sink& sink) const {
  Request request(*handles_, url);
  request.receives(sink);
  return request.run();
}

Result<int> HttpClient::put(const std::string& url, std::istream& body, std::uint64_t bytes) const {
  Request request(*handles_, url);
  request.sends(body, bytes);
  return request.run();
}

}  // namespace boxtree::cooker
