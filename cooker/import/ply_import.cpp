// SPDX-License-Identifier: MIT
#include "cooker/import/ply_import.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "cooker/import/binary_ply.h"
#include "cooker/import/direct_import.h"
#include "cooker/import/f32_digits.h"
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

  if (!options.user_data.empty()) {
    if (Status status = find_user_data(options.user_data, layout); !status.ok())
      return in_file(source.title(), status.error());
  }
  if (!options.face_ids.empty()) {
    if (Status status = find_face_ids(options.face_ids, layout); !status.ok())
      return in_file(source.title(), status.error());
  }

  const auto counts = [&layout](PlyType type) {
    return std::count_if(layout.xyz.begin(), layout.xyz.end(),
                         [type](const PlyProperty* each) { return each->type == type; });
  };
  if (options.keep_doubles && counts(PlyType::kFloat64) > 0 &&
      options.precision == Precision::kF32) {
    ImportOptions keeping = options;
    keeping.precision = Precision::kF64;
    Imported kept;
    if (Status status = import_ply(source, keeping, kept); !status.ok()) return status;
    if (moved_by_f32(kept.mesh.positions) > 0) {
      out = std::move(kept);
      return {};
    }
  }

  // A text has the digits that it has, whatever type it states.
  out.report.has_f32_alone =
      counts(PlyType::kFloat32) == 3 && layout.header.form != PlyHeader::Form::kText;
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
