// SPDX-License-Identifier: MIT
// In place of libcurl where the cooker is built without it (BOXTREE_HTTP=OFF).
#include "cooker/farm/http_client.h"

namespace boxtree::cooker {
namespace {

Error unsupported() {
  return {Errc::kFeatureUnsupported, "this boxtree was built without HTTP (BOXTREE_HTTP=OFF)"};
}

}  // namespace

struct HttpClient::Handles {};

HttpClient::HttpClient(std::unique_ptr<Handles> handles) : handles_(std::move(handles)) {}
HttpClient::HttpClient(HttpClient&&) noexcept = default;
HttpClient::~HttpClient() = default;

Result<HttpClient> HttpClient::open(const HttpLimits& /*limits*/) {
  return unsupported();
}

Result<int> HttpClient::get(const std::string& /*url*/, const Sink& /*sink*/) const {
  return unsupported();
}

Result<int> HttpClient::put(const std::string& /*url*/, std::istream& /*body*/,
                            std::uint64_t /*bytes*/) const {
  return unsupported();
}

}  // namespace boxtree::cooker
