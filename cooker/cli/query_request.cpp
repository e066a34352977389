// SPDX-License-Identifier: MIT
// Parsing, querying, and the JSON of answers.
#include "cooker/cli/query_request.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "cooker/cli/open_file.h"
#include "cooker/cli/output.h"
#include "cooker/cli/standard_streams.h"
#include "cooker/cli/tree_kinds.h"
#include "cooker/import/import.h"
#include "cooker/import/mesh_arrays.h"
#include "cooker/text/nearest_name.h"
#include "cooker/text/pose_fault.h"
#include "format/tree_record.h"
#include "runtime/file/open_file.h"

namespace boxtree::cooker {
namespace {

Result<Json> answer(const Tree& tree, const RayRequest& request) {
  return answer_ray(tree, request,
                    [](const RayHit& found, Json& json) { json["face"] = face_json(found.face); });
}

template <class Overlap>
Result<Json> answer_faces(Overlap overlap) {
  Json faces = Json::array();
  const Result<Visit> visit = overlap([&](const FaceRef& face) {
    faces.push_back(face_json(face));
    return true;
  });
  if (!visit) return visit.error();
  return Json{{"count", faces.size()}, {"faces", faces}};
}

const char* name_of(Overlap overlap) {
  switch (overlap) {
    case Overlap::kOverlapping:
      return "overlapping";
    case Overlap::kDisjoint:
      return "disjoint";
    case Overlap::kUndecided:
      return "undecided";
    case Overlap::kBudgetSpent:
      return "budget_spent";
  }
  return "";
}

Result<Json> answer(const Tree& tree, const BoxRequest& request) {
  if (request.with_overlap) {
    const auto found =
        overlap_box_within(tree, request.box, request.overlap.within, request.overlap.node_budget);
    if (!found) return found.error();
    Json json = {{"overlap", name_of(found->overlap)}, {"nodes", found->nodes_expanded}};
    if (found->face) json["face"] = face_json(*found->face);
    return json;
  }
  return answer_faces([&](FaceVisitor visitor) { return overlap_box(tree, request.box, visitor); });
}

Result<Json> answer(const Tree& tree, const SphereRequest& request) {
  return answer_faces([&](FaceVisitor visitor) {
    return overlap_sphere(tree, request.center, request.radius, visitor);
  });
}

void add_closest(Json& json, const std::optional<ClosestPoint>& closest) {
  json["found"] = closest.has_value();
  if (!closest) return;
  json["distance"] = closest->distance;
  json["point"] = to_json(closest->point);
  json["face"] = face_json(closest->face);
  json["triangle"] = closest->triangle;
}

// What is known, for any answer with bounds. An infinite upper bound is null: JSON has no infinity.
template <class Bounded>
Json bounds_json(const Bounded& bounds) {
  return {{"lower", bounds.lower},
          {"upper", bounds.upper},
          {"converged", bounds.converged},
          {"nodes", bounds.nodes_expanded}};
}

Result<Json> answer(const Tree& tree, const PointRequest& request) {
  if (request.with_bounds) {
    const auto found = closest_point(tree, request.at, request.options);
    if (!found) return found.error();
    Json json = bounds_json(*found);
    add_closest(json, found->witness);
    return json;
  }
  const auto closest = closest_point(tree, request.at, request.options.max_distance);
  if (!closest.ok()) return closest.error();
  Json json;
  add_closest(json, closest.as_optional());
  return json;
}

Result<Json> answer_pair(const Tree& first, const Tree& second, const PairRequest& request) {
  Json pairs = Json::array();
  const Result<Visit> visit = overlap_pairs(
      first, Pose::Identity(), second, request.second.pose, [&](const FacePair& pair) {
        pairs.push_back({face_json(pair.first), face_json(pair.second)});
        return !request.first_only;
      });
  if (!visit) return visit.error();
  return Json{{"hit", !pairs.empty()}, {"count", pairs.size()}, {"pairs", pairs}};
}

Result<Json> answer_pair(const Tree& first, const Tree& second, const DistanceRequest& request) {
  const auto found =
      distance(first, Pose::Identity(), second, request.second.pose, request.options);
  if (!found) return found.error();
  Json json = bounds_json(*found);
  json["found"] = found->witness.has_value();
  if (found->witness) {
    const DistanceWitness& witness = *found->witness;
    json["faces"] = {face_json(witness.faces.first), face_json(witness.faces.second)};
    json["points"] = {to_json(witness.first), to_json(witness.second)};
  }
  return json;
}

Result<Json> answer_pair(const Tree& first, const Tree& second, const OverlapRequest& request) {
  const auto found = overlap_within(first, Pose::Identity(), second, request.second.pose,
                                    request.options.within, request.options.node_budget);
  if (!found) return found.error();
  Json json = {{"overlap", name_of(found->overlap)}, {"nodes", found->nodes_expanded}};
  if (found->contact) {
    json["faces"] = {face_json(found->contact->first), face_json(found->contact->second)};
  }
  return json;
}

Result<Json> answer(const Tree& /*tree*/, const ContactsRequest& /*request*/) {
  return Error{Errc::kNoScene, "contacts are those of a scene, and this is one tree"};
}

QueryKinds kind_of(const RayRequest&) {
  return kRayQueries;
}
QueryKinds kind_of(const BoxRequest&) {
  return kBoxQueries;
}
QueryKinds kind_of(const SphereRequest&) {
  return kBoxQueries;
}
QueryKinds kind_of(const PointRequest&) {
  return kPointQueries;
}
QueryKinds kind_of(const ContactsRequest&) {
  return kPairQueries;
}
template <class AboutTwo>
requires requires(const AboutTwo& request) {
  request.second;
}
QueryKinds kind_of(const AboutTwo&) {
  return kPairQueries;
}

Error invalid(std::string what) {
  return {Errc::kInvalidQuery, std::move(what)};
}

// A value in a message, which a long one would fill.
std::string found_text(const Json& value) {
  constexpr std::size_t kLongest = 60;
  const std::string text = line_of(value);
  return text.size() <= kLongest ? text
                                 : fmt::format("{} of {} bytes", value.type_name(), text.size());
}

// X,Y,Z, or a 3x4 matrix row by row. Nothing for another count of numbers.
std::optional<Pose> pose_of(std::span<const double> numbers) {
  Pose pose = Pose::Identity();
  if (numbers.size() == 3) {
    pose.translation() = Eigen::Vector3d(numbers[0], numbers[1], numbers[2]);
    return pose;
  }
  if (numbers.size() != 12) return std::nullopt;
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < 4; ++column) {
      pose.matrix()(row, column) = numbers[static_cast<std::size_t>(4 * row + column)];
    }
  }
  return pose;
}

