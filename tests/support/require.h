// SPDX-License-Identifier: MIT
// Unwraps results where a test cannot continue after a failure.
#pragma once

#include <optional>
#include <stdexcept>
#include <utility>

#include <boxtree/error.h>
#include <boxtree/query.h>

namespace boxtree::test {

/// The value; throws the error's message otherwise.
template <class T>
[[nodiscard]] T require(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message());
  return std::move(*result);
}

/// The result of a query, which may be empty; throws the query's error.
template <class T>
[[nodiscard]] std::optional<T> require(const QueryResult<T>& result) {
  if (!result.ok()) throw std::runtime_error(result.error().message());
  return result.as_optional();
}

}  // namespace boxtree::test
