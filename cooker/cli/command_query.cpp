// SPDX-License-Identifier: MIT
// `boxtree query`: asks one tree of a mapped file, or two trees against each other, one question
// from options or many from a file of JSON lines.
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <functional>
#include <memory>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "cooker/cli/help_format.h"
#include "cooker/cli/open_file.h"
#include "cooker/cli/question.h"
#include "cooker/cli/scene_question.h"

namespace boxtree::cooker {
namespace {

struct Arguments {
  std::filesystem::path file;
  std::string tree;  // empty: the scene of the file, or else its first tree
  std::vector<std::string> moves;
  std::filesystem::path mesh;
  std::filesystem::path batch;
  bool json = false;
  VectorOption origin, direction, low, high, center, at;
  RayQuestion ray;
  SphereQuestion sphere;
  PointQuestion point;
  PairQuestion pair;
  ContactsQuestion contacts;
  SecondTree second;
  Approximation options;
  OverlapOptions overlap;
  std::string pose;
};

void print_answer(const Arguments& arguments, const Json& json) {
  if (arguments.json) {
    print(json);
  } else {
    for (const auto& [key, value] : json.items()) fmt::print("{}: {}\n", key, line_of(value));
  }
}

// The lines of a batch. Not a stream of C++: those take a read error of standard input for its end.
class BatchLines {
 public:
  // Far beyond any query; an endless line would fill the memory.
  static constexpr std::size_t kLongestLine = std::size_t{1} << 20;

  explicit BatchLines(const std::filesystem::path& path)
      : path_(path), file_(path == "-" ? stdin : std::fopen(path.c_str(), "rb")) {
    if (file_ == nullptr) error_ = errno;
  }
  BatchLines(const BatchLines&) = delete;
  BatchLines& operator=(const BatchLines&) = delete;
  ~BatchLines() {
    if (file_ != nullptr && file_ != stdin) static_cast<void>(std::fclose(file_));
  }

  // The next line, without its end; false after the last one and after an error.
  bool next(std::string& line) {
    line.clear();
    if (file_ == nullptr) return false;
    ++number_;
    int c = 0;
    while ((c = std::getc(file_)) != EOF && c != '\n') {
      if (line.size() == kLongestLine) {
        is_too_long_ = true;
        return false;
      }
      line += static_cast<char>(c);
    }
    if (c == EOF && std::ferror(file_) != 0) {
      error_ = errno;
      return false;
    }
    return c != EOF || !line.empty();
  }

  [[nodiscard]] std::size_t number() const { return number_; }

  // Why there is no next line, unless the file simply ended.
  [[nodiscard]] Status status() const {
    if (is_too_long_) {
      return Error{Errc::kInvalidQuery, fmt::format("{}: line {} has more than {} bytes",
                                                    path_.string(), number_, kLongestLine)};
    }
    if (error_ == 0) return {};
    return Error{Errc::kFileUnreadable,
                 fmt::format("{}: {}", path_.string(), std::generic_category().message(error_))};
  }