// A line of a batch.
struct BatchLine {
  Json values = Json::object();                // by key, with _ between words
  std::map<std::string, std::string> written;  // the key as the line has it
};

std::vector<std::string> kind_names() {
  std::vector<std::string> names;
  for_each_kind([&]<class Kind>() { names.emplace_back(Kind::kKind); });
  return names;
}

std::vector<std::string> kinds_of_two() {
  std::vector<std::string> names;
  for_each_kind([&]<class Kind>() {
    if constexpr (requires(Kind kind) { kind.second; }) names.emplace_back(Kind::kKind);
  });
  return names;
}

// Reads the keys of one request, which has the values of the command line, and remembers the first
// that is missing, wrong or unknown.
class KeyFields {
 public:
  // `given`: keys that may be missing, though they are needed.
  KeyFields(const BatchLine& line, std::string_view kind, std::span<const std::string> given)
      : json_(line.values), written_(line.written), kind_(kind), given_(given) {}

  template <class T>
  void required(const char* key, T& out, const char* /*help*/) {
    const bool is_given = std::find(given_.begin(), given_.end(), key) != given_.end();
    is_given ? static_cast<void>(read_if_given(key, out)) : read(key, out);
  }
  template <class T>
  void optional(const char* key, T& out, const char* /*help*/, bool* given = nullptr) {
    if (read_if_given(key, out) && given != nullptr) *given = true;
  }
  void second(SecondTree& tree) {
    if (!json_.contains("file") && !tree.file.empty()) {
      known_.emplace_back("file");
    } else {
      if (!tree.file.empty()) tree = SecondTree();
      read("file", tree.file, "the second .bxt file, here or on the command line");
    }
    read_if_given("tree", tree.tree);
    read_if_given("mesh", tree.mesh);
    read_if_given("pose", tree.pose);
  }

