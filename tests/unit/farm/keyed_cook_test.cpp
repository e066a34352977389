// SPDX-License-Identifier: MIT
// Outputs come from the journal, the cache or a cook, and are always those of the key.
#include "cooker/farm/keyed_cook.h"

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cooker/farm/folder_cache.h"
#include "tests/support/require.h"
#include "tests/support/temp_folder.h"
#include "tests/unit/farm/cache_values.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;
using How = KeyedOutcome::How;
using test::require;

using test::kRoom;
constexpr const char* kMesh = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
constexpr const char* kOther = "mtllib m.mtl\nv 0 0 0\nv 2 0 0\nv 0 2 0\nf 1 2 3\n";

struct Farm {
  Farm() {
    folder.write("m.obj", kMesh);
    folder.write("m.mtl", "newmtl a\n");
    job.inputs = {folder.path() / "m.obj"};
    job.output = folder.path() / "m.bxt";
  }

  Result<KeyedOutcome> cook(const Progress& progress = {}) {
    return cook_by_key(job, require(key_of(job)), stores, progress);
  }

  const test::TempFolder folder;
  CookJob job;
  FolderCache cache = require(FolderCache::open(folder.path() / "cache", kRoom));
  Journal journal = require(Journal::open(folder.path() / "journal"));
  KeyedStores stores{&cache, &journal, 0, [](const Summary& summary) {
                       return std::to_string(summary.trees.size()) + " trees";
                     }};
};

TEST(KeyedCook, CooksOnce) {
  Farm farm;
  const KeyedOutcome first = require(farm.cook());
  EXPECT_EQ(first.how, How::kCooked);
  EXPECT_EQ(first.report, "1 trees");
  ASSERT_TRUE(first.summary);
  const std::string bytes = test::read_text(farm.job.output);
  EXPECT_EQ(first.bytes, bytes.size());
  const KeyedOutcome second = require(farm.cook());
  EXPECT_EQ(second.how, How::kThere);
  EXPECT_EQ(second.bytes, bytes.size());
  // Away, damaged, or elsewhere: the cache has it.
  for (const char* output : {"m.bxt", "m.bxt", "elsewhere.bxt"}) {
    farm.job.output = farm.folder.path() / output;
    const KeyedOutcome hit = require((fs::remove(farm.job.output), farm.cook()));
    EXPECT_EQ(hit.how, How::kFromCache);
    EXPECT_EQ(hit.report, "1 trees");
    EXPECT_EQ(test::read_text(farm.job.output), bytes);
    EXPECT_EQ(require(farm.cook()).how, How::kThere);
    std::string damaged = bytes;
    damaged[damaged.size() / 2] ^= 1;
    farm.folder.write(output, damaged);
  }
  farm.folder.write("m.obj", kOther);
  EXPECT_EQ(require(farm.cook()).how, How::kCooked);
  EXPECT_NE(test::read_text(farm.job.output), bytes);
  farm.folder.write("m.obj", kMesh);
  EXPECT_EQ(require(farm.cook()).how, How::kFromCache);
  EXPECT_EQ(test::read_text(farm.job.output), bytes);
}

TEST(KeyedCook, WithoutStoresItCooks) {
  Farm farm;
  farm.stores = {};
  for (int i = 0; i < 2; ++i) EXPECT_EQ(require(farm.cook()).how, How::kCooked);
}

TEST(KeyedCook, TheDepfileIsThatOfACook) {
  Farm farm;
  farm.job.depfile = farm.folder.path() / "m.d";
  ASSERT_TRUE(farm.cook());
  const std::string depfile = test::read_text(farm.job.depfile);
  EXPECT_NE(depfile.find("m.mtl"), std::string::npos);
  for (const How how : {How::kThere, How::kFromCache}) {
    fs::remove(farm.job.depfile);
    if (how == How::kFromCache) fs::remove(farm.job.output);
    EXPECT_EQ(require(farm.cook()).how, how);
    EXPECT_EQ(test::read_text(farm.job.depfile), depfile);
  }
}

