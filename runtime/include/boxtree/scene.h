// SPDX-License-Identifier: MIT
// A scene, placed trees of an open file or of several, and what it answers, in world coordinates:
// rays, boxes, spheres, closest points, contacts.
//
// Each query answers for the instances of the given layers whose layer answers its kind. Errors, if
// not said otherwise: those of the same query on a tree; kPartLeftOut when the scene was cooked
// without the kind; kRecordInvalid on corrupt bytes. Limits count for all instances together. None
// allocates; contacts and pairs take up to 352 KB of stack, all others here at most 64 KB.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include <boxtree/closest.h>
#include <boxtree/configuration.h>
#include <boxtree/contact.h>
#include <boxtree/export.h>
#include <boxtree/face_options.h>
#include <boxtree/ray.h>
#include <boxtree/shape.h>

static_assert(BOXTREE_HAS_SCENE_QUERIES,
              "BOXTREE_QUERIES left scenes out of this build of boxtree");

namespace boxtree {

class BoundScene;

/// Layers of a scene, as bits.
using LayerMask = std::uint32_t;
/// Every layer.
inline constexpr LayerMask kAllLayers = 0xffffffffu;

/// The application's arrays for one tree with external geometry.
struct SceneMeshArrays {
  std::uint32_t tree;  ///< Its number in the file.
  MeshArrays arrays;   ///< Positions and corners of its source mesh.
};

/// What an application needs of a scene, said when it is bound.
struct SceneOptions {
  /// The kinds of queries that the application will make. One that the profile left out is refused
  /// here, and named.
  QueryKinds queries = 0;
  /// Refuse a scene of which a tree has no face ids [default false] rather than answer kNoFaceId
  /// later.
  bool require_face_ids = false;
  /// Refuse a scene of which a tree has no active edges [default false] rather than call every edge
  /// active later.
  bool require_active_edges = false;
  /// Refuse a scene without any material [default false] rather than answer kNoMaterial later.
  bool require_materials = false;
  /// Refuse a scene of which a tree has no user data [default false] rather than answer nothing
  /// later.
  bool require_user_data = false;
  /// Refuse a scene of which no instance has a name [default false] rather than answer an empty
  /// name later.
  bool require_names = false;
  /// For trees with external geometry; those of other trees are not looked at, nor whether
  /// positions are those of the cook (BindOptions::verify_mesh).
  std::span<const SceneMeshArrays> meshes = {};
  /// Static instances that update() shall be allowed to move: doors, say; see make_movable(). The
  /// others that move are known from the file.
  std::span<const std::uint32_t> moving = {};
  /// Of all that the Scene owns [operator new]. Texts of errors come from operator new always.
  Memory memory = {};
};

/// One instance of a scene that Scene::assemble() makes.
struct PlacedTree {
  std::uint32_t tree = 0;        ///< The number of its tree among those given.
  Pose pose = Pose::Identity();  ///< Object space to world.
  std::uint32_t layer = 0;       ///< The number of its layer, 0 to 31.
  bool moves = false;            ///< Whether Scene::update() may move it; see contacts(), too.
  std::uint64_t user_data = 0;   ///< What Scene::user_data() answers.
  std::string_view name = {};    ///< At most 65535 bytes, which the scene copies.
};

/// A layer of such a scene.
struct SceneLayer {
  std::string_view name = {};  ///< The scene copies it.
  /// Layers with which there may be contacts; two layers collide if each allows the other.
  LayerMask collides_with = kAllLayers;
  QueryKinds queries = kAllQueries;  ///< The kinds of queries that its instances answer.
};

/// What is known of one instance.
struct InstanceInfo {
  std::string_view name;    ///< Empty when it has none, or names were left out.
  std::uint32_t tree = 0;   ///< The number of its tree in the file, and in Scene::trees().
  std::uint32_t id = 0;     ///< Its number in the source, depth first; assembled: its number.
  std::uint32_t layer = 0;  ///< The number of its layer: bit `1 << layer` of a LayerMask.
  bool moves = false;       ///< Whether Scene::update() may move it.
};

/// The instance of a body that is no part of the scene, and of no answer.
inline constexpr std::uint32_t kNoInstance = 0xffffffffu;

/// A face of an instance.
struct SceneFace {
  std::uint32_t instance = kNoInstance;  ///< The number of the instance.
  FaceRef face;                          ///< A face of its tree.
};

/// One scene. Points into the bytes of its File, or of the files of its trees. Instances are
/// numbered from 0 in the order of the file, or as given. Where queries say that of several faces
/// that of the instance with the smallest id counts, the face with the smallest id does in a file
/// that `boxtree merge` made of tiles, whose faces are numbered throughout. Queries on a scene that
/// is not being updated are safe from many threads at once; update(), make_movable(), rebuild() and
/// what is set need the scene for themselves. The bytes of files are never written: poses of moving
/// instances, and the tree over them, live in the Scene. Move-only; a scene that was moved from may
/// only be assigned to or destroyed.
class BOXTREE_API Scene {
 public:
  /// Checks the records of the scene and of each tree, no instance but the moving ones; cost grows
  /// with the number of trees and moving instances alone.
  /// Errors: kNoScene, kPartLeftOut (naming the part and the line of the profile),
  /// kInstanceIndex, kRecordInvalid, kSectionMissing, kSectionSize, and those of Tree::bind.
  static Result<Scene> bind(const File& file, const SceneOptions& options = {});
  // A scene must not outlive its file.
  static Result<Scene> bind(const File&& file, const SceneOptions& options = {}) = delete;

