// SPDX-License-Identifier: MIT
// The encodings for which tests of the numbers of faces, materials and user data, run.
#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "format/codec.h"
#include "tests/support/cooked.h"

namespace boxtree::test {

struct FaceNumberCase {
  CodecId codec;
  GeometryId geometry;
  bool face_ids;
};

inline std::vector<FaceNumberCase> face_number_cases() {
  std::vector<FaceNumberCase> all;
  for (const CodecId codec : all_codecs()) {
    for (const bool face_ids : {true, false}) all.push_back({codec, GeometryId::kExact, face_ids});
    all.push_back({codec, GeometryId::kExternal, false});
  }
  all.push_back({CodecId::kWide8, GeometryId::kArrays, false});
  return all;
}

inline std::string name_of_case(const testing::TestParamInfo<FaceNumberCase>& each) {
  return test_name({each.param.codec, each.index}) + "_" +
         std::string(geometry_name(each.param.geometry)) +
         (each.param.face_ids ? "_ids" : "_no_ids");
}

}  // namespace boxtree::test
