// SPDX-License-Identifier: MIT
// Versions and errors of the C interface.
#include <algorithm>
#include <boxtree_c.h>
#include <cstddef>
#include <cstring>
#include <limits>
#include <string_view>

#include <boxtree/configuration.h>
#include <boxtree/error.h>
#include <boxtree/kinds.h>

#include "runtime/c/call.h"

namespace boxtree::c {
namespace {

// tests/unit/c/library_test.cpp compares the codes of errors, both lists as a whole.
static_assert(BXT_NO_FACE == kNoFaceId && BXT_NO_MATERIAL == kNoMaterial);
static_assert(BXT_RAY_QUERIES == kRayQueries && BXT_BOX_QUERIES == kBoxQueries &&
              BXT_POINT_QUERIES == kPointQueries && BXT_PAIR_QUERIES == kPairQueries &&
              BXT_ALL_QUERIES == kAllQueries);

const ErrcInfo& info_of(bxt_status status) {
  using Number = std::underlying_type_t<Errc>;
  const bool is_code = status >= 0 && status <= std::numeric_limits<Number>::max();
  return error_info(is_code ? static_cast<Errc>(status) : Errc::kInternal);
}

}  // namespace

std::size_t whole_characters(std::string_view text, std::size_t capacity) noexcept {
  if (text.size() <= capacity) return text.size();
  std::size_t end = capacity;
  // The bytes of a character behind its first one are 10xxxxxx.
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
  return end;
}

std::size_t copy_text(std::string_view text, char* buffer, std::size_t capacity) noexcept {
  if (buffer != nullptr && capacity > 0) {
    const std::size_t end = whole_characters(text, capacity - 1);
    std::copy_n(text.data(), end, buffer);
    buffer[end] = 0;
  }
  return text.size();
}

bxt_status fail(bxt_error* error, Errc code, std::string_view detail,
                std::string_view more) noexcept {
  const auto status = static_cast<bxt_status>(code);
  if (error == nullptr || stated_size(error) < sizeof(bxt_error) ||
      stated_size(error) > kMostErrorSize) {
    return status;
  }
  const ErrcInfo& info = error_info(code);
  std::string_view between;
  if (code == Errc::kInvalidQuery && more.empty()) {
    more = expected_of(detail);
    if (!more.empty()) between = ": expected ";
  }
  const std::string_view texts[] = {info.name, ": ", detail.empty() ? info.meaning : detail,
                                    between, more};
  error->status = status;
  error->message_length = 0;
  error->message[0] = 0;
  // More than one text in a row without an allocation: what is missing is memory, say.
  const std::size_t capacity = stated_size(error) - offsetof(bxt_error, message);
  for (const std::string_view text : texts) {
    const std::size_t at = std::min<std::size_t>(error->message_length, capacity - 1);
    copy_text(text, error->message + at, capacity - at);
    error->message_length += text.size();
  }
  return status;
}

}  // namespace boxtree::c

using namespace boxtree::c;

uint32_t bxt_abi_version(void) {
  return BXT_ABI_VERSION;
}

const char* bxt_version(void) {
  return BOXTREE_VERSION;
}

// Names and meanings are literals, so a 0 is behind them.
const char* bxt_error_name(bxt_status status) {
  return info_of(status).name.data();
}

const char* bxt_error_meaning(bxt_status status) {
  return info_of(status).meaning.data();
}