  /// Makes a scene of trees of any files, as of the tiles of a world that are near. It answers as
  /// one file with these instances would, every kind of query, but no edge is known to be inactive
  /// because the surface goes on in another instance. What BindOptions refuse is refused when the
  /// trees are bound.
  ///
  /// The trees are copied and become trees(); their files, and arrays of external geometry, must
  /// outlive the scene. Materials are numbered file after file, in the order of the trees; those of
  /// one file once if its trees follow each other. There are as many layers as given, or as
  /// instances name; those that are not given collide with all.
  ///
  /// Costs O(n log n), no tree is read; allocates 1 KB for each tree and each instance.
  /// Errors, which name the instance: kTreeIndex, kInvalidPose, kInvalidQuery (a layer beyond 31, a
  /// name too long), kMeshTooLarge (too many instances, materials or bytes of names).
  /// `memory`: of all that the Scene owns.
  static Result<Scene> assemble(std::span<const Tree> trees, std::span<const PlacedTree> instances,
                                std::span<const SceneLayer> layers = {}, const Memory& memory = {});

  /// Takes the scene over.
  Scene(Scene&&) noexcept;
  /// Takes the scene over, after freeing this one's moving instances.
  Scene& operator=(Scene&&) noexcept;
  /// Frees the moving instances; the bytes are the File's.
  ~Scene();

  /// How many instances it has, numbered from 0.
  [[nodiscard]] std::uint32_t instance_count() const noexcept;
  /// Its trees, in the order of the file, or as given.
  [[nodiscard]] std::span<const Tree> trees() const noexcept;
  /// The kinds of queries that it was cooked for; all if it was assembled.
  [[nodiscard]] QueryKinds query_kinds() const noexcept;

  /// What is known of an instance. Errors: kInstanceIndex; kRecordInvalid where the bytes of
  /// the instance are corrupt.
  [[nodiscard]] Result<InstanceInfo> info(std::uint32_t number) const;
  /// The number of the instance with that name, the first if several share it; O(instances).
  /// Error: kInstanceIndex when there is none.
  [[nodiscard]] Result<std::uint32_t> find_instance(std::string_view name) const;
  /// Its pose, object space to world: as last given to update(), else as in the file, or
  /// as given. Errors as for info().
  [[nodiscard]] Result<Pose> pose(std::uint32_t number) const;
  /// Name of a layer; empty when it has none.
  [[nodiscard]] std::string_view layer_name(std::uint32_t number) const noexcept;
  /// How many layers it has, numbered from 0.
  [[nodiscard]] std::uint32_t layer_count() const noexcept;

  /// Whether queries see an instance [true]: one that is disabled is in no answer, as if it were
  /// not there. O(1) after the first call, which allocates a bit for each instance. Error:
  /// kInstanceIndex.
  Status set_enabled(std::uint32_t instance, bool enabled);
  /// As last given to set_enabled(). False for numbers of no instance.
  [[nodiscard]] bool is_enabled(std::uint32_t instance) const noexcept;
  /// Keeps a number of the application's for an instance: an entity, a pointer. The first call
  /// allocates one for each instance. Error: kInstanceIndex.
  Status set_user_data(std::uint32_t instance, std::uint64_t data);
  /// As last given to set_user_data(), or in PlacedTree; else 0.
  [[nodiscard]] std::uint64_t user_data(std::uint32_t instance) const noexcept;

  /// A triangle of a face that an answer names, in world coordinates: each corner is brought there
  /// in double precision, in the order of the tree: a pose that mirrors turns how it is seen, and
  /// nothing over (see SceneRayHit). `half` and cost as for Tree::triangle(). Errors: as there and
  /// for info().
  [[nodiscard]] Result<Triangle> triangle(const SceneFace& face, std::uint32_t half = 0) const;

