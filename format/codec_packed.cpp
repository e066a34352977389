// SPDX-License-Identifier: MIT
// Checks the header of a packed tree; sizes and offsets then follow from it.
#include "format/codec_packed.h"

#include <algorithm>
#include <string>

namespace boxtree {
namespace {

bool cut_width_fits(const PackedHeader& header, PackedCut cut) {
  switch (cut) {
    case PackedCut::kF16:
      return header.cut_bits == 16 && header.cut_count == 0;
    case PackedCut::kF32:
      return header.cut_bits == 32 && header.cut_count == 0;
    case PackedCut::kF64:
      return header.cut_bits == 64 && header.cut_count == 0;
    case PackedCut::kTable:
      break;
  }
  return header.cut_count == 0 ? header.cut_bits == 32
                               : header.cut_bits >= 1 && header.cut_bits <= 32;
}

}  // namespace

Status check_packed_header(const PackedHeader& header, PackedCut cut, const TreeCounts& counts) {
  const auto invalid = [](const char* what) {
    return Error{Errc::kRecordInvalid, std::string("packed header: ") + what};
  };
  std::uint64_t nodes = 0;
  for (const std::uint32_t count : header.node_count) nodes += count;
  if (nodes != counts.node_count) return invalid("nodes of the four kinds are not those stated");
  const auto is_width = [](std::uint8_t bits) { return bits >= 1 && bits <= 32; };
  if (!is_width(header.node_bits) || !is_width(header.face_bits) || !cut_width_fits(header, cut)) {
    return invalid("width of a field");
  }
  if (header.root_kind >= kNodeKinds || header.node_count[header.root_kind] == 0) {
    return invalid("the root is not in the array of its kind");
  }
  const bool zero = std::all_of(header.reserved.begin(), header.reserved.end(),
                                [](std::uint64_t word) { return word == 0; });
  return zero ? Status() : Status(invalid("reserved bits are set"));
}

}  // namespace boxtree
