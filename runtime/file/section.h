// SPDX-License-Identifier: MIT
// Checks the size of a section against what a record states.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <boxtree/error.h>

#include "format/bytes.h"
#include "format/container.h"

namespace boxtree {

/// "section " and its name, for messages.
[[nodiscard]] std::string section_text(SectionKind kind);

/// The error, said of a section.
[[nodiscard]] Error section_error(SectionKind kind, const Error& error);

/// The bytes of `section`, if there are `count * element` of them. Precondition: the product does
/// not overflow; that of two record fields never does. Errors: kSectionMissing when bytes are
/// required and there are none; kSectionSize.
[[nodiscard]] Result<const std::byte*> sized_section(Bytes section, SectionKind kind,
                                                     std::uint64_t count, std::uint64_t element);

}  // namespace boxtree
