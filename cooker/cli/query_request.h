// SPDX-License-Identifier: MIT
// Queries as data: what each kind is made of, and its answer in JSON.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include <boxtree/boxtree.h>

#include "cooker/cli/json_output.h"
#include "cooker/cli/open_file.h"
#include "cooker/import/source_mesh.h"

namespace boxtree::cooker {

/// A command line that shows a kind, and what it answers.
struct KindExample {
  const char* what;
  const char* line;
};

// A kind of request states its name, a line of help, examples, and what it is made of: describe()
// tells a reader of options each of them once. Such readers are those for lines of a batch and for
// the command line, where key "t_max" is option
// --t-max, and one that shows what was given. They have
//   required(key, value, help)           a Vector3d or a double
//   optional(key, value, help, given)    a double, an uint64_t or a bool; sets *given if there
//   second(tree)                         a SecondTree
//   shape(shape)                         a CastShape
//   back_faces(back_faces)               a BackFaces
// A kind of which some fields exclude each other has fault(before, may_lack_shape), too.

struct RayRequest {
  static constexpr const char* kKind = "ray";
  static constexpr const char* kHelp = "Closest hit of a ray, or all";
  static constexpr KindExample kExamples[] = {
      {"What a ray from above hits first",
       "boxtree query bunny.bxt ray --origin 0,9,0 --direction 0,-1,0"},
      {"All that it hits", "boxtree query bunny.bxt ray --origin 0,9,0 --direction 0,-1,0 --all"}};

  Ray ray{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  bool any = false;
  bool all = false;
  BackFaces back_faces = BackFaces::kHit;

  template <class Fields>
  void describe(Fields& fields) {
    fields.required("origin", ray.origin, "Where it starts");
    fields.required("direction", ray.direction, "Where it goes; t counts in its length");
    fields.optional("t_min", ray.t_min, "Where it begins, as t [0]");
    fields.optional("t_max", ray.t_max, "Where it ends, as t [nowhere]");
    fields.optional("any", any, "Any hit, not the closest");
    fields.optional("all", all, "All hits, in the order of t, then of faces");
    fields.back_faces(back_faces);
  }
  /// What is wrong with what is given, or nothing. `before`: what stands before names, "--".
  [[nodiscard]] std::string fault(std::string_view before, bool may_lack_shape) const;
};

/// A shape that is cast or touches. One of the first four is given.
struct CastShape {
  std::optional<double> sphere;                   // the radius
  std::optional<std::array<double, 4>> capsule;   // X,Y,Z from one end to the other, the radius
  std::optional<std::array<double, 3>> box;       // half its extents
  std::optional<std::filesystem::path> hull;      // a mesh whose points it is of
  std::optional<std::array<double, 4>> rotation;  // of the box or the hull: X,Y,Z,W

  /// What is wrong with what is given, or nothing. `before`: what stands before names, "--".
  [[nodiscard]] std::string fault(std::string_view before, bool may_lack_shape) const;
};

struct CastRequest {
  static constexpr const char* kKind = "cast";
  static constexpr const char* kHelp =
      "First touch of a sphere, a capsule, a box or a convex hull that moves along a line";
  static constexpr KindExample kExamples[] = {
      {"How far a ball falls",
       "boxtree query bunny.bxt cast --sphere 0.1 --at 0,0,9 --direction 0,0,-1"},
      {"All that a box touches on its way",
       "boxtree query bunny.bxt cast --box 1,1,2 --at 0,0,9 --direction 0,0,-1 --all"}};

  CastShape shape;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  Motion motion;
  bool any = false;
  bool all = false;
  BackFaces back_faces = BackFaces::kHit;

