// SPDX-License-Identifier: MIT
// Errors: the codes of the whole project, and Result and Status, which carry them. Values are
// pinned: they appear in logs, in JSON and in other people's switch statements, so a code is never
// renumbered and a retired number is never reused.
#pragma once

#include <cassert>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace boxtree {

enum class Errc : std::uint16_t {
  kOk = 0,

  // 10..29: the container (header, section table, sections).
  kBadMagic = 10,
  kTruncated = 11,
  kVersionUnsupported = 12,
  kFeatureUnsupported = 13,
  kHeaderCorrupt = 14,
  kTooManySections = 15,
  kSectionOutOfRange = 16,
  kSectionMisaligned = 17,
  kSectionOverlap = 18,
  kSectionDuplicate = 19,
  kSectionMissing = 20,
  kSectionSize = 21,
  kSectionUnknown = 22,
  kPaddingNotZero = 23,
  kChecksumMismatch = 24,
  kBlobLimit = 25,
  kBlobCorrupt = 26,

  // 30..49: the trees inside.
  kCodecUnsupported = 30,
  kGeometryUnsupported = 31,
  kRecordInvalid = 32,
  kNodeCorrupt = 33,
  kDepthExceeded = 34,
  kFaceOutOfRange = 35,
  kVertexOutOfRange = 36,
  kCertificateMismatch = 37,
  kBoxEscape = 38,
  kFaceUnreachable = 39,
  kFaceRepeated = 40,
  kVertexNotFinite = 41,
  kDuplicateDiffers = 42,

  // 50..59: binding and querying.
  kInvalidQuery = 50,
  kInvalidPose = 51,
  kPartLeftOut = 52,
  kExternalMeshNeeded = 53,
  kExternalMeshMismatch = 54,
  kTreeIndex = 55,
  kNoScene = 56,
  kInstanceIndex = 57,
  kInstanceStatic = 58,
  kWorkLimit = 59,

  // 60..69: the operating system.
  kFileNotFound = 60,
  kFileUnreadable = 61,
  kMapFailed = 62,
  kWriteFailed = 63,

  // 70..79: meshes.
  kImportFailed = 70,
  kNoFaces = 71,
  kMeshNotFinite = 72,
  kMeshIndexOutOfRange = 73,
  kMeshTooLarge = 74,
  kMeshUnsupported = 75,
  kBudgetUnreachable = 76,
  kProfileInvalid = 77,

  // 90: our own bug; please report.
  kInternal = 90,
};

/// One row of the error table: pinned number, stable name, meaning, exit status of the command
/// line.
struct ErrcInfo {
  Errc code;
  std::string_view name;
  std::string_view meaning;
  int exit_status;
};

/// Every code in ascending order of its number.
[[nodiscard]] std::span<const ErrcInfo> error_table() noexcept;

/// The row of `code`; an unknown number gets the row of kInternal.
[[nodiscard]] const ErrcInfo& error_info(Errc code) noexcept;

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

/// A value or the first error that prevented it. Stands in for std::expected, which C++20 lacks.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : value_(std::move(value)) {}
  Result(Error error) : error_(std::move(error)) {}
  Result(Errc code) : error_{code, {}} {}

  [[nodiscard]] bool ok() const noexcept { return value_.has_value(); }
  explicit operator bool() const noexcept { return ok(); }

  /// Precondition: ok().
  [[nodiscard]] T& value() & {
    assert(ok());
    return *value_;
  }
  [[nodiscard]] const T& value() const& {
    assert(ok());
    return *value_;
  }
  [[nodiscard]] T&& value() && {
    assert(ok());
    return *std::move(value_);
  }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

  /// Precondition: !ok().
  [[nodiscard]] const Error& error() const {
    assert(!ok());
    return error_;
  }
  [[nodiscard]] Errc code() const noexcept { return error_.code; }

 private:
  std::optional<T> value_;
  Error error_{Errc::kOk, {}};
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
