// SPDX-License-Identifier: MIT
// Values where nothing can follow a failure.
#pragma once

#include <stdexcept>
#include <utility>

#include "format/result.h"

namespace boxtree::test {

/// The value, or a throw with the error's message.
template <class T>
[[nodiscard]] T require(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message());
  return std::move(*result);
}

}  // namespace boxtree::test
