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

#include <boxtree/export.h>

namespace boxtree {

/// Every error of the project. Compare with these, print error_info(code).name, and log the number:
/// all three are pinned.
enum class Errc : std::uint16_t {
  kOk = 0,  ///< No error.

  // 10..29: the container (header, section table, sections).
  kBadMagic = 10,            ///< Not a .bxt file.
  kTruncated = 11,           ///< The file is not as long as its sections.
  kVersionUnsupported = 12,  ///< Written by a newer format than this reader knows.
  kFeatureUnsupported = 13,  ///< Uses a feature that a reader must know and this one does not.
  kHeaderCorrupt = 14,       ///< Header or section table is damaged.
  kTooManySections = 15,     ///< More sections than the limit.
  kSectionOrder = 18,        ///< Sections are out of order, or one occurs twice.
  kSectionMissing = 20,      ///< A section that the tree needs is absent.
  kSectionSize = 21,         ///< A section's size contradicts its records.
  kSectionUnknown = 22,      ///< A section that a reader must know and this one does not.
  kPaddingNotZero = 23,      ///< Padding or reserved bytes are not zero.
  kChecksumMismatch = 24,    ///< A section's bytes have changed.
  kBlobLimit = 25,           ///< Decompressing would take more memory than allowed.
  kBlobCorrupt = 26,         ///< A compressed file is damaged.

  // 30..49: the trees inside.
  kCodecUnsupported = 30,     ///< Unknown node codec.
  kGeometryUnsupported = 31,  ///< Unknown geometry store.
  kRecordInvalid = 32,        ///< A tree record contradicts itself.
  kNodeCorrupt = 33,          ///< A node points outside its own subtree.
  kDepthExceeded = 34,        ///< The tree is deeper than it states.
  kFaceOutOfRange = 35,       ///< A leaf names a face that is not there.
  kVertexOutOfRange = 36,     ///< A face names a vertex that is not there.
  kBoxEscape = 38,            ///< A triangle sticks out of a box above it.
  kFaceUnreachable = 39,      ///< No leaf holds this face.
  kFaceRepeated = 40,         ///< More than one leaf holds this face.
  kVertexNotFinite = 41,      ///< A stored vertex is NaN or infinite.
  kDuplicateDiffers = 42,     ///< A face listed as a copy of another one is not the same.

  // 50..59: binding and querying.
  kInvalidQuery = 50,  ///< NaN, infinite or empty query.
  kInvalidPose = 51,   ///< Pose is not finite, not invertible or leads too far away.
  /// A needed part was left out; require it when the file is bound, which tells the line.
  kPartLeftOut = 52,
  /// The tree was cooked without geometry; give the mesh when binding.
  kExternalMeshNeeded = 53,
  kExternalMeshMismatch = 54,  ///< The mesh given is not the one the tree was cooked from.
  kTreeIndex = 55,             ///< No tree with this number in the file.
  kNoScene = 56,               ///< The file holds trees but no scene; bind one of its trees.
  kInstanceIndex = 57,         ///< No instance with this number in the scene.
  /// An instance that was bound as static cannot be moved; make_movable() allows it.
  kInstanceStatic = 58,
  kWorkLimit = 59,  ///< The query would cost more than its caller allows.

  // 60..69: the operating system.
  kFileNotFound = 60,    ///< No such file.
  kFileUnreadable = 61,  ///< The file cannot be read.
  kMapFailed = 62,       ///< The file cannot be mapped.
  kWriteFailed = 63,     ///< The file cannot be written.
  kOutOfMemory = 64,     ///< There is too little memory.

  // 70..79: meshes.
  kImportFailed = 70,         ///< The mesh cannot be read.
  kNoFaces = 71,              ///< The mesh has no faces.
  kMeshNotFinite = 72,        ///< A vertex is NaN or infinite.
  kMeshIndexOutOfRange = 73,  ///< A face names a vertex that is not there.
  kMeshTooLarge = 74,         ///< More faces or vertices than the format holds.
  kMeshUnsupported = 75,      ///< The mesh cannot be stored in the way requested.
  kBudgetUnreachable = 76,    ///< No encoding keeps to the bytes and the time requested.
  kProfileInvalid = 77,       ///< A profile says what it must not, or of nothing that is there.
  kDocumentInvalid = 78,      ///< A JSON document is not what it should be.

