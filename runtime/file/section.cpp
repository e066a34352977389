// SPDX-License-Identifier: MIT
#include "runtime/file/section.h"

#include "format/message.h"
#include "format/tree_record.h"

namespace boxtree {

std::string section_text(SectionKind kind) {
  return "section " + std::string(section_name(kind));
}

Error section_error(SectionKind kind, const Error& error) {
  return error_in(section_text(kind), error);
}

Result<const std::byte*> sized_section(Bytes section, SectionKind kind, std::uint64_t count,
                                       std::uint64_t element) {
  const std::uint64_t expected = count * element;
  if (section.size() == expected) return section.data();
  return section.empty() ? error_with(Errc::kSectionMissing, section_text(kind), " is absent")
                         : section_error(kind, section_size_error(section.size(), expected));
}

}  // namespace boxtree
