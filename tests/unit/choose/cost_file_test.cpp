// SPDX-License-Identifier: MIT
// Constants survive their file, and decide; what is missing or makes no sense is refused by name.
#include "cooker/choose/cost_file.h"

#include <functional>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cooker/cook.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"
#include "tests/support/temp_folder.h"

namespace boxtree::cooker {
namespace {

using Json = nlohmann::ordered_json;
using test::require;

Calibration compiled() {
  const std::span<const CodecCost> costs = compiled_costs();
  return {{costs.begin(), costs.end()}, 1.5};
}

TEST(CostFile, GivesBackWhatWasWritten) {
  const test::TempFolder folder;
  const auto path = folder.write("costs.json", costs_to_json(compiled()));
  const Calibration calibration = require(read_costs(path));
  const std::vector<CodecCost>& read = calibration.costs;
  ASSERT_EQ(read.size(), compiled_costs().size());
  EXPECT_EQ(calibration.worst_ratio, 1.5);
  EXPECT_EQ(calibration.timed_work.disturbance(), "");
  const WorkOfKinds work = {{{5, 2}, {6, 9}, {4, 8}, {3, 3}}};
  for (const CodecInfo& codec : kCodecs) {
    for (const GeometryId geometry : {GeometryId::kArrays, GeometryId::kExact, GeometryId::kGrid}) {
      for (const Precision precision : {Precision::kF32, Precision::kF64}) {
        EXPECT_EQ(cost_of(work, codec.id, geometry, precision, read),
                  cost_of(work, codec.id, geometry, precision));
      }
    }
  }
  EXPECT_EQ(read_costs(folder.path() / "none").code(), Errc::kFileNotFound);
}

TEST(CostFile, RefusesWhatIsNotOneSensibleRowForEach) {
  const Json good = Json::parse(costs_to_json(compiled()));
  const auto refusal = [&](const std::function<void(Json&)>& spoil) {
    Json bad = good;
    spoil(bad);
    const auto parsed = parse_costs(bad.dump());
    if (parsed) return std::string("accepted");
    EXPECT_EQ(parsed.code(), Errc::kDocumentInvalid);
    return parsed.error().detail;
  };
  EXPECT_EQ(refusal([](Json&) {}), "accepted");
  EXPECT_EQ(
      refusal([](Json& j) { j = Json::array(); }),
      "costs: expected an object with an array \"costs\", as `bench --calibrate --json` prints it");
  EXPECT_EQ(
      refusal([](Json& j) { j.erase("costs"); }),
      "costs: expected an object with an array \"costs\", as `bench --calibrate --json` prints it");
  EXPECT_EQ(refusal([](Json& j) { j["costs"].erase(0); }),
            "costs: plain-f32, arrays, f32: expected one row, found 0");
  EXPECT_EQ(refusal([](Json& j) { j["costs"].push_back(j["costs"][0]); }),
            "costs: plain-f32, arrays, f32: expected one row, found 2");
  EXPECT_EQ(refusal([](Json& j) { j["costs"][1] = 3; }), "costs: row 1: expected an object");
  EXPECT_EQ(refusal([](Json& j) { j["costs"][0]["codec"] = "wide9"; }),
            "costs: row 0: unknown codec \"wide9\"");
  EXPECT_EQ(refusal([](Json& j) { j["costs"][0]["geometry"] = "external"; }),
            "costs: row 0: geometry \"external\": expected arrays, exact or grid");
  EXPECT_EQ(refusal([](Json& j) { j["costs"][0]["positions"] = "f16"; }),
            "costs: row 0: positions \"f16\": expected f32 or f64");
  EXPECT_EQ(refusal([](Json& j) { j["costs"].erase(j["costs"].size() - 1); }),
            "costs: wide4, exact, f64: expected one row, found 0");
  EXPECT_EQ(refusal([](Json& j) { j["costs"][0].erase("box"); }),
            "costs: plain-f32, arrays: expected an object \"box\"");
  EXPECT_EQ(refusal([](Json& j) { j["costs"][0]["ray"].erase("node_ns"); }),
            "costs: plain-f32, arrays, ray: expected \"node_ns\", nanoseconds, 0 or more, found "
            "nothing");
  for (const Json& value : {Json(-1), Json("7"), Json(nullptr)}) {
    EXPECT_EQ(
        refusal([&](Json& j) { j["costs"][0]["ray"]["leaf_ns"] = value; }),
        "costs: plain-f32, arrays, ray: expected \"leaf_ns\", nanoseconds, 0 or more, found " +
            value.dump());
  }
  EXPECT_EQ(refusal([](Json& j) {
              j["costs"][0]["ray"] = {{"query_ns", 0}, {"node_ns", 0}, {"leaf_ns", 0}};
            }),
            "costs: plain-f32, arrays, ray: all steps are 0, but no query is free");
  EXPECT_EQ(refusal([](Json& j) { j["processor_share"] = -0.5; }),
            "costs: expected \"processor_share\", 0 or more, found -0.5");
  EXPECT_EQ(refusal([](Json& j) { j["speed_ratio"] = "1"; }),
            "costs: expected \"speed_ratio\", 1 or more, found \"1\"");
  EXPECT_EQ(refusal([](Json& j) { j["worst_ratio"] = 0.5; }),
            "costs: expected \"worst_ratio\", 1 or more, found 0.5");
  for (const char* schema : {"2", "\"1\"", "null", "1.5"}) {
    EXPECT_EQ(refusal([&](Json& j) { j["schema"] = Json::parse(schema); }),
              std::string("costs: expected \"schema\": 1, found ") + schema +
                  ": as another version prints it");
  }
  EXPECT_EQ(parse_costs("{").error().detail,
            "costs: expected JSON, as `bench --calibrate --json` prints it");
  // Numbers that double cannot hold.
  EXPECT_FALSE(parse_costs(R"({"costs":[{"codec":"wide8","geometry":"exact","ray":)"
                           R"({"query_ns":1e999,"node_ns":1,"leaf_ns":1}}]})"));
}

// Found by a newcomer: constants that a warning had called wrong chose without another.
TEST(CostFile, TellsHowItWasMeasured) {
  Json document = Json::parse(costs_to_json(compiled()));
  document["speed_ratio"] = 1.45;
  EXPECT_EQ(require(parse_costs(document.dump())).timed_work.disturbance(),
            TimedWork(1, 1, 1.45).disturbance());
  document["processor_share"] = 0.25;
  EXPECT_EQ(require(parse_costs(document.dump())).timed_work.disturbance(),
            TimedWork(0.25, 1, 1.45).disturbance());
  // Files of earlier versions do not say.
  for (const char* key : {"processor_share", "speed_ratio", "worst_ratio"}) document.erase(key);
  EXPECT_EQ(require(parse_costs(document.dump())).timed_work.disturbance(), "");
}

// On a machine where wide4 were a hundred times as fast, it would be the fastest.
TEST(CostFile, OwnConstantsDecide) {
  const SourceMesh mesh = test::torus(24, 40);
  CookOptions options;
  options.wishes.goal = Goal::kSpeed;
  EXPECT_EQ(require(cook_mesh(mesh, options)).tree.nodes.codec, CodecId::kWide8);
  options.costs = compiled().costs;
  for (CodecCost& cost : options.costs) {
    if (cost.codec != CodecId::kWide4) continue;
    for (StepCost& step : cost.of_kind) {
      step = {step.query / 100, step.node / 100, step.leaf / 100};
    }
  }
  EXPECT_EQ(require(cook_mesh(mesh, options)).tree.nodes.codec, CodecId::kWide4);
}

}  // namespace
}  // namespace boxtree::cooker
