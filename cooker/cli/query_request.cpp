// SPDX-License-Identifier: MIT
// Opening, querying, and the JSON of answers.
#include "cooker/cli/query_request.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include <fmt/format.h>

#include "cooker/cli/open_file.h"
#include "cooker/cli/output.h"
#include "cooker/cli/shape_answers.h"
#include "cooker/cli/standard_streams.h"
#include "cooker/cli/tree_kinds.h"
#include "cooker/import/file_error.h"
#include "cooker/import/import.h"
#include "cooker/import/mesh_arrays.h"
#include "cooker/text/nearest_name.h"
#include "cooker/text/pose_fault.h"
#include "format/tree_record.h"
#include "runtime/file/open_file.h"
#include "runtime/tree/bound_tree.h"

namespace boxtree::cooker {
namespace {

// The same keys wherever an object names a face.
void add_face(const Tree& tree, const FaceRef& face, Json& json) {
  json["face"] = face_json(face);
  const std::uint32_t material = tree.material(face);
  add_material(json, material, tree.material_name(material));
  add_user_data(json, tree.user_data(face));
}

// A face in a list: an object if the tree has materials or user data, else its number.
Json listed_face(const Tree& tree, const FaceRef& face) {
  if (!BoundTree::of(tree).has_materials() && !tree.has_user_data()) return face_json(face);
  Json json;
  add_face(tree, face, json);
  return json;
}

Error only_of_scenes(const std::string& what, const std::string& instead) {
  return {Errc::kNoScene,
          fmt::format("{} are those of a scene, and this is one tree; {}, or query a file of "
                      "cook --scene, without --tree (of a pack, with --scene NAME)",
                      what, instead)};
}

// A face of each tree.
Json listed_faces(const Tree& first, const Tree& second, const FacePair& faces) {
  return {listed_face(first, faces.first), listed_face(second, faces.second)};
}

// See ShapeAnswers.
struct TreeKinds {
  using Body = Tree;
  using OfRay = RayHit;
  using OfCast = CastHit;
  using OfShape = Contact;
  using Options = FaceOptions;

