// SPDX-License-Identifier: MIT
// `boxtree query`: queries one tree of a mapped file, or two trees against each other, one request
// from options or many from a file of JSON lines.
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <sys/stat.h>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cooker/cli/batch_line.h"
#include "cooker/cli/command.h"
#include "cooker/cli/commands.h"
#include "cooker/cli/json_output.h"
#include "cooker/cli/open_file.h"
#include "cooker/cli/output.h"
#include "cooker/cli/query_request.h"
#include "cooker/cli/scene_info.h"
#include "cooker/cli/scene_query.h"
#include "cooker/cli/standard_streams.h"
#include "cooker/import/file_error.h"
#include "cooker/system/file_handle.h"
#include "cooker/system/input_failure.h"
#include "cooker/text/nearest_name.h"

namespace boxtree::cooker {
namespace {

struct QueryArguments {
  std::filesystem::path file;
  std::string tree;   // empty: the scene of the file, or else its first tree
  std::string scene;  // a tree of the scene to query; empty: the file's
  std::vector<std::string> moves;
  std::vector<std::string> layers;  // names; empty: all
  std::filesystem::path mesh;
  std::filesystem::path batch;
  bool json = false;
};

// A key a line. Lists of objects or of lists, of which there may be hundreds, have a line for each.
void print_answer(const QueryArguments& arguments, const Json& json) {
  if (arguments.json) return print(json);
  for (const auto& [key, value] : json.items()) {
    const bool is_list = value.is_array() && !value.empty() && value.front().is_structured();
    fmt::print("{}:{}\n", key, is_list ? "" : " " + line_of(value));
    if (!is_list) continue;
    for (const Json& each : value) fmt::print("  {}\n", line_of(each));
  }
}

// The lines of a batch. Not a stream of C++: those take a read error of standard input for its end.
class BatchLines {
 public:
  // Far beyond any query; longer lines are not kept. One that is longer still may have no end.
  static constexpr std::size_t kLongestLine = std::size_t{1} << 20;
  static constexpr std::size_t kEndlessLine = std::size_t{1} << 26;

  explicit BatchLines(const std::filesystem::path& path)
      : path_(path), file_(is_standard_stream(path) ? stdin : open_to_read(path).release()) {
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
    bytes_ = 0;
    if (file_ == nullptr) return false;
    ++number_;
    int c = 0;
    while ((c = std::getc(file_)) != EOF && c != '\n') {
      if (++bytes_ > kEndlessLine) return false;
      if (bytes_ <= kLongestLine) line += static_cast<char>(c);
    }
    if (c == EOF && std::ferror(file_) != 0) {
      error_ = errno;
      return false;
    }
    return c != EOF || !line.empty();
  }

  /// Whether someone may wait for an answer before the next line: not where a file has them all.
  [[nodiscard]] bool is_interactive() const {
    struct stat status {};
    return file_ != nullptr && ::fstat(::fileno(file_), &status) == 0 && !S_ISREG(status.st_mode);
  }
  [[nodiscard]] std::size_t number() const { return number_; }
  [[nodiscard]] std::string name() const { return input_name(path_); }
  /// Why the last line cannot be a query.
  [[nodiscard]] Status check_line() const {
    if (bytes_ <= kLongestLine) return {};
    return Error{Errc::kInvalidQuery, fmt::format("it has more than {} bytes", kLongestLine)};
  }

  // Why there is no next line, unless the file simply ended.
  [[nodiscard]] Status status() const {
    if (bytes_ > kEndlessLine) {
      return Error{Errc::kInvalidQuery, fmt::format("{}: line {} has more than {} bytes", name(),
                                                    number_, kEndlessLine)};
    }
    if (error_ == 0) return {};
    return input_failure(name(), error_);
  }

