// SPDX-License-Identifier: MIT
// Shared steps of boxtree's own readers: one file, one mesh, hashed while it is read.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "cooker/import/file_error.h"
#include "cooker/import/import.h"
#include "cooker/import/source_stream.h"
#include "cooker/import/text_tokens.h"

namespace boxtree::cooker {

/// Calls `read` with the positions of `out` in the precision of `options`. `read` takes the rest of
/// `stream` into `out` and returns a Status. Fills in the file's part of the report.
template <class Read>
Status read_into(SourceStream& stream, const SourceFile& source, const ImportOptions& options,
                 Imported& out, const Read& read) {
  out.report.meshes = 1;
  if (!source.bytes()) out.report.files_read = {tidied(source.path())};
  Positions& positions = out.mesh.positions;
  positions.precision = options.precision;
  Status status = options.precision == Precision::kF32 ? read(positions.f32) : read(positions.f64);
  if (!status.ok()) return status;
  const Result<std::uint64_t> hash = stream.finish();
  if (!hash.ok()) return hash.error();
  out.report.content_hash = hash.value();
  return {};
}

/// The same for a text file: calls `read` with the whole text, the file's name and the positions.
template <class Read>
Status read_text_into(const SourceFile& source, const ImportOptions& options, Imported& out,
                      const Read& read) {
  Result<SourceStream> stream = SourceStream::open(source);
  if (!stream.ok()) return stream.error();
  const Result<std::string> bytes = stream->take_rest();
  if (!bytes.ok()) return bytes.error();
  const Result<std::string_view> text = text_of(*bytes);
  if (!text.ok()) return in_file(source.title(), text.error());
  out.report.has_open_end = has_open_end(*bytes);
  return read_into(*stream, source, options, out, [&]<class T>(std::vector<T>& positions) {
    return read(*text, source.title(), positions);
  });
}

}  // namespace boxtree::cooker
