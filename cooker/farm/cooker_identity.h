// SPDX-License-Identifier: MIT
// Which cooker this is: what a cooked file depends on beside its inputs and options.
#pragma once

#include <string>
#include <string_view>

namespace boxtree::cooker {

/// SHA-256, in hexadecimal digits, over names and bytes of the sources that can decide a byte of a
/// cooked file: the same for equal sources, whatever compiles them and wherever. The build makes it
/// (cmake/BoxtreeSourceDigest.cmake).
extern const std::string_view kSourceDigest;

/// Versions of boxtree and of the libraries that decide bytes, and kSourceDigest. Equal texts, and
/// of meshes that assimp reads equal import_libraries(): equal bytes for equal inputs and options.
[[nodiscard]] std::string cooker_identity();

}  // namespace boxtree::cooker