 private:
  const std::filesystem::path path_;
  std::FILE* file_;
  std::size_t number_ = 0;
  int error_ = 0;          // of the system
  std::size_t bytes_ = 0;  // of the last line
};

// Answers each line of the batch: JSON lines as they come, at once where lines come from a program,
// or one document with --json, each with the number of its line, since empty lines have no answer.
// A line that cannot be answered gets an error in its place; at the end the first is told with the
// number of all, and its exit status.
using AnswerRequest = std::function<Result<Json>(const BatchRequest& line, TreeCache& others)>;
int run_batch(const QueryArguments& arguments, const AnswerRequest& answer_request,
              const RequestDefaults& defaults) {
  BatchLines lines(arguments.batch);
  const bool is_interactive = lines.is_interactive();
  TreeCache others;
  Json answers = Json::array();
  std::optional<Error> first_error;
  std::size_t queries = 0, errors = 0;
  std::string line;
  while (lines.next(line)) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    ++queries;
    const Status length = lines.check_line();
    const Result<BatchRequest> request =
        length.ok() ? parse_request(line, defaults) : Result<BatchRequest>(length.error());
    Result<Json> answer =
        request ? answer_request(*request, others) : Result<Json>(request.error());
    if (!answer) {
      const ErrcInfo& info = error_info(answer.code());
      const std::string& detail = answer.error().detail;
      const Error error{answer.code(), fmt::format("line {}: {}", lines.number(),
                                                   detail.empty() ? info.meaning : detail)};
      ++errors;
      if (!first_error) first_error = error;
      answer = Json{{"error", info.name}, {"detail", error.detail}};
    }
    Json numbered = {{"line", lines.number()}};
    numbered.update(*answer);
    if (arguments.json) {
      answers.push_back(std::move(numbered));
    } else {
      fmt::print("{}\n", line_of(std::move(numbered)));
      if (is_interactive && std::fflush(stdout) != 0) return fail_to_print();
    }
  }
  if (arguments.json) print({{"answers", answers}});
  if (const Status read = lines.status(); !read.ok()) return fail(read.error());
  if (!first_error) return 0;
  return fail({first_error->code, fmt::format("{}: {} of {} queries have no answer; the first: {}",
                                              lines.name(), errors, queries, first_error->detail)});
}

// Empty for a query about one tree.
std::filesystem::path second_file(const QueryRequest& request) {
  return std::visit(
      [](const auto& q) {
        if constexpr (requires { q.second; }) return q.second.file;
        return std::filesystem::path();
      },
      request);
}

// The file that a query names beside the one that it is about; empty for none.
std::filesystem::path other_file(const QueryRequest& request) {
  return std::visit(
      [&](const auto& q) {
        if constexpr (requires { q.shape; }) {
          return q.shape.hull.value_or(std::filesystem::path());
        } else {
          return second_file(request);
        }
      },
      request);
}

// The error of a query or a scene of the file, behind its name, unless it is that of the other
// file.
Error in_queried_file(const QueryArguments& arguments, const std::filesystem::path& other,
                      const Error& error) {
  const bool is_of_other = !other.empty() && error.detail.starts_with(input_name(other) + ": ");
  if (is_of_other) return error;
  const std::string what =
      error.detail.empty() ? std::string(error_info(error.code).meaning) : error.detail;
  return in_file(input_name(arguments.file), {error.code, what});
}

// Contacts are those of moving instances: where there is none, the answer is always the same.
class StillSceneWarning {
 public:
  explicit StillSceneWarning(const QueryArguments& arguments) : arguments_(arguments) {}

  // The answer. Warns once for all lines of a batch; not of a query that has no answer, whose error
  // says more.
  Result<Json> told(Result<Json> answer, const Scene& scene, const QueryRequest& request) {
    if (answer) warn_of(scene, request);
    return answer;
  }

 private:
  enum class Moving { kNothing, kAnswersNoPairs, kAnswersPairs };

