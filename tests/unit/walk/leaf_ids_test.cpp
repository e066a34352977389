// SPDX-License-Identifier: MIT
// The ids of a leaf, in every instruction set, against those of its faces one by one: of valid
// sections that end right after their padding, and of corrupt ones.
#include "runtime/walk/leaf_ids.h"

#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "format/face_ids.h"
#include "tests/support/face_ids.h"
#include "tests/unit/walk/targets.h"

namespace boxtree {
namespace {

using test::ascending;
using test::encoded;
using test::Ids;

// Numbers of `bits` bits: fields and starts of every width.
Ids random_ids(std::uint32_t count, std::uint32_t bits, std::mt19937& random) {
  Ids ids(count);
  for (std::uint32_t& id : ids) id = static_cast<std::uint32_t>(random()) >> (32 - bits);
  return ids;
}

// Runs of neighbours, as sources have them: several intervals in a block.
Ids runs(std::uint32_t count, std::uint32_t most, std::mt19937& random) {
  Ids ids;
  while (ids.size() < count) {
    const std::uint32_t first = static_cast<std::uint32_t>(random()) % most;
    for (std::uint32_t i = 0; i < 1 + random() % 20 && ids.size() < count; ++i) {
      ids.push_back(first + i);
    }
  }
  return ids;
}

Ids one_by_one(const FaceIdView& view, std::uint32_t count) {
  Ids ids(count);
  for (std::uint32_t f = 0; f < count; ++f) ids[f] = view[f];
  return ids;
}

Ids by_leaves(const FaceIdView& view, std::uint32_t count) {
  Ids ids(count);
  for (std::uint32_t first = 0; first < count; first += kLeafFaces) {
    std::array<std::uint32_t, kLeafFaces> leaf;
    read_leaf_ids_wide(view, first / kLeafFaces, leaf);
    std::copy_n(leaf.begin(), std::min(kLeafFaces, count - first), ids.begin() + first);
  }
  return ids;
}

TEST(LeafIds, AreThoseOfTheirFaces) {
  for_each_target([](const char* target) {
    std::mt19937 random(1);
    for (const std::uint32_t count : {1u, 7u, 8u, 9u, 64u, 65u, 1024u, 1025u, 3000u}) {
      std::vector<Ids> cases = {ascending(count), runs(count, 1000, random),
                                runs(count, kMaxFaces - 20, random)};
      for (std::uint32_t bits = 1; bits < 30; ++bits) {
        cases.push_back(random_ids(count, bits, random));
      }
      for (const Ids& ids : cases) {
        const std::vector<std::byte> section = encoded(ids);
        ASSERT_EQ(by_leaves(FaceIdView(section), count), ids) << target << ", " << count;
      }
    }
  });
}

// The section lies alone on the heap, where the address sanitizer and valgrind see every read
// outside.
TEST(LeafIds, OfCorruptBytesAreReadInsideTheSection) {
  for_each_target([](const char* target) {
    constexpr std::uint32_t kFaces = 3000;
    std::mt19937 random(2);
    const std::vector<std::byte> valid = encoded(runs(kFaces, 100000, random));
    for (int round = 0; round < 300; ++round) {
      std::vector<std::byte> section = valid;
      if (round % 3 == 0) section.resize(least_id_bytes(kFaces));
      for (int change = 0; change < 1 + round; ++change) {
        section[random() % section.size()] = static_cast<std::byte>(random());
      }
      section.shrink_to_fit();
      const FaceIdView view(section);
      ASSERT_EQ(by_leaves(view, kFaces), one_by_one(view, kFaces)) << target << ", " << round;
    }
  });
}

}  // namespace
}  // namespace boxtree
