// SPDX-License-Identifier: MIT
// Runs each case as a test: Robustness.R07_...
#include <gtest/gtest.h>

#include "tests/robustness/run.h"

namespace boxtree::robustness {
namespace {

class RobustnessTest : public testing::Test {
 public:
  explicit RobustnessTest(const Case& tested) : case_(tested) {}

  void TestBody() override {
    const robustness::Run run = run_case(case_, false);
    std::string complaints;
    for (const std::string& complaint : run.complaints()) complaints += "\n  " + complaint;
    EXPECT_TRUE(run.passes(case_.limit)) << case_.what << ": " << run.figure() << " " << case_.unit
                                         << ", limit " << case_.limit << complaints;
  }

 private:
  Case case_;
};

void register_cases() {
  for (const Case& tested : all_cases()) {
    const std::string name = std::string(tested.id) + "_" + tested.name;
    testing::RegisterTest("Robustness", name.c_str(), nullptr, nullptr, __FILE__, __LINE__,
                          [tested]() -> testing::Test* { return new RobustnessTest(tested); });
  }
}

}  // namespace
}  // namespace boxtree::robustness

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  boxtree::robustness::register_cases();
  return RUN_ALL_TESTS();
}
