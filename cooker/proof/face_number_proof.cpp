// SPDX-License-Identifier: MIT
#include "cooker/proof/face_number_proof.h"

#include <cstddef>
#include <cstdint>

#include "cooker/proof/names.h"
#include "format/container.h"
#include "format/face_numbers.h"
#include "format/numbers.h"
#include "format/scene_record.h"
#include "runtime/file/open_file.h"

namespace boxtree::cooker {
namespace {

using AddFault = std::function<void(const std::string& fault)>;

// `count`: every number is less.
void check_runs(Bytes runs, std::uint64_t count, const std::string& what, const AddFault& add) {
  for (std::size_t i = 0; i < runs.size() / sizeof(FaceRun); ++i) {
    const auto run = load<FaceRun>(runs.data(), i);
    const bool is_ordered = i == 0 ? run.first_face == 0
                                   : run.first_face > load<FaceRun>(runs.data(), i - 1).first_face;
    if (!is_ordered || run.number >= count) add(what + "run " + std::to_string(i));
  }
}

void check_faces(Bytes faces, std::uint32_t count, const std::string& what, const AddFault& add) {
  const std::uint8_t bytes = material_number_bytes(count);
  const NumberView numbers(faces.data(), bytes);
  for (std::size_t face = 0; face < faces.size() / bytes; ++face) {
    if (numbers[face] >= count) add(what + "face " + std::to_string(face));
  }
}

// Calls check(runs, faces, what) with the sections of each tree.
template <class Check>
void check_trees(const OpenFile& file, SectionKind kind, const std::string& numbers,
                 const AddFault& add, const Check& check) {
  for (std::uint32_t tree = 0; tree < file.tree_count(); ++tree) {
    const std::string what = numbers + " of tree " + std::to_string(tree) + ": ";
    const Bytes runs = file.section(kind, tree);
    const Bytes faces = file.section(by_face(kind), tree);
    if (!runs.empty() && !faces.empty()) add(what + "both runs and faces have some");
    check(runs, faces, what);
  }
}

}  // namespace

void check_materials(const File& opened, const AddFault& add) {
  const OpenFile& file = OpenFile::of(opened);
  const Bytes records = file.section(SectionKind::kMaterials);
  const auto count = static_cast<std::uint32_t>(records.size() / sizeof(MaterialRecord));
  if (records.size() % sizeof(MaterialRecord) != 0) {
    add("section materials has " + std::to_string(records.size()) + " bytes, expected " +
        std::to_string(sizeof(MaterialRecord)) + " for each material");
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto record = load<MaterialRecord>(records.data(), i);
    const Status status =
        check_text(file.section(SectionKind::kNames), record.name_offset, record.name_bytes,
                   "material " + std::to_string(i) + ": its name");
    if (!status.ok()) add(status.error().detail);
  }
  check_trees(file, SectionKind::kMaterialRuns, "materials", add,
              [&](Bytes runs, Bytes faces, const std::string& what) {
                check_runs(runs, count, what, add);
                check_faces(faces, count, what, add);
              });
}

void check_user_data(const File& opened, const AddFault& add) {
  constexpr std::uint64_t kAny = std::uint64_t{1} << 32;
  check_trees(OpenFile::of(opened), SectionKind::kUserDataRuns, "user data", add,
              [&](Bytes runs, Bytes /*faces*/, const std::string& what) {
                check_runs(runs, kAny, what, add);
              });
}

}  // namespace boxtree::cooker
