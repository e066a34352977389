// SPDX-License-Identifier: MIT
// What the formats share that are written in the order of a tree.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include <boxtree/error.h>

#include "cooker/cook.h"
#include "cooker/write/byte_sink.h"

namespace boxtree::cooker {

/// What is written: `faces` of `text`, the bytes of a file in `from`, into a file in `to`.
struct Reordering {
  std::string_view text;
  std::span<const SourceCorners> faces;
  std::filesystem::path from;  // folders
  std::filesystem::path to;

  /// `reference`, a path relative to `from`, as a path relative to `to`; the same if it is
  /// absolute.
  [[nodiscard]] std::string moved(const std::string& reference) const;
  /// What to put before paths relative to `from`: empty, or a path that ends in a slash.
  [[nodiscard]] std::string way() const;
};

/// The error of a source that is not what was cooked.
[[nodiscard]] Error has_changed(std::string_view what);

/// Each as reordered_mesh.h specifies; errors do not name the file.
Status reorder_obj(const Reordering& reordering, ByteSink& out);
Status reorder_ply(const Reordering& reordering, ByteSink& out);
Status reorder_gltf(const Reordering& reordering, bool is_binary, ByteSink& out);

}  // namespace boxtree::cooker