  template <class Shape>
  static Result<Visit> collide(const Tree& tree, const Shape& shape, ContactVisitor visitor,
                               const FaceOptions& options) {
    return boxtree::collide(tree, shape, visitor, options.limits);
  }
  template <class Hit>
  static void add_face(const Tree& tree, const Hit& hit, Json& json) {
    cooker::add_face(tree, hit.face, json);
  }
  template <class Hit>
  static const Tree& tree_of(const Tree& tree, const Hit&) {
    return tree;
  }
  template <class Hit>
  static auto rank(const Tree&, const Hit& hit) {  // without ids all faces have the same
    return std::array{std::uint32_t{0}, hit.face.id, hit.face.index, hit.triangle};
  }
};

Result<Json> answer(const Tree& tree, const RayRequest& request) {
  return ShapeAnswers<TreeKinds>(tree).answer(request);
}
Result<Json> answer(const Tree& tree, const CastRequest& request) {
  return ShapeAnswers<TreeKinds>(tree).answer(request);
}
Result<Json> answer(const Tree& tree, const CollideRequest& request) {
  return ShapeAnswers<TreeKinds>(tree).answer(request);
}

template <class Overlap>
Result<Json> answer_faces(const Tree& tree, Overlap overlap) {
  Json faces = Json::array();
  const Result<Visit> visit = overlap([&](const FaceRef& face) {
    faces.push_back(listed_face(tree, face));
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
    if (found->face) add_face(tree, *found->face, json);
    return json;
  }
  return answer_faces(tree,
                      [&](FaceVisitor visitor) { return overlap_box(tree, request.box, visitor); });
}

Result<Json> answer(const Tree& tree, const SphereRequest& request) {
  return answer_faces(tree, [&](FaceVisitor visitor) {
    return overlap_sphere(tree, request.center, request.radius, visitor);
  });
}

Result<Json> answer(const Tree& tree, const FrustumRequest& request) {
  if (request.instances) {
    return only_of_scenes("instances", "leave --instances out for its faces");
  }
  return answer_faces(
      tree, [&](FaceVisitor visitor) { return overlap_frustum(tree, request.frustum(), visitor); });
}

void add_closest(const Tree& tree, Json& json, const std::optional<ClosestPoint>& closest) {
  json["found"] = closest.has_value();
  if (!closest) return;
  json["distance"] = closest->distance;
  json["point"] = to_json(closest->point);
  add_face(tree, closest->face, json);
  json["triangle"] = closest->triangle;
}

Result<Json> answer(const Tree& tree, const PointRequest& request) {
  if (request.with_bounds) {
    const auto found = closest_point(tree, request.at, request.options);
    if (!found) return found.error();
    Json json = bounds_json(*found);
    add_closest(tree, json, found->witness);
    return json;
  }
  const auto closest = closest_point(tree, request.at, request.options.max_distance);
  if (!closest.ok()) return closest.error();
  Json json;
  add_closest(tree, json, closest.as_optional());
  return json;
}

Result<Json> answer_pair_contacts(const Tree& first, const Tree& second,
                                  const PairRequest& request) {
  Json contacts = Json::array();
  const Result<Visit> visit = pair_contacts(
      first, Pose::Identity(), second, request.second.pose, [&](const PairContact& contact) {
        Json& json = contacts.emplace_back();
        json["faces"] = listed_faces(first, second, contact.faces);
        json.update(contact_json(contact));
        return !request.first_only;
      });
  if (!visit) return visit.error();
  return Json{{"hit", !contacts.empty()}, {"count", contacts.size()}, {"contacts", contacts}};
}

Result<Json> answer_pair(const Tree& first, const Tree& second, const PairRequest& request) {
  if (request.contacts) return answer_pair_contacts(first, second, request);
  Json pairs = Json::array();
  const Result<Visit> visit = overlap_pairs(first, Pose::Identity(), second, request.second.pose,
                                            [&](const FacePair& pair) {
                                              pairs.push_back(listed_faces(first, second, pair));
                                              return !request.first_only;
                                            });
  if (!visit) return visit.error();
  return Json{{"hit", !pairs.empty()}, {"count", pairs.size()}, {"pairs", pairs}};
}

Result<Json> answer_pair(const Tree& first, const Tree& second, const DistanceRequest& request) {
  const auto found =
      distance(first, Pose::Identity(), second, request.second.pose, request.options);
  if (!found) return found.error();
  return distance_json(*found,
                       [&](const FacePair& faces) { return listed_faces(first, second, faces); });
}

Result<Json> answer_pair(const Tree& first, const Tree& second, const OverlapRequest& request) {
  const auto found = overlap_within(first, Pose::Identity(), second, request.second.pose,
                                    request.options.within, request.options.node_budget);
  if (!found) return found.error();
  Json json = {{"overlap", name_of(found->overlap)}, {"nodes", found->nodes_expanded}};
  if (found->contact) {
    json["faces"] = listed_faces(first, second, *found->contact);
  }
  return json;
}

Result<Json> answer(const Tree& /*tree*/, const ContactsRequest& /*request*/) {
  return only_of_scenes("contacts", "of a tree use collide or pair");
}

QueryKinds kind_of(const RayRequest&) {
  return kRayQueries;
}
QueryKinds kind_of(const CastRequest&) {
  return kRayQueries;
}
QueryKinds kind_of(const CollideRequest&) {
  return kBoxQueries;
}
QueryKinds kind_of(const BoxRequest&) {
  return kBoxQueries;
}
QueryKinds kind_of(const SphereRequest&) {
  return kBoxQueries;
}
QueryKinds kind_of(const FrustumRequest&) {
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

// "[1,2.5,3]". Not fmt::join: the code that prints numbers would be compiled here again.
std::string list_of(std::span<const double> numbers) {
  std::string text;
  for (const double number : numbers) {
    text += fmt::format("{}{}", text.empty() ? "[" : ",", number);
  }
  return text + "]";
}

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
    fields_.push_back({key, list_of(std::span(value.data(), 3)), true});
  }
  void required(const char* key, double value, const char* /*help*/) {
    fields_.push_back({key, fmt::format("{}", value), true});
  }
  void required(const char* key, const Frustum::ViewProjection& value, const char* /*help*/) {
    const Eigen::Matrix4d by_columns = value.transpose();
    fields_.push_back({key, list_of(std::span(by_columns.data(), 16)), true});
  }
  template <class T>
  void optional(const char* key, const T& value, const char* /*help*/, bool* /*given*/ = nullptr) {
    fields_.push_back({key, fmt::format("{}", value), false});
  }
  void second(const SecondTree& /*tree*/) {}  // has no numbers but a pose, which has its own error
  void back_faces(BackFaces value) {
    fields_.push_back({"back_faces", cooker::name_of(value), false});
  }
  void shape(const CastShape& shape) {
    if_given("sphere", shape.sphere, [](double radius) { return fmt::format("{}", radius); });
    if_given("capsule", shape.capsule, list_of);
    if_given("box", shape.box, list_of);
    if_given("hull", shape.hull, [](const std::filesystem::path& mesh) { return mesh.string(); });
    if_given("rotation", shape.rotation, list_of);
  }

 private:
  template <class T, class ToText>
  void if_given(const char* key, const std::optional<T>& value, const ToText& to_text) {
    fields_.push_back({key, value ? to_text(*value) : std::string(), value.has_value()});
  }

  struct Field {
    std::string key;
    std::string text;
    bool is_needed;
  };
  std::vector<Field> fields_;
};

// What an argument that the library does not take has to be, "t_max: expected 0 or more".
std::string expectation(std::string_view kind, std::string_view argument) {
  if (argument == "direction") {
    return fmt::format("direction: expected finite{}",
                       kind == RayRequest::kKind ? " and not zero" : "");
  }
  if (argument == "t_max" && kind == RayRequest::kKind) {
    return "t_max: expected t_min [0] or more";
  }
  // The library knows no merge.
  if (argument == "t_min" || argument == "t_max" || argument == "merge") {
    return fmt::format("{}: expected 0 or more", argument);
  }
  const std::string_view expected = expected_of(argument);
  if (argument == "distance") return fmt::format("within: expected {}", expected);
  if (expected.empty()) return fmt::format("{} is not valid", argument);
  const std::string of = argument == kind ? std::string() : std::string(argument) + ": ";
  return fmt::format("{}expected {}", of, expected);
}

}  // namespace

Json contact_json(const PairContact& contact) {
  return {{"triangles", {contact.first_triangle, contact.second_triangle}},
          {"point", to_json(contact.point)},
          {"start", to_json(contact.start)},
          {"end", to_json(contact.end)},
          {"normal", to_json(contact.normal)},
          {"depth", contact.depth}};
}

Result<std::vector<Eigen::Vector3d>> hull_points(const std::filesystem::path& mesh) {
  ImportOptions options = careful_import();
  options.precision = Precision::kF64;
  const Result<Imported> imported = import_mesh(mesh, options);
  if (!imported) return imported.error();
  const Positions& positions = imported->mesh.positions;
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < positions.size(); ++i) points.push_back(positions[i]);
  const auto key = [](const Eigen::Vector3d& p) { return std::tuple(p[0], p[1], p[2]); };
  std::sort(points.begin(), points.end(),
            [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return key(a) < key(b); });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (!points.empty() && points.size() <= kMaxHullPoints) return points;
  return Error{Errc::kInvalidQuery,
               fmt::format("{}: expected a mesh of 1 to {} points for a hull, found {}",
                           input_name(mesh), kMaxHullPoints, points.size())};
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
    const bool f64 =
        *index < file->tree_count() && (record_of(*file, *index).flags & kTreePositionsF64) != 0;
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
  if (!tree) return in_file(name, naming_mesh(mesh, tree.error()));
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
  std::unique_ptr<OpenedTree>& place =
      opened_[{second.file.string(), second.tree, second.mesh.string()}];
  if (place == nullptr) {
    Result<OpenedFile> file = open_file(second.file);
    if (!file) return file.error();
    if (file->file.has_scene() && second.tree.empty()) {
      return Error{Errc::kInvalidQuery,
                   input_name(second.file) +
                       ": the second of two is a tree, and this is a scene; name a tree of the "
                       "file with --tree2, in a line of a batch with \"tree\""};
    }
    Result<OpenedTree> opened = bind_tree(
        std::move(file->file), {second.file, second.tree, second.mesh, "--tree2", "--mesh2"});
    if (!opened) return opened.error();
    if ((opened->kinds & kPairQueries) == 0) {
      const Error error = kind_left_out(opened->file, opened->index, kPairQueries);
      return Error{error.code, second.file.string() + ": " + error.detail};
    }
    place = std::make_unique<OpenedTree>(std::move(*opened));
  }
  return &place->tree;
}

