// SPDX-License-Identifier: MIT
// Versions and errors of the C interface: numbers and names are those of Errc, and messages fit.
#include <boxtree_c.h>
#include <cstddef>
#include <cstring>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>
#include <boxtree/configuration.h>

#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"
#include "tests/support/temp_folder.h"
#include "tests/unit/c/subjects.h"

namespace boxtree {
namespace {

TEST(CLibrary, IsOfTheVersionOfItsHeader) {
  EXPECT_EQ(bxt_abi_version(), BXT_ABI_VERSION);
  EXPECT_STREQ(bxt_version(), BOXTREE_VERSION);
}

// Enumerators of the header from BXT_OK to BXT_INTERNAL, as "too_many_sections".
std::map<std::string, int> statuses_of_header() {
  const std::string text = test::read_text(BOXTREE_C_HEADER);
  const std::size_t begin = text.find("BXT_OK = 0"), end = text.find("};", begin);
  const std::string list = text.substr(begin, end - begin);
  const std::regex enumerator("BXT_([A-Z_]+) = ([0-9]+)");
  std::map<std::string, int> found;
  for (std::sregex_iterator i(list.begin(), list.end(), enumerator), none; i != none; ++i) {
    std::string name = (*i)[1];
    for (char& c : name) c = static_cast<char>(std::tolower(c));
    found[name] = std::stoi((*i)[2]);
  }
  return found;
}

TEST(CLibrary, CodesAreThoseOfErrc) {
  std::map<std::string, int> expected;
  for (const ErrcInfo& info : error_table()) {
    const auto status = static_cast<bxt_status>(info.code);
    expected[std::string(info.name)] = status;
    EXPECT_EQ(bxt_error_name(status), info.name);
    EXPECT_EQ(bxt_error_meaning(status), info.meaning);
  }
  EXPECT_EQ(statuses_of_header(), expected);
  for (const bxt_status none : {-1, 1, 17, 91, 65536 + BXT_TRUNCATED, INT32_MIN, INT32_MAX}) {
    EXPECT_STREQ(bxt_error_name(none), bxt_error_name(BXT_INTERNAL));
    EXPECT_STREQ(bxt_error_meaning(none), bxt_error_meaning(BXT_INTERNAL));
  }
}

TEST(CLibrary, ConstantsAreThoseOfCpp) {
  EXPECT_EQ(BXT_NO_FACE, kNoFaceId);
  EXPECT_EQ(BXT_NO_INSTANCE, kNoInstance);
  EXPECT_EQ(BXT_NO_MATERIAL, kNoMaterial);
  EXPECT_EQ(std::size_t{BXT_MAX_HULL_POINTS}, kMaxHullPoints);
  EXPECT_EQ(BXT_UNLIMITED, kUnlimitedNodes);
  EXPECT_EQ(BXT_ALL_LAYERS, kAllLayers);
  EXPECT_EQ(static_cast<int>(BackFaces::kHit), BXT_BACK_FACES_HIT);
  EXPECT_EQ(static_cast<int>(BackFaces::kIgnore), BXT_BACK_FACES_IGNORE);
  EXPECT_EQ(static_cast<int>(BackFaces::kOnly), BXT_BACK_FACES_ONLY);
  EXPECT_EQ(static_cast<int>(ClipDepth::kZeroToOne), BXT_CLIP_ZERO_TO_ONE);
  EXPECT_EQ(static_cast<int>(ClipDepth::kMinusOneToOne), BXT_CLIP_MINUS_ONE_TO_ONE);
  EXPECT_EQ(static_cast<int>(Access::kNormal), BXT_ACCESS_NORMAL);
  EXPECT_EQ(static_cast<int>(Access::kRandom), BXT_ACCESS_RANDOM);
  EXPECT_EQ(static_cast<int>(Access::kSequential), BXT_ACCESS_SEQUENTIAL);
  EXPECT_EQ(static_cast<int>(Access::kWillNeed), BXT_ACCESS_WILL_NEED);
  EXPECT_EQ(static_cast<int>(Access::kDontNeed), BXT_ACCESS_DONT_NEED);
  EXPECT_EQ(static_cast<int>(Feature::kFace), BXT_FEATURE_FACE);
  EXPECT_EQ(static_cast<int>(Feature::kEdge), BXT_FEATURE_EDGE);
  EXPECT_EQ(static_cast<int>(Feature::kVertex), BXT_FEATURE_VERTEX);
  EXPECT_EQ(static_cast<int>(Overlap::kOverlapping), BXT_OVERLAPPING);
  EXPECT_EQ(static_cast<int>(Overlap::kDisjoint), BXT_DISJOINT);
  EXPECT_EQ(static_cast<int>(Overlap::kUndecided), BXT_UNDECIDED);
  EXPECT_EQ(static_cast<int>(Overlap::kBudgetSpent), BXT_BUDGET_SPENT);
}

TEST(CLibrary, ValuesOfTheHeaderAreWhatTheySay) {
  const bxt_pose identity = bxt_identity(), moved = bxt_translation(1, 2, 3);
  const Pose pose = Pose::Identity() * Eigen::Translation3d(1, 2, 3);
  const bxt_pose expected_identity = test::pose_of(Pose::Identity());
  const bxt_pose expected_moved = test::pose_of(pose);
  EXPECT_EQ(std::memcmp(&identity, &expected_identity, sizeof identity), 0);
  EXPECT_EQ(std::memcmp(&moved, &expected_moved, sizeof moved), 0);
  EXPECT_EQ(bxt_default_limits().struct_size, sizeof(bxt_limits));
  EXPECT_EQ(bxt_default_face_options().struct_size, sizeof(bxt_face_options));
  EXPECT_EQ(bxt_default_approximation().struct_size, sizeof(bxt_approximation));
  EXPECT_EQ(bxt_motion_along({1, 2, 3}).struct_size, sizeof(bxt_motion));
}

class CMessages : public testing::Test {
 protected:
  // The message of C++ for a tree that is not there, whose name has letters of two bytes.
  [[nodiscard]] std::string expected() const {
    return test::require(File::open(Bytes(bytes_))).find_tree(name_).error().message();
  }
  bxt_status find(bxt_error* error) const {
    std::uint32_t number;
    return bxt_file_find_tree(file_.get(), name_.c_str(), &number, error);
  }
  // Names of `letters`, and an "x" in front if `odd`.
  void set_name(std::size_t letters, bool odd) {
    name_ = odd ? "x" : "";
    for (std::size_t i = 0; i < letters; ++i) name_ += "\u00e4";
  }