  void warn_of(const Scene& scene, const QueryRequest& request) {
    if (is_told_ || !std::holds_alternative<ContactsRequest>(request)) return;
    const Moving moving = moving_of(scene);
    if (moving == Moving::kAnswersPairs) return;
    is_told_ = true;
    warn(input_name(arguments_.file) +
         (moving == Moving::kNothing
              ? ": no instance moves, so that contacts has none to look at: use --move "
                "INSTANCE=POSE, or a profile with motion = \"moving\""
              : ": no instance that moves is in a layer that answers pairs, so that contacts has "
                "none to look at: its object of the profile needs \"pair\" among its queries"));
  }

  static Moving moving_of(const Scene& scene) {
    Moving moving = Moving::kNothing;
    for (std::uint32_t i = 0; i < scene.instance_count(); ++i) {
      const Result<InstanceInfo> info = scene.info(i);
      if (!info || !info->moves) continue;
      if ((layer_queries(scene, info->layer) & kPairQueries) != 0) return Moving::kAnswersPairs;
      moving = Moving::kAnswersNoPairs;
    }
    return moving;
  }

  const QueryArguments& arguments_;
  bool is_told_ = false;
};

// With the names of those that there are.
Error no_scene_called(const File& pack, const std::string& name) {
  std::vector<std::string> names;
  for (std::uint32_t i = 0; i < pack.tree_count(); ++i) {
    const Result<Member> member = pack.member(i);
    if (!member || !member->file.has_scene()) continue;
    const std::string tree(pack.tree_name(i));
    const std::size_t end = tree.rfind('/');
    if (member->file.tree_count() > 1 && end != std::string::npos)
      names.push_back(tree.substr(0, end));
    names.push_back(tree);
  }
  const std::string meant =
      names.empty() ? "; the file holds no scene" : path_suggestion(name, names);
  return {Errc::kTreeIndex,
          fmt::format("no scene, and no tree of one, is called \"{}\"{}", name, meant)};
}

// The file that `tree` came in, whose bytes are those of `pack`; one with a scene. A file of
// several trees has a name, too, which is what comes before theirs. Errors: those of find_tree and
// File::member, and kNoScene.
Result<File> scene_around(const File& pack, const std::string& tree) {
  Result<std::uint32_t> index = find_tree(pack, {tree});
  for (std::uint32_t i = 0; !index && i < pack.tree_count(); ++i) {
    if (pack.tree_name(i).starts_with(tree + "/")) index = i;
  }
  if (!index) return no_scene_called(pack, tree);
  Result<Member> member = pack.member(*index);
  if (!member) return member.error();
  if (!member->file.has_scene()) {
    return Error{Errc::kNoScene, fmt::format("--scene {0}: this tree was cooked without --scene; "
                                             "--tree {0} queries it",
                                             tree)};
  }
  return std::move(member->file);
}

// Without a batch, `defaults` is the query.
int run(const QueryArguments& arguments, const RequestDefaults& defaults) {
  const bool is_file =
      is_standard_stream(arguments.file) || is_standard_stream(second_file(defaults.request));
  if (is_file && is_standard_stream(arguments.batch)) {
    return usage("query: standard input is the file or the batch, not both");
  }
  std::optional<File> pack;  // outlives its member
  Result<OpenedFile> opened = open_file(arguments.file);
  if (!opened) return fail(opened.error());
  if (!arguments.scene.empty()) {
    pack = std::move(opened->file);
    Result<File> member = scene_around(*pack, arguments.scene);
    if (!member) return fail(in_queried_file(arguments, {}, member.error()));
    opened->file = std::move(*member);
  }
  const File& file = opened->file;
  const bool is_of_scene = file.has_scene() && arguments.tree.empty();
  if (!is_of_scene && !arguments.moves.empty()) {
    return usage("query: --move is for instances of a scene");
  }
  if (!is_of_scene && !arguments.layers.empty()) {
    return usage("query: --layer is for instances of a scene");
  }
  const auto answer_all = [&](const AnswerRequest& answer_request) {
    if (!arguments.batch.empty()) return run_batch(arguments, answer_request, defaults);
    TreeCache others;
    const Result<Json> answer = answer_request({defaults.request, {}}, others);
    if (!answer) {
      return fail(in_queried_file(arguments, other_file(defaults.request), answer.error()));
    }
    print_answer(arguments, *answer);
    return 0;
  };
  if (is_of_scene) {
    const Result<OpenedScene> scene = open_scene(std::move(opened->file), arguments.moves);
    if (scene.code() == Errc::kExternalMeshNeeded) {
      return fail(
          {scene.code(), fmt::format("{}: {}: a scene is queried with geometry in its file; "
                                     "for one tree name --tree TREE and --mesh MESH",
                                     input_name(arguments.file), scene.error().detail)});
    }
    if (!scene) return fail(in_queried_file(arguments, {}, scene.error()));
    const Result<LayerMask> layers = layers_named(scene->scene, arguments.layers);
    if (!layers) return fail(in_queried_file(arguments, {}, layers.error()));
    StillSceneWarning still(arguments);
    std::set<std::string> told;
    const auto tell_hidden = [&](const std::vector<std::string>& moves) {
      for (const std::string& what : hidden_by_names(scene->scene, moves)) {
        if (told.insert(what).second) warn(fmt::format("{}: {}", input_name(arguments.file), what));
      }
    };
    tell_hidden(arguments.moves);
    return answer_all([&](const BatchRequest& line, TreeCache& others) -> Result<Json> {
      if (line.moves.empty()) {
        return still.told(answer(scene->file, scene->scene, *layers, line.request, others),
                          scene->scene, line.request);
      }
      std::vector<std::string> moves = arguments.moves;
      moves.insert(moves.end(), line.moves.begin(), line.moves.end());
      const Result<Scene> moved = move_scene(scene->file, moves);
      if (!moved) return moved.error();
      tell_hidden(line.moves);
      return still.told(answer(scene->file, *moved, *layers, line.request, others), *moved,
                        line.request);
    });
  }
  const Result<OpenedTree> tree =
      bind_tree(std::move(opened->file),
                {arguments.file, {arguments.tree}, arguments.mesh, "--tree", "--mesh"});
  if (!tree) return fail(tree.error());
  return answer_all([&](const BatchRequest& line, TreeCache& others) -> Result<Json> {
    if (!line.moves.empty()) {
      return Error{Errc::kInvalidQuery,
                   "\"move\": is for instances of a scene, and this is a tree"};
    }
    return answer(*tree, line.request, others);
  });
}

// A value like "1,-2.5,3e4". `out` has to live until the command line has been parsed.
Option* add_vector_option(Command& command, const std::string& option, Eigen::Vector3d& out,
                          const char* help) {
  return command
      .add_parsed_option(
          option,
          [&out](const std::string& text) {
            const std::optional<Eigen::Vector3d> vector = parse_vector(text);
            if (!vector) return "expected X,Y,Z, " + found_instead(text);
            out = *vector;
            return std::string();
          },
          help)
      ->type_name("X,Y,Z");
}

// Declares what a request is made of as options of its command. What is needed may be missing where
// `batch` is given.
class OptionFields {
 public:
  OptionFields(Command& command, const Option* batch) : command_(command), batch_(batch) {}

