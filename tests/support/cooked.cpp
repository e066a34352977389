// SPDX-License-Identifier: MIT
// Mesh to bound tree, without a file.
#include "tests/support/cooked.h"

#include <algorithm>
#include <cstring>

#include <boxtree/runtime/file/checksum.h>

#include "tests/support/require.h"

namespace boxtree::test {

std::vector<std::byte> cook_bytes(const cooker::SourceMesh& mesh, CodecId codec,
                                  const cooker::CookOptions& options) {
  const cooker::EncodedTree cooked = require(cooker::cook_as(mesh, codec, options));
  return cooker::serialize(std::span(&cooked, 1));
}

CookedTree cook_tree(const cooker::SourceMesh& mesh, CodecId codec,
                     const cooker::CookOptions& options, const BindOptions& bind) {
  std::vector<std::byte> bytes = cook_bytes(mesh, codec, options);
  File file = require(File::open(Bytes(bytes)));
  Tree tree = require(Tree::bind(file, 0, bind));
  return {std::move(bytes), std::move(file), std::move(tree)};
}

std::vector<CodecId> all_codecs() {
  std::vector<CodecId> ids;
  for (const CodecInfo& codec : kCodecs) ids.push_back(codec.id);
  return ids;
}

std::string test_name(const testing::TestParamInfo<CodecId>& info) {
  std::string name(codec_name(info.param));
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

void repair_checksums(std::vector<std::byte>& bytes) {
  const auto count = load<FileHeader>(bytes.data()).section_count;
  const std::size_t table = sizeof(FileHeader);
  if (!in_range(table, std::uint64_t{count} * sizeof(SectionEntry), bytes.size())) return;
  for (std::size_t i = 0; i < count; ++i) {
    auto entry = load<SectionEntry>(bytes.data() + table, i);
    if (!in_range(entry.offset, entry.size, bytes.size())) continue;
    entry.checksum = checksum(Bytes(bytes).subspan(entry.offset, entry.size));
    std::memcpy(bytes.data() + table + i * sizeof(SectionEntry), &entry, sizeof(entry));
  }
  const std::uint64_t sum = checksum(Bytes(bytes).first(offsetof(FileHeader, checksum)),
                                     Bytes(bytes).subspan(table, count * sizeof(SectionEntry)));
  std::memcpy(bytes.data() + offsetof(FileHeader, checksum), &sum, sizeof(sum));
}

}  // namespace boxtree::test
