// SPDX-License-Identifier: MIT
// Numbers of faces, as of materials: of each tree the smaller of two forms, and its section.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cooker/import/source_mesh.h"
#include "format/face_numbers.h"

namespace boxtree::cooker {

/// Numbers of one tree's faces: by runs of source faces, or per face in tree order, or neither.
struct FaceNumbers {
  std::vector<FaceRun> runs;
  std::vector<std::uint32_t> faces;
};

/// Their sections; the others are empty.
struct EncodedFaceNumbers {
  std::vector<std::byte> runs;
  std::vector<std::byte> faces;
};

/// `width`: bytes of each number of FaceNumbers::faces, which holds all of them.
[[nodiscard]] EncodedFaceNumbers encode_face_numbers(const FaceNumbers& numbers,
                                                     std::uint8_t width);

/// Bytes of both forms; no runs if they do not tell the numbers of the faces.
struct FaceNumberBytes {
  std::optional<std::uint64_t> runs;
  std::uint64_t faces = 0;

  [[nodiscard]] bool keeps_runs() const { return runs && *runs <= faces; }
  [[nodiscard]] std::uint64_t kept() const { return keeps_runs() ? *runs : faces; }
};

/// Drops the form that takes more bytes, which it returns of both; faces if they are equal.
/// Precondition: numbers are in both forms. `has_ids`: whether faces of the tree have ids, without
/// which only a single run tells their numbers.
FaceNumberBytes keep_smaller(FaceNumbers& numbers, std::uint8_t width, bool has_ids);

/// The form that keep_smaller() kept and what the other would take, for people: "by runs of the
/// source's faces; 40 bytes of each face".
[[nodiscard]] std::string forms_text(const FaceNumberBytes& bytes);

/// The number of each face of a mesh. Precondition: `runs` is as in SceneMesh, and not empty.
[[nodiscard]] std::vector<std::uint32_t> numbers_of_faces(const SourceMesh& mesh,
                                                          std::span<const FaceRun> runs);

/// The runs of numbers of faces with ascending ids; nothing of those in between. Precondition: as
/// many ids as numbers.
[[nodiscard]] std::vector<FaceRun> runs_of(std::span<const std::uint32_t> ids,
                                           std::span<const std::uint32_t> numbers);

}  // namespace boxtree::cooker
