// SPDX-License-Identifier: MIT
// Paths as the command line, JSON and meshes have them, in UTF-8 and of any length. On Windows the
// C++ library of mingw-w64 takes the chars that a path is made of for Latin-1, and its functions no
// path longer than MAX_PATH: what comes from outside becomes a path here, and is looked up here.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <system_error>

namespace boxtree::cooker {

/// The path of that name, whose path::string() is the name again. On Windows, U+FFFD stands for
/// what is not UTF-8, which names no file; elsewhere names are any bytes. Throws std::bad_alloc.
[[nodiscard]] std::filesystem::path named_path(std::string_view name);

/// As std::filesystem::status().
[[nodiscard]] std::filesystem::file_status status_of(const std::filesystem::path& path,
                                                     std::error_code& error);

/// As std::filesystem::file_size().
[[nodiscard]] std::uintmax_t size_of_file(const std::filesystem::path& path,
                                          std::error_code& error);

/// As std::filesystem::equivalent().
[[nodiscard]] bool is_one_file(const std::filesystem::path& a, const std::filesystem::path& b,
                               std::error_code& error);

/// As std::filesystem::create_directories().
void make_folders(const std::filesystem::path& path, std::error_code& error);

}  // namespace boxtree::cooker
