// SPDX-License-Identifier: MIT
// Windows alone: names of files as its functions take them, and what it says of them as an Error.
#pragma once

#ifdef _WIN32
#include <string>

#ifndef NOMINMAX
#define NOMINMAX
#endif
#ifndef WIN32_LEAN_AND_MEAN
#define WIN32_LEAN_AND_MEAN
#endif
#include <windows.h>
// Names that it takes from all that follow, in the amalgamation.
#undef near
#undef far

#include <boxtree/error.h>

namespace boxtree {

/// A path in UTF-8 as the system takes it; empty if it is not UTF-8 or has a zero in it. Those that
/// the system does not take for their length are made absolute, and begin with "\\\\?\\".
[[nodiscard]] std::wstring wide_path(const std::string& path);

/// The error for `path` by what GetLastError() returned: `code`, or kFileNotFound and kOutOfMemory
/// if it is that.
[[nodiscard]] Error windows_error(Errc code, const std::string& path, DWORD reason);

}  // namespace boxtree
#endif
