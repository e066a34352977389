// SPDX-License-Identifier: MIT
// The container around a compressed stream.
#include "format/blob.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <utility>

#include <boxtree/blob.h>

#include "format/message.h"
#include "runtime/blob/compressor.h"
#include "runtime/file/checksum.h"
#include "runtime/file/open_file.h"
#include "runtime/file/section.h"

namespace boxtree {
namespace {

Result<Bytes> blob_section(Bytes file) {
  const Result<Container> container = check_container(file, checksum, kFeatureBlob);
  if (!container) return container.error();
  if ((container->header.incompatible_features & kFeatureBlob) == 0) {
    return Error{Errc::kFeatureUnsupported, "the file is not a blob: map it with File::open"};
  }
  const SectionEntry* entry = container->find(SectionKind::kBlob, kNoOwner);
  if (entry == nullptr) return Error{Errc::kSectionMissing, "the blob has no section \"blob\""};
  // All of a blob is read anyway, so that no changed bit of it remains unseen.
  if (Status status = check_padding(file, *container); !status) return status.error();
  const Bytes section = file.subspan(entry->offset, entry->size);
  if (checksum(section) != entry->checksum) {
    return section_error(SectionKind::kBlob, {Errc::kChecksumMismatch, "checksum differs"});
  }
  return section;
}

Status decompress(BlobMethod method, Bytes stream, std::span<std::byte> out, std::uint64_t limit) {
  switch (method) {
    case BlobMethod::kLzma:
      return decompress_lzma(stream, out, limit);
    case BlobMethod::kZstd:
      return decompress_zstd(stream, out, limit);
  }
  return Error{Errc::kFeatureUnsupported,
               "blob method " + std::to_string(static_cast<std::uint32_t>(method))};
}

Result<std::vector<std::byte>> compress(Bytes bytes, BlobMethod method) {
  return method == BlobMethod::kLzma ? compress_lzma(bytes) : compress_zstd(bytes);
}

}  // namespace

Result<File> open_blob(Bytes blob, std::uint64_t memory_limit) {
  const Result<Bytes> section = blob_section(blob);
  if (!section) return section.error();
  if (section->size() < sizeof(BlobHeader)) {
    return section_error(SectionKind::kBlob,
                         section_size_error(section->size(), sizeof(BlobHeader)));
  }
  const auto header = load<BlobHeader>(section->data());
  if (header.reserved0 != 0 || header.reserved1 != 0) {
    return Error{Errc::kBlobCorrupt, "blob header: reserved bits are set"};
  }
  if (header.file_bytes > memory_limit) {
    return Error{Errc::kBlobLimit, "the file inside has " + std::to_string(header.file_bytes) +
                                       " bytes, allowed are " + std::to_string(memory_limit)};
  }
  Result<WritableMapping> memory = WritableMapping::allocate(header.file_bytes);
  if (!memory) return memory.error();
  const std::span<std::byte> out = memory->bytes();
  const Bytes stream = section->subspan(sizeof(BlobHeader));
  if (Status status = decompress(header.method, stream, out, memory_limit - header.file_bytes);
      !status) {
    return status.error();
  }
  if (checksum(out) != header.checksum) {
    return Error{Errc::kBlobCorrupt, "the checksum of the file inside differs"};
  }
  return OpenFile::open(std::move(*memory).finish(), {});
}

Result<File> open_blob(const std::string& path, std::uint64_t memory_limit) {
  const Result<Mapping> mapping = Mapping::map(path);
  if (!mapping) return mapping.error();
  Result<File> file = open_blob(mapping->bytes(), memory_limit);
  if (!file) return Error{file.code(), path + ": " + file.error().detail};
  return file;
}

Result<std::vector<std::byte>> make_blob(Bytes file, BlobMethod method) {
  const Result<std::vector<std::byte>> stream = compress(file, method);
  if (!stream) return stream.error();
  BlobHeader blob{};
  blob.method = method;
  blob.file_bytes = file.size();
  blob.checksum = checksum(file);
  std::vector<std::byte> body(sizeof(blob) + stream->size());
  std::memcpy(body.data(), &blob, sizeof(blob));
  std::copy(stream->begin(), stream->end(), body.begin() + sizeof(blob));

  SectionEntry entry;
  entry.kind = SectionKind::kBlob;
  entry.is_required = true;
  entry.offset = section_begin(table_end(1), body.size());
  entry.size = body.size();
  entry.checksum = checksum(body);
  const SectionRow row = entry.row();
  const FileHeader header = make_header({&row, 1}, kFeatureBlob, checksum);
  std::vector<std::byte> out(file_end(entry.end()));
  std::memcpy(out.data(), &header, sizeof(header));
  std::memcpy(out.data() + sizeof(header), &row, sizeof(row));
  std::copy(body.begin(), body.end(), out.begin() + static_cast<std::ptrdiff_t>(entry.offset));
  return out;
}

Result<std::uint64_t> compressed_size(Bytes bytes, BlobMethod method) {
  const Result<std::vector<std::byte>> stream = compress(bytes, method);
  if (!stream) return stream.error();
  return std::uint64_t{stream->size()};
}

}  // namespace boxtree
