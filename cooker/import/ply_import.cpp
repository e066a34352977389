// SPDX-License-Identifier: MIT
#include "cooker/import/ply_import.h"

#include <string>
#include <utility>
#include <vector>

#include "cooker/import/binary_ply.h"
#include "cooker/import/direct_import.h"
#include "cooker/import/file_error.h"
#include "cooker/import/text_ply.h"
#include "cooker/import/text_tokens.h"

namespace boxtree::cooker {

Status import_ply(const SourceFile& source, const ImportOptions& options, Imported& out) {
  Result<SourceStream> stream = SourceStream::open(source);
  if (!stream.ok()) return stream.error();
  Result<PlyHeader> header = read_ply_header(stream->ahead());
  if (!header.ok()) return in_file(source.title(), header.error());
  PlyLayout layout;
  layout.header = std::move(*header);
  if (Status status = find_ply_parts(layout); !status.ok())
    return in_file(source.title(), status.error());

  const std::string& file = source.title();
  return read_into(*stream, source, options, out,
                   [&]<class T>(std::vector<T>& positions) -> Status {
                     IndexedMesh<T> mesh(file, options, positions, out);
                     if (layout.header.form != PlyHeader::Form::kText) {
                       return read_binary_ply(*stream, layout, file, mesh);
                     }
                     const Result<std::string> text = stream->take_rest();
                     if (!text.ok()) return text.error();
                     out.report.has_open_end = has_open_end(*text);
                     return read_text_ply(*text, layout, file, mesh);
                   });
}

}  // namespace boxtree::cooker
