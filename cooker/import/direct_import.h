// SPDX-License-Identifier: MIT
// What our own readers do around their walks: one file, one mesh, hashed while it is read.
#pragma once

#include <filesystem>

#include <boxtree/cooker/import/import.h>
#include <boxtree/cooker/import/source_stream.h>

namespace boxtree::cooker {

/// Calls `read` with the array of positions that has the precision asked for, to take the rest of
/// `stream` into `out` and return a Status; fills in what the report says of the file.
template <class Read>
Status read_into(SourceStream& stream, const std::filesystem::path& path,
                 const ImportOptions& options, Imported& out, const Read& read) {
  out.report.meshes = 1;
  out.report.files_read = {path.lexically_normal()};
  Positions& positions = out.mesh.positions;
  positions.precision = options.precision;
  Status status = options.precision == Precision::kF32 ? read(positions.f32) : read(positions.f64);
  if (!status.ok()) return status;
  const Result<std::uint64_t> hash = stream.finish();
  if (!hash.ok()) return hash.error();
  out.report.content_hash = hash.value();
  return {};
}

}  // namespace boxtree::cooker