  /// The material of a face that an answer names; kNoMaterial without materials.
  [[nodiscard]] std::uint32_t material(const SceneFace& face) const noexcept;
  /// Name of a material; empty when it has none.
  [[nodiscard]] std::string_view material_name(std::uint32_t number) const noexcept;
  /// How many materials its files have, numbered from 0.
  [[nodiscard]] std::uint32_t material_count() const noexcept;

  /// Lets update() move a static instance from now on; nothing happens where it moves already.
  /// O(moving instances), allocates: many are named together in SceneOptions::moving. Errors:
  /// kInstanceIndex, kRecordInvalid.
  Status make_movable(std::uint32_t instance);
  /// Gives a moving instance another pose and refits the tree over the moving ones; O(log) of their
  /// number; allocates for the text of an error alone. Errors: kInstanceIndex, kInstanceStatic,
  /// kInvalidPose (then nothing has changed).
  Status update(std::uint32_t instance, const Pose& pose);
  /// Builds the tree over moving instances anew, for after many of them have gone far. Allocates.
  void rebuild();

 private:
  friend class BoundScene;
  struct Ends {  // to where its memory came from
    void operator()(BoundScene* bound) const noexcept;
  };
  explicit Scene(std::unique_ptr<BoundScene, Ends> bound) noexcept;