  void moves(std::vector<std::string>& out) { read_if_given("move", out); }

  // A misspelt key is the likely cause where another one is missing.
  [[nodiscard]] Status finish() {
    for (const auto& [key, value] : json_.items()) {
      const bool known = std::find(known_.begin(), known_.end(), key) != known_.end();
      if (!known && key != "kind" && (error_.empty() || is_missing_)) {
        is_missing_ = false;
        error_ = unknown_key(key);
      }
    }
    return error_.empty() ? Status() : Status(invalid(error_));
  }

 private:
  void fail(const std::string& key, std::string_view expected, const std::string& found) {
    if (!error_.empty()) return;
    is_missing_ = found == kNoSuchKey;
    error_ = fmt::format("{}: \"{}\": expected {}, found {}", kind_,
                         is_missing_ ? key : written_.at(key), expected, found);
  }

  // Words are joined in the message as they are in the line.
  [[nodiscard]] std::string unknown_key(const std::string& key) const {
    for (const char* second : {"file", "tree", "mesh", "pose"}) {
      if (key != second) continue;
      return fmt::format(
          "{}: \"{}\" is of the second tree of a line of the kind {}; FILE, --tree and --mesh of "
          "the command line say which tree a batch queries",
          kind_, key, listed(kinds_of_two()));
    }
    const std::string& written = written_.at(key);
    std::vector<std::string> names = known_;
    if (written != key) {
      for (std::string& name : names) std::replace(name.begin(), name.end(), '_', '-');
    }
    return fmt::format("{}: expected the keys {}{}kind, found \"{}\"{}", kind_,
                       fmt::join(names, ", "), names.empty() ? "" : " or ", written,
                       suggestion(written, names));
  }

  // The numbers of an array; nothing if it is another value.
  static std::optional<std::vector<double>> numbers_of(const Json& value) {
    const auto is_number = [](const Json& each) { return each.is_number(); };
    if (!value.is_array() || !std::all_of(value.begin(), value.end(), is_number)) {
      return std::nullopt;
    }
    return value.get<std::vector<double>>();
  }
  static bool convert(const Json& value, Eigen::Vector3d& out) {
    const auto numbers = numbers_of(value);
    if (!numbers || numbers->size() != 3) return false;
    out = Eigen::Vector3d((*numbers)[0], (*numbers)[1], (*numbers)[2]);
    return true;
  }
  static bool convert(const Json& value, Pose& out) {
    const auto numbers = numbers_of(value);
    const std::optional<Pose> pose = value.is_string() ? parse_pose(value.get<std::string>())
                                     : numbers         ? pose_of(*numbers)
                                                       : std::nullopt;
    out = pose.value_or(Pose::Identity());
    return pose.has_value();
  }
  static bool convert(const Json& value, double& out) {
    if (value.is_number()) out = value.get<double>();
    return value.is_number();
  }
  static bool convert(const Json& value, std::string& out) {
    if (value.is_string()) out = value.get<std::string>();
    if (value.is_number_unsigned()) out = std::to_string(value.get<std::uint64_t>());
    return value.is_string() || value.is_number_unsigned();
  }
  static bool convert(const Json& value, std::vector<std::string>& out) {
    const Json texts = value.is_array() ? value : Json::array({value});
    const auto is_text = [](const Json& each) { return each.is_string(); };
    const bool are_texts = std::all_of(texts.begin(), texts.end(), is_text);
    if (are_texts) out = texts.get<std::vector<std::string>>();
    return are_texts;
  }
  static bool convert(const Json& value, std::filesystem::path& out) {
    if (value.is_string()) out = value.get<std::string>();
    return value.is_string();
  }
  static bool convert(const Json& value, bool& out) {
    if (value.is_boolean()) out = value.get<bool>();
    return value.is_boolean();
  }
  static bool convert(const Json& value, std::uint64_t& out) {
    if (value.is_number_unsigned()) out = value.get<std::uint64_t>();
    return value.is_number_unsigned();
  }
  // What convert() takes.
  static const char* form_of(const Eigen::Vector3d&) { return "[X,Y,Z]"; }
  static const char* form_of(const Pose&) { return "X,Y,Z or 12 numbers, as an array or as text"; }
  static const char* form_of(double) { return "a number"; }
  static const char* form_of(const std::string&) { return "a name as a text, or a number"; }
  static const char* form_of(const std::vector<std::string>&) {
    return "INSTANCE=POSE as a text (\"Crate=1,2,3\"), or an array of such";
  }
  static const char* form_of(const std::filesystem::path&) { return "a text"; }
  static const char* form_of(bool) { return "true or false"; }
  static const char* form_of(std::uint64_t) { return "a whole number, 0 or more"; }

