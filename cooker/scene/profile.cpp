// SPDX-License-Identifier: MIT
// Reads the tables of a profile into complete values: values that an object does not state are
// taken from [scene] here, so that later stages look in one place.
#include "cooker/scene/profile.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "cooker/import/whole_file.h"
#include "cooker/scene/hidden_faces.h"
#include "cooker/scene/profile_fields.h"
#include "cooker/scene/profile_pose.h"
#include "cooker/system/path.h"
#include "runtime/primitive/float_state.h"

namespace boxtree::cooker {
namespace {

constexpr std::size_t kLongestName = 0xffff;                     // InstanceRecord::name_bytes
constexpr std::array kSeveral = {"mesh", "object", "instance"};  // tables in double brackets
constexpr std::size_t kMaxObjects = kMaxLayers - 1;              // and "other"

template <class T>
void override_with(T& target, std::optional<T> value) {
  if (value) target = std::move(*value);
}

std::vector<std::string> codec_names() {
  std::vector<std::string> names;
  names.reserve(kCodecs.size());
  for (const CodecInfo& info : kCodecs) names.emplace_back(info.name);
  return names;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

class ProfileReader {
 public:
  /// `tables`: those of all profiles.
  ProfileReader(const std::filesystem::path& path, Profile& profile, TableKeys tables)
      : profile_(profile), complaints_(path.string(), std::move(tables)) {}

  Status read(const TomlTable& root);
  /// The tables that were read, and `tables`.
  [[nodiscard]] const TableKeys& tables() const { return complaints_.tables(); }

 private:
  // Tables of one kind, each with its line; empty if there are none.
  struct Header {
    const TomlTable* table;
    std::uint32_t line;
  };
  std::optional<Header> table(Fields& root, std::string_view key);
  std::vector<Header> tables(Fields& root, std::string_view key);

  void read_queries(Fields& fields, Stated<QueryKinds>& queries);
  void read_needs(Fields& fields, Needs& needs);
  void read_contact(Fields& fields, std::optional<ContactRule>& rule, bool is_object);
  void read_scene(const Header& header);
  void read_budget(const Header& header);
  void collect_names(const std::vector<Header>& headers, std::vector<std::string>& names,
                     std::string_view where);
  void read_object(const Header& header);
  void read_mesh(const Header& header);
  void read_hidden_faces(Fields& fields, ProfileMesh& mesh);
  void refuse_keys_outside_tables(const TomlTable& root);
  void read_instance(const Header& header);
  Stated<std::filesystem::path> beside(const Stated<std::string>& file) const {
    return {profile_.path.parent_path() / named_path(file.value), file.line};
  }

  Profile& profile_;
  Complaints complaints_;
  std::vector<std::string> object_names_;  // in order; the last: "other"
  std::vector<std::string> mesh_names_;
};

bool is_array_of_tables(const TomlNode& node) {
  const auto* array = std::get_if<TomlArray>(&node.value);
  return array != nullptr && !array->empty() &&
         std::holds_alternative<TomlTable>(array->front().value);
}

std::optional<ProfileReader::Header> ProfileReader::table(Fields& root, std::string_view key) {
  const TomlEntry* entry = root.find(key);
  if (entry == nullptr) return std::nullopt;
  if (const auto* found = std::get_if<TomlTable>(&entry->node.value)) {
    return Header{found, entry->line};
  }
  const bool is_doubled = is_array_of_tables(entry->node);
  complaints_.expected(entry->line, key,
                       is_doubled ? fmt::format("one table, [{}] in single brackets", key)
                                  : fmt::format("a table [{}]", key),
                       is_doubled ? fmt::format("[[{}]]", key) : shown(entry->node));
  return std::nullopt;
}

std::vector<ProfileReader::Header> ProfileReader::tables(Fields& root, std::string_view key) {
  const TomlEntry* entry = root.find(key);
  if (entry == nullptr) return {};
  std::vector<Header> found;
  const auto* array = std::get_if<TomlArray>(&entry->node.value);
  if (array == nullptr) {
    const bool is_single = std::holds_alternative<TomlTable>(entry->node.value);
    complaints_.expected(
        entry->line, key,
        is_single ? fmt::format("[[{}]] in double brackets, since there may be several", key)
                  : fmt::format("tables [[{}]]", key),
        is_single ? fmt::format("[{}]", key) : shown(entry->node));
    return found;
  }
  for (const TomlNode& node : *array) {
    if (const auto* element = std::get_if<TomlTable>(&node.value)) {
      found.push_back({element, node.line});
    } else {
      complaints_.expected(node.line, key, fmt::format("tables [[{}]]", key), shown(node));
    }
  }
  return found;
}

void ProfileReader::read_queries(Fields& fields, Stated<QueryKinds>& queries) {
  static const std::vector<std::string> kNames(kQueryNames.begin(), kQueryNames.end());
  const auto kinds = fields.texts("queries");
  if (!kinds) return;
  queries = {0, fields.find("queries")->line};
  for (const Stated<std::string>& kind : *kinds) {
    const auto number = fields.number_of(kind, "queries", kNames, "ray, box, point or pair");
    if (number) queries.value = static_cast<QueryKinds>(queries.value | 1u << *number);
  }
}

// If two keys state the same property in two ways, either replaces both values of [scene].
void ProfileReader::read_needs(Fields& fields, Needs& needs) {
  read_queries(fields, needs.queries);
  override_with(needs.face_ids, fields.flag("face_ids"));
  override_with(needs.materials, fields.flag("materials"));
  override_with(needs.names, fields.flag("names"));
  const auto tolerance = fields.number("tolerance", kAboveZero);
  const auto exact = fields.flag("exact");
  if (tolerance && exact && exact->value) fields.exclude("tolerance", "exact");
  if (exact) {
    needs.exact = *exact;
    if (exact->value) needs.tolerance.reset();
  }
  if (tolerance) {
    needs.tolerance = *tolerance;
    if (!exact) needs.exact = {false, tolerance->line};
  }
  if (const auto scale = fields.number("largest_scale", kAboveZero)) needs.largest_scale = *scale;
  if (const auto codec = fields.one_of("codec", codec_names(), "the name of a codec")) {
    needs.codec = {kCodecs[codec->value].id, codec->line};
  }
  static const std::vector<std::string> kGoals = {"memory", "speed", "balance"};
  static_assert(static_cast<int>(Goal::kSpeed) == 1 && static_cast<int>(Goal::kBalance) == 2);
  if (const auto goal = fields.one_of("for", kGoals, "memory, speed or balance")) {
    needs.goal = {static_cast<Goal>(goal->value), goal->line};
  }
  override_with(needs.external, fields.flag("external"));
}

void ProfileReader::read_contact(Fields& fields, std::optional<ContactRule>& rule, bool is_object) {
  const auto stiffness = fields.number("stiffness", kAboveZero);
  const auto mass = fields.number("mass", kAboveZero);
  const auto gravity = fields.number("gravity", kAboveZero);
  const auto jump = fields.number("jump", kAboveZero);
  const auto invisible = fields.flag("invisible");
  if (jump && invisible && invisible->value) fields.exclude("jump", "invisible");
  std::uint32_t line = 0;
  for (const auto& stated : {stiffness, mass, gravity, jump}) {
    if (stated && line == 0) line = stated->line;
  }
  if (invisible && line == 0) line = invisible->line;
  if (line == 0) return;
  if (!rule && (!stiffness || !mass)) {
    const char* missing = stiffness ? "mass" : "stiffness";
    // Invalid values have been reported already.
    if (fields.find(missing) == nullptr) {
      complaints_.expected(line, "contact", fmt::format("the key \"{}\" as well", missing), "none");
    }
    return;
  }
  if (!rule) rule.emplace();
  override_with(rule->stiffness, stiffness);
  override_with(rule->mass, mass);
  override_with(rule->gravity, gravity);
  rule->of_object = is_object;
  if (invisible) rule->invisible = *invisible;
  if (jump) {
    rule->jump = *jump;
    if (!invisible) rule->invisible = {false, jump->line};
  }
}

void ProfileReader::read_scene(const Header& header) {
  Fields fields(*header.table, "[scene]", header.line, complaints_);
  if (const auto source = fields.text("source")) profile_.source = beside(*source);
  if (const auto degrees = fields.number("active_edges", kSharpAngle)) {
    profile_.active_edges = *degrees;
  }
  if (const auto user_data = fields.text("user_data")) profile_.user_data = *user_data;
  read_needs(fields, profile_.scene);
  const TomlEntry* queries = fields.find("queries");
  if (queries != nullptr && profile_.scene.queries.value == 0) {
    complaints_.expected(queries->line, "queries", "at least one kind", "none");
  }
  fields.finish();
}

void ProfileReader::read_budget(const Header& header) {
  Fields fields(*header.table, "[budget]", header.line, complaints_);
  profile_.budget.bytes = fields.count("bytes");
  profile_.budget.bytes_per_triangle = fields.number("bytes_per_triangle", kAboveZero);
  profile_.budget.slowdown = fields.number("slowdown", kAboveZero);
  fields.finish();
}

// Collects names of objects and meshes before anything refers to them.
void ProfileReader::collect_names(const std::vector<Header>& headers,
                                  std::vector<std::string>& names, std::string_view where) {
  std::map<std::string, std::uint32_t> lines;
  for (const Header& header : headers) {
    Fields fields(*header.table, std::string(where), header.line, complaints_);
    const auto name = fields.required_text("name");
    names.push_back(name ? name->value : std::string());
    if (!name) continue;
    if (name->value.size() > kLongestName) {
      complaints_.expected(name->line, "name", fmt::format("at most {} bytes", kLongestName),
                           fmt::format("{}", name->value.size()));
    }
    const auto [earlier, is_new] = lines.emplace(name->value, name->line);
    if (!is_new) {
      complaints_.expected(name->line, "name", "a name of its own",
                           fmt::format("\"{}\", as in line {}", name->value, earlier->second));
    }
  }
}

void ProfileReader::read_object(const Header& header) {
  Fields fields(*header.table, "[[object]]", header.line, complaints_);
  ProfileObject object;
  object.needs = profile_.scene;
  override_with(object.name, fields.text("name"));
  if (object.name.value == kOtherObject) {
    complaints_.expected(object.name.line, "name", "another name: \"other\" is what is left over",
                         "\"other\"");
  }
  if (auto match = fields.texts("match")) object.match = std::move(*match);
  static const std::vector<std::string> kMotions = {"static", "moving"};
  if (const auto motion = fields.one_of("motion", kMotions, "static or moving")) {
    object.moves = {motion->value == 1, motion->line};
  }
  if (const auto names = fields.texts("never_collides_with")) {
    for (const Stated<std::string>& name : *names) {
      const auto number =
          fields.number_of(name, "never_collides_with", object_names_, "the name of an object");
      if (number) object.never_collides_with.push_back({*number, name.line});
    }
  }
  override_with(object.leave_out, fields.flag("leave_out"));
  read_needs(fields, object.needs);
  const auto extra =
      static_cast<QueryKinds>(object.needs.queries.value & ~profile_.scene.queries.value);
  if (extra != 0) {
    complaints_.expected(
        object.needs.queries.line, "queries",
        fmt::format("only kinds that [scene] states in line {}", profile_.scene.queries.line),
        "more");
  }
  // Of [scene] both may stand: its objects differ.
  const TomlEntry* const face_ids = fields.find("face_ids");
  if (face_ids != nullptr && fields.find("external") != nullptr && object.needs.external.value &&
      !object.needs.face_ids.value) {
    complaints_.expected(face_ids->line, "face_ids",
                         "true, since with external = true they lead into the application's arrays",
                         "false");
  }
  read_contact(fields, object.needs.contact, true);
  fields.finish();
  profile_.objects.push_back(std::move(object));
}

void ProfileReader::read_mesh(const Header& header) {
  Fields fields(*header.table, "[[mesh]]", header.line, complaints_);
  ProfileMesh mesh;
  override_with(mesh.name, fields.text("name"));
  if (const auto file = fields.text("file")) {
    mesh.file = beside(*file);
    if (profile_.source) {
      complaints_.expected(file->line, "file", "no file, as [scene] states a source", "one");
    }
  }
  mesh.external = fields.flag("external");
  mesh.spawned_as = fields.one_of("spawned_as", object_names_, "the name of an object");
  if (mesh.spawned_as) {
    const ProfileObject& object = profile_.objects[mesh.spawned_as->value];
    if (object.leave_out.value) {
      complaints_.expected(mesh.spawned_as->line, "spawned_as", "an object that is kept",
                           fmt::format("\"{}\", which line {} leaves out", object.name.value,
                                       object.leave_out.line));
    }
  }
  read_hidden_faces(fields, mesh);
  fields.finish();
  profile_.meshes.push_back(std::move(mesh));
}

void ProfileReader::read_hidden_faces(Fields& fields, ProfileMesh& mesh) {
  const auto list = fields.text("hidden_faces");
  if (!list) return;
  const std::filesystem::path path = beside(*list).value;
  const Result<std::string> text = read_whole_file(path, kMaxFaceListBytes, profile_.path.string());
  if (!text) {
    const Error& error = text.error();
    if (error.code == Errc::kFileNotFound) {  // with its code: it may be there later
      complaints_.add(list->line, "hidden_faces: " + error.detail, error.code);
    } else {
      complaints_.expected(list->line, "hidden_faces", "the name of a list of faces",
                           error.message());
    }
    return;
  }
  profile_.files_read.push_back(path);
  auto faces = parse_hidden_faces(*text, list->value);
  if (!faces) return complaints_.add(list->line, "hidden_faces: " + faces.error().detail);
  mesh.hidden_faces = std::move(*faces);
  mesh.hidden_faces_line = list->line;
}

void ProfileReader::read_instance(const Header& header) {
  Fields fields(*header.table, "[[instance]]", header.line, complaints_);
  ProfileInstance instance;
  instance.line = header.line;
  if (const auto mesh = fields.required_text("mesh")) {
    const auto number = fields.number_of(*mesh, "mesh", mesh_names_, "the name of a [[mesh]]");
    if (number) {
      instance.mesh = *number;
      instance.name = mesh->value;
      if (!profile_.meshes[*number].file) {
        complaints_.expected(mesh->line, "mesh", "a mesh that states a file",
                             '"' + mesh->value + '"');
      }
    }
  }
  if (const auto name = fields.text("name")) {
    instance.name = name->value;
    if (name->value.size() > kLongestName) {
      complaints_.expected(name->line, "name", fmt::format("at most {} bytes", kLongestName),
                           fmt::format("{}", name->value.size()));
    }
  }
  instance.object = fields.one_of("object", object_names_, "the name of an object");
  instance.pose = read_pose(fields);
  fields.finish();
  profile_.instances.push_back(std::move(instance));
}

// Values of keys; other tables are reported as keys that are not known.
void ProfileReader::refuse_keys_outside_tables(const TomlTable& root) {
  for (const TomlEntry& entry : root) {
    if (std::holds_alternative<TomlTable>(entry.node.value) || is_array_of_tables(entry.node)) {
      continue;
    }
    const std::string tables = complaints_.tables_with(entry.key);
    complaints_.expected(entry.line, entry.key,
                         tables.empty() ? "it below a table: [scene], [budget], [contact], "
                                          "[[object]], [[mesh]] or [[instance]]"
                                        : "it below " + tables,
                         "it outside of all tables");
  }
}

Status ProfileReader::read(const TomlTable& root) {
  Fields fields(root, "the profile", 1, complaints_);
  if (const auto scene = table(fields, "scene")) read_scene(*scene);
  if (const auto budget = table(fields, "budget")) read_budget(*budget);
  if (const auto contact = table(fields, "contact")) {
    Fields keys(*contact->table, "[contact]", contact->line, complaints_);
    read_contact(keys, profile_.scene.contact, false);
    // Values that are wrong have been reported already, at later lines.
    const bool has_stiffness = keys.find("stiffness") != nullptr;
    const bool has_mass = keys.find("mass") != nullptr;
    if (!has_stiffness || !has_mass) {
      complaints_.expected(contact->line, "[contact]", "the keys \"stiffness\" and \"mass\"",
                           has_stiffness ? "no \"mass\""
                           : has_mass    ? "no \"stiffness\""
                                         : "neither");
    }
    keys.finish();
  }
  const std::vector<Header> meshes = tables(fields, "mesh");
  const std::vector<Header> objects = tables(fields, "object");
  const std::vector<Header> instances = tables(fields, "instance");
  refuse_keys_outside_tables(root);
  fields.finish();
  if (objects.size() > kMaxObjects) {
    complaints_.expected(objects[kMaxObjects].line, "[[object]]",
                         fmt::format("at most {} objects", kMaxObjects),
                         fmt::format("{}", objects.size()));
  }
  collect_names(objects, object_names_, "[[object]]");
  collect_names(meshes, mesh_names_, "[[mesh]]");
  object_names_.emplace_back(kOtherObject);
  profile_.objects.clear();
  for (const Header& header : objects) read_object(header);
  profile_.objects.push_back({.name = {std::string(kOtherObject)}, .needs = profile_.scene});
  for (const Header& header : meshes) read_mesh(header);
  if (profile_.source && !instances.empty()) {
    complaints_.expected(instances.front().line, "[[instance]]",
                         "no instances, as [scene] states a source", "one");
  }
  for (const Header& header : instances) read_instance(header);
  return complaints_.status();
}

// The keys that each table may have: what is requested of one that is empty.
TableKeys keys_of_tables() {
  const TomlNode empty{TomlTable(), 0};
  TomlTable root;
  for (const char* name : {"scene", "budget", "contact"}) root.push_back({name, 0, empty});
  for (const char* name : kSeveral) root.push_back({name, 0, {TomlArray(1, empty), 0}});
  Profile none;
  ProfileReader reader({}, none, {});
  static_cast<void>(reader.read(root));  // complains of keys that are needed
  return reader.tables();
}

// The line up to a '#' outside of strings.
std::string without_comment(const std::string& line) {
  char quote = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quote == '"' && c == '\\') {
      ++i;
    } else if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '#') {
      return line.substr(0, i);
    }
  }
  return line;
}

