// SPDX-License-Identifier: MIT
// A section of a file, held to the size that a record says it has.
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

/// The bytes of `section`, which must be `count * element` of them; `place` begins the message of
/// an error. Precondition: the product does not overflow, as that of no two numbers of records
/// does. Errors: kSectionMissing where there must be bytes and are none, kSectionSize.
[[nodiscard]] Result<const std::byte*> sized_section(Bytes section, SectionKind kind,
                                                     std::string_view place, std::uint64_t count,
                                                     std::uint64_t element);

}  // namespace boxtree
