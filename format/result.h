// SPDX-License-Identifier: MIT
// A value or the first error that prevented it. Stands in for std::expected, which C++20 lacks.
#pragma once

#include <cassert>
#include <string>
#include <utility>
#include <variant>

#include "format/error.h"

namespace boxtree {

/// What went wrong, and where: `detail` names the place, what was expected and what was found.
struct Error {
  Errc code = Errc::kInternal;
  std::string detail;

  /// "box_escape: tree 0, node 17: ..."; the form that the command line prints.
  [[nodiscard]] std::string message() const {
    const ErrcInfo& info = error_info(code);
    return std::string(info.name) + ": " + (detail.empty() ? std::string(info.meaning) : detail);
  }
};

template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
  Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}
  Result(Errc code) : state_(std::in_place_index<1>, Error{code, {}}) {}

  [[nodiscard]] bool ok() const noexcept { return state_.index() == 0; }
  explicit operator bool() const noexcept { return ok(); }

  /// Precondition: ok().
  [[nodiscard]] T& value() & {
    assert(ok());
    return *std::get_if<0>(&state_);
  }
  [[nodiscard]] const T& value() const& {
    assert(ok());
    return *std::get_if<0>(&state_);
  }
  [[nodiscard]] T&& value() && {
    assert(ok());
    return std::move(*std::get_if<0>(&state_));
  }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

  /// Precondition: !ok().
  [[nodiscard]] const Error& error() const {
    assert(!ok());
    return *std::get_if<1>(&state_);
  }
  [[nodiscard]] Errc code() const noexcept {
    return ok() ? Errc::kOk : std::get_if<1>(&state_)->code;
  }

 private:
  std::variant<T, Error> state_;
};

/// The result of an operation that has no value.
class [[nodiscard]] Status {
 public:
  Status() = default;
  Status(Error error) : error_(std::move(error)) {}
  Status(Errc code) : error_{code, {}} {}

  [[nodiscard]] bool ok() const noexcept { return error_.code == Errc::kOk; }
  explicit operator bool() const noexcept { return ok(); }
  [[nodiscard]] const Error& error() const { return error_; }
  [[nodiscard]] Errc code() const noexcept { return error_.code; }

 private:
  Error error_{Errc::kOk, {}};
};

}  // namespace boxtree