  void required(const char* key, Eigen::Vector3d& out, const char* help) {
    need(key, add_vector_option(command_, option_name(key), out, help));
  }
  void required(const char* key, Frustum::ViewProjection& out, const char* help) {
    const auto parse = [&out](const std::string& text) {
      std::array<double, 16> numbers{};
      const auto matrix = matrix_of(std::span(numbers).first(parse_numbers(text, numbers)));
      if (!matrix) return "expected 16 numbers between commas, " + found_instead(text);
      out = *matrix;
      return std::string();
    };
    need(key, command_.add_parsed_option(option_name(key), parse, help)->type_name("MATRIX"));
  }
  void required(const char* key, double& out, const char* help) {
    need(key, command_.add_option(option_name(key), out, help)->type_name("N"));
  }
  void optional(const char* key, double& out, const char* help, bool* given = nullptr) {
    note(command_.add_option(option_name(key), out, help)->type_name("N"), given);
  }
  void optional(const char* key, std::uint64_t& out, const char* help, bool* given = nullptr) {
    note(command_.add_option(option_name(key), out, help)->type_name("N"), given);
  }
  void optional(const char* key, bool& out, const char* help) {
    command_.add_flag(option_name(key), out, help);
  }
  void second(SecondTree& tree) {
    command_
        .add_file("FILE2", tree.file, Values::kCookedFiles,
                  "The second .bxt file; in a batch, that of lines without \"file\"")
        ->needed(batch_);
    command_
        .add_parsed_option(
            "--pose",
            [&tree](const std::string& text) {
              const std::optional<Pose> pose = parse_pose(text);
              if (!pose) return "expected X,Y,Z or 12 numbers, " + found_instead(text);
              tree.pose = *pose;
              return std::string();
            },
            "Pose of the second tree: X,Y,Z or the 12 numbers of a 3x4 matrix, row by row "
            "[0,0,0]")
        ->type_name("POSE");
    command_
        .add_option("--tree2", tree.tree.text,
                    "Its tree, by name or number; needed if FILE2 holds a scene [tree 0]")
        ->type_name("TREE")
        ->group(kRareOptions);
    command_
        .add_file("--mesh2", tree.mesh, Values::kMeshes,
                  "Its source mesh, if it was cooked with --external")
        ->group(kRareOptions);
  }

