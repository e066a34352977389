// SPDX-License-Identifier: MIT
// Paths as URIs: what is no plain character is %XX.
#pragma once

#include <string>
#include <string_view>

namespace boxtree::cooker {

/// A path as a URI.
[[nodiscard]] std::string percent_encoded(std::string_view path);

/// Text with the codes of a URI, as bytes. What is no code stays as it is, and so does %00, which
/// no path has.
[[nodiscard]] std::string percent_decoded(std::string_view uri);

}  // namespace boxtree::cooker