  template <class Fields>
  void describe(Fields& fields) {
    fields.required(
        "at", at,
        "Where it starts: its center, of a capsule one end, of a hull the origin of its points");
    fields.required("direction", motion.direction, "Where it goes; t counts in its length");
    fields.shape(shape);
    fields.optional("t_max", motion.t_max, "Where it ends, as t [nowhere]");
    fields.optional("any", any, "Any touch, not the first");
    fields.optional("all", all,
                    "All triangles that it touches, in the order of t_lower, then of faces");
    fields.back_faces(back_faces);
  }
  /// What is wrong with what is given, or nothing. `before`: what stands before names, "--".
  [[nodiscard]] std::string fault(std::string_view before, bool may_lack_shape) const;
};

struct CollideRequest {
  static constexpr const char* kKind = "collide";
  static constexpr const char* kHelp =
      "Triangles that a sphere, a capsule, a box or a convex hull touches, and how it leaves them";
  static constexpr KindExample kExamples[] = {
      {"What a ball touches, and how deep",
       "boxtree query bunny.bxt collide --sphere 0.5 --at 0,0,1"},
      {"The same, contacts of neighbours within 0.001 as one",
       "boxtree query bunny.bxt collide --sphere 0.5 --at 0,0,1 --merge 0.001"}};

  CastShape shape;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  double merge = 0;
  bool merges = false;  // merge was given

  template <class Fields>
  void describe(Fields& fields) {
    fields.required(
        "at", at,
        "Where it is: its center, of a capsule one end, of a hull the origin of its points");
    fields.shape(shape);
    fields.optional("merge", merge,
                    "Of contacts within this of each other and of nearly one normal, the deepest",
                    &merges);
  }
  /// See CastShape.
  [[nodiscard]] std::string fault(std::string_view before, bool may_lack_shape) const {
    return shape.fault(before, may_lack_shape);
  }
};

/// What overlap may leave undecided.
struct OverlapOptions {
  double within = 0;
  std::uint64_t node_budget = kUnlimitedNodes;

  template <class Fields>
  void describe(Fields& fields, bool* given = nullptr) {
    fields.optional(
        "within", within,
        "May end with undecided where parts are closer than this, and so sooner; disjoint does not "
        "say that they are farther apart, which distance --max-distance tells [0]",
        given);
    fields.optional("budget", node_budget, "Stop after so many nodes", given);
  }
};

struct BoxRequest {
  static constexpr const char* kKind = "box";
  static constexpr const char* kHelp =
      "Faces that touch an axis-aligned box, or with --within or --budget whether any does";
  static constexpr KindExample kExamples[] = {
      {"The faces in a box", "boxtree query bunny.bxt box --min -1,-1,-1 --max 1,1,1"},
      {"Whether anything touches it, gaps of less than 0.1 left undecided",
       "boxtree query bunny.bxt box --min -9,-9,-9 --max -8,-8,-8 --within 0.1"}};

  Eigen::AlignedBox3d box;
  OverlapOptions overlap;
  bool with_overlap = false;  // one of them was given: whether there is any, instead of all faces

  template <class Fields>
  void describe(Fields& fields) {
    fields.required("min", box.min(), "Lower corner");
    fields.required("max", box.max(), "Upper corner");
    overlap.describe(fields, &with_overlap);
  }
};

struct SphereRequest {
  static constexpr const char* kKind = "sphere";
  static constexpr const char* kHelp = "Faces within a radius of a point";
  static constexpr KindExample kExamples[] = {
      {"The faces within a radius", "boxtree query bunny.bxt sphere --center 0,0,0 --radius 2"}};

  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0;

  template <class Fields>
  void describe(Fields& fields) {
    fields.required("center", center, "The point");
    fields.required("radius", radius, "The radius");
  }
};

struct FrustumRequest {
  static constexpr const char* kKind = "frustum";
  static constexpr const char* kHelp = "Faces that touch what a camera sees";
  static constexpr KindExample kExamples[] = {
      {"The faces in a box from -1 to 1 along x and y and from 0 to 2 along z",
       "boxtree query bunny.bxt frustum --matrix 1,0,0,0,0,1,0,0,0,0,0.5,0,0,0,0,1"}};

  Frustum::ViewProjection matrix = Frustum::ViewProjection::Identity();
  bool open_gl = false;
  bool instances = false;