  void back_faces(BackFaces& out) {
    command_
        .add_parsed_option(
            "--back-faces",
            [&out](const std::string& text) {
              const std::optional<BackFaces> known = back_faces_of(text);
              if (!known) return "expected hit, ignore or only, found \"" + text + "\"";
              out = *known;
              return std::string();
            },
            "Faces that are met from behind, where their corners are clockwise: hit, ignore or "
            "only "
            "[hit]")
        ->type_name("HOW");
  }

  void shape(CastShape& shape) {
    command_.add_option("--sphere", shape.sphere, "The shape: a ball of this radius,")
        ->type_name("R")
        ->one_is_needed();
    add_numbers("--capsule", "X,Y,Z,R", shape.capsule,
                "or all within R of the segment from --at to --at + X,Y,Z,")
        ->one_is_needed();
    add_numbers("--box", "HX,HY,HZ", shape.box,
                "or a box that reaches so far from --at along each of its axes,")
        ->one_is_needed();
    command_
        .add_parsed_option(
            "--hull",
            [&shape](const std::string& text) {
              shape.hull = text;
              return std::string();
            },
            fmt::format(
                "or the convex hull of the points of the faces of a mesh, at most {} of them",
                kMaxHullPoints))
        ->type_name("MESH")
        ->takes(Values::kMeshes)
        ->one_is_needed();
    add_numbers("--rotation", "X,Y,Z,W", shape.rotation,
                "Of the box or the hull, a quaternion of any length [0,0,0,1]");
  }

  // The keys that have to be given, and their options.
  [[nodiscard]] const std::vector<std::pair<std::string, const Option*>>& needed() const {
    return needed_;
  }

 private:
  void need(const char* key, Option* option) { needed_.emplace_back(key, option->needed(batch_)); }
  static std::string option_name(std::string key) {
    std::replace(key.begin(), key.end(), '_', '-');
    return "--" + key;
  }
  template <std::size_t kCount>
  Option* add_numbers(const char* name, const std::string& form,
                      std::optional<std::array<double, kCount>>& out, const char* help) {
    return command_
        .add_parsed_option(
            name,
            [&out, form](const std::string& text) {
              const bool is_list = parse_numbers(text, out.emplace()) == kCount;
              return is_list ? std::string() : "expected " + form + ", " + found_instead(text);
            },
            help)
        ->type_name(form);
  }
  static void note(Option* option, bool* given) {
    if (given != nullptr) option->each([given] { *given = true; });
  }

