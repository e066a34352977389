// SPDX-License-Identifier: MIT
// `boxtree query`: asks one tree of a mapped file, or two trees against each other, one question
// from options or many from a file of JSON lines.
#include <fstream>
#include <iostream>
#include <memory>

#include <fmt/format.h>

#include <boxtree/cooker/cli/question.h>

namespace boxtree::cooker {
namespace {

struct Arguments {
  std::filesystem::path file;
  std::string tree = "0";
  std::filesystem::path mesh;
  std::filesystem::path batch;
  bool json = false;
  VectorOption origin, direction, low, high, center, at;
  RayQuestion ray;
  SphereQuestion sphere;
  PointQuestion point;
  PairQuestion pair;
  std::string pose;
};

void print_answer(const Arguments& arguments, const Json& json) {
  if (arguments.json) {
    print(json);
  } else {
    for (const auto& [key, value] : json.items()) fmt::print("{}: {}\n", key, value.dump());
  }
}

int usage(const std::string& what) {
  fmt::print(stderr, "boxtree: {}\n", what);
  return kExitUsage;
}

// Answers each line of the batch: JSON lines as they come, or one document with --json. A line that
// cannot be answered gets an error in its place; the exit status is that of the first such line.
int run_batch(const Arguments& arguments, const Tree& tree, const std::string& kind) {
  std::ifstream opened;
  const bool from_input = arguments.batch == "-";
  if (!from_input) {
    opened.open(arguments.batch);
    if (!opened) {
      return fail({Errc::kFileUnreadable, arguments.batch.string() + ": cannot be read"});
    }
  }
  std::istream& in = from_input ? std::cin : opened;
  TreeCache others;
  Json answers = Json::array();
  int status = 0;
  std::string line;
  for (std::size_t number = 1; std::getline(in, line); ++number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const Result<Question> question = parse_question(line, kind);
    Result<Json> answer = question ? ask(tree, *question, others) : Result<Json>(question.error());
    if (!answer) {
      const Error error{answer.code(), fmt::format("line {}: {}", number, answer.error().detail)};
      if (status == 0) status = error_info(error.code).exit_status;
      answer = Json{{"error", error_info(error.code).name}, {"detail", error.detail}};
    }
    if (arguments.json) {
      answers.push_back(*answer);
    } else {
      fmt::print("{}\n", answer->dump(-1, ' ', false, Json::error_handler_t::replace));
    }
  }
  if (arguments.json) print({{"answers", answers}});
  return status;
}

// `missing` names an option that the kind needs and that was not given.
int run(const Arguments& arguments, const std::string& kind, const Question& question,
        const char* missing) {
  if (arguments.batch.empty() && missing != nullptr) {
    return usage(fmt::format("{} is required", missing));
  }
  const Result<OpenedTree> opened = open_tree(arguments.file, arguments.tree, arguments.mesh);
  if (!opened) return fail(opened.error());
  if (!arguments.batch.empty()) return run_batch(arguments, opened->tree, kind);
  TreeCache others;
  const Result<Json> answer = ask(opened->tree, question, others);
  if (!answer) return fail(answer.error());
  print_answer(arguments, *answer);
  return 0;
}

int run_pair(Arguments& arguments) {
  if (!arguments.pose.empty()) {
    const std::optional<Pose> pose = parse_pose(arguments.pose);
    if (!pose) {
      return usage(
          fmt::format("--pose: expected X,Y,Z or 12 numbers, found \"{}\"", arguments.pose));
    }
    arguments.pair.pose = *pose;
  }
  return run(arguments, "pair", arguments.pair,
             arguments.pair.file.empty() ? "the second file" : nullptr);
}

const char* first_missing(const VectorOption& first, const VectorOption& second) {
  return !first.given ? first.name.c_str() : !second.given ? second.name.c_str() : nullptr;
}

void add_ray_and_point(CLI::App& query, const std::shared_ptr<Arguments>& a, int& status) {
  CLI::App& ray = *query.add_subcommand("ray", "Closest hit of a ray");
  a->origin.add_to(ray, "--origin", "Where it starts");
  a->direction.add_to(ray, "--direction", "Where it goes; t counts in its length");
  ray.add_option("--t-max", a->ray.ray.t_max, "Where it ends");
  ray.add_flag("--any", a->ray.any, "Any hit, not the closest");
  ray.callback([a, &status] {
    a->ray.ray.origin = a->origin.value;
    a->ray.ray.direction = a->direction.value;
    status = run(*a, "ray", a->ray, first_missing(a->origin, a->direction));
  });

  CLI::App& point = *query.add_subcommand("point", "Closest point of the surface");
  a->at.add_to(point, "--at", "The point");
  point.add_option("--max-distance", a->point.max_distance, "Look no farther");
  point.callback([a, &status] {
    a->point.at = a->at.value;
    status = run(*a, "point", a->point, first_missing(a->at, a->at));
  });
}

void add_box_and_sphere(CLI::App& query, const std::shared_ptr<Arguments>& a, int& status) {
  CLI::App& box = *query.add_subcommand("box", "Faces that touch an axis-aligned box");
  a->low.add_to(box, "--min", "Lower corner");
  a->high.add_to(box, "--max", "Upper corner");
  box.callback([a, &status] {
    status =
        run(*a, "box", BoxQuestion{{a->low.value, a->high.value}}, first_missing(a->low, a->high));
  });

  CLI::App& sphere = *query.add_subcommand("sphere", "Faces within a radius of a point");
  a->center.add_to(sphere, "--center", "The point");
  CLI::Option* radius = sphere.add_option("--radius", a->sphere.radius, "The radius");
  sphere.callback([a, radius, &status] {
    a->sphere.center = a->center.value;
    const char* missing = first_missing(a->center, a->center);
    if (missing == nullptr && radius->count() == 0) missing = "--radius";
    status = run(*a, "sphere", a->sphere, missing);
  });
}

void add_pair(CLI::App& query, const std::shared_ptr<Arguments>& a, int& status) {
  CLI::App& pair = *query.add_subcommand("pair", "Pairs of faces of two trees that touch");
  pair.add_option("file2", a->pair.file, "The second .bxt file");
  pair.add_option("--pose", a->pose,
                  "Pose of the second tree: X,Y,Z or the 12 numbers of a 3x4 matrix, row by row");
  pair.add_flag("--first", a->pair.first_only, "Stop at the first contact");
  pair.add_option("--tree2", a->pair.tree, "Its tree, by number or name")->group(kRareOptions);
  pair.add_option("--mesh2", a->pair.mesh, "Its source mesh, if it was cooked with --external")
      ->group(kRareOptions);
  pair.callback([a, &status] { status = run_pair(*a); });
}

}  // namespace

void add_query_command(CLI::App& app, int& status) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App& command = *app.add_subcommand("query", "Ask a .bxt file");
  command.add_option("file", arguments->file, "A .bxt file")->required();
  command.add_option("--tree", arguments->tree, "Which tree, by number or name");
  command.add_option("--batch", arguments->batch,
                     "Ask every line of a file (- for standard input): JSON objects with the names "
                     "of the options as keys, and \"kind\" if no kind of query is given here");
  command.add_flag("--json", arguments->json, "Print one JSON document");
  command.add_option("--mesh", arguments->mesh, "The source mesh of a tree cooked with --external")
      ->group(kRareOptions);
  command.require_subcommand(0, 1);
  command.fallthrough();
  add_ray_and_point(command, arguments, status);
  add_box_and_sphere(command, arguments, status);
  add_pair(command, arguments, status);
  command.callback([&command, arguments, &status] {
    if (!command.get_subcommands().empty()) return;
    status = arguments->batch.empty() ? usage("a kind of query or --batch is required")
                                      : run(*arguments, "", RayQuestion(), nullptr);
  });
}

}  // namespace boxtree::cooker
