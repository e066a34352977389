// SPDX-License-Identifier: MIT
// What the functions of the C interface share: errors in words, structs that carry their size,
// texts that are copied, and no exception that leaves.
#pragma once

#include <algorithm>
#include <boxtree_c.h>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <new>
#include <string_view>
#include <type_traits>

#include <boxtree/error.h>
#include <boxtree/query.h>

namespace boxtree::c {

/// Writes what went wrong, if the caller wants to know, and returns its code. `more` follows the
/// detail.
bxt_status fail(bxt_error* error, Errc code, std::string_view detail = {},
                std::string_view more = {}) noexcept;
/// The same of an error of the C++ interface.
inline bxt_status fail(bxt_error* error, const Error& what) noexcept {
  return fail(error, what.code, what.detail);
}
/// kInvalidQuery for an argument, or a member of one.
inline bxt_status refuse(bxt_error* error, std::string_view argument) noexcept {
  return fail(error, Errc::kInvalidQuery, argument);
}

/// The same for a pointer that is null.
inline bxt_status refuse_null(bxt_error* error, std::string_view argument) noexcept {
  return fail(error, Errc::kInvalidQuery, argument, " is NULL");
}

/// How a function ends: BXT_OK, or the error of a Status, Result or QueryResult.
template <class Outcome>
bxt_status finish(const Outcome& outcome, bxt_error* error) {
  if (outcome.code() == Errc::kOk) return BXT_OK;
  if (error == nullptr) return static_cast<bxt_status>(outcome.code());
  return fail(error, outcome.error());
}

/// Runs the body of a function. Memory that is missing, for a text of an error as for a handle, is
/// an error like others; nothing else throws.
template <class Body>
bxt_status guarded(bxt_error* error, Body body) {
  try {
    return body();
  } catch (const std::bad_alloc&) {
    return fail(error, Errc::kOutOfMemory, "no memory left");
  }
}

/// The name of the first pointer that is null, or nullptr. Arguments: names and pointers by turns.
inline const char* first_null() noexcept {
  return nullptr;
}
/// The same.
template <class Pointer, class... Rest>
const char* first_null(const char* name, Pointer pointer, Rest... rest) noexcept {
  return pointer == nullptr ? name : first_null(rest...);
}

/// Structs may grow by this in all later versions: a size beyond is taken for none that was set.
inline constexpr std::uint32_t kMostGrowth = 1024;

/// The largest bxt_error, with room for a longer message behind it.
inline constexpr std::uint32_t kMostErrorSize = 65536;

/// The size that a struct, which may be as short as an older version made it, says that it has.
template <class T>
std::uint32_t stated_size(const T* given) noexcept {
  static_assert(std::is_trivially_copyable_v<T> && offsetof(T, struct_size) == 0);
  std::uint32_t size = 0;
  std::memcpy(&size, given, sizeof size);
  return size;
}

/// Whether a struct, or the first one of an array, has a size that some version gave it. There is
/// one version: none is shorter.
template <class T>
bool has_size(const T* given) noexcept {
  const std::uint32_t size = stated_size(given);
  return size >= sizeof(T) && size <= sizeof(T) + kMostGrowth && size % alignof(T) == 0;
}

/// Reads element `i` of an array of structs, all of the size that the first one has, whatever the
/// others say. False if members are set that this version does not know. Precondition:
/// has_size(first).
template <class T>
[[nodiscard]] bool read_element(const T* first, std::size_t i, T& value) noexcept {
  const std::uint32_t size = stated_size(first);
  const unsigned char* const bytes = reinterpret_cast<const unsigned char*>(first) + i * size;
  const bool knows_all =
      std::all_of(bytes + sizeof(T), bytes + size, [](unsigned char byte) { return byte == 0; });
  if (knows_all) std::memcpy(&value, bytes, sizeof(T));
  return knows_all;
}

/// Reads a struct of the caller into `value`, which holds what stands for a null pointer. False if
/// its size is none, or if members are set that this version does not know.
template <class T>
[[nodiscard]] bool read_struct(const T* given, T& value) noexcept {
  return given == nullptr || (has_size(given) && read_element(given, 0, value));
}

/// Writes all members but its size. Precondition: has_size(given).
template <class T>
void write_struct(T* given, const T& value) noexcept {
  constexpr std::size_t kBehindSize = sizeof(given->struct_size);
  std::memcpy(reinterpret_cast<std::byte*>(given) + kBehindSize,
              reinterpret_cast<const std::byte*>(&value) + kBehindSize, sizeof(T) - kBehindSize);
}

/// An array of structs of the caller that are written, all of the size that the first one has.
template <class T>
class Elements {
 public:
  /// Precondition: has_size(first).
  explicit Elements(T* first) noexcept
      : bytes_(reinterpret_cast<std::byte*>(first)), size_(stated_size(first)) {}

  [[nodiscard]] T& operator[](std::size_t i) const noexcept {
    return *reinterpret_cast<T*>(bytes_ + i * size_);
  }
  /// Writes all members of element `i`.
  void write(std::size_t i, const T& value) const noexcept {
    write_struct(&(*this)[i], value);
    (*this)[i].struct_size = size_;
  }
  /// Copies an element to the place of another one, with what lies behind its members.
  void move(std::size_t from, std::size_t to) const noexcept {
    std::memmove(bytes_ + to * size_, bytes_ + from * size_, size_);
    (*this)[to].struct_size = size_;
  }

 private:
  std::byte* bytes_;
  std::uint32_t size_;
};

/// How many bytes of a UTF-8 text fit into `capacity`, without cutting a character in two.
[[nodiscard]] std::size_t whole_characters(std::string_view text, std::size_t capacity) noexcept;

/// Copies a text, cut to fit, and a 0 behind it; returns its whole length.
std::size_t copy_text(std::string_view text, char* buffer, std::size_t capacity) noexcept;

}  // namespace boxtree::c