  template <class T>
  void read(const char* key, T& out, const char* expected = nullptr) {
    if (expected == nullptr) expected = form_of(out);
    known_.emplace_back(key);
    const auto found = json_.find(key);
    if (found == json_.end()) return fail(key, expected, kNoSuchKey);
    if (!convert(*found, out)) fail(key, expected, found_text(*found));
  }
  // The same, but the key may be missing.
  template <class T>
  bool read_if_given(const char* key, T& out) {
    if (json_.contains(key)) {
      read(key, out);
      return true;
    }
    known_.emplace_back(key);
    return false;
  }

  const Json& json_;
  const std::map<std::string, std::string>& written_;
  const std::string_view kind_;
  const std::span<const std::string> given_;
  std::vector<std::string> known_;
  static constexpr const char* kNoSuchKey = "no such key";
  std::string error_;
  bool is_missing_ = false;  // `error_` is of a key that is not there
};

// Shows what a request is made of: what is needed, and what differs from the defaults.
class FieldTexts {
 public:
  // The request in one line, "direction [0,0,0], t_max -1".
  template <class Kind>
  static std::string line_of(Kind request) {
    FieldTexts given, defaults;
    request.describe(given);
    Kind().describe(defaults);
    std::string line;
    for (std::size_t i = 0; i < given.fields_.size(); ++i) {
      const auto& [key, text, is_needed] = given.fields_[i];
      if (!is_needed && text == defaults.fields_[i].text) continue;
      line += fmt::format("{}{} {}", line.empty() ? "" : ", ", key, text);
    }
    return line;
  }

  void required(const char* key, const Eigen::Vector3d& value, const char* /*help*/) {
    fields_.push_back({key, fmt::format("[{},{},{}]", value[0], value[1], value[2]), true});
  }
  void required(const char* key, double value, const char* /*help*/) {
    fields_.push_back({key, fmt::format("{}", value), true});
  }
  template <class T>
  void optional(const char* key, const T& value, const char* /*help*/, bool* /*given*/ = nullptr) {
    fields_.push_back({key, fmt::format("{}", value), false});
  }
  void second(const SecondTree& /*tree*/) {}  // has no numbers but a pose, which has its own error

 private:
  struct Field {
    std::string key;
    std::string text;
    bool is_needed;
  };
  std::vector<Field> fields_;
};

// How many numbers stand between commas, in any locale; 0 if it is not that, or too many.
std::size_t parse_numbers(std::string_view text, std::span<double> numbers) {
  std::size_t count = 0;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (count < numbers.size()) {
    const auto [next, error] = std::from_chars(at, end, numbers[count++]);
    if (error != std::errc()) return 0;
    at = next;
    if (at == end) return count;
    if (*at++ != ',') return 0;
  }
  return 0;
}

// Names of options have hyphens, keys of answers underscores: keys of lines have either. Hyphens
// before a name, which no key has, stay for the message.
std::string with_underscores(std::string key) {
  const std::size_t first = std::min(key.find_first_not_of('-'), key.size());
  std::replace(key.begin() + static_cast<std::ptrdiff_t>(first), key.end(), '-', '_');
  return key;
}