  // 90: our own bug; please report.
  kInternal = 90,  ///< An internal error; please report it.
};

/// One row of the error table: pinned number, stable name, meaning, exit status of the command
/// line.
struct ErrcInfo {
  Errc code;                 ///< The error.
  std::string_view name;     ///< Its name in messages and JSON, as "box_escape".
  std::string_view meaning;  ///< What it means, in one sentence without a full stop.
  int exit_status;           ///< Of the command line: 0 to 5, see docs/GUIDE.md.
};

/// Every code in ascending order of its number. Thread-safe, never allocates.
[[nodiscard]] BOXTREE_API std::span<const ErrcInfo> error_table() noexcept;

/// The row of `code`; an unknown number gets the row of Errc::kInternal. O(codes), thread-safe,
/// never allocates.
[[nodiscard]] BOXTREE_API const ErrcInfo& error_info(Errc code) noexcept;

/// What is expected of the argument of a query, or of the field of one, that the detail of
/// kInvalidQuery names: "finite and 0 or more" of a "radius". Empty for other texts. Thread-safe,
/// never allocates.
[[nodiscard]] BOXTREE_API std::string_view expected_of(std::string_view argument) noexcept;

/// What went wrong, and where: `detail` names the place, what was expected and what was found.
struct Error {
  Errc code = Errc::kInternal;  ///< What went wrong.
  std::string detail;           ///< Where, what was expected and what was found; may be empty.

  /// "box_escape: tree 0, node 17: ...", the form that the command line prints; the meaning of the
  /// code where there is no detail; "invalid_query: radius: expected finite and 0 or more".
  [[nodiscard]] std::string message() const {
    const ErrcInfo& info = error_info(code);
    std::string text(info.name);
    text.append(": ").append(detail.empty() ? info.meaning : std::string_view(detail));
    if (code == Errc::kInvalidQuery) {
      const std::string_view expected = expected_of(detail);
      if (!expected.empty()) text.append(": expected ").append(expected);
    }
    return text;
  }
};

/// A value or the first error that prevented it. Stands in for `std::expected`, which C++20 lacks.
template <class T>
class [[nodiscard]] Result {
 public:
  /// A value.
  Result(T value) : value_(std::move(value)) {}
  /// An error with its detail.
  Result(Error error) : error_(std::move(error)) {}
  /// An error that its code says in full.
  Result(Errc code) : error_{code, {}} {}

  /// Whether there is a value.
  [[nodiscard]] bool ok() const noexcept { return value_.has_value(); }
  /// The same: `if (const auto file = File::open(path))`.
  explicit operator bool() const noexcept { return ok(); }

  /// The value. Precondition, here and for the operators: ok().
  [[nodiscard]] T& value() & {
    assert(ok());
    return *value_;
  }
  /// \copydoc value()
  [[nodiscard]] const T& value() const& {
    assert(ok());
    return *value_;
  }
  /// The value, to be moved from.
  [[nodiscard]] T&& value() && {
    assert(ok());
    return *std::move(value_);
  }
  /// The value.
  T& operator*() & { return value(); }
  /// The value.
  const T& operator*() const& { return value(); }
  /// The value, to be moved from.
  T&& operator*() && { return std::move(*this).value(); }
  /// A member of the value.
  T* operator->() { return &value(); }
  /// A member of the value.
  const T* operator->() const { return &value(); }

  /// The error. Precondition: not ok().
  [[nodiscard]] const Error& error() const {
    assert(!ok());
    return error_;
  }
  /// The code of the error; Errc::kOk if there is a value.
  [[nodiscard]] Errc code() const noexcept { return error_.code; }

 private:
  std::optional<T> value_;
  Error error_{Errc::kOk, {}};
};

/// The result of an operation that has no value.
class [[nodiscard]] Status {
 public:
  /// Success.
  Status() = default;
  /// An error with its detail.
  Status(Error error) : error_(std::move(error)) {}
  /// An error that its code says in full; Errc::kOk is success.
  Status(Errc code) : error_{code, {}} {}

  /// Whether there was no error.
  [[nodiscard]] bool ok() const noexcept { return error_.code == Errc::kOk; }
  /// The same.
  explicit operator bool() const noexcept { return ok(); }
  /// The error; its code is Errc::kOk if there was none.
  [[nodiscard]] const Error& error() const { return error_; }
  /// The code of the error, or Errc::kOk.
  [[nodiscard]] Errc code() const noexcept { return error_.code; }

 private:
  Error error_{Errc::kOk, {}};
};

}  // namespace boxtree