  Command& command_;
  const Option* batch_;
  std::vector<std::pair<std::string, const Option*>> needed_;
};

// What a kind needs of the command around it.
struct Around {
  Command& query;
  const Option* batch;
  std::shared_ptr<QueryArguments> arguments;
};

template <class Kind>
void add_kind(const Around& around, int& status) {
  Command& command = around.query.add_command(Kind::kKind, Kind::kHelp);
  const auto request = std::make_shared<Kind>();
  OptionFields options(command, around.batch);
  request->describe(options);
  for (const KindExample& example : Kind::kExamples) command.example(example.what, example.line);
  command.callback([request, needed = options.needed(), arguments = around.arguments, &status] {
    if constexpr (requires { request->fault("--", false); }) {
      const std::string fault = request->fault("--", !arguments->batch.empty());
      if (!fault.empty()) {
        status = usage(fmt::format("query {}: {}", Kind::kKind, fault));
        return;
      }
    }
    RequestDefaults defaults{Kind::kKind, *request, {}};
    for (const auto& [key, option] : needed) {
      if (option->count() > 0) defaults.given.push_back(key);
    }
    status = run(*arguments, defaults);
  });
}

}  // namespace

void add_query_command(Command& program, int& status) {
  const auto arguments = std::make_shared<QueryArguments>();
  Command& command = program.add_command("query",
                                         "Query a .bxt file\n"
                                         "Queries one tree or a scene, or two trees against each "
                                         "other. The options of query may also stand "
                                         "behind the kind.");
  command
      .add_file("FILE", arguments->file, Values::kCookedFiles,
                "The file to query; - is standard input")
      ->needed();
  Option* tree =
      command
          .add_option("--tree", arguments->tree,
                      "Which tree, by name or number [the scene of the file, or else tree 0]")
          ->type_name("TREE");
  command
      .add_option("--scene", arguments->scene,
                  "Of a pack: the scene with this tree, by name or number, or the "
                  "scene of a file of several trees")
      ->type_name("NAME")
      ->excludes(tree);
  command
      .add_option(
          "--move", arguments->moves,
          "Of a scene, as often as needed: INSTANCE=POSE, the instance by name or number. The "
          "pose replaces its whole pose: X,Y,Z is one without rotation and scale; 12 "
          "numbers, a 3x4 matrix row by row, keep them")
      ->type_name("INSTANCE=POSE");
  command
      .add_option("--layer", arguments->layers,
                  "Of a scene, as often as needed: answer for instances of this layer alone, by "
                  "its name (info lists them) [all]")
      ->type_name("NAME");
  Option* batch = command.add_file(
      "--batch", arguments->batch, Values::kFiles,
      "Query every line of a file (- for standard input): JSON objects with the names of the "
      "options as keys, without -- and with - or _ between words, \"file\", \"tree\" and \"mesh\" "
      "for FILE2, --tree2 and --mesh2, \"move\" for that line alone, and \"kind\" if no kind of "
      "query is given here. What lines "
      "of a kind that is given here do not say is taken from its options. Answers are JSON, too, "
      "each with the number of its \"line\", at once where lines come from a pipe");
  command.add_flag("--json", arguments->json, "Print one JSON document");
  command.add_file("--mesh", arguments->mesh, Values::kMeshes,
                   "The source mesh of a tree cooked with --external");
  command.takes_kinds();
  const Around around{command, batch, arguments};
  for_each_kind([&]<class Kind>() { add_kind<Kind>(around, status); });
  command.example("Many queries, one per line, from standard input",
                  "echo '{\"kind\":\"point\",\"at\":[1,2,3]}' | boxtree query bunny.bxt --batch -");
  command.callback([&command, arguments, &status] {
    if (command.has_parsed_command()) return;
    if (arguments->batch.empty()) {
      std::vector<std::string> kinds;
      for (const Command* kind : command.commands()) kinds.push_back(kind->name());
      refuse_without("a kind of query, " + listed(kinds) + ", or --batch");
    }
    status = run(*arguments, RequestDefaults());
  });
}

}  // namespace boxtree::cooker