  std::unique_ptr<BoundScene, Ends> bound_;
};

/// Receives one face after the other; returns whether to go on.
using SceneFaceVisitor = FunctionRef<bool(const SceneFace&)>;

/// Whether a face of an instance may be hit; see FaceFilter. By material: a lambda that looks at
/// Scene::material().
using SceneFaceFilter = NamedFunctionRef<bool(const SceneFace&)>;
/// Whether an instance may be hit; called once for each that a query comes near.
using InstanceFilter = NamedFunctionRef<bool(std::uint32_t)>;

/// Which faces a ray or a cast may hit, and what it may cost.
struct SceneFaceOptions {
  /// Which side counts as seen from the instance: a pose that mirrors turns nothing over. [kHit]
  BackFaces back_faces = BackFaces::kHit;
  std::optional<SceneFaceFilter> filter = {};  ///< [every face]
  /// Takes the number of an instance and says whether it may be hit. [every instance]
  std::optional<InstanceFilter> instance_filter = {};
  LayerMask layers = kAllLayers;  ///< [every layer]
  QueryLimits limits = {};        ///< [none]
};

/// A hit of an instance. `t` counts in units of the ray's direction; point and normal are in world
/// coordinates, the normal carried there by the pose: a pose that mirrors leaves it on its side of
/// the face, from which the corners of Scene::triangle() are then seen clockwise.
struct SceneRayHit : RayHit {
  std::uint32_t instance = kNoInstance;  ///< The instance that was hit.
};

/// A hit, nothing, or an error.
using SceneRayResult = QueryResult<SceneRayHit>;

/// The hit with the smallest t; of several at the same t that of the instance with the smallest id,
/// then of the smallest face. The ray is brought into each tree's object space in double precision
/// and answered there, so no gap lies between faces of one instance that share an edge.
BOXTREE_API SceneRayResult closest_hit(const Scene& scene, const Ray& ray,
                                       LayerMask layers = kAllLayers,
                                       const QueryLimits& limits = {});

/// Some hit, or nothing: cheaper than closest_hit() when only the fact matters.
BOXTREE_API SceneRayResult any_hit(const Scene& scene, const Ray& ray,
                                   LayerMask layers = kAllLayers, const QueryLimits& limits = {});

/// The same among the faces that `options` let be hit; see closest_hit() of a tree.
BOXTREE_API SceneRayResult closest_hit(const Scene& scene, const Ray& ray,
                                       const SceneFaceOptions& options);
/// Some hit of those, or nothing.
BOXTREE_API SceneRayResult any_hit(const Scene& scene, const Ray& ray,
                                   const SceneFaceOptions& options);

/// Receives one hit after the other; what it returns is as for RayVisitor.
using SceneRayVisitor = FunctionRef<double(const SceneRayHit&)>;

/// Visits every hit, in no promised order: each triangle once, copies of a face, too. Those of one
/// instance come together.
BOXTREE_API Result<Visit> all_hits(const Scene& scene, const Ray& ray, SceneRayVisitor visitor,
                                   const SceneFaceOptions& options = {});

/// The first hits, as many as `hits` has room for, in ascending order of t, then of instance ids
/// and of face ids. Returns how many there are. Takes time proportional to the room for each hit
/// that is met.
BOXTREE_API Result<std::size_t> nearest_hits(const Scene& scene, const Ray& ray,
                                             std::span<SceneRayHit> hits,
                                             const SceneFaceOptions& options = {});

/// Visits every face that touches the closed box `box` of the world, each once. Exact for the
/// triangles that arise when each corner is brought into the world in double precision.
BOXTREE_API Result<Visit> overlap_box(const Scene& scene, const Eigen::AlignedBox3d& box,
                                      SceneFaceVisitor visitor, LayerMask layers = kAllLayers,
                                      const QueryLimits& limits = {});

/// Visits every face whose distance from `center` is at most `radius`, likewise.
BOXTREE_API Result<Visit> overlap_sphere(const Scene& scene, const Eigen::Vector3d& center,
                                         double radius, SceneFaceVisitor visitor,
                                         LayerMask layers = kAllLayers,
                                         const QueryLimits& limits = {});
/// The same of a sphere of the world as casts and collide() take it.
inline Result<Visit> overlap_sphere(const Scene& scene, const Sphere& sphere,
                                    SceneFaceVisitor visitor, LayerMask layers = kAllLayers,
                                    const QueryLimits& limits = {}) {
  return overlap_sphere(scene, sphere.center, sphere.radius, visitor, layers, limits);
}

/// A closest point on an instance. Point and distance are in world coordinates.
struct SceneClosestPoint : ClosestPoint {
  std::uint32_t instance = kNoInstance;  ///< The instance that it lies on.
};

/// A closest point, nothing, or an error.
using ScenePointResult = QueryResult<SceneClosestPoint>;

/// The nearest point of any surface within `max_distance` of `point`, or nothing. Of several at the
/// same distance that of the instance with the smallest id, then of the smallest face.
BOXTREE_API ScenePointResult
closest_point(const Scene& scene, const Eigen::Vector3d& point,
              double max_distance = std::numeric_limits<double>::infinity(),
              LayerMask layers = kAllLayers, const QueryLimits& limits = {});

/// A face of an instance and a face of another body that touch.
struct ScenePair {
  SceneFace first;   ///< A face of the scene; which one, each query says.
  SceneFace second;  ///< A face of the other body.
};
/// Receives one pair after the other; returns whether to go on.
using ScenePairVisitor = FunctionRef<bool(const ScenePair&)>;

/// Visits every contact of a moving instance with any other one, each pair of faces once; `first`
/// is the moving instance, of two the one with the smaller number. Pairs whose layers do not
/// collide, and pairs of static instances, are not looked at. Each pair of instances is answered as
/// by overlap_pairs() of the two trees, the one whose pose magnifies errors less being the first
/// there.
BOXTREE_API Result<Visit> contacts(const Scene& scene, ScenePairVisitor visitor,
                                   const QueryLimits& limits = {});

/// The contacts of one instance, moving or not, with all others: `first` is the instance.
/// Also kInstanceIndex.
BOXTREE_API Result<Visit> contacts_of(const Scene& scene, std::uint32_t instance,
                                      ScenePairVisitor visitor, const QueryLimits& limits = {});

/// Visits every pair of a face of the scene (`first`) and a face of a tree that is no part of it,
/// placed by `pose` (`second`, whose instance is kNoInstance).
BOXTREE_API Result<Visit> overlap_pairs(const Scene& scene, const Tree& tree, const Pose& pose,
                                        ScenePairVisitor visitor, LayerMask layers = kAllLayers,
                                        const QueryLimits& limits = {});

/// Where two triangles touch, one of an instance and one of another instance or body: faces are of
/// the trees of these. The normal is that along which the second triangle leaves the first soonest.
struct ScenePairContact : PairContact {
  std::uint32_t first_instance = kNoInstance;   ///< The instance of the first triangle.
  std::uint32_t second_instance = kNoInstance;  ///< Of the second one; kNoInstance for a body.
};

/// Receives one contact after the other; returns whether to go on.
using ScenePairContactVisitor = FunctionRef<bool(const ScenePairContact&)>;

/// The same pairs as contacts(), triangle by triangle, with where they touch, as pair_contacts() of
/// two trees. The first triangle is that of the moving instance.
BOXTREE_API Result<Visit> pair_contacts(const Scene& scene, ScenePairContactVisitor visitor,
                                        const QueryLimits& limits = {});
/// Those of contacts_of(). The first triangle is that of the instance.
BOXTREE_API Result<Visit> pair_contacts_of(const Scene& scene, std::uint32_t instance,
                                           ScenePairContactVisitor visitor,
                                           const QueryLimits& limits = {});
/// Those of overlap_pairs(). The first triangle is that of the scene, so that the normal is the one
/// along which the body leaves it.
BOXTREE_API Result<Visit> pair_contacts(const Scene& scene, const Tree& tree, const Pose& pose,
                                        ScenePairContactVisitor visitor,
                                        LayerMask layers = kAllLayers,
                                        const QueryLimits& limits = {});

}  // namespace boxtree