void sort_places(std::vector<HitPlace>& places) {
  std::sort(places.begin(), places.end());
}

namespace {

std::string any_and_all_fault(bool any, bool all, std::string_view before) {
  return any && all ? fmt::format("expected {0}any or {0}all, found both", before) : std::string();
}

}  // namespace

std::string RayRequest::fault(std::string_view before, bool /*may_lack_shape*/) const {
  return any_and_all_fault(any, all, before);
}

std::string CastRequest::fault(std::string_view before, bool may_lack_shape) const {
  const std::string of_shape = shape.fault(before, may_lack_shape);
  return of_shape.empty() ? any_and_all_fault(any, all, before) : of_shape;
}

std::string CastShape::fault(std::string_view before, bool may_lack_shape) const {
  std::vector<std::string> given;
  if (sphere) given.push_back(fmt::format("{}sphere", before));
  if (capsule) given.push_back(fmt::format("{}capsule", before));
  if (box) given.push_back(fmt::format("{}box", before));
  if (hull) given.push_back(fmt::format("{}hull", before));
  if (given.size() > 1 || (given.empty() && !may_lack_shape)) {
    return fmt::format("expected one shape, {0}sphere, {0}capsule, {0}box or {0}hull, found {1}",
                       before, given.empty() ? "none" : joined(given, " and "));
  }
  if (rotation && !given.empty() && !box && !hull) {
    return fmt::format("expected {0}rotation with {0}box or {0}hull, found it with {1}", before,
                       given.front());
  }
  return {};
}

