// SPDX-License-Identifier: MIT
// Serialize, compress, write, read back, compare, prove, rename.
#include "cooker/write/blob_writer.h"

#include <algorithm>
#include <vector>

#include <boxtree/blob.h>

#include "cooker/proof/proof.h"
#include "cooker/write/file_writer.h"
#include "runtime/file/mapping.h"

namespace boxtree::cooker {

Result<std::uint64_t> write_blob(const OutputTarget& to, const FileParts& parts,
                                 BlobMethod method) {
  const Result<std::vector<std::byte>> file = serialize(parts);
  if (!file) return file.error();
  const Result<std::vector<std::byte>> blob = make_blob(*file, method);
  if (!blob) return blob.error();
  Result<AtomicFile> out = AtomicFile::create(to);
  if (!out) return out.error();
  if (Status status = out->write(*blob); !status) return status.error();
  const Result<Mapping> written = Mapping::map(out->descriptor(), to.title());
  if (!written) return written.error();
  const Result<File> opened = open_blob(written->bytes(), ~std::uint64_t{0});
  if (!opened) return opened.error();
  const Bytes inside = opened->bytes();
  if (!std::equal(inside.begin(), inside.end(), file->begin(), file->end())) {
    return Error{Errc::kBlobCorrupt, to.title() + ": the file inside did not come back"};
  }
  if (const Findings findings = verify_file(*opened); !findings.empty()) return findings.front();
  if (Status status = out->commit(); !status) return status.error();
  return std::uint64_t{blob->size()};
}

}  // namespace boxtree::cooker