  template <class Fields>
  void describe(Fields& fields) {
    fields.required("matrix", matrix,
                    "What takes points, as columns, to clip space: 4x4 numbers, row by row");
    fields.optional("open_gl", open_gl,
                    "Visible is what z / w takes to -1 to 1, as in OpenGL [0 to 1]");
    fields.optional("instances", instances,
                    "Of a scene, the instances whose bounds may touch it, instead of faces");
  }
  [[nodiscard]] Frustum frustum() const {
    return Frustum::of(matrix, open_gl ? ClipDepth::kMinusOneToOne : ClipDepth::kZeroToOne);
  }
};

/// How near to the truth an answer has to be.
template <class Fields>
void describe_approximation(Fields& fields, Approximation& options, bool* given = nullptr) {
  fields.optional("max_distance", options.max_distance, "Look no farther");
  fields.optional("relative_error", options.relative_error,
                  "Be content if upper <= lower * (1 + this)", given);
  fields.optional("absolute_error", options.absolute_error, "Be content if upper <= lower + this",
                  given);
  fields.optional("budget", options.node_budget, "Stop after so many nodes", given);
}

struct PointRequest {
  static constexpr const char* kKind = "point";
  static constexpr const char* kHelp = "Closest point of the surface";
  static constexpr KindExample kExamples[] = {
      {"The closest point, at most 1 % farther than the closest of all",
       "boxtree query bunny.bxt point --at 1,2,3 --relative-error 0.01"}};

  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  PointOptions options;
  bool with_bounds = false;  // an error or a budget was given

  template <class Fields>
  void describe(Fields& fields) {
    fields.required("at", at, "The point");
    describe_approximation(fields, options, &with_bounds);
  }
};

struct SecondTree {
  std::filesystem::path file;
  WhichTree tree;
  std::filesystem::path mesh;  // its source, if its geometry is external
  Pose pose = Pose::Identity();
};

struct PairRequest {
  static constexpr const char* kKind = "pair";
  static constexpr const char* kHelp = "Pairs of faces of two trees that touch";
  static constexpr KindExample kExamples[] = {
      {"The faces that touch a second tree, moved along x",
       "boxtree query bunny.bxt pair bunny.bxt --pose 0.5,0,0"},
      {"The same for many poses, one per line",
       "echo '{\"pose\":[0.5,0,0]}' | boxtree query bunny.bxt pair bunny.bxt --batch -"}};

  SecondTree second;
  bool first_only = false;
  bool contacts = false;

  template <class Fields>
  void describe(Fields& fields) {
    fields.second(second);
    fields.optional("first", first_only, "Stop at the first contact");
    fields.optional("contacts", contacts,
                    "Pairs of triangles instead, with where they touch and how they part");
  }
};

struct DistanceRequest {
  static constexpr const char* kKind = "distance";
  static constexpr const char* kHelp = "Distance of two trees, or of a scene from a tree";
  static constexpr KindExample kExamples[] = {
      {"How far two trees are apart", "boxtree query bunny.bxt distance bunny.bxt --pose 5,0,0"},
      {"Whether they are closer than 0.1: found says it",
       "boxtree query bunny.bxt distance bunny.bxt --pose 5,0,0 --max-distance 0.1"}};

  SecondTree second;
  DistanceOptions options;

  template <class Fields>
  void describe(Fields& fields) {
    fields.second(second);
    describe_approximation(fields, options);
  }
};

struct OverlapRequest {
  static constexpr const char* kKind = "overlap";
  static constexpr const char* kHelp = "Whether two trees overlap";
  static constexpr KindExample kExamples[] = {
      {"Whether two trees overlap, within 200 nodes",
       "boxtree query bunny.bxt overlap bunny.bxt --pose 5,0,0 --budget 200"}};

  SecondTree second;
  OverlapOptions options;