// The parser refuses a second [object] before it is known that it may stand several times.
Error explained(const Error& error) {
  for (const char* table : kSeveral) {
    if (error.detail.ends_with(fmt::format("existing table '{}'", table))) {
      return {error.code,
              fmt::format("{}; expected [[{}]] in double brackets, since there may be several",
                          error.detail, table)};
    }
  }
  return error;
}

}  // namespace

Profile::Profile() {
  objects.push_back({.name = {std::string(kOtherObject)}});
}

std::string Profile::cite(std::uint32_t line) const {
  if (path.empty()) return "no profile";
  if (line == 0 || line > lines.size()) return "default";
  const std::string text = without_comment(lines[line - 1]);
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string::npos) return fmt::format("{}:{}", path.filename().string(), line);
  const std::size_t last = text.find_last_not_of(" \t\r");
  return fmt::format("{}:{}: {}", path.filename().string(), line,
                     text.substr(first, last - first + 1));
}

Result<Profile> read_profile(const std::filesystem::path& path) {
  const DefaultFloatState state;
  const Result<std::string> text = read_whole_file(path, kMaxProfileBytes);
  if (!text) return text.error();
  const Result<TomlTable> root = parse_toml(*text, path.string());
  if (!root) return explained(root.error());
  Profile profile;
  profile.path = path;
  profile.lines = lines_of(*text);
  profile.files_read.push_back(path);
  ProfileReader reader(path, profile, keys_of_tables());
  if (Status status = reader.read(*root); !status) return status.error();
  return profile;
}

// On a mismatch the last '*' takes one more character; an earlier one never has to.
bool glob_matches(std::string_view glob, std::string_view name) noexcept {
  std::size_t g = 0, n = 0;
  std::size_t star = std::string_view::npos, taken = 0;
  while (n < name.size()) {
    if (g < glob.size() && glob[g] == '*') {
      star = g++;
      taken = n;
    } else if (g < glob.size() && (glob[g] == '?' || glob[g] == name[n])) {
      ++g;
      ++n;
    } else if (star != std::string_view::npos) {
      g = star + 1;
      n = ++taken;
    } else {
      return false;
    }
  }
  while (g < glob.size() && glob[g] == '*') ++g;
  return g == glob.size();
}

}  // namespace boxtree::cooker
