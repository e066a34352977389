// SPDX-License-Identifier: MIT
// Points against files that were really written and surfaces that were really decoded; curves where
// theory orders them; the page and its data against the points.
#include <array>
#include <cmath>
#include <map>
#include <regex>
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cooker/report/tradeoff_advice.h"
#include "cooker/report/tradeoff_page.h"
#include "runtime/tree/bound_tree.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"
#include "tests/support/temp_folder.h"

namespace boxtree::cooker {
namespace {

using test::require;

const SourceMesh& mesh() {
  static const SourceMesh torus = [] {
    SourceMesh made = test::torus(24, 40);
    made.name = "<torus> & co";
    return made;
  }();
  return torus;
}

// Without times: every figure is the same on every machine.
const MeshTradeoff& counted() {
  static const MeshTradeoff tradeoff = require(measure_tradeoff(mesh(), {false, false}));
  return tradeoff;
}

const TradePoint* find(CodecId codec, int grid_bits) {
  for (const TradePoint& point : counted().points) {
    if (is_wide(codec) && point.geometry == GeometryId::kArrays) continue;
    if (point.codec == codec && point.grid_bits == grid_bits) return &point;
  }
  return nullptr;
}

TEST(Tradeoff, EveryCodecIsExactAndTheWideOnesSweepTheGrids) {
  std::set<std::pair<CodecId, int>> found;
  for (const TradePoint& point : counted().points) found.insert({point.codec, point.grid_bits});
  std::set<std::pair<CodecId, int>> expected;
  for (const CodecInfo& codec : kCodecs) expected.insert({codec.id, 0});
  for (const int bits : {8, 10, 12, 14, 16, 18, 21, 24, 27, 30}) {
    expected.insert({CodecId::kWide8, bits});
    expected.insert({CodecId::kWide4, bits});
  }
  EXPECT_EQ(found, expected);
  EXPECT_EQ(counted().points.size(), expected.size() + 2);  // wide codecs have arrays, too
}

// As cook --strip writes them.
TEST(Tradeoff, BytesAreThoseOfTheFileThatACookWrites) {
  for (const TradePoint& point : counted().points) {
    CookOptions options;
    options.geometry = point.geometry;
    if (point.grid_bits != 0) options.grid.bits = point.grid_bits;
    options.codec = point.codec;
    EncodedTree tree = require(cook_as(mesh(), point.codec, options));
    tree.name.clear();
    EXPECT_EQ(point.bytes.total(), serialize(std::span(&tree, 1)).size()) << point.name();
    EXPECT_EQ(point.bytes.nodes, tree.nodes.bytes.size()) << point.name();
    EXPECT_GT(point.bytes.rest, 0u) << point.name();
  }
}

// A file smaller than some ten pages is read as a whole or in part, and opening reads its head.
TEST(Tradeoff, PagesAreThoseOfTheFile) {
  for (const TradePoint& point : counted().points) {
    const PageFigures& pages = point.pages;
    EXPECT_EQ(pages.file_pages, (point.bytes.total() + 4095) / 4096) << point.name();
    EXPECT_EQ(pages.open, 1u) << point.name();
    for (const PageCount& count : {pages.ray, pages.box, pages.point}) {
      EXPECT_EQ(count.queries, 300u) << point.name();
      EXPECT_GE(count.median, pages.open) << point.name();
      EXPECT_LE(count.median, count.worst) << point.name();
      EXPECT_LE(count.worst, pages.file_pages) << point.name();
    }
    EXPECT_GT(pages.point.median, pages.open) << point.name();
  }
}

TEST(Tradeoff, EveryPointPassesItsGates) {
  for (const TradePoint& point : counted().points) EXPECT_TRUE(point.gates.pass()) << point.name();
}

// Largest distance of a decoded corner from the source's, found by the face ids of an opened file.
double decoded_move(int grid_bits) {
  CookOptions options;
  options.geometry = GeometryId::kGrid;
  options.grid.bits = grid_bits;
  const test::CookedTree cooked = test::cook_tree(mesh(), CodecId::kWide8, options);
  double largest = 0;
  std::size_t triangles = 0;
  std::vector<Node> pending = {BoundTree::of(cooked.tree).root()};
  while (!pending.empty()) {
    const Node node = pending.back();
    pending.pop_back();
    if (!node.is_leaf) {
      NodeChildren children;
      EXPECT_EQ(BoundTree::of(cooked.tree).expand(node, children), NodeState::kValid);
      for (std::uint32_t i = 0; i < children.count; ++i) pending.push_back(children.child[i]);
      continue;
    }
    TriangleBatch batch;
    EXPECT_EQ(BoundTree::of(cooked.tree).leaf_triangles(node, batch), Errc::kOk);
    for (std::uint32_t i = 0; i < batch.count; ++i, ++triangles) {
      const Face& face = mesh().faces[BoundTree::of(cooked.tree).face_id(batch.face[i])];
      if (face.is_quad()) throw std::logic_error("triangles alone are compared here");
      for (std::size_t k = 0; k < 3; ++k) {
        const Eigen::Vector3d corner =
            BoundTree::of(cooked.tree).frame().to_object(batch.triangle(i).corner[k]);
        largest = std::max(largest, (corner - mesh().positions[face.corner[k]]).norm());
      }
    }
  }
  EXPECT_EQ(triangles, mesh().triangle_count());
  return largest;
}

TEST(Tradeoff, SurfaceMovesAsFarAsTheDecodedTrianglesTell) {
  for (const int bits : {8, 14, 21, 30}) {
    const double diagonal = counted().diagonal;
    const TradePoint& point = *find(CodecId::kWide8, bits);
    // Decoding goes through tree space and back: a few roundings of numbers of the mesh's size.
    EXPECT_NEAR(point.surface_max, decoded_move(bits) / diagonal, 1e-14) << bits;
  }
}

TEST(Tradeoff, SurfaceAndBytesOfGridsAreMonotoneAndWithinTheBound) {
  for (const CodecId codec : {CodecId::kWide8, CodecId::kWide4}) {
    const TradePoint* coarser = nullptr;
    for (const int bits : grid_sweep(false)) {
      const TradePoint& point = *find(codec, bits);
      EXPECT_GT(point.surface_max, 0) << point.name();
      EXPECT_LE(point.surface_max, point.surface_bound * (1 + 1e-12)) << point.name();
      EXPECT_LE(point.surface_rms, point.surface_max) << point.name();
      EXPECT_GT(point.surface_rms, 0) << point.name();
      // The closest point of a surface that moves by at most so much, but for roundings.
      EXPECT_LE(point.answers.distance_max, point.surface_max + 1e-14) << point.name();
      EXPECT_LE(point.answers.distance_median, point.answers.distance_max);
      if (coarser != nullptr) {
        EXPECT_LT(point.surface_max, coarser->surface_max) << point.name();
        EXPECT_LT(point.surface_rms, coarser->surface_rms) << point.name();
        EXPECT_GE(point.bytes.vertices, coarser->bytes.vertices) << point.name();
      }
      coarser = &point;
    }
  }
}

TEST(Tradeoff, ExactGeometryGivesTheAnswersOfTheReference) {
  for (const TradePoint& point : counted().points) {
    if (point.grid_bits != 0) continue;
    EXPECT_EQ(point.surface_max, 0) << point.name();
    EXPECT_EQ(point.answers.distance_max, 0) << point.name();
    EXPECT_EQ(point.answers.flips_per_million, 0) << point.name();
    EXPECT_EQ(point.answers.ray_median, 0) << point.name();
  }
  EXPECT_GT(find(CodecId::kWide8, 8)->answers.distance_max, 0);
  EXPECT_GT(find(CodecId::kWide8, 8)->answers.ray_median, 0);
}

// What overlaps a box overlaps every box around it. Rays and closest points visit the nearest box
// first, so that single queries may gain by coarser ones; between wide8 and wide4 the mean may
// not.
TEST(Tradeoff, CoarserBoxesNeverSaveWork) {
  constexpr auto kBox = static_cast<std::size_t>(QueryKind::kBox);
  for (const TradePoint& point : counted().points) {
    if (point.codec == CodecId::kWide4) {
      const TradePoint& finer = *find(CodecId::kWide8, point.grid_bits);
      for (std::size_t kind = 0; kind < kQueryKinds; ++kind) {
        EXPECT_GE(point.work[kind].nodes, finer.work[kind].nodes) << point.name() << kind;
        EXPECT_GE(point.work[kind].leaves, finer.work[kind].leaves) << point.name() << kind;
      }
    }
    if (point.grid_bits == 0) {
      EXPECT_GE(point.false_leaf_tests[kBox], 0) << point.name();
    }
  }
  // Lossless codecs of one tree do the same work, to the last node.
  for (const CodecId codec : {CodecId::kPackedF32, CodecId::kPackedF64, CodecId::kDedup}) {
    for (std::size_t kind = 0; kind < kQueryKinds; ++kind) {
      EXPECT_EQ(find(codec, 0)->extra_nodes[kind], 0) << codec_name(codec) << kind;
      EXPECT_EQ(find(codec, 0)->false_leaf_tests[kind], 0) << codec_name(codec) << kind;
    }
  }
  EXPECT_GT(find(CodecId::kWide4, 0)->extra_nodes[0], 0);
}

TEST(Tradeoff, TimesComeInOrder) {
  const MeshTradeoff timed = require(measure_tradeoff(test::sphere(8, 12), {true, true}));
  for (const TradePoint& point : timed.points) {
    for (const KindTimes& times : point.times) {
      EXPECT_GT(times.median_ns, 0) << point.name();
      EXPECT_LE(times.median_ns, times.p99_ns) << point.name();
      EXPECT_LE(times.mean_ns, times.p99_ns * 100) << point.name();
    }
  }
}

TEST(Tradeoff, AToleranceHasTheGridThatCookTakesForIt) {
  TradeoffOptions options{true, false};
  options.tolerance = 1e-3;
  const MeshTradeoff made = require(measure_tradeoff(mesh(), options));
  std::size_t found = 0;
  int bits = 0;
  for (const TradePoint& point : made.points) {
    if (point.codec == CodecId::kWide8 && point.grid_bits != 0) {
      EXPECT_GE(point.grid_bits, bits) << "curves follow the grids";
      bits = point.grid_bits;
    }
    if (!point.tolerance) continue;
    ++found;
    EXPECT_EQ(point.name(), std::string(codec_name(point.codec)) + ", tolerance 0.001");
    CookOptions cook;
    cook.geometry = GeometryId::kGrid;
    cook.grid.tolerance = options.tolerance;
    EncodedTree tree = require(cook_as(mesh(), point.codec, cook));
    tree.name.clear();
    EXPECT_EQ(point.bytes.total(), serialize(std::span(&tree, 1)).size());
    EXPECT_LE(point.surface_max, made.tolerance_left);
    EXPECT_EQ(point.surface_max * made.diagonal, tree.geometry.max_vertex_error);
    EXPECT_NE(cook_options(made, point)
                  .find("--grid-step 2^" + std::to_string(tree.geometry.grid_exponent) + " "),
              std::string::npos);
  }
  EXPECT_EQ(found, 2u);
  // It is the limit of what is recommended, and of what cook takes.
  const auto advice = advise(made);
  ASSERT_TRUE(advice);
  EXPECT_TRUE(made.points[advice->smallest].tolerance);
  EXPECT_NE(advice_in_words(made)[0].lead.find("(surface within the tolerance of 0.001)"),
            std::string::npos);
  CookOptions cook;
  cook.wishes.goal = Goal::kMemory;
  cook.may_use_grid = cook.may_use_arrays = cook.try_all = true;
  cook.grid.tolerance = options.tolerance;
  const TradePoint& chosen = made.points[cooks_choice(made, Goal::kMemory).value()];
  EXPECT_TRUE(chosen.tolerance);
  EXPECT_EQ(chosen.codec, require(cook_mesh(mesh(), cook)).tree.nodes.codec);
}

// Figures are of the positions that were read; how far those are from the source stands beside
// them.
TEST(Tradeoff, TellsHowFarF32MovedTheMesh) {
  SourceMesh far = mesh();
  far.moved_by_f32 = 0.25;
  far.f32_loss = F32Loss::kReader;
  TradeoffReport report;
  report.meshes = {require(measure_tradeoff(far, {true, false}))};
  const MeshTradeoff& made = report.meshes.front();
  EXPECT_EQ(made.moved_by_f32, 0.25);
  for (const TradePoint& point : made.points) {
    EXPECT_LE(point.surface_max, point.grid_bits == 0    ? 0
                                 : point.grid_bits == 24 ? 1e-6
                                                         : 1)
        << point.name();
  }
  ASSERT_TRUE(advise(made));
  const std::string page = to_text(tradeoff_page(report));
  EXPECT_NE(page.find("as f32 moved a vertex by up to"), std::string::npos);
  EXPECT_NE(page.find("its reader has f32 alone"), std::string::npos);
  EXPECT_NE(page.find("No position changes by a single bit of f32."), std::string::npos);
  EXPECT_EQ(to_text(tradeoff_page({.meshes = {counted()}})).find("moved a vertex"),
            std::string::npos);
}

TEST(Tradeoff, CommandsOfAMeshInF64ReadItSo) {
  SourceMesh precise = mesh();
  precise.positions.precision = Precision::kF64;
  precise.positions.f64.assign(precise.positions.f32.begin(), precise.positions.f32.end());
  precise.positions.f32.clear();
  const MeshTradeoff made = require(measure_tradeoff(precise, {true, false}));
  for (const TradePoint& point : made.points) {
    EXPECT_NE(cook_options(made, point).find(" --f64 "), std::string::npos);
  }
  // cook --f64 tries no grid unless told one.
  EXPECT_EQ(made.points[cooks_choice(made, Goal::kMemory).value()].grid_bits, 0);
}

TEST(Tradeoff, CommandsOfAMeshWithoutItsBadFacesLeaveThemOut) {
  MeshTradeoff made = require(measure_tradeoff(mesh(), {true, false}));
  EXPECT_EQ(cook_options(made, made.points.front()).find("--skip-bad"), std::string::npos);
  made.skipped = 3;
  for (const TradePoint& point : made.points) {
    EXPECT_NE(cook_options(made, point).find(" --skip-bad "), std::string::npos);
  }
}

TEST(Tradeoff, RefusesAMeshWithoutFaces) {
  EXPECT_EQ(measure_tradeoff({}, {}).code(), Errc::kNoFaces);
}

TEST(ParetoFront, HoldsWhatNothingBeats) {
  const std::array<TwoCosts, 7> points = {{{3, 3}, {1, 5}, {2, 5}, {2, 4}, {5, 1}, {5, 2}, {2, 4}}};
  EXPECT_EQ(pareto_front(points), (std::vector<std::size_t>{1, 3, 0, 4}));
  EXPECT_TRUE(pareto_front({}).empty());

  // Against the definition, point by point.
  std::vector<TwoCosts> many;
  std::uint32_t state = 1;
  const auto next = [&state] {
    state = state * 1664525u + 1013904223u;
    return static_cast<double>(state >> 28);  // 16 values: many ties
  };
  for (int i = 0; i < 60; ++i) {
    const double x = next();
    many.push_back({x, next()});
  }
  const std::vector<std::size_t> front = pareto_front(many);
  for (std::size_t i = 0; i < many.size(); ++i) {
    bool is_beaten = false;
    for (std::size_t j = 0; j < many.size(); ++j) {
      const bool no_worse = many[j].x <= many[i].x && many[j].y <= many[i].y;
      const bool better = many[j].x < many[i].x || many[j].y < many[i].y;
      const bool earlier_twin = no_worse && !better && j < i;
      is_beaten |= (no_worse && better) || earlier_twin;
    }
    const bool in_front = std::find(front.begin(), front.end(), i) != front.end();
    EXPECT_EQ(in_front, !is_beaten) << many[i].x << ' ' << many[i].y;
  }
}

MeshTradeoff three_points() {
  MeshTradeoff made;
  made.name = "made up";
  made.triangles = 100;
  made.diagonal = 2;
  made.source.vertices = 1000;
  made.timed = true;
  const auto add = [&](CodecId codec, int bits, std::uint64_t bytes, double moved, double ns) {
    TradePoint point;
    point.codec = codec;
    point.grid_bits = bits;
    point.geometry = bits == 0 ? GeometryId::kExact : GeometryId::kGrid;
    point.bytes.nodes = bytes;
    point.surface_max = moved;
    point.gates.certificate = true;
    for (KindTimes& times : point.times) times = {ns, 2 * ns, ns};
    made.points.push_back(point);
  };
  add(CodecId::kWide8, 0, 1300, 0, 100);
  add(CodecId::kWide4, 0, 1200, 0, 150);
  add(CodecId::kWide4, 8, 200, 3e-3, 200);  // small, but farther off than any choice allows
  add(CodecId::kWide4, 14, 400, 5e-5, 200);
  add(CodecId::kWide8, 24, 800, 4e-8, 120);
  made.points[0].geometry = GeometryId::kArrays;
  return made;
}

TEST(Advice, SaysThatOtherProgramsDisturbedTheTimes) {
  const auto page = [](double processor_seconds, bool timed, double speed_ratio = 1) {
    MeshTradeoff made = three_points();
    made.timed = timed;
    made.timed_work = {processor_seconds, 10, speed_ratio};
    TradeoffReport report;
    report.meshes = {made};
    const Page whole = tradeoff_page(report);
    return to_text(whole) + to_html(whole);
  };
  EXPECT_EQ(page(10, true).find("disturbed"), std::string::npos);
  EXPECT_EQ(page(4, false).find("disturbed"), std::string::npos);
  EXPECT_NE(page(4, true).find("Times were disturbed: other programs had the processor for 60 % of "
                               "the time in which queries were timed"),
            std::string::npos);
  // So each of them has a mark.
  EXPECT_NE(page(4, true).find("Disturbed times are behind a ~."), std::string::npos);
  EXPECT_NE(page(4, true).find("a ray takes ~120 ns"), std::string::npos);
  EXPECT_EQ(page(10, true).find("~120 ns"), std::string::npos);
  // Whatever the page says of slowdowns is said of the same times.
  EXPECT_NE(page(10, true).find("go by the times on this page"), std::string::npos);
  EXPECT_NE(page(10, true).find("of the measured mean times"), std::string::npos);
  EXPECT_NE(page(4, true).find("go by the modelled times"), std::string::npos);
  EXPECT_NE(page(4, true).find("of the modelled mean times"), std::string::npos);
  EXPECT_EQ(page(4, true).find("of the measured mean times"), std::string::npos);
  EXPECT_NE(page(10, true, 1.4)
                .find("Times were disturbed: the processor took up to 40 % longer for "
                      "the same work at some times than at others"),
            std::string::npos);
}

TEST(Advice, IsTheMinimumWithinEachLimit) {
  MeshTradeoff made = three_points();
  const auto advice = advise(made);
  ASSERT_TRUE(advice);
  EXPECT_EQ(advice->smallest, 3u);
  EXPECT_EQ(advice->balanced, 4u);  // 800 * 1.2 < 1300 * 1 < 1200 * 1.5
  EXPECT_EQ(advice->fastest_exact, 0u);
  EXPECT_EQ(advice->smallest_exact, 1u);
  const std::vector<PageConclusion> words = advice_in_words(made);
  ASSERT_EQ(words.size(), 4u);
  EXPECT_EQ(
      words[0].lead,
      "Balanced, for most uses (surface within a millionth of the diagonal): wide8, grid 24.");
  EXPECT_EQ(
      words[0].text,
      "8.00 bytes per triangle, a file of 800 bytes, tree included: 80 % of what positions "
      "and corners of the source alone take; "
      "8.00 with geometry and without face ids, as cook counts. No point of the "
      "surface moves by more than 4e-08 of the diagonal (8e-08 units of the mesh). In the mean a "
      "ray takes 120 ns, a box 120 ns, a closest point 120 ns, all "
      "contacts 120 ns (one in a hundred takes longer than 240 ns, 240 ns, 240 ns and "
      "240 ns). Slowdown: 1.20.");
  EXPECT_EQ(words[0].command,
            "boxtree cook MESH -o FILE.bxt --codec wide8 --grid-bits 24 --flatten --strip");
  EXPECT_EQ(made.file_name, "");
  made.file_name = "my mesh.obj";
  EXPECT_EQ(advice_in_words(made)[0].command,
            "boxtree cook 'my mesh.obj' -o 'my mesh.bxt' --codec wide8 --grid-bits 24 --flatten "
            "--strip");
  EXPECT_NE(words[3].text.find("No position changes by a single bit."), std::string::npos);
  EXPECT_NE(words[3].command.find("--codec wide4 --exact"), std::string::npos);
  // Two stores keep every bit; the goal says which.
  EXPECT_NE(words[3].command.find("--codec wide4 --exact --for memory"), std::string::npos);
  made.points[1].geometry = GeometryId::kArrays;
  EXPECT_NE(advice_in_words(made)[3].command.find("--codec wide4 --exact --for speed"),
            std::string::npos);
  made.points[1].geometry = GeometryId::kExact;

  // What fails its gates is no choice, however good.
  made.points[4].gates.missed = 1;
  EXPECT_EQ(advise(made)->balanced, 0u);
  for (TradePoint& point : made.points) point.gates.missed = 1;
  EXPECT_FALSE(advise(made));
}

// Found by a newcomer: the balanced choice is not always what cook takes by itself.
TEST(Advice, SaysWhatCookTakesWhereThatIsAnother) {
  const auto says = [](const MeshTradeoff& made) {
    TradeoffReport report;
    report.meshes = {made};
    const std::string name = made.points[cooks_choice(made, Goal::kBalance).value()].name();
    return to_text(tradeoff_page(report)).find("Unless told a codec, boxtree cook takes " + name +
                                               ". It counts nodes and geometry alone") !=
           std::string::npos;
  };
  MeshTradeoff made = three_points();
  for (TradePoint& point : made.points) point.modelled = {100, 100, 100, 100};
  EXPECT_EQ(made.points[cooks_choice(made, Goal::kBalance).value()].name(), "wide8, grid 24");
  EXPECT_FALSE(says(made));
  made.points[0].bytes.nodes = 700;
  made.points[0].bytes.face_ids = 900;  // which cook does not weigh
  EXPECT_EQ(made.points[advise(made)->balanced].name(), "wide8, grid 24");
  EXPECT_TRUE(says(made));
}

// Found by a newcomer: of two encodings of one size the slower one was the smallest.
TEST(Advice, OfEqualSizesTheFasterOneIsTheSmallest) {
  MeshTradeoff made = three_points();
  std::swap(made.points[0], made.points[1]);
  made.points[0].bytes = made.points[1].bytes;
  EXPECT_EQ(advise(made)->smallest_exact, 1u);
}

// Found by a newcomer: "Balanced ...; also: Fastest ..." read as if another encoding followed.
TEST(Advice, AnEncodingThatIsBestInSeveralWaysIsNamedOnce) {
  const auto leads = [](const MeshTradeoff& made) {
    std::vector<std::string> said;
    for (const PageConclusion& words : advice_in_words(made)) said.push_back(words.lead);
    return said;
  };
  using Leads = std::vector<std::string>;
  MeshTradeoff made = three_points();
  made.points[4].bytes = made.points[0].bytes;
  EXPECT_EQ(leads(made),
            (Leads{"Balanced, and also the fastest with every position bit for bit: wide8, arrays.",
                   "Smallest (surface within a ten-thousandth of the diagonal): wide4, grid 14.",
                   "Smallest with every position bit for bit: wide4, exact."}));
  made.points[3].gates.missed = 1;
  EXPECT_EQ(leads(made),
            (Leads{"Balanced, and also the fastest with every position bit for bit: wide8, arrays.",
                   "Smallest, with every position bit for bit: wide4, exact."}));
  made.points[1].bytes = made.points[4].bytes = {2000};
  EXPECT_EQ(leads(made), (Leads{"Balanced and smallest, and also the fastest with every position "
                                "bit for bit: wide8, arrays."}));

  made = three_points();
  made.points[1].bytes = {1400};
  made.points[3].gates.missed = 1;
  EXPECT_EQ(leads(made),
            (Leads{"Balanced (surface within a millionth of the diagonal), and also the smallest "
                   "(surface within a ten-thousandth of the diagonal): wide8, grid 24.",
                   "Fastest and smallest with every position bit for bit: wide8, arrays."}));
  made.tolerance = 0.5;
  made.tolerance_left = 1e-5;
  EXPECT_EQ(leads(made)[0],
            "Balanced and smallest (surface within the tolerance of 0.5): wide8, grid 24.");
  made.points[4].gates.missed = 1;
  made.points[1].bytes = {700};
  EXPECT_EQ(leads(made), (Leads{"Balanced and smallest (surface within the tolerance of 0.5), with "
                                "every position bit for bit: wide4, exact.",
                                "Fastest with every position bit for bit: wide8, arrays."}));
}

// A coarse grid makes points of triangles, which are tested in no time.
TEST(Advice, TheFastestHasTheSurfaceOfTheMesh) {
  MeshTradeoff made = three_points();
  for (KindTimes& times : made.points[2].times) times = {50, 100, 50};
  EXPECT_EQ(advise(made)->fastest_exact, 0u);
  made.points[1].times = made.points[2].times;
  EXPECT_EQ(advise(made)->fastest_exact, 1u);
}

TEST(Advice, SlowdownsAreRelativeToWide8WithArrays) {
  MeshTradeoff made = three_points();
  EXPECT_EQ(slowdowns_of(made), (std::vector<double>{1, 1.5, 2, 2, 1.2}));
  // Of mean times, as cook's, and of the kinds that cook takes: not of first contacts.
  for (KindTimes& times : made.points[2].times) times.median_ns = 1;
  made.points[2].times[kFirstContact].mean_ns = 1;
  EXPECT_EQ(slowdowns_of(made)[2], 2);
  made.points[1].times[0].mean_ns = 50;  // faster than the baseline for rays alone
  EXPECT_EQ(slowdowns_of(made)[0], 1);
  EXPECT_EQ(slowdowns_of(made)[1], (0.5 + 3 * 1.5) / 4);
}

// Found by a newcomer: on a busy machine the page advised wide4, which took longer than wide8.
TEST(Advice, DisturbedTimesDecideNothing) {
  MeshTradeoff made = three_points();
  for (TradePoint& point : made.points) point.modelled = {100, 100, 100, 100};
  made.points[4].modelled = {300, 300, 300, 300};
  for (KindTimes& times : made.points[1].times) times = {50, 100, 50};
  EXPECT_EQ(slowdowns_of(made), (std::vector<double>{1, 0.5, 2, 2, 1.2}));
  EXPECT_EQ(advise(made)->fastest_exact, 1u);
  made.timed_work = {4, 10};
  EXPECT_EQ(slowdowns_of(made), (std::vector<double>{1, 1, 1, 1, 3}));
  EXPECT_EQ(advise(made)->fastest_exact, 0u);
}

// Without times, the page's slowdowns are the numbers that `cook --candidates` prints.
TEST(Advice, SlowdownsByCountedWorkAreThoseOfCook) {
  CookOptions options;
  options.may_use_grid = true;
  options.may_use_arrays = true;
  options.try_all = true;
  const CookedTree cooked = require(cook_mesh(mesh(), options));
  const std::vector<double> of_cook = slowdowns(cooked.contest);
  const std::vector<double> of_page = slowdowns_of(counted());
  std::size_t compared = 0;
  for (std::size_t c = 0; c < of_cook.size(); ++c) {
    const Candidate& candidate = cooked.contest.candidates[c];
    const int bits = candidate.geometry == GeometryId::kGrid ? GridChoice().bits : 0;
    for (std::size_t i = 0; i < of_page.size(); ++i) {
      const TradePoint& point = counted().points[i];
      if (point.codec != candidate.codec || point.geometry != candidate.geometry ||
          point.grid_bits != bits) {
        continue;
      }
      EXPECT_DOUBLE_EQ(of_page[i], of_cook[c]) << point.name();
      ++compared;
    }
  }
  EXPECT_GE(compared, 6u);
}

// `cook --for memory` takes arrays where they are smaller, so no command makes the clusters.
TEST(Advice, ClustersLargerThanArraysAreNotRecommended) {
  MeshTradeoff made = three_points();
  TradePoint arrays = made.points[1];
  arrays.geometry = GeometryId::kArrays;
  made.points[1].bytes = {1000, 150, 50, 0, 0};
  arrays.bytes = {1000, 100, 101, 0, 0};
  made.points.push_back(arrays);
  EXPECT_EQ(advise(made)->smallest_exact, 1u);
  made.points.back().bytes = {1000, 100, 99, 0, 60};  // more in all, by padding
  EXPECT_FALSE(may_be_advised(made)[1]);
  EXPECT_EQ(advise(made)->smallest_exact, 5u);
}

TEST(Advice, CodecsOfThePaperAreThereToCompareWith) {
  MeshTradeoff made = three_points();
  made.points[0].codec = CodecId::kPackedF16;
  EXPECT_EQ(advise(made)->fastest_exact, 1u);
  for (std::size_t i = 1; i < made.points.size(); ++i) made.points[i].gates.missed = 1;
  EXPECT_EQ(advise(made)->fastest_exact, 0u);
}

TEST(Advice, TellsWhatCookChooses) {
  for (const Goal goal : {Goal::kMemory, Goal::kSpeed, Goal::kBalance}) {
    CookOptions options;
    options.wishes.goal = goal;
    options.may_use_grid = true;
    options.may_use_arrays = true;
    options.try_all = true;
    const CookedTree cooked = require(cook_mesh(mesh(), options));
    const auto place = cooks_choice(counted(), goal);
    ASSERT_TRUE(place);
    const TradePoint& point = counted().points[*place];
    EXPECT_EQ(point.codec, cooked.tree.nodes.codec) << goal_name(goal);
    EXPECT_EQ(point.geometry, cooked.tree.geometry.geometry) << goal_name(goal);
  }
  EXPECT_FALSE(cooks_choice({}, Goal::kBalance));
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) {
    ++found;
  }
  return found;
}

TradeoffReport sample_report() {
  TradeoffReport report;
  report.meshes = {counted()};
  report.surroundings = surroundings("boxtree report <torus>.obj");
  report.no_peers = "--no-times";
  return report;
}

TEST(TradeoffPage, IsOneWellFormedPageWithoutNetwork) {
  const std::string html = to_html(tradeoff_page(sample_report()));
  EXPECT_EQ(html.find("http:"), std::string::npos);
  EXPECT_EQ(html.find("https:"), std::string::npos);
  EXPECT_EQ(html.find("<script"), std::string::npos);
  EXPECT_EQ(html.find("<torus>"), std::string::npos) << "a name is no markup";
  EXPECT_FALSE(std::regex_search(html, std::regex("[ \">(MLHV]-?(nan|inf)[ \"<)HVL]")));
  // Every element that opens is closed, innermost first.
  std::vector<std::string> open;
  const std::regex tag("<(/?)([a-z0-9]+)([^<>]*)>");
  const std::set<std::string> alone = {"meta"};
  for (std::sregex_iterator it(html.begin(), html.end(), tag), end; it != end; ++it) {
    const std::string name = (*it)[2];
    const std::string rest = (*it)[3];
    if (alone.contains(name) || (!rest.empty() && rest.back() == '/')) continue;
    if ((*it)[1] == "") {
      open.push_back(name);
    } else {
      ASSERT_FALSE(open.empty()) << name;
      ASSERT_EQ(open.back(), name);
      open.pop_back();
    }
  }
  EXPECT_TRUE(open.empty());
  // Error and bytes for each of four kinds, two of work for each, three of approximate queries for
  // each of two, and the bars.
  EXPECT_EQ(count(html, "<svg"), 4u * 2 + 4u * 2 + 2u * 3 + 1);
}

TEST(TradeoffPage, MarksOfPlotsLieInsideTheirFrames) {
  const std::string html = to_html(tradeoff_page(sample_report()));
  const std::regex view(
      "viewBox=\"0 0 ([0-9]+) ([0-9]+)\"|<circle cx=\"([^\"]+)\" cy=\"([^\"]+)\"");
  double width = 0;
  double height = 0;
  std::size_t marks = 0;
  for (std::sregex_iterator it(html.begin(), html.end(), view), end; it != end; ++it) {
    if ((*it)[1].matched) {
      width = std::stod((*it)[1]);
      height = std::stod((*it)[2]);
      continue;
    }
    ++marks;
    EXPECT_TRUE(std::stod((*it)[3]) > 0 && std::stod((*it)[3]) < width) << (*it)[3];
    EXPECT_TRUE(std::stod((*it)[4]) > 0 && std::stod((*it)[4]) < height) << (*it)[4];
  }
  EXPECT_GT(marks, 50u);
}

TEST(TradeoffPage, SaysWhatWasLeftOutAndShowsWhatWasIncluded) {
  TradeoffReport report = sample_report();
  EXPECT_NE(to_html(tradeoff_page(report)).find("stiff contacts and robustness"),
            std::string::npos);
  const test::TempFolder folder;
  report.included.push_back(
      require(read_results(folder.write("stiff.json", R"({"title":"Stiff contact","rows":[
        {"id":"S1","what":"same hash","figure":0,"limit":"0 differ","pass":true}]})"))));
  const std::string html = to_html(tradeoff_page(report));
  EXPECT_EQ(html.find("stiff contacts and robustness"), std::string::npos);
  EXPECT_NE(html.find("<h2>Stiff contact</h2>"), std::string::npos);
  EXPECT_NE(html.find("<td class=\"word\">0 differ</td><td class=\"word\">yes</td>"),
            std::string::npos);
  EXPECT_EQ(require(read_results(folder.write("rows.json", R"([{"id":"A"}])"))).title, "rows");
  for (const auto& [bad, found] : {std::pair{"{", "no JSON"},
                                   {"", "no JSON"},
                                   {"3", "no rows"},
                                   {"[]", "no rows"},
                                   {R"({"rows":{}})", "no rows"},
                                   {R"({"cases":[{}]})", "no rows"},
                                   {"[3]", "rows of another kind"}}) {
    const auto results = read_results(folder.write("bad.json", bad));
    EXPECT_EQ(results.code(), Errc::kDocumentInvalid) << bad;
    EXPECT_TRUE(results.error().detail.ends_with(
        std::string("bad.json: expected rows of results, as boxtree_stiff and boxtree_robustness "
                    "write with --json, found ") +
        found))
        << results.error().detail;
  }
  EXPECT_EQ(read_results(folder.path() / "none").code(), Errc::kFileNotFound);
}

TEST(TradeoffPage, OtherLibrariesStandWhereTheirFiguresAre) {
  TradeoffReport report = sample_report();
  const auto add = [&](const char* metric, double value) {
    report.peers.push_back({counted().name, "original", "pointers", metric, value, ""});
  };
  EXPECT_EQ(to_html(tradeoff_page(report)).find("original pointers"), std::string::npos);
  add("total_bytes_per_tri", 171);
  add("ray_median_ns", 2500);
  const std::string html = to_html(tradeoff_page(report));
  // In the two plots of rays, beside the mark or in its hint.
  EXPECT_EQ(count(html, "original pointers: 171.00 bytes per triangle, 2.5 µs"), 2u);
}

TEST(TradeoffData, JsonAndCsvSayWhatThePointsSay) {
  const TradeoffReport report = sample_report();
  const auto json = nlohmann::json::parse(to_json(report));
  const auto& points = json.at("meshes").at(0).at("points");
  ASSERT_EQ(points.size(), counted().points.size());
  std::istringstream lines(to_csv(report));
  std::string line;
  ASSERT_TRUE(std::getline(lines, line));
  const auto commas = std::count(line.begin(), line.end(), ',');
  for (std::size_t i = 0; i < points.size(); ++i) {
    const TradePoint& point = counted().points[i];
    EXPECT_EQ(points[i].at("bytes").at("total"), point.bytes.total());
    EXPECT_EQ(points[i].at("surface").at("max"), point.surface_max);
    EXPECT_EQ(points[i].at("work").at("ray").at("nodes"), point.work[0].nodes);
    EXPECT_EQ(points[i].at("pages").at("box").at("worst"), point.pages.box.worst);
    EXPECT_TRUE(points[i].at("times").is_null());
    ASSERT_TRUE(std::getline(lines, line));
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), commas) << line;
    EXPECT_NE(line.find("," + std::to_string(point.bytes.total()) + ","), std::string::npos);
    EXPECT_TRUE(line.ends_with("," + std::to_string(point.pages.point.median) + "," +
                               std::to_string(point.pages.point.worst) + ","))
        << line;  // without a tolerance
  }
  EXPECT_FALSE(std::getline(lines, line));
}

}  // namespace
}  // namespace boxtree::cooker
