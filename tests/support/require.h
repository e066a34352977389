// SPDX-License-Identifier: MIT
// Values where nothing can follow a failure.
#pragma once

#include <optional>
#include <stdexcept>
#include <utility>

#include <boxtree/error.h>
#include <boxtree/query.h>

namespace boxtree::test {

/// The value, or a throw with the error's message.
template <class T>
[[nodiscard]] T require(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message());
  return std::move(*result);
}

/// What a query found, which may be nothing, or a throw with its error.
template <class T>
[[nodiscard]] std::optional<T> require(const QueryResult<T>& result) {
  if (!result.ok()) throw std::runtime_error(result.error().message());
  return result.as_optional();
}

}  // namespace boxtree::test