// Else make and ninja would cook it at each build again, once an input was written anew.
TEST(KeyedCook, WhatIsThereIsMadeNewerThanItsInputs) {
  Farm farm;
  for (const bool has_journal : {false, true}) {
    SCOPED_TRACE(has_journal);
    if (!has_journal) farm.stores.journal = nullptr;
    ASSERT_TRUE(farm.cook());
    const fs::file_time_type cooked = fs::last_write_time(farm.job.output);
    // Neither input is newer: it stays as it is.
    ASSERT_TRUE(farm.cook());
    EXPECT_EQ(fs::last_write_time(farm.job.output), cooked);
    for (const char* input : {"m.obj", "m.mtl"}) {
      const fs::file_time_type now = fs::file_time_type::clock::now();
      fs::last_write_time(farm.job.output, now - std::chrono::hours(2));
      fs::last_write_time(farm.folder.path() / input, now - std::chrono::hours(1));
      const KeyedOutcome outcome = require(farm.cook());
      EXPECT_EQ(outcome.how, has_journal ? How::kThere : How::kFromCache);
      EXPECT_GE(fs::last_write_time(farm.job.output), now - std::chrono::minutes(1));
    }
    farm.stores.journal = &farm.journal;
  }
}

// An editor saves the mesh while it is cooked: whatever the cook read, it is not kept.
TEST(KeyedCook, WhatChangesWhileItIsCookedIsNotKept) {
  for (const char* file : {"m.obj", "m.mtl"}) {
    Farm farm;
    const JobKey key = require(key_of(farm.job));
    const Result<KeyedOutcome> outcome =
        cook_by_key(farm.job, key, farm.stores, [&](const std::string& step) {
          if (step.starts_with("write")) farm.folder.write(file, kOther);
        });
    EXPECT_EQ(outcome.code(), Errc::kFileUnreadable);
    EXPECT_NE(outcome.error().detail.find(file), std::string::npos) << outcome.error().detail;
    EXPECT_FALSE(farm.journal.find(farm.job.output, key.key));
    EXPECT_FALSE(require(farm.cache.fetch(key.key, farm.job.output)));
  }
}

// A file that is read and not in the key would make stale hits: it is a defect, and told as one.
TEST(KeyedCook, WhatIsNotInTheKeyIsNotKept) {
  Farm farm;
  JobKey key = require(key_of(farm.job));
  key.files.pop_back();
  const Result<KeyedOutcome> outcome = cook_by_key(farm.job, key, farm.stores);
  EXPECT_EQ(outcome.code(), Errc::kInternal);
  EXPECT_NE(outcome.error().detail.find("m.mtl"), std::string::npos);
  EXPECT_FALSE(require(farm.cache.fetch(key.key, farm.job.output)));
}

TEST(KeyedCook, AnAuditFindsOtherBytesAndPutsThemRight) {
  Farm farm;
  farm.stores.journal = nullptr;
  ASSERT_TRUE(farm.cook());
  const std::string bytes = test::read_text(farm.job.output);
  farm.stores.audit_share = 1;
  EXPECT_FALSE(require(farm.cook()).difference);
  const Digest key = require(key_of(farm.job)).key;
  ASSERT_TRUE(farm.cache.store(key, farm.folder.write("lie", "another output"), ""));
  const KeyedOutcome audited = require(farm.cook());
  ASSERT_TRUE(audited.difference);
  EXPECT_NE(audited.difference->detail.find("audit"), std::string::npos);
  EXPECT_EQ(test::read_text(farm.job.output), bytes);
  farm.stores.audit_share = 0;
  fs::remove(farm.job.output);
  EXPECT_EQ(require(farm.cook()).how, How::kFromCache);
  EXPECT_EQ(test::read_text(farm.job.output), bytes);
}

TEST(KeyedCook, ACacheThatTakesNothingCostsNoOutput) {
  Farm farm;
  fs::remove_all(farm.folder.path() / "cache" / "cas");
  const KeyedOutcome outcome = require(farm.cook());
  EXPECT_EQ(outcome.how, How::kCooked);
  const std::vector<std::string> warnings = farm.cache.take_warnings();
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("cas"), std::string::npos) << warnings[0];
  EXPECT_TRUE(fs::exists(farm.job.output));
  EXPECT_EQ(require(farm.cook()).how, How::kThere);
}

TEST(KeyedCook, NothingThatIsReadIsWrittenOver) {
  Farm farm;
  ASSERT_TRUE(farm.cook());
  farm.job.output = farm.folder.path() / "m.mtl";
  EXPECT_EQ(farm.cook().code(), Errc::kWriteFailed);
  EXPECT_EQ(test::read_text(farm.job.output), "newmtl a\n");
}

TEST(KeyedCook, AnErrorIsNotKept) {
  Farm farm;
  farm.folder.write("m.obj", "v 0 0 0\nf 1 2 3\n");
  for (int i = 0; i < 2; ++i) EXPECT_EQ(farm.cook().code(), Errc::kMeshIndexOutOfRange);
  EXPECT_FALSE(fs::exists(farm.job.output));
}

}  // namespace
}  // namespace boxtree::cooker
