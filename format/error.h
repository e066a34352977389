// SPDX-License-Identifier: MIT
// Error codes of the whole project. Values are pinned: they appear in logs, in JSON and in other
// people's switch statements, so a code is never renumbered and a retired number is never reused.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

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

  // 50..59: binding and asking.
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

}  // namespace boxtree