 private:
  const std::filesystem::path path_;
  std::FILE* file_;
  std::size_t number_ = 0;
  int error_ = 0;  // of the system
  bool is_too_long_ = false;
};

// Answers each line of the batch: JSON lines as they come, or one document with --json. A line that
// cannot be answered gets an error in its place; the exit status is that of the first such line.
using Ask = std::function<Result<Json>(const Question& question, TreeCache& others)>;
int run_batch(const Arguments& arguments, const Ask& ask_it, const std::string& kind) {
  BatchLines lines(arguments.batch);
  TreeCache others;
  Json answers = Json::array();
  int status = 0;
  std::string line;
  while (lines.next(line)) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const Result<Question> question = parse_question(line, kind);
    Result<Json> answer = question ? ask_it(*question, others) : Result<Json>(question.error());
    if (!answer) {
      const Error error{answer.code(),
                        fmt::format("line {}: {}", lines.number(), answer.error().detail)};
      if (status == 0) status = error_info(error.code).exit_status;
      answer = Json{{"error", error_info(error.code).name}, {"detail", error.detail}};
    }
    if (arguments.json) {
      answers.push_back(*answer);
    } else {
      fmt::print("{}\n", line_of(*answer));
    }
  }
  if (arguments.json) print({{"answers", answers}});
  if (const Status read = lines.status(); !read.ok()) return fail(read.error());
  return status;
}

// `missing` names an option that the kind needs and that was not given.
int run(const Arguments& arguments, const std::string& kind, const Question& question,
        const char* missing) {
  if (arguments.batch.empty() && missing != nullptr) {
    return usage(fmt::format("{} is required", missing));
  }
  Result<OpenedFile> opened = open_file(arguments.file);
  if (!opened) return fail(opened.error());
  const File& file = opened->file;
  if (!arguments.moves.empty() && (!file.has_scene() || !arguments.tree.empty())) {
    return usage("--move is for instances of a scene");
  }
  const auto answer_all = [&](const Ask& ask_it) {
    if (!arguments.batch.empty()) return run_batch(arguments, ask_it, kind);
    TreeCache others;
    const Result<Json> answer = ask_it(question, others);
    if (!answer) return fail(answer.error());
    print_answer(arguments, *answer);
    return 0;
  };
  if (file.has_scene() && arguments.tree.empty()) {
    const Result<OpenedScene> scene = open_scene(std::move(opened->file), arguments.moves);
    if (!scene) {
      return fail({scene.code(), arguments.file.string() + ": " + scene.error().detail});
    }
    return answer_all(
        [&](const Question& asked, TreeCache& others) { return ask(scene->scene, asked, others); });
  }
  const Result<OpenedTree> tree =
      bind_tree(std::move(opened->file), arguments.file,
                arguments.tree.empty() ? "0" : arguments.tree, arguments.mesh);
  if (!tree) return fail(tree.error());
  return answer_all(
      [&](const Question& asked, TreeCache& others) { return ask(tree->tree, asked, others); });
}

// A question about two trees: `question` is made when the second one is known.
template <class Make>
int run_pair(Arguments& arguments, const std::string& kind, Make question) {
  if (!arguments.pose.empty()) {
    const std::optional<Pose> pose = parse_pose(arguments.pose);
    if (!pose) {
      return usage(
          fmt::format("--pose: expected X,Y,Z or 12 numbers, found \"{}\"", arguments.pose));
    }
    arguments.second.pose = *pose;
  }
  return run(arguments, kind, question(),
             arguments.second.file.empty() ? "the second file" : nullptr);
}

const char* first_missing(const VectorOption& first, const VectorOption& second) {
  return !first.given ? first.name.c_str() : !second.given ? second.name.c_str() : nullptr;
}

CLI::Option* add_budget(CLI::App& query, std::uint64_t& nodes) {
  // Unsigned numbers of CLI11 take "-1" for 2^64 - 1.
  return query.add_option("--budget", nodes, "Stop after so many nodes")
      ->check(CLI::NonNegativeNumber);
}

// How near to the truth an answer has to be; returns those that make it one with bounds.
std::vector<CLI::Option*> add_approximation(CLI::App& query, Approximation& options) {
  query.add_option("--max-distance", options.max_distance, "Look no farther");
  return {query.add_option("--relative-error", options.relative_error,
                           "Be content if upper <= lower * (1 + this)"),
          query.add_option("--absolute-error", options.absolute_error,
                           "Be content if upper <= lower + this"),
          add_budget(query, options.node_budget)};
}

// What may be left undecided; returns those that ask for no more than whether there is an overlap.
std::vector<CLI::Option*> add_overlap(CLI::App& query, OverlapOptions& options) {
  return {query.add_option("--within", options.within,
                           "Answer hit or free, or undecided if closer than this"),
          add_budget(query, options.node_budget)};
}

bool any_given(const std::vector<CLI::Option*>& options) {
  return std::any_of(options.begin(), options.end(),
                     [](const CLI::Option* option) { return option->count() > 0; });
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
  const std::vector<CLI::Option*> given = add_approximation(point, a->options);
  point.callback([a, given, &status] {
    a->point.at = a->at.value;
    a->point.options = a->options;
    a->point.with_bounds = any_given(given);
    status = run(*a, "point", a->point, first_missing(a->at, a->at));
  });
}

void add_box_and_sphere(CLI::App& query, const std::shared_ptr<Arguments>& a, int& status) {
  CLI::App& box = *query.add_subcommand("box", "Faces that touch an axis-aligned box");
  a->low.add_to(box, "--min", "Lower corner");
  a->high.add_to(box, "--max", "Upper corner");
  const std::vector<CLI::Option*> given = add_overlap(box, a->overlap);
  box.callback([a, given, &status] {
    BoxQuestion question{{a->low.value, a->high.value}, {}};
    if (any_given(given)) question.overlap = a->overlap;
    status = run(*a, "box", question, first_missing(a->low, a->high));
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

void add_second(CLI::App& query, Arguments& arguments) {
  query.add_option("file2", arguments.second.file, "The second .bxt file");
  query.add_option("--pose", arguments.pose,
                   "Pose of the second tree: X,Y,Z or the 12 numbers of a 3x4 matrix, row by row");
  query.add_option("--tree2", arguments.second.tree, "Its tree, by number or name")
      ->group(kRareOptions);
  query
      .add_option("--mesh2", arguments.second.mesh,
                  "Its source mesh, if it was cooked with --external")
      ->group(kRareOptions);
}

void add_two_trees(CLI::App& query, const std::shared_ptr<Arguments>& a, int& status) {
  CLI::App& pair = *query.add_subcommand("pair", "Pairs of faces of two trees that touch");
  add_second(pair, *a);
  pair.add_flag("--first", a->pair.first_only, "Stop at the first contact");
  pair.callback([a, &status] {
    status = run_pair(*a, "pair", [&] { return PairQuestion{a->second, a->pair.first_only}; });
  });

  CLI::App& distance = *query.add_subcommand("distance", "Distance of two trees");
  add_second(distance, *a);
  add_approximation(distance, a->options);
  distance.callback([a, &status] {
    status = run_pair(*a, "distance", [&] { return DistanceQuestion{a->second, a->options}; });
  });

  CLI::App& overlap = *query.add_subcommand("overlap", "Whether two trees touch: hit or free");
  add_second(overlap, *a);
  add_overlap(overlap, a->overlap);
  overlap.callback([a, &status] {
    status = run_pair(*a, "overlap", [&] { return OverlapQuestion{a->second, a->overlap}; });
  });
}

void add_contacts(CLI::App& query, const std::shared_ptr<Arguments>& a, int& status) {
  CLI::App& command = *query.add_subcommand(
      "contacts", "Of a scene: pairs of faces of what moves and all else that touch");
  command.add_flag("--first", a->contacts.first_only, "Stop at the first contact");
  command.callback([a, &status] { status = run(*a, "contacts", a->contacts, nullptr); });
}

}  // namespace

void add_query_command(CLI::App& app, int& status) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App& command = *app.add_subcommand("query", "Ask a .bxt file");
  command.add_option("FILE", arguments->file, "The file to query")->type_name("FILE")->required();
  command.add_option("--tree", arguments->tree,
                     "Which tree, by number or name [the scene of the file, or else tree 0]");
  command.add_option("--move", arguments->moves,
                     "Of a scene, as often as needed: INSTANCE=POSE, the instance by number or "
                     "name, the pose as X,Y,Z or 12 numbers");
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
  add_two_trees(command, arguments, status);
  add_contacts(command, arguments, status);
  command.callback([&command, arguments, &status] {
    if (!command.get_subcommands().empty()) return;
    status = arguments->batch.empty() ? usage("a kind of query or --batch is required")
                                      : run(*arguments, "", RayQuestion(), nullptr);
  });
}

}  // namespace boxtree::cooker