// The object of a line. What nests deeper than any value that a message shows would overflow the
// stack.
Result<BatchLine> parse_line(std::string_view text) {
  constexpr int kDeepest = 4;
  bool is_too_deep = false;
  std::vector<std::string> keys;  // all that the line has, in its order
  const auto watch = [&](int depth, Json::parse_event_t event, const Json& parsed) {
    is_too_deep = is_too_deep || depth > kDeepest;
    const bool is_of_line = event == Json::parse_event_t::key && depth == 1;
    if (is_of_line && !is_too_deep) keys.push_back(parsed.get<std::string>());
    return !is_too_deep;
  };
  try {
    const Json json = Json::parse(text, watch);
    if (is_too_deep) {
      return invalid(fmt::format(
          "{}expected a JSON object of numbers, texts and arrays of them, found an array or an "
          "object in another",
          keys.empty() ? std::string() : '"' + keys.back() + "\": "));
    }
    if (!json.is_object()) return invalid("expected a JSON object, found " + found_text(json));
    BatchLine line;
    for (const std::string& key : keys) {
      const std::string name = with_underscores(key);
      const auto [first, is_new] = line.written.emplace(name, key);
      if (!is_new) {
        return invalid(fmt::format("\"{}\": expected once, found twice{}", key,
                                   first->second == key ? "" : ": - and _ are the same"));
      }
      line.values[name] = json[key];
    }
    return line;
  } catch (const Json::parse_error& error) {
    return invalid(fmt::format("expected a JSON object, found no JSON at byte {}", error.byte));
  } catch (const Json::out_of_range&) {
    return invalid(
        "expected a JSON object of finite numbers, found one beyond what a double holds");
  }
}

Result<BatchRequest> request_of(std::string_view kind, const BatchLine& of,
                                const RequestDefaults& defaults) {
  const bool is_default = kind == defaults.kind;
  KeyFields fields(of, kind,
                   is_default ? std::span(defaults.given) : std::span<const std::string>());
  std::optional<QueryRequest> result;
  for_each_kind([&]<class Kind>() {
    if (kind != Kind::kKind) return;
    const Kind* const given = is_default ? std::get_if<Kind>(&defaults.request) : nullptr;
    Kind request = given == nullptr ? Kind() : *given;
    request.describe(fields);
    result = request;
  });
  if (!result) {
    if (kind.empty()) {
      return invalid(fmt::format("\"kind\": expected {}, found no such key", listed(kind_names())));
    }
    return invalid(fmt::format("\"kind\": expected {}, found \"{}\"{}", listed(kind_names()), kind,
                               suggestion(kind, kind_names())));
  }
  BatchRequest line{*result, {}};
  fields.moves(line.moves);
  if (Status status = fields.finish(); !status) return status.error();
  return line;
}

}  // namespace

Result<OpenedTree> open_tree(const TreeWanted& wanted) {
  Result<OpenedFile> opened = open_file(wanted.path);
  if (!opened) return opened.error();
  return bind_tree(std::move(opened->file), wanted);
}

Result<OpenedTree> bind_tree(File opened, const TreeWanted& wanted) {
  const auto& [path, which, mesh, option, mesh_option] = wanted;
  File* const file = &opened;
  const Result<std::uint32_t> index = find_tree(*file, which);
  const std::string name = input_name(path);
  if (!index) return Error{index.code(), name + ": " + index.error().detail};
  BindOptions options;
  std::unique_ptr<SourceMesh> source;
  if (!mesh.empty()) {
    ImportOptions import = careful_import();
    const bool f64 = *index < file->tree_count() &&
                     (OpenFile::of(*file).tree_record(*index).flags & kTreePositionsF64) != 0;
    if (f64) import.precision = Precision::kF64;
    Result<Imported> imported = import_mesh(mesh, import);
    if (!imported) return imported.error();
    source = std::make_unique<SourceMesh>(std::move(imported->mesh));
    options.mesh = arrays_of(*source);
    options.verify_mesh = true;
  }
  Result<Tree> tree = Tree::bind(*file, *index, options);
  if (tree.code() == Errc::kExternalMeshNeeded) {
    return Error{tree.code(), fmt::format("{}: {}: name the one that it was cooked of with {} MESH",
                                          name, tree.error().detail, mesh_option)};
  }
  if (!tree) return Error{tree.code(), name + ": " + tree.error().detail};
  const Result<QueryKinds> kinds = kinds_of_tree(*file, *index);
  if (!kinds) return kinds.error();
  if (which.empty() && file->tree_count() > 1) {
    const std::string_view called = file->tree_name(*index);
    warn(fmt::format("{}: has {} trees, and this is about tree {}{}; {} names another, or this one",
                     name, file->tree_count(), *index,
                     called.empty() ? std::string() : fmt::format(", \"{}\"", called), option));
  }
  return OpenedTree{std::move(*file), std::move(source), std::move(*tree), *index, *kinds};
}

