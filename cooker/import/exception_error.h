// SPDX-License-Identifier: MIT
// What readers throw, ours and other people's, as an error: no exception leaves import.
#pragma once

#include <exception>
#include <new>

#include <boxtree/error.h>

namespace boxtree::cooker {

/// The error for the exception at hand. Precondition: called in a handler.
[[nodiscard]] inline Error error_of_exception() {
  try {
    throw;
  } catch (const std::bad_alloc&) {
    return {Errc::kMeshTooLarge, "not enough memory to import it"};
  } catch (const std::exception& error) {
    return {Errc::kImportFailed, error.what()};
  } catch (...) {
    return {Errc::kImportFailed, "unknown exception while reading"};
  }
}

}  // namespace boxtree::cooker
