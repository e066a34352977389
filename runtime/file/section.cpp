// SPDX-License-Identifier: MIT
#include "runtime/file/section.h"

#include "format/message.h"
#include "format/tree_record.h"

namespace boxtree {

std::string section_text(SectionKind kind) {
  return "section " + std::string(section_name(kind));
}

Result<const std::byte*> sized_section(Bytes section, SectionKind kind, std::string_view place,
                                       std::uint64_t count, std::uint64_t element) {
  const std::uint64_t expected = count * element;
  if (section.size() == expected) return section.data();
  const std::string where = std::string(place) + section_text(kind);
  if (section.empty()) return error_with(Errc::kSectionMissing, where, " is absent");
  return error_with(Errc::kSectionSize, where + ": ",
                    section_size_error(section.size(), expected).detail);
}

}  // namespace boxtree