  template <class Fields>
  void describe(Fields& fields) {
    fields.second(second);
    options.describe(fields);
  }
};

/// Of a scene: what moves against the rest.
struct ContactsRequest {
  static constexpr const char* kKind = "contacts";
  static constexpr const char* kHelp =
      "Of a scene: pairs of faces of what moves and all else that touch";
  static constexpr KindExample kExamples[] = {
      {"What an instance touches that is moved",
       "boxtree query level.bxt contacts --move Crate=0.8,2.1,-6.8"}};

  bool first_only = false;
  bool points = false;

  template <class Fields>
  void describe(Fields& fields) {
    fields.optional("first", first_only, "Stop at the first contact");
    fields.optional("points", points,
                    "Pairs of triangles instead, with where they touch and how they part");
  }
};

/// What the JSON of a contact of two triangles has besides their faces.
[[nodiscard]] Json contact_json(const PairContact& contact);

/// What is known, for any answer with bounds. An infinite upper bound is null: JSON has no
/// infinity.
template <class Bounded>
[[nodiscard]] Json bounds_json(const Bounded& bounds) {
  return {{"lower", bounds.lower},
          {"upper", bounds.upper},
          {"converged", bounds.converged},
          {"nodes", bounds.nodes_expanded}};
}

/// A distance of trees or from a scene; `faces` makes the list of the two faces of its witness.
template <class AnyDistance, class Faces>
[[nodiscard]] Json distance_json(const AnyDistance& found, const Faces& faces) {
  Json json = bounds_json(found);
  json["found"] = found.witness.has_value();
  if (found.witness) {
    json["faces"] = faces(found.witness->faces);
    json["points"] = {to_json(found.witness->first), to_json(found.witness->second)};
  }
  return json;
}

/// A kind that is here is one of batches and of the command line, without another line of theirs.
using QueryRequest =
    std::variant<RayRequest, CastRequest, CollideRequest, BoxRequest, SphereRequest, FrustumRequest,
                 PointRequest, PairRequest, DistanceRequest, OverlapRequest, ContactsRequest>;

/// Calls visit.template operator()<Kind>() for each kind of request, in order.
template <class Visit>
void for_each_kind(const Visit& visit) {
  [&]<std::size_t... kIndex>(std::index_sequence<kIndex...>) {
    (visit.template operator()<std::variant_alternative_t<kIndex, QueryRequest>>(), ...);
  }
  (std::make_index_sequence<std::variant_size_v<QueryRequest>>());
}

/// A file, one of its trees, and the mesh that it is bound to if its geometry is external.
struct OpenedTree {
  File file;
  std::unique_ptr<SourceMesh> mesh;
  Tree tree;
  std::uint32_t index;  // of the tree in the file
  QueryKinds kinds;     // that the scene's profile left to it; all of them without a scene
};

/// The kind that a scene needs for a query.
[[nodiscard]] QueryKinds kind_of(const QueryRequest& request);

/// What users say of a tree to bind.
struct TreeWanted {
  const std::filesystem::path& path;
  WhichTree which;                    // if empty, tree 0, and a warning where there are others
  const std::filesystem::path& mesh;  // of a tree cooked with --external; compared by content
  const char* option;                 // that says which, for messages
  const char* mesh_option;            // that names the mesh, likewise
};

/// Binds a tree of a file that is open; the path serves messages.
Result<OpenedTree> bind_tree(File opened, const TreeWanted& wanted);

/// Second trees of queries about two, each opened once. Errors: kInvalidQuery, too, if the file
/// holds a scene and none of its trees is named; kPartLeftOut if its profile left pair queries out.
class TreeCache {
 public:
  Result<const Tree*> get(const SecondTree& second);