Result<const Tree*> TreeCache::get(const SecondTree& second) {
  std::unique_ptr<OpenedTree>& place = opened_[{second.file.string(), second.tree}];
  if (place == nullptr) {
    Result<OpenedTree> opened =
        open_tree({second.file, second.tree, second.mesh, "--tree2", "--mesh2"});
    if (!opened) return opened.error();
    if ((opened->kinds & kPairQueries) == 0) {
      const Error error = kind_left_out(opened->file, opened->index, kPairQueries);
      return Error{error.code, second.file.string() + ": " + error.detail};
    }
    place = std::make_unique<OpenedTree>(std::move(*opened));
  }
  return &place->tree;
}

QueryKinds kind_of(const QueryRequest& request) {
  return std::visit([](const auto& q) { return kind_of(q); }, request);
}

std::optional<Eigen::Vector3d> parse_vector(std::string_view text) {
  std::array<double, 3> numbers{};
  if (parse_numbers(text, numbers) != numbers.size()) return std::nullopt;
  return Eigen::Vector3d(numbers[0], numbers[1], numbers[2]);
}

std::optional<Pose> parse_pose(std::string_view text) {
  std::array<double, 12> numbers{};
  const std::size_t count = parse_numbers(text, numbers);
  return pose_of(std::span(numbers).first(count));
}

Error explained_pose(std::string_view whose, const Pose& pose) {
  std::vector<double> numbers;
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < 4; ++column) numbers.push_back(pose(row, column));
  }
  return {Errc::kInvalidPose,
          fmt::format("{} pose {}; expected finite numbers of an invertible map, found [{}]", whose,
                      pose_fault(pose), fmt::join(numbers, ","))};
}

Error explained(const Error& error, const QueryRequest& request) {
  // Of numbers that are not valid the library names one argument, without what was expected.
  const bool is_name =
      error.code == Errc::kInvalidQuery && error.detail.find(' ') == std::string::npos;
  if (!error.detail.empty() && !is_name) return error;
  if (error.code == Errc::kInvalidPose) {
    return std::visit(
        [&]<class Kind>(const Kind& q) -> Error {
          if constexpr (requires { q.second; }) {
            return explained_pose(std::string(Kind::kKind) + ": the second tree's", q.second.pose);
          } else {
            return error;
          }
        },
        request);
  }
  if (error.code != Errc::kInvalidQuery) return error;
  return std::visit(
      [&]<class Kind>(const Kind& q) -> Error {
        if constexpr (requires { Kind::kExpected; }) {
          return invalid(fmt::format("{}: expected {}, found {}", Kind::kKind, Kind::kExpected,
                                     FieldTexts::line_of(q)));
        } else {
          return error;
        }
      },
      request);
}

Result<BatchRequest> parse_request(std::string_view line, const RequestDefaults& defaults) {
  const Result<BatchLine> parsed = parse_line(line);
  if (!parsed) return parsed.error();
  const Json& values = parsed->values;
  std::string kind = defaults.kind;
  if (const auto given = values.find("kind"); given != values.end()) {
    if (!given->is_string())
      return invalid("\"kind\": expected a text, found " + found_text(*given));
    kind = given->get<std::string>();
  }
  return request_of(kind, *parsed, defaults);
}

Result<Json> answer(const Tree& tree, const QueryRequest& request, TreeCache& others) {
  return query_one_or_two(
      request, others, [&](const auto& q) { return answer(tree, q); },
      [&](const Tree& second, const auto& q) { return answer_pair(tree, second, q); });
}

Result<Json> answer(const OpenedTree& opened, const QueryRequest& request, TreeCache& others) {
  const QueryKinds kind = kind_of(request);
  if ((opened.kinds & kind) == 0) return kind_left_out(opened.file, opened.index, kind);
  return answer(opened.tree, request, others);
}

}  // namespace boxtree::cooker
