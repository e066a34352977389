// SPDX-License-Identifier: MIT
// Reading JSON, and messages for what is missing, wrong or unknown.
#include "cooker/cli/batch_line.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "cooker/cli/json_output.h"
#include "cooker/system/path.h"
#include "cooker/text/nearest_name.h"

namespace boxtree::cooker {
namespace {

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
  // A line with a shape takes none of the command line.
  void shape(CastShape& shape) {
    const bool has_axes = json_.contains("box") || json_.contains("hull");
    if (json_.contains("sphere") || json_.contains("capsule") || has_axes) {
      const auto turned = has_axes ? shape.rotation : std::nullopt;
      shape = CastShape();
      shape.rotation = turned;
    }
    read_if_given("sphere", shape.sphere);
    read_if_given("capsule", shape.capsule, "[X,Y,Z,R]");
    read_if_given("box", shape.box, "[HX,HY,HZ]");
    read_if_given("hull", shape.hull, "the file of a mesh");
    read_if_given("rotation", shape.rotation, "[X,Y,Z,W]");
  }

  void back_faces(BackFaces& out) {
    std::string name = name_of(out);
    read_if_given("back_faces", name);
    if (const auto known = back_faces_of(name)) {
      out = *known;
    } else {
      fail("back_faces", "hit, ignore or only", "\"" + name + "\"");
    }
  }

  void moves(std::vector<std::string>& out) { read_if_given("move", out); }

  // Of keys that exclude each other.
  void check(const std::string& fault) {
    if (fault.empty() || !error_.empty()) return;
    error_ = fmt::format("{}: {}", kind_, fault);
    is_missing_ = true;
  }

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
    return fmt::format("{}: expected the keys {}{}kind, found \"{}\"{}", kind_, joined(names, ", "),
                       names.empty() ? "" : " or ", written, suggestion(written, names));
  }

  // The numbers of an array; nothing if it is another value.
  static std::optional<std::vector<double>> numbers_of(const Json& value) {
    if (!value.is_array()) return std::nullopt;
    std::vector<double> numbers;
    for (const Json& each : value) {
      if (!each.is_number()) return std::nullopt;
      numbers.push_back(each.get<double>());
    }
    return numbers;
  }
  static bool convert(const Json& value, Eigen::Vector3d& out) {
    const auto numbers = numbers_of(value);
    if (!numbers || numbers->size() != 3) return false;
    out = Eigen::Vector3d((*numbers)[0], (*numbers)[1], (*numbers)[2]);
    return true;
  }
  static bool convert(const Json& value, Frustum::ViewProjection& out) {
    const auto numbers = numbers_of(value);
    const auto matrix = numbers ? matrix_of(*numbers) : std::nullopt;
    if (matrix) out = *matrix;
    return matrix.has_value();
  }
  static bool convert(const Json& value, Pose& out) {
    const auto numbers = numbers_of(value);
    const std::optional<Pose> pose = value.is_string() ? parse_pose(value.get<std::string>())
                                     : numbers         ? pose_of(*numbers)
                                                       : std::nullopt;
    out = pose.value_or(Pose::Identity());
    return pose.has_value();
  }
  template <std::size_t kCount>
  static bool convert(const Json& value, std::array<double, kCount>& out) {
    const auto numbers = numbers_of(value);
    if (!numbers || numbers->size() != kCount) return false;
    std::copy(numbers->begin(), numbers->end(), out.begin());
    return true;
  }
  template <class T>
  static bool convert(const Json& value, std::optional<T>& out) {
    return convert(value, out.emplace());
  }
  static bool convert(const Json& value, double& out) {
    if (value.is_number()) out = value.get<double>();
    return value.is_number();
  }
  static bool convert(const Json& value, std::string& out) {
    if (value.is_string()) out = value.get<std::string>();
    return value.is_string();
  }
  static bool convert(const Json& value, WhichTree& out) {
    out.is_number = value.is_number_unsigned();
    if (out.is_number) out.text = std::to_string(value.get<std::uint64_t>());
    return out.is_number || convert(value, out.text);
  }
  static bool convert(const Json& value, std::vector<std::string>& out) {
    std::vector<std::string> texts;
    for (const Json& each :
         value.is_array() ? std::span(value.begin(), value.end()) : std::span(&value, 1)) {
      if (!each.is_string()) return false;
      texts.push_back(each.get<std::string>());
    }
    out = std::move(texts);
    return true;
  }
  // The system takes a name to end at a NUL.
  static bool convert(const Json& value, std::filesystem::path& out) {
    std::string name;
    if (!convert(value, name) || name.find('\0') != std::string::npos) return false;
    out = named_path(name);
    return true;
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
  static const char* form_of(const Frustum::ViewProjection&) { return "an array of 16 numbers"; }
  static const char* form_of(const Pose&) { return "X,Y,Z or 12 numbers, as an array or as text"; }
  static const char* form_of(double) { return "a number"; }
  static const char* form_of(const std::optional<double>&) { return "a number"; }
  static const char* form_of(const std::string&) { return "a text"; }
  static const char* form_of(const WhichTree&) { return "a name as a text, or a number"; }
  static const char* form_of(const std::vector<std::string>&) {
    return "INSTANCE=POSE as a text (\"Crate=1,2,3\"), or an array of such";
  }
  static const char* form_of(const std::filesystem::path&) { return "the name of a file"; }
  static const char* form_of(bool) { return "true or false"; }
  static const char* form_of(std::uint64_t) { return "a whole number, 0 or more"; }

  template <class T>
  void read(const char* key, T& out, const char* expected = nullptr) {
    if constexpr (requires { form_of(out); }) {
      if (expected == nullptr) expected = form_of(out);
    }
    known_.emplace_back(key);
    const Json* const found = json_.find(key);
    if (found == nullptr) return fail(key, expected, kNoSuchKey);
    if (!convert(*found, out)) fail(key, expected, found_text(*found));
  }
  // The same, but the key may be missing.
  template <class T>
  bool read_if_given(const char* key, T& out, const char* expected = nullptr) {
    if (json_.contains(key)) {
      read(key, out, expected);
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
  constexpr std::size_t kDeepest = 4;
  const ParsedJson parsed = parse_json(text, kDeepest);
  const Json& json = parsed.value;
  const std::vector<std::string>& keys = parsed.keys;
  switch (parsed.fault) {
    case ParsedJson::Fault::kNoJson:
      return invalid(fmt::format("expected a JSON object, found no JSON at byte {}", parsed.byte));
    case ParsedJson::Fault::kTooLarge:
      return invalid(
          "expected a JSON object of finite numbers, found one beyond what a double holds");
    case ParsedJson::Fault::kTooDeep:
      return invalid(fmt::format(
          "{}expected a JSON object of numbers, texts and arrays of them, found an array or an "
          "object in another",
          keys.empty() ? std::string() : '"' + keys.back() + "\": "));
    case ParsedJson::Fault::kNone:
      break;
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
    if constexpr (requires { request.fault("", false); }) fields.check(request.fault("", false));
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

Result<BatchRequest> parse_request(std::string_view line, const RequestDefaults& defaults) {
  const Result<BatchLine> parsed = parse_line(line);
  if (!parsed) return parsed.error();
  const Json& values = parsed->values;
  std::string kind = defaults.kind;
  if (const Json* const given = values.find("kind"); given != nullptr) {
    if (!given->is_string())
      return invalid("\"kind\": expected a text, found " + found_text(*given));
    kind = given->get<std::string>();
  }
  return request_of(kind, *parsed, defaults);
}

}  // namespace boxtree::cooker
