// SPDX-License-Identifier: MIT
// `boxtree query`: queries one tree of a mapped file, or two trees against each other, one request
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
#include "cooker/cli/query_request.h"
#include "cooker/cli/scene_query.h"

namespace boxtree::cooker {
namespace {

struct Arguments {
  std::filesystem::path file;
  std::string tree;  // empty: the scene of the file, or else its first tree
  std::vector<std::string> moves;
  std::filesystem::path mesh;
  std::filesystem::path batch;
  bool json = false;
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
using AnswerRequest = std::function<Result<Json>(const QueryRequest& request, TreeCache& others)>;
int run_batch(const Arguments& arguments, const AnswerRequest& answer_request,
              const std::string& kind) {
  BatchLines lines(arguments.batch);
  TreeCache others;
  Json answers = Json::array();
  int status = 0;
  std::string line;
  while (lines.next(line)) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const Result<QueryRequest> request = parse_request(line, kind);
    Result<Json> answer =
        request ? answer_request(*request, others) : Result<Json>(request.error());
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

// `missing` names an option that the kind needs and that was not given; or is empty.
int run(const Arguments& arguments, const std::string& kind, const QueryRequest& request,
        const std::string& missing) {
  if (arguments.batch.empty() && !missing.empty()) {
    return usage(fmt::format("{} is required", missing));
  }
  Result<OpenedFile> opened = open_file(arguments.file);
  if (!opened) return fail(opened.error());
  const File& file = opened->file;
  if (!arguments.moves.empty() && (!file.has_scene() || !arguments.tree.empty())) {
    return usage("--move is for instances of a scene");
  }
  const auto answer_all = [&](const AnswerRequest& answer_request) {
    if (!arguments.batch.empty()) return run_batch(arguments, answer_request, kind);
    TreeCache others;
    const Result<Json> answer = answer_request(request, others);
    if (!answer) return fail(answer.error());
    print_answer(arguments, *answer);
    return 0;
  };
  if (file.has_scene() && arguments.tree.empty()) {
    const Result<OpenedScene> scene = open_scene(std::move(opened->file), arguments.moves);
    if (!scene) {
      return fail({scene.code(), arguments.file.string() + ": " + scene.error().detail});
    }
    return answer_all([&](const QueryRequest& each, TreeCache& others) {
      return answer(scene->scene, each, others);
    });
  }
  const Result<OpenedTree> tree =
      bind_tree(std::move(opened->file), arguments.file, arguments.tree, arguments.mesh);
  if (!tree) return fail(tree.error());
  return answer_all([&](const QueryRequest& each, TreeCache& others) {
    return answer(tree->tree, each, others);
  });
}

// Declares what a request is made of as options of its command.
class OptionFields {
 public:
  explicit OptionFields(CLI::App& command) : command_(command) {}

  void required(const char* key, Eigen::Vector3d& out, const char* help) {
    required_.push_back(add_vector_option(command_, option_name(key), out, help));
  }
  void required(const char* key, double& out, const char* help) {
    required_.push_back(command_.add_option(option_name(key), out, help)->type_name("N"));
  }
  void optional(const char* key, double& out, const char* help, bool* given = nullptr) {
    note(command_.add_option(option_name(key), out, help)->type_name("N"), given);
  }
  void optional(const char* key, std::uint64_t& out, const char* help, bool* given = nullptr) {
    // Unsigned numbers of CLI11 take "-1" for 2^64 - 1.
    note(command_.add_option(option_name(key), out, help)
             ->type_name("N")
             ->check(CLI::NonNegativeNumber.description("")),
         given);
  }
  void optional(const char* key, bool& out, const char* help) {
    command_.add_flag(option_name(key), out, help);
  }
  void second(SecondTree& tree) {
    second_ = command_.add_option("FILE2", tree.file, "The second .bxt file")->type_name("FILE2");
    command_
        .add_option_function<std::string>(
            "--pose",
            [this, &tree](const std::string& text) {
              const std::optional<Pose> pose = parse_pose(text);
              if (pose) {
                tree.pose = *pose;
              } else {
                problem_ = fmt::format("--pose: expected X,Y,Z or 12 numbers, found \"{}\"", text);
              }
            },
            "Pose of the second tree: X,Y,Z or the 12 numbers of a 3x4 matrix, row by row")
        ->type_name("POSE");
    command_.add_option("--tree2", tree.tree, "Its tree, by name or number")
        ->type_name("TREE")
        ->group(kRareOptions);
    command_.add_option("--mesh2", tree.mesh, "Its source mesh, if it was cooked with --external")
        ->type_name("FILE")
        ->group(kRareOptions);
  }

  // What is wrong with what was given; nothing if all is right.
  [[nodiscard]] const std::string& problem() const { return problem_; }

  // What has to be given and was not; nothing if all was.
  [[nodiscard]] std::string first_missing() const {
    if (second_ != nullptr && second_->count() == 0) return "the second file";
    for (const CLI::Option* option : required_) {
      if (option->count() == 0) return option->get_name();
    }
    return {};
  }

 private:
  static std::string option_name(std::string key) {
    std::replace(key.begin(), key.end(), '_', '-');
    return "--" + key;
  }
  static void note(CLI::Option* option, bool* given) {
    if (given != nullptr) option->each([given](const std::string&) { *given = true; });
  }

  CLI::App& command_;
  std::vector<const CLI::Option*> required_;
  const CLI::Option* second_ = nullptr;
  std::string problem_;
};

template <class Kind>
void add_kind(CLI::App& query, const std::shared_ptr<Arguments>& arguments, int& status) {
  CLI::App& command = *query.add_subcommand(Kind::kKind, Kind::kHelp);
  const auto request = std::make_shared<Kind>();
  const auto options = std::make_shared<OptionFields>(command);
  request->describe(*options);
  command.callback([arguments, request, options, &status] {
    status = options->problem().empty()
                 ? run(*arguments, Kind::kKind, *request, options->first_missing())
                 : usage(options->problem());
  });
}

}  // namespace

void add_query_command(CLI::App& app, int& status) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App& command = *app.add_subcommand("query", "Query a .bxt file");
  command.add_option("FILE", arguments->file, "The file to query; - is standard input")
      ->type_name("FILE")
      ->required();
  command
      .add_option("--tree", arguments->tree,
                  "Which tree, by name or number [the scene of the file, or else tree 0]")
      ->type_name("TREE");
  command
      .add_option("--move", arguments->moves,
                  "Of a scene, as often as needed: INSTANCE=POSE, the instance by name or "
                  "number, the pose as X,Y,Z or 12 numbers")
      ->type_name("INSTANCE=POSE");
  command
      .add_option("--batch", arguments->batch,
                  "Query every line of a file (- for standard input): JSON objects with the names "
                  "of the options as keys, and \"kind\" if no kind of query is given here")
      ->type_name("FILE");
  command.add_flag("--json", arguments->json, "Print one JSON document");
  command.add_option("--mesh", arguments->mesh, "The source mesh of a tree cooked with --external")
      ->type_name("FILE")
      ->group(kRareOptions);
  command.require_subcommand(0, 1);
  command.fallthrough();
  for_each_kind([&]<class Kind>() { add_kind<Kind>(command, arguments, status); });
  command.callback([&command, arguments, &status] {
    if (!command.get_subcommands().empty()) return;
    status = arguments->batch.empty() ? usage("a kind of query or --batch is required")
                                      : run(*arguments, "", RayRequest(), {});
  });
}

}  // namespace boxtree::cooker
