// SPDX-License-Identifier: MIT
#include "cooker/encode/face_numbers.h"

#include <fmt/format.h>

#include "cooker/encode/append.h"
#include "cooker/import/face_runs.h"

namespace boxtree::cooker {

EncodedFaceNumbers encode_face_numbers(const FaceNumbers& numbers, std::uint8_t width) {
  EncodedFaceNumbers out;
  for (const FaceRun& run : numbers.runs) append(out.runs, run);
  for (const std::uint32_t number : numbers.faces) {
    if (width == 1) {
      append(out.faces, static_cast<std::uint8_t>(number));
    } else if (width == 2) {
      append(out.faces, static_cast<std::uint16_t>(number));
    } else {
      append(out.faces, number);
    }
  }
  return out;
}

FaceNumberBytes keep_smaller(FaceNumbers& numbers, std::uint8_t width, bool has_ids) {
  auto& [runs, faces] = numbers;
  FaceNumberBytes bytes;
  bytes.faces = std::uint64_t{faces.size()} * width;
  if (has_ids || runs.size() == 1) bytes.runs = runs.size() * sizeof(FaceRun);
  if (bytes.keeps_runs()) {
    faces.clear();
  } else {
    runs.clear();
  }
  return bytes;
}

std::string forms_text(const FaceNumberBytes& bytes) {
  if (bytes.keeps_runs()) {
    return fmt::format("by runs of the source's faces; a number for each face would take {} bytes",
                       bytes.faces);
  }
  return bytes.runs ? fmt::format("of each face; runs of the source's faces would take {} bytes",
                                  *bytes.runs)
                    : "of each face; runs need face ids";
}

std::vector<std::uint32_t> numbers_of_faces(const SourceMesh& mesh, std::span<const FaceRun> runs) {
  std::vector<std::uint32_t> numbers;
  numbers.reserve(mesh.faces.size());
  std::size_t run = 0;  // ids ascend
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    while (run + 1 < runs.size() && runs[run + 1].first_face <= mesh.face_id(face)) ++run;
    numbers.push_back(runs[run].number);
  }
  return numbers;
}

std::vector<FaceRun> runs_of(std::span<const std::uint32_t> ids,
                             std::span<const std::uint32_t> numbers) {
  std::vector<FaceRun> runs;
  for (std::size_t i = 0; i < numbers.size(); ++i) add_face_to(runs, ids[i], numbers[i]);
  return runs;
}

}  // namespace boxtree::cooker