 private:
  // By file, tree and mesh: another mesh may be the wrong one.
  std::map<std::tuple<std::string, WhichTree, std::string>, std::unique_ptr<OpenedTree>> opened_;
};

/// The points of a mesh, each once, for a ConvexHull; an error where these are too many.
Result<std::vector<Eigen::Vector3d>> hull_points(const std::filesystem::path& mesh);

/// How many numbers stand between commas, in any locale; 0 if it is not that, or too many.
std::size_t parse_numbers(std::string_view text, std::span<double> numbers);

/// What to say of a text that is no list of as many numbers, and why: `found "1, 2"; write it
/// without spaces`.
[[nodiscard]] std::string found_instead(std::string_view text);
/// The second half of it: "; write it with commas, without spaces" of "1". Empty where nothing
/// helps.
[[nodiscard]] std::string why_no_list(std::string_view text);

/// Of 16 numbers, row by row. Nothing for another count.
[[nodiscard]] std::optional<Frustum::ViewProjection> matrix_of(std::span<const double> numbers);

/// "X,Y,Z". Nothing if it is not.
[[nodiscard]] std::optional<Eigen::Vector3d> parse_vector(std::string_view text);

/// X,Y,Z, or a 3x4 matrix row by row. Nothing for another count of numbers.
[[nodiscard]] std::optional<Pose> pose_of(std::span<const double> numbers);
/// The same as text, with commas.
[[nodiscard]] std::optional<Pose> parse_pose(std::string_view text);

/// kInvalidPose with what is wrong; `whose`: "the second tree's".
[[nodiscard]] Error explained_pose(std::string_view whose, const Pose& pose);

/// The error of a query, which has only a code and a name if its numbers or its pose are not valid:
/// then with the kind, what was expected and what was found.
[[nodiscard]] Error explained(const Error& error, const QueryRequest& request);

/// Answers queries about one thing by alone(request), those about it and a second tree by
/// together(second, request). Errors are explained.
template <class Alone, class Together>
Result<Json> query_one_or_two(const QueryRequest& request, TreeCache& others, const Alone& alone,
                              const Together& together) {
  Result<Json> answered = std::visit(
      [&](const auto& q) -> Result<Json> {
        if constexpr (requires { q.second; }) {
          const Result<const Tree*> second = others.get(q.second);
          if (!second) return second.error();
          return together(**second, q);
        } else {
          return alone(q);
        }
      },
      request);
  if (!answered) return explained(answered.error(), request);
  return answered;
}

/// The number of a face in the source; null if the tree has none.
[[nodiscard]] inline Json face_json(const FaceRef& face) {
  return face.id == kNoFaceId ? Json(nullptr) : Json(face.id);
}

/// Adds the name of a material, or its number if it has none; nothing for kNoMaterial.
inline void add_material(Json& json, std::uint32_t material, std::string_view name) {
  if (material != kNoMaterial) json["material"] = name.empty() ? Json(material) : Json(name);
}

/// Adds the user data of a face, if it has some.
inline void add_user_data(Json& json, const std::optional<std::uint32_t>& number) {
  if (number) json["user_data"] = *number;
}

/// Adds a hit of a ray in a tree or a scene; add_face(hit, json) adds what was hit.
template <class Hit, class AddFace>
void add_hit(Json& json, const Hit& hit, const AddFace& add_face) {
  json["t"] = hit.t;
  add_face(hit, json);
  json["triangle"] = hit.triangle;
  json["point"] = to_json(hit.point);
  json["normal"] = to_json(hit.normal);
  json["barycentric"] = {1 - hit.u - hit.v, hit.u, hit.v};
}

/// The answer of one hit, or none.
template <class Hit, class AddFace>
Result<Json> answer_hit(const Hit& hit, const AddFace& add_face) {
  if (!hit.ok()) return hit.error();
  Json json = {{"hit", hit.has_value()}};
  if (hit) add_hit(json, *hit, add_face);
  return json;
}

/// The name of a kind of faces, as options have it: hit, ignore or only.
[[nodiscard]] const char* name_of(BackFaces back_faces);
/// Nothing if it is none.
[[nodiscard]] std::optional<BackFaces> back_faces_of(std::string_view name);

/// The answer in the form that `boxtree query --json` prints.
Result<Json> answer(const Tree& tree, const QueryRequest& request, TreeCache& others);
/// The same; kPartLeftOut if the tree is one of a scene whose profile left such queries out.
Result<Json> answer(const OpenedTree& opened, const QueryRequest& request, TreeCache& others);

}  // namespace boxtree::cooker