 private:
  std::vector<std::byte> bytes_ = test::cook_bytes(test::torus(5, 4), CodecId::kWide8);
  test::CFile file_ = test::open_c(bytes_);
  std::string name_;
};

TEST_F(CMessages, ThatAreLongAreCutAtAWholeCharacter) {
  for (const bool odd : {false, true}) {
    for (const std::size_t letters : {3u, 200u, 400u}) {
      set_name(letters, odd);
      bxt_error error = {};
      error.struct_size = sizeof error;
      std::memset(error.message, '#', sizeof error.message);
      EXPECT_EQ(find(&error), BXT_TREE_INDEX);
      EXPECT_EQ(error.status, BXT_TREE_INDEX);
      EXPECT_EQ(error.message_length, expected().size());
      const std::string message = error.message;
      EXPECT_EQ(expected().substr(0, message.size()), message);
      if (expected().size() < sizeof error.message) {
        EXPECT_EQ(message, expected());
      } else {
        EXPECT_GE(message.size(), sizeof error.message - 2);
        // What comes next is no part of a character that was begun.
        EXPECT_NE(static_cast<unsigned char>(expected()[message.size()]) & 0xc0, 0x80);
      }
    }
  }
}

TEST_F(CMessages, ContinueInALongerBuffer) {
  struct {
    bxt_error error = {};
    char more[65536 - sizeof(bxt_error)];
    char behind[8];
  } longer;
  for (const std::size_t size :
       {std::size_t{1512}, std::size_t{1537}, std::size_t{4096}, std::size_t{65536}}) {
    SCOPED_TRACE(size);
    std::memset(longer.more, '#', sizeof longer.more + sizeof longer.behind);
    set_name((std::min<std::size_t>(size, 4096) - 1000) / 2, false);
    longer.error.struct_size = static_cast<std::uint32_t>(size);
    EXPECT_EQ(find(&longer.error), BXT_TREE_INDEX);
    const auto* const all = reinterpret_cast<const char*>(&longer);
    EXPECT_EQ(std::string(all + offsetof(bxt_error, message)), expected());
    EXPECT_EQ(longer.error.message_length, expected().size());
    EXPECT_EQ(std::string(all + size, 8), "########");
  }
}

TEST_F(CMessages, OfAnErrorWithoutASizeAreNotWritten) {
  set_name(3, false);
  for (const std::uint32_t size :
       {0u, 4u, static_cast<std::uint32_t>(sizeof(bxt_error)) - 1, 65537u, 0xffffffffu}) {
    bxt_error error = {};
    error.struct_size = size;
    error.status = -1;
    EXPECT_EQ(find(&error), BXT_TREE_INDEX);
    EXPECT_EQ(error.status, -1);
    EXPECT_EQ(error.message[0], 0);
  }
}

// Of what the C++ interface gives no detail, the message says what the code means.
TEST(CLibrary, MessagesWithoutADetailHaveTheMeaning) {
  const std::vector<std::byte> bytes = test::cook_bytes(test::torus(5, 4), CodecId::kWide8);
  const test::CFile file = test::open_c(bytes);
  const test::CTree tree = test::bind_c(file);
  bxt_limits limits = bxt_default_limits();
  limits.nodes = 0;
  const bxt_vec3 point = {0, 0, 0};
  bxt_closest_point answer = {};
  answer.struct_size = sizeof answer;
  bxt_error error = {};
  error.struct_size = sizeof error;
  EXPECT_EQ(bxt_tree_closest_point(tree.get(), &point, INFINITY, &limits, &answer, &error),
            BXT_WORK_LIMIT);
  EXPECT_EQ(std::string(error.message),
            std::string("work_limit: ") + bxt_error_meaning(BXT_WORK_LIMIT));
}

// As Error::message() does; a pointer that is NULL is another matter than a value.
TEST(CLibrary, MessagesSayWhatAQueryExpects) {
  const std::vector<std::byte> bytes = test::cook_bytes(test::torus(5, 4), CodecId::kWide8);
  const test::CFile file = test::open_c(bytes);
  const test::CTree tree = test::bind_c(file);
  bxt_closest_point answer = {};
  answer.struct_size = sizeof answer;
  bxt_error error = {};
  error.struct_size = sizeof error;
  const bxt_vec3 point = {NAN, 0, 0};
  EXPECT_EQ(bxt_tree_closest_point(tree.get(), &point, 1, nullptr, &answer, &error),
            BXT_INVALID_QUERY);
  EXPECT_STREQ(error.message,
               "invalid_query: point: expected a finite point, at most 2^185 mesh extents away");
  EXPECT_EQ(error.message_length, std::strlen(error.message));
  EXPECT_EQ(bxt_tree_closest_point(tree.get(), nullptr, 1, nullptr, &answer, &error),
            BXT_INVALID_QUERY);
  EXPECT_STREQ(error.message, "invalid_query: point is NULL");
  EXPECT_EQ(error.message_length, std::strlen(error.message));
}

}  // namespace
}  // namespace boxtree
