// SPDX-License-Identifier: MIT
// Converts exceptions of boxtree's and other readers to errors: no exception leaves import.
#pragma once

#include <exception>
#include <new>

#include <boxtree/error.h>

namespace boxtree::cooker {

/// The error for the current exception. Precondition: called in a handler.
[[nodiscard]] inline Error error_of_exception() {
  try {
    throw;
  } catch (const std::bad_alloc&) {
    return {Errc::kOutOfMemory, "not enough memory to import it"};
  } catch (const std::exception& error) {
    return {Errc::kImportFailed, error.what()};
  } catch (...) {
    return {Errc::kImportFailed, "unknown exception while reading"};
  }
}

}  // namespace boxtree::cooker