const char* name_of(BackFaces back_faces) {
  switch (back_faces) {
    case BackFaces::kHit:
      return "hit";
    case BackFaces::kIgnore:
      return "ignore";
    case BackFaces::kOnly:
      return "only";
  }
  return "";
}

std::optional<BackFaces> back_faces_of(std::string_view name) {
  for (const BackFaces each : {BackFaces::kHit, BackFaces::kIgnore, BackFaces::kOnly}) {
    if (name == name_of(each)) return each;
  }
  return std::nullopt;
}

QueryKinds kind_of(const QueryRequest& request) {
  return std::visit([](const auto& q) { return kind_of(q); }, request);
}

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

std::string found_instead(std::string_view text) {
  return fmt::format("found \"{}\"{}", text, why_no_list(text));
}

// A shell gives what stands before a space alone: a number, or one and a comma.
std::string why_no_list(std::string_view text) {
  double number = 0;
  const auto fault = [&](std::string_view word) {
    return std::from_chars(word.data(), word.data() + word.size(), number).ec;
  };
  if (text.find(',') == std::string_view::npos && fault(text) == std::errc()) {
    return "; write it with commas, without spaces";
  }
  if (text.find(' ') != std::string_view::npos || text.ends_with(',')) {
    return "; write it without spaces";
  }
  for (std::size_t at = 0; at < text.size();) {
    const std::string_view word = text.substr(at, text.find(',', at) - at);
    if (fault(word) == std::errc::result_out_of_range) {
      return fmt::format("; {} is beyond the range of double", word);
    }
    at += word.size() + 1;
  }
  return {};
}

std::optional<Eigen::Vector3d> parse_vector(std::string_view text) {
  std::array<double, 3> numbers{};
  if (parse_numbers(text, numbers) != numbers.size()) return std::nullopt;
  return Eigen::Vector3d(numbers[0], numbers[1], numbers[2]);
}

std::optional<Frustum::ViewProjection> matrix_of(std::span<const double> numbers) {
  if (numbers.size() != 16) return std::nullopt;
  using ByRows = Eigen::Matrix<double, 4, 4, Eigen::RowMajor | Eigen::DontAlign>;
  return Frustum::ViewProjection(Eigen::Map<const ByRows>(numbers.data()));
}

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
  return {
      Errc::kInvalidPose,
      fmt::format(
          "{} pose {}; expected finite numbers of an invertible map, not too far away, found {}",
          whose, pose_fault(pose), list_of(numbers))};
}

Error explained(const Error& error, const QueryRequest& request) {
  // Of numbers that are not valid the library names one argument, without what was expected.
  const bool is_name =
      error.code == Errc::kInvalidQuery && error.detail.find(' ') == std::string::npos;
  if (!error.detail.empty() && !is_name) return error;
  return std::visit(
      [&]<class Kind>(const Kind& q) -> Error {
        if (error.code == Errc::kInvalidQuery) {
          return {error.code,
                  fmt::format("{}: {}, found {}", Kind::kKind,
                              expectation(Kind::kKind, error.detail), FieldTexts::line_of(q))};
        }
        if constexpr (requires { q.second; }) {
          if (error.code == Errc::kInvalidPose) {
            return explained_pose(std::string(Kind::kKind) + ": the second tree's", q.second.pose);
          }
        }
        return error;
      },
      request);
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
