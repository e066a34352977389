// SPDX-License-Identifier: MIT
#include "cooker/import/stl_import.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "cooker/import/binary_stl.h"
#include "cooker/import/direct_import.h"
#include "cooker/import/text_stl.h"

namespace boxtree::cooker {
namespace {

bool is_plain_text(std::string_view start) {
  return std::all_of(start.begin(), start.end(),
                     [](char c) { return (c >= '\t' && c <= '\r') || (c >= ' ' && c <= '~'); });
}

}  // namespace

Status import_stl(const SourceFile& source, const ImportOptions& options, Imported& out) {
  Result<SourceStream> stream = SourceStream::open(source);
  if (!stream.ok()) return stream.error();
  // A text hardly ever has by chance the length that its bytes, read as a count, require.
  const bool is_binary = is_binary_stl(*stream);
  const bool is_text = !is_binary && is_text_stl(stream->ahead());

  const std::string& file = source.title();
  if (!is_binary && !is_text && is_plain_text(stream->ahead().substr(0, kStlHeaderBytes))) {
    return Error{Errc::kImportFailed,
                 file + ": no STL file: a text that does not begin with 'solid'"};
  }
  out.report.has_f32_alone = !is_text;
  return read_into(*stream, source, options, out,
                   [&]<class T>(std::vector<T>& positions) -> Status {
                     StlMesh<T> mesh(file, options, positions, out);
                     if (!is_text) return read_binary_stl(*stream, file, mesh);
                     const Result<std::string> text = stream->take_rest();
                     if (!text.ok()) return text.error();
                     return read_text_stl(*text, file, mesh);
                   });
}

}  // namespace boxtree::cooker
