// SPDX-License-Identifier: MIT
// The C interface: everything that boxtree's runtime does, for C99 and for whatever can call C.
//
//     bxt_file* file;
//     bxt_tree* tree;
//     if (bxt_file_open("rock.bxt", NULL, &file, NULL) == BXT_OK &&
//         bxt_tree_bind(file, BXT_ONLY_TREE, NULL, &tree, NULL) == BXT_OK) {
//       const bxt_ray ray = {{0, 0, 10}, {0, 0, -1}, 0, INFINITY};
//       bxt_ray_hit hit = {.struct_size = sizeof hit};
//       if (bxt_tree_closest_hit(tree, &ray, NULL, &hit, NULL) == BXT_OK && hit.is_hit) use(hit.t);
//     }
//
// What holds for all of it:
//
// Errors. Functions that can fail return BXT_OK or the code of an error. Their last parameter,
// which may be NULL, then says more; where they succeed they leave it alone. What they would have
// written elsewhere is untouched, where a function does not say otherwise. That nothing was hit is
// no error. A handle, an output or an input that is NULL though it is not said to be optional is
// BXT_INVALID_QUERY; functions that return no bxt_status take no NULL but a buffer's.
//
// Structs. bxt_vec3, bxt_quaternion, bxt_pose, bxt_plane, bxt_ray, bxt_face and bxt_triangle are
// what they are for good. All others begin with `struct_size`, the bytes that the caller's header
// gives them: set it, and the rest to zero, as `bxt_ray_hit hit = {.struct_size = sizeof hit};`
// does. bxt_limits, bxt_face_options and bxt_approximation come from the function
// bxt_default_...() instead: 0 is a value of their members, such as no layer and no node, and not
// the default; NULL in their place is all defaults. A bxt_motion comes from bxt_motion_along().
// Later versions add members at the end: a library reads and writes no member that its caller does
// not know, and refuses (BXT_INVALID_QUERY) one of an input that it does not know itself, unless it
// is zero. Of an array of structs the first one's size is that of all; the others need not set it.
// Arrays that are written have it in all of them.
//
// Memory. Handles come from functions with "open", "bind", "assemble" or "copy" in their names and
// are given back, once, to the one that is named there; NULL is given back for nothing. The memory
// of a handle and of all that it owns, a copied file and the instances of a scene among it, comes
// from the bxt_allocator that is given, if any, or else from operator new (of a copied file, from
// pages of the system); texts that a call needs for itself, names of files and the words of errors,
// from operator new always. Queries allocate nothing. Texts are UTF-8; functions that return a text
// copy as much of it as fits into `buffer`, with a 0 at the end, and return its whole length
// without this 0, as snprintf does: with NULL and 0 the length alone. A text that is cut ends with
// a whole character.
//
// Callbacks are a function and a `context`, which is handed through. They are called on the thread
// of the query, before it returns, and must return: no longjmp, no exception. A callback may make
// queries.
//
// Threads. Queries of a file, tree or scene are safe from many threads at once. Functions that take
// a handle without const need it for themselves. There is no global state.
//
// Coordinates: a tree's are those of its mesh, object space; a scene's are those of the world.
// Stack: as the C++ functions of the same names, at most 64 KB where a function does not say
// otherwise.
#ifndef BOXTREE_C_H
#define BOXTREE_C_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifndef BXT_API
#if defined(_WIN32) && defined(BXT_BUILDS_SHARED)
#define BXT_API __declspec(dllexport)
#elif defined(BXT_BUILDS_SHARED)
#define BXT_API __attribute__((visibility("default")))
#else
#define BXT_API
#endif
#endif

#ifdef __cplusplus
extern "C" {
#endif

// ---- The library -----------------------------------------------------------------------------

/// The version of this interface: major * 65536 + minor. Programs run with a library of the same
/// major version whose minor version is theirs or higher.
#define BXT_ABI_VERSION 0x10004u

/// BXT_ABI_VERSION of the library that is linked.
BXT_API uint32_t bxt_abi_version(void);
/// The version of boxtree, as "0.1.0".
BXT_API const char* bxt_version(void);

// ---- Errors ----------------------------------------------------------------------------------

/// BXT_OK or the code of an error. Pinned: a number never changes its meaning.
typedef int32_t bxt_status;
enum {
  BXT_OK = 0,  ///< No error.

  // The container.
  BXT_BAD_MAGIC = 10,            ///< Not a .bxt file.
  BXT_TRUNCATED = 11,            ///< The file is not as long as its sections.
  BXT_VERSION_UNSUPPORTED = 12,  ///< Written by a newer format than this reader knows.
  BXT_FEATURE_UNSUPPORTED = 13,  ///< Uses a feature that this reader does not know.
  BXT_HEADER_CORRUPT = 14,       ///< Header or section table is damaged.
  BXT_TOO_MANY_SECTIONS = 15,    ///< More sections than the limit.
  BXT_SECTION_ORDER = 18,        ///< Sections are out of order, or one occurs twice.
  BXT_SECTION_MISSING = 20,      ///< A section that the tree needs is absent.
  BXT_SECTION_SIZE = 21,         ///< A section's size contradicts its records.
  BXT_SECTION_UNKNOWN = 22,      ///< A section that this reader does not know.
  BXT_PADDING_NOT_ZERO = 23,     ///< Padding or reserved bytes are not zero.
  BXT_CHECKSUM_MISMATCH = 24,    ///< A section's bytes have changed.
  BXT_BLOB_LIMIT = 25,           ///< Decompressing would take more memory than allowed.
  BXT_BLOB_CORRUPT = 26,         ///< A compressed file is damaged.

  // The trees inside.
  BXT_CODEC_UNSUPPORTED = 30,     ///< Unknown node codec, or one that this library leaves out.
  BXT_GEOMETRY_UNSUPPORTED = 31,  ///< Unknown geometry store.
  BXT_RECORD_INVALID = 32,        ///< A record contradicts itself.
  BXT_NODE_CORRUPT = 33,          ///< A node points outside its own subtree.
  BXT_DEPTH_EXCEEDED = 34,        ///< The tree is deeper than it states.
  BXT_FACE_OUT_OF_RANGE = 35,     ///< A leaf names a face that is not there.
  BXT_VERTEX_OUT_OF_RANGE = 36,   ///< A face names a vertex that is not there.
  BXT_BOX_ESCAPE = 38,            ///< A triangle sticks out of a box above it.
  BXT_FACE_UNREACHABLE = 39,      ///< No leaf holds this face.
  BXT_FACE_REPEATED = 40,         ///< More than one leaf holds this face.
  BXT_VERTEX_NOT_FINITE = 41,     ///< A stored vertex is NaN or infinite.
  BXT_DUPLICATE_DIFFERS = 42,     ///< A face listed as a copy of another one is not the same.

  // Binding and querying.
  BXT_INVALID_QUERY = 50,           ///< An argument is not valid; the message names it.
  BXT_INVALID_POSE = 51,            ///< A pose is not finite, not invertible or leads too far.
  BXT_PART_LEFT_OUT = 52,           ///< A needed part was left out when the file was cooked.
  BXT_EXTERNAL_MESH_NEEDED = 53,    ///< The tree has no geometry; give the mesh when binding.
  BXT_EXTERNAL_MESH_MISMATCH = 54,  ///< The mesh given is not the one it was cooked from.
  BXT_TREE_INDEX = 55,              ///< No tree with this number or name, or several trees.
  BXT_NO_SCENE = 56,                ///< The file holds trees but no scene.
  BXT_INSTANCE_INDEX = 57,          ///< No instance with this number or name in the scene.
  BXT_INSTANCE_STATIC = 58,         ///< A static instance cannot be moved.
  BXT_WORK_LIMIT = 59,              ///< The query would cost more than its caller allows.

  // The operating system.
  BXT_FILE_NOT_FOUND = 60,   ///< No such file.
  BXT_FILE_UNREADABLE = 61,  ///< The file cannot be read.
  BXT_MAP_FAILED = 62,       ///< The file cannot be mapped.
  BXT_WRITE_FAILED = 63,     ///< The file cannot be written.
  BXT_OUT_OF_MEMORY = 64,    ///< There is too little memory.

  // Meshes.
  BXT_IMPORT_FAILED = 70,            ///< The mesh cannot be read.
  BXT_NO_FACES = 71,                 ///< The mesh has no faces.
  BXT_MESH_NOT_FINITE = 72,          ///< A vertex is NaN or infinite.
  BXT_MESH_INDEX_OUT_OF_RANGE = 73,  ///< A face names a vertex that is not there.
  BXT_MESH_TOO_LARGE = 74,           ///< More than the format, or a scene, holds.
  BXT_MESH_UNSUPPORTED = 75,         ///< The mesh cannot be stored in the way requested.
  BXT_BUDGET_UNREACHABLE = 76,       ///< No encoding keeps to what was requested.
  BXT_PROFILE_INVALID = 77,          ///< A profile says what it must not.
  BXT_DOCUMENT_INVALID = 78,         ///< A JSON document is not what it should be.

  BXT_INTERNAL = 90  ///< An error of the library; please report it.
};

/// The pinned name of a code, as "work_limit"; that of BXT_INTERNAL for numbers that are no code.
BXT_API const char* bxt_error_name(bxt_status status);
/// What a code means, in one sentence without a full stop.
BXT_API const char* bxt_error_meaning(bxt_status status);

/// What a function that failed says of it.
typedef struct bxt_error {
  uint32_t struct_size;     ///< sizeof(bxt_error); up to 65536 if `message` goes on behind it.
  bxt_status status;        ///< What the function returned.
  uint64_t message_length;  ///< Of the whole message without the 0 behind it, be it cut or not.
  char message[496];  ///< What went wrong, where, and what was expected; cut where it is long.
} bxt_error;

// ---- Geometry --------------------------------------------------------------------------------

/// A point or vector.
typedef struct bxt_vec3 {
  double x, y, z;
} bxt_vec3;

/// A rotation. Need not have a length of 1, but not 0.
typedef struct bxt_quaternion {
  double x, y, z, w;
} bxt_quaternion;

/// An affine map of object space to the world, which takes a point p to
/// position + p.x * x_axis + p.y * y_axis + p.z * z_axis.
typedef struct bxt_pose {
  bxt_vec3 x_axis, y_axis, z_axis, position;
} bxt_pose;

/// The points p with normal . p + offset >= 0.
typedef struct bxt_plane {
  bxt_vec3 normal;
  double offset;
} bxt_plane;

/// The points origin + t * direction with t_min <= t <= t_max.
typedef struct bxt_ray {
  bxt_vec3 origin;     ///< Where t is 0.
  bxt_vec3 direction;  ///< Of any length but zero; the unit of t.
  double t_min;        ///< 0 or more.
  double t_max;        ///< t_min or more; INFINITY for a ray without an end.
} bxt_ray;

/// A triangle. Counterclockwise, seen from the front.
typedef struct bxt_triangle {
  bxt_vec3 corner[3];
} bxt_triangle;

/// No face: what its members say of none, and its id in trees without ids.
#define BXT_NO_FACE 0xffffffffu
/// The instance of what is no part of a scene.
#define BXT_NO_INSTANCE 0xffffffffu
/// The material of a face without one.
#define BXT_NO_MATERIAL 0xffffffffu

/// A face in an answer.
typedef struct bxt_face {
  /// Number in the source mesh, the same for all parts of a face that import split; BXT_NO_FACE
  /// when the file has no ids.
  uint32_t id;
  uint32_t index;     ///< Number in the tree's own order, by which functions take it; where they
                      ///< need the id and it is BXT_NO_FACE, they find it by this.
  uint32_t instance;  ///< Of a scene; BXT_NO_INSTANCE of a tree.
} bxt_face;

/// The part of a triangle that a contact lies on.
enum {
  BXT_FEATURE_FACE = 0,   ///< Its inside.
  BXT_FEATURE_EDGE = 1,   ///< An edge, without its ends.
  BXT_FEATURE_VERTEX = 2  ///< A corner.
};

/// Kinds of shapes.
enum {
  BXT_SPHERE = 1,   ///< `position`, `radius`.
  BXT_CAPSULE = 2,  ///< `position` and `end` of its segment, `radius`.
  BXT_BOX = 3,      ///< `position` of its centre, `half_extents`, `rotation`.
  BXT_CONVEX_HULL =
      4  ///< `points` in space of their own, whose origin is at `position`; `rotation`.
};

/// The most points of a convex hull.
#define BXT_MAX_HULL_POINTS 256

/// A convex shape: the members that its kind names, the others are not read.
typedef struct bxt_shape {
  uint32_t struct_size;     ///< sizeof(bxt_shape).
  uint32_t kind;            ///< BXT_SPHERE, ...
  bxt_vec3 position;        ///< Centre, begin of the segment, or where the points' origin is.
  bxt_vec3 end;             ///< The segment's other end; may be the same.
  bxt_vec3 half_extents;    ///< Along the box's own axes, 0 or more.
  bxt_quaternion rotation;  ///< From the shape's own axes.
  double radius;            ///< 0 or more.
  const bxt_vec3* points;   ///< Any points: nobody needs to compute their hull.
  uint64_t point_count;     ///< 1 to BXT_MAX_HULL_POINTS.
} bxt_shape;

/// A ball.
static inline bxt_shape bxt_sphere(bxt_vec3 center, double radius) {
  bxt_shape shape = {sizeof(bxt_shape), BXT_SPHERE, center, center, {0, 0, 0},
                     {0, 0, 0, 1},      radius,     NULL,   0};
  return shape;
}
/// All points within a radius of a segment.
static inline bxt_shape bxt_capsule(bxt_vec3 start, bxt_vec3 end, double radius) {
  bxt_shape shape = {sizeof(bxt_shape), BXT_CAPSULE, start, end, {0, 0, 0},
                     {0, 0, 0, 1},      radius,      NULL,  0};
  return shape;
}
/// A box along axes of its own.
static inline bxt_shape bxt_box(bxt_vec3 center, bxt_vec3 half_extents, bxt_quaternion rotation) {
  bxt_shape shape = {sizeof(bxt_shape), BXT_BOX, center, center, half_extents,
                     rotation,          0,       NULL,   0};
  return shape;
}
/// The smallest convex body that holds some points, which are borrowed.
static inline bxt_shape bxt_convex_hull(const bxt_vec3* points, uint64_t count, bxt_vec3 position,
                                        bxt_quaternion rotation) {
  bxt_shape shape = {sizeof(bxt_shape),
                     BXT_CONVEX_HULL,
                     position,
                     position,
                     {0, 0, 0},
                     rotation,
                     0,
                     points,
                     count};
  return shape;
}
/// The rotation that turns nothing.
static inline bxt_quaternion bxt_no_rotation(void) {
  bxt_quaternion rotation = {0, 0, 0, 1};
  return rotation;
}
/// The pose of what is in the world as in object space.
static inline bxt_pose bxt_identity(void) {
  bxt_pose pose = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}};
  return pose;
}
/// The pose of what is moved, and not turned.
static inline bxt_pose bxt_translation(double x, double y, double z) {
  bxt_pose pose = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {x, y, z}};
  return pose;
}

// ---- Memory ----------------------------------------------------------------------------------

/// Where the memory of a handle and of what it owns comes from. Called by the functions that make
/// the handle, change what it owns or take it back, on their threads. The struct itself is copied;
/// what `context` points to has to live as long as the handle.
typedef struct bxt_allocator {
  uint32_t struct_size;  ///< sizeof(bxt_allocator).
  void* context;         ///< Handed to both.
  /// Memory of at least `size` bytes at a multiple of `alignment` (a power of two), or NULL, which
  /// the library answers with BXT_OUT_OF_MEMORY.
  void* (*allocate)(void* context, size_t size, size_t alignment);
  /// Takes back what `allocate` gave for the same size and alignment.
  void (*release)(void* context, void* memory, size_t size, size_t alignment);
} bxt_allocator;

// ---- Files -----------------------------------------------------------------------------------

/// An open .bxt file: checked header and section table over mapped bytes.
typedef struct bxt_file bxt_file;

/// How a file is opened.
typedef struct bxt_file_options {
  uint32_t struct_size;            ///< sizeof(bxt_file_options).
  bool copy;                       ///< Read it into memory: for files that others modify in place.
  bool verify_checksums;           ///< Check every section: reads the whole file.
  const bxt_allocator* allocator;  ///< NULL for the allocator of C++.
} bxt_file_options;

/// Maps a file and checks what can be checked without reading trees. While it is mapped it must not
/// be truncated in place. `path`: UTF-8. `options` may be NULL. Errors: BXT_FILE_NOT_FOUND,
/// BXT_FILE_UNREADABLE, BXT_MAP_FAILED, BXT_OUT_OF_MEMORY and 10 to 29.
BXT_API bxt_status bxt_file_open(const char* path, const bxt_file_options* options, bxt_file** file,
                                 bxt_error* error);
/// The same of memory of the caller, of any alignment, which must stay as it is until the file is
/// closed. `copy` is not for memory: BXT_INVALID_QUERY.
BXT_API bxt_status bxt_file_open_memory(const void* bytes, size_t size,
                                        const bxt_file_options* options, bxt_file** file,
                                        bxt_error* error);
/// Closes it, after what was bound to it.
BXT_API void bxt_file_close(bxt_file* file);

/// How many trees it holds, those of a scene included.
BXT_API uint32_t bxt_file_tree_count(const bxt_file* file);
/// Whether it is a pack of many files, which is used like one: its trees are those of all members.
BXT_API bool bxt_file_is_pack(const bxt_file* file);
/// Opens the file that a tree is in: a member of a pack, which may have a scene of its own; of
/// another file, the same again. Its bytes are those of `file`, which has to be open for as long;
/// it is given back to bxt_file_close(). `number`: that of the tree there; may be NULL. Errors:
/// BXT_TREE_INDEX, BXT_OUT_OF_MEMORY; of a pack, BXT_RECORD_INVALID and those of bxt_file_open().
BXT_API bxt_status bxt_file_open_member(const bxt_file* file, uint32_t tree, bxt_file** member,
                                        uint32_t* number, bxt_error* error);
/// Whether bxt_scene_bind() finds a scene; no pack has one, but its members may.
BXT_API bool bxt_file_has_scene(const bxt_file* file);
/// Name of a tree; empty when it has none or there is no such tree.
BXT_API size_t bxt_file_tree_name(const bxt_file* file, uint32_t tree, char* buffer,
                                  size_t capacity);
/// The number of the first tree with that name. Error: BXT_TREE_INDEX.
BXT_API bxt_status bxt_file_find_tree(const bxt_file* file, const char* name, uint32_t* tree,
                                      bxt_error* error);
/// Whether the bytes of all sections are as written; reads the whole file. Error:
/// BXT_CHECKSUM_MISMATCH.
BXT_API bxt_status bxt_file_verify_checksums(const bxt_file* file, bxt_error* error);

/// How a mapped file will be read.
enum {
  BXT_ACCESS_NORMAL = 0,      ///< As the system does unless told otherwise.
  BXT_ACCESS_RANDOM = 1,      ///< Here and there: nothing is read ahead.
  BXT_ACCESS_SEQUENTIAL = 2,  ///< From front to back: much is read ahead.
  BXT_ACCESS_WILL_NEED = 3,   ///< All of it, soon: starts reading in the background.
  BXT_ACCESS_DONT_NEED = 4    ///< Nothing for a while: gives the memory back.
};
/// Tells the system. Returns whether it took the advice: not of memory, nor everywhere. Never
/// changes an answer.
BXT_API bool bxt_file_advise(const bxt_file* file, uint32_t access);

// ---- Trees -----------------------------------------------------------------------------------

/// A tree of a file, ready for queries.
typedef struct bxt_tree bxt_tree;

/// Arrays of the application for a tree that was cooked with external geometry: those of the source
/// mesh, which must outlive the tree and not change.
typedef struct bxt_mesh {
  uint32_t struct_size;      ///< sizeof(bxt_mesh).
  uint32_t vertex_count;     ///< Number of vertices.
  const void* positions;     ///< Of the first vertex: three floats or doubles.
  uint64_t position_stride;  ///< Bytes from one vertex to the next.
  const void* corners;       ///< The corner numbers of all faces.
  uint32_t face_count;       ///< Number of faces.
  uint32_t corner_bytes;     ///< Of one corner number: 2 or 4.
  /// 3, or 4, of which the last may be missing: all bits set.
  uint32_t corners_per_face;
  bool positions_are_double;  ///< Whether positions are doubles.
} bxt_mesh;

/// What is required of a tree or scene when it is bound, rather than found missing later.
typedef struct bxt_tree_options {
  uint32_t struct_size;            ///< sizeof(bxt_tree_options).
  bool verify_mesh;                ///< Compare the content of `mesh` with the hash in the file.
  bool require_face_ids;           ///< Else ids are BXT_NO_FACE where there are none.
  bool require_active_edges;       ///< Else all edges are active where nothing is known.
  bool require_materials;          ///< Else materials are BXT_NO_MATERIAL.
  bool require_user_data;          ///< Else there is none.
  const bxt_mesh* mesh;            ///< For external geometry, or NULL.
  const bxt_allocator* allocator;  ///< NULL for the allocator of C++.
} bxt_tree_options;

/// The only tree of a file.
#define BXT_ONLY_TREE 0xffffffffu

/// Makes tree `number` of a file ready for queries, at a cost that does not depend on its size but
/// for `verify_mesh`. `options` may be NULL. Errors: BXT_TREE_INDEX (also of BXT_ONLY_TREE where
/// there are several, or a scene), 20, 21, 30 to 32, BXT_PART_LEFT_OUT,
/// BXT_EXTERNAL_MESH_NEEDED, BXT_EXTERNAL_MESH_MISMATCH, BXT_VERTEX_OUT_OF_RANGE (with
/// `verify_mesh`), BXT_OUT_OF_MEMORY.
BXT_API bxt_status bxt_tree_bind(const bxt_file* file, uint32_t number,
                                 const bxt_tree_options* options, bxt_tree** tree,
                                 bxt_error* error);
/// Another handle of the same tree whose visitors hear of original faces alone, not of their
/// copies. Error: BXT_OUT_OF_MEMORY.
BXT_API bxt_status bxt_tree_copy_without_duplicates(const bxt_tree* tree,
                                                    const bxt_allocator* allocator, bxt_tree** copy,
                                                    bxt_error* error);
/// Releases the handle; scenes that were assembled of it have their own.
BXT_API void bxt_tree_release(bxt_tree* tree);

/// Its name in the file; empty when it has none.
BXT_API size_t bxt_tree_name(const bxt_tree* tree, char* buffer, size_t capacity);
/// The name of its codec, as "wide8".
BXT_API size_t bxt_tree_codec_name(const bxt_tree* tree, char* buffer, size_t capacity);
/// How many faces it has: triangles and quads.
BXT_API uint32_t bxt_tree_face_count(const bxt_tree* tree);
/// How many triangles; a quad counts as two.
BXT_API uint32_t bxt_tree_triangle_count(const bxt_tree* tree);
/// Whether faces have the ids of the source mesh.
BXT_API bool bxt_tree_has_face_ids(const bxt_tree* tree);
/// Whether edges are known to be active or not.
BXT_API bool bxt_tree_has_active_edges(const bxt_tree* tree);
/// A box around all faces, rounded outward; returns false, and writes nothing, of an empty tree.
BXT_API bool bxt_tree_bounds(const bxt_tree* tree, bxt_vec3* min, bxt_vec3* max);
/// The material of a face that an answer names; BXT_NO_MATERIAL without any.
BXT_API uint32_t bxt_tree_material(const bxt_tree* tree, const bxt_face* face);
/// How many materials its file has, numbered from 0.
BXT_API uint32_t bxt_tree_material_count(const bxt_tree* tree);
/// Name of a material; empty when it has none.
BXT_API size_t bxt_tree_material_name(const bxt_tree* tree, uint32_t material, char* buffer,
                                      size_t capacity);
/// The application's number of a face that an answer names; returns whether there is one.
BXT_API bool bxt_tree_user_data(const bxt_tree* tree, const bxt_face* face, uint32_t* data);
/// Whether there are such numbers.
BXT_API bool bxt_tree_has_user_data(const bxt_tree* tree);
/// A triangle of a face that an answer names, as queries see it. `half`: 0, or 1 for the second
/// half of a quad. Errors: BXT_INVALID_QUERY (no such face or half) and those of corrupt bytes.
BXT_API bxt_status bxt_tree_triangle(const bxt_tree* tree, const bxt_face* face, uint32_t half,
                                     bxt_triangle* triangle, bxt_error* error);
/// Which edges of it are active: bit i is the edge from corner i to the next one. Errors: as there.
BXT_API bxt_status bxt_tree_active_edges(const bxt_tree* tree, const bxt_face* face, uint32_t half,
                                         uint32_t* edges, bxt_error* error);
/// Reads the nodes of the first `levels` levels, so that queries of a cold file do not wait for
/// them. Returns how many there are.
BXT_API uint32_t bxt_tree_prefetch(const bxt_tree* tree, uint32_t levels);

// ---- What queries share ----------------------------------------------------------------------

/// No limit of the nodes that a query may visit.
#define BXT_UNLIMITED UINT64_MAX
/// Every layer of a scene.
#define BXT_ALL_LAYERS 0xffffffffu

/// What a query may cost and, in a scene, which instances it is about. NULL stands for the default.
typedef struct bxt_limits {
  uint32_t struct_size;  ///< sizeof(bxt_limits).
  uint32_t layers;       ///< Of scenes alone, as bits [BXT_ALL_LAYERS].
  uint64_t nodes;        ///< Nodes to visit before BXT_WORK_LIMIT [BXT_UNLIMITED].
} bxt_limits;

/// No limit, every layer.
static inline bxt_limits bxt_default_limits(void) {
  bxt_limits limits = {sizeof(bxt_limits), BXT_ALL_LAYERS, BXT_UNLIMITED};
  return limits;
}

/// What becomes of faces that are met from behind: from where corners are seen clockwise, of an
/// instance in its own coordinates, so that a pose that mirrors turns nothing over.
enum {
  BXT_BACK_FACES_HIT = 0,     ///< They are hit like others.
  BXT_BACK_FACES_IGNORE = 1,  ///< They are passed through.
  BXT_BACK_FACES_ONLY = 2     ///< They alone are hit.
};

/// Whether a face may be hit. Must answer alike whenever it is called.
typedef bool (*bxt_face_filter)(void* context, const bxt_face* face);
/// Whether an instance of a scene may be hit; called once for each that a query comes near.
typedef bool (*bxt_instance_filter)(void* context, uint32_t instance);

/// Which faces a ray or a cast may hit, and what it may cost. NULL stands for the default.
typedef struct bxt_face_options {
  uint32_t struct_size;                 ///< sizeof(bxt_face_options).
  uint32_t back_faces;                  ///< [BXT_BACK_FACES_HIT]
  uint32_t layers;                      ///< Of scenes alone, as bits [BXT_ALL_LAYERS].
  uint32_t reserved;                    ///< 0
  uint64_t nodes;                       ///< Nodes to visit before BXT_WORK_LIMIT [BXT_UNLIMITED].
  bxt_face_filter filter;               ///< NULL: every face.
  void* filter_context;                 ///< For `filter`.
  bxt_instance_filter instance_filter;  ///< NULL: every instance. Of scenes alone.
  void* instance_filter_context;        ///< For `instance_filter`.
} bxt_face_options;

/// Every face, from both sides, no limit.
static inline bxt_face_options bxt_default_face_options(void) {
  bxt_face_options options = {sizeof(bxt_face_options),
                              BXT_BACK_FACES_HIT,
                              BXT_ALL_LAYERS,
                              0,
                              BXT_UNLIMITED,
                              NULL,
                              NULL,
                              NULL,
                              NULL};
  return options;
}

/// How near to the truth an answer has to be, and what it may cost: [lower, upper] has converged if
/// upper <= lower * (1 + relative_error) or upper <= lower + absolute_error, but for what rounding
/// takes from both. NULL: the default.
typedef struct bxt_approximation {
  uint32_t struct_size;   ///< sizeof(bxt_approximation).
  uint32_t reserved;      ///< 0
  double relative_error;  ///< 0 or more [0].
  double absolute_error;  ///< A length, 0 or more [0].
  double max_distance;    ///< Nothing farther is looked for [INFINITY].
  uint64_t node_budget;   ///< Nodes and leaves before it ends with what it knows [BXT_UNLIMITED].
} bxt_approximation;

/// As exactly as doubles tell, however far, whatever it costs.
static inline bxt_approximation bxt_default_approximation(void) {
  bxt_approximation options = {sizeof(bxt_approximation), 0, 0, 0, INFINITY, BXT_UNLIMITED};
  return options;
}

/// Receives one face after the other; returns whether to go on.
typedef bool (*bxt_face_visitor)(void* context, const bxt_face* face);

// ---- Rays ------------------------------------------------------------------------------------

/// Where a ray meets a surface.
typedef struct bxt_ray_hit {
  uint32_t struct_size;  ///< sizeof(bxt_ray_hit).
  bool is_hit;           ///< Whether there is a hit; else the rest says: infinitely far, no face.
  double t;              ///< In units of the ray's direction.
  bxt_face face;         ///< The face that was hit, in a scene with its instance.
  uint32_t triangle;     ///< 0, or 1 for the second half of a quad.
  double u, v;           ///< Weights of the triangle's corners 1 and 2; corner 0 has 1 - u - v.
  bxt_vec3 point;        ///< Where, on the face.
  bxt_vec3 normal;       ///< Unit normal to the face's front; zero of a face without an area.
} bxt_ray_hit;

/// The hit with the smallest t; of several the one with the smallest id (of the instance, then of
/// the face). Both sides count unless `options` say otherwise; no gap lies between faces that share
/// an edge. Errors: BXT_INVALID_QUERY, BXT_WORK_LIMIT, 33 to 41 where the ray comes upon corrupt
/// bytes.
BXT_API bxt_status bxt_tree_closest_hit(const bxt_tree* tree, const bxt_ray* ray,
                                        const bxt_face_options* options, bxt_ray_hit* hit,
                                        bxt_error* error);
/// Some hit: cheaper where only the fact matters.
BXT_API bxt_status bxt_tree_any_hit(const bxt_tree* tree, const bxt_ray* ray,
                                    const bxt_face_options* options, bxt_ray_hit* hit,
                                    bxt_error* error);

/// Receives one hit after the other; returns the largest t that is still of interest, or a negative
/// number to stop.
typedef double (*bxt_ray_visitor)(void* context, const bxt_ray_hit* hit);
/// Visits every hit, each triangle once, in no promised order.
BXT_API bxt_status bxt_tree_all_hits(const bxt_tree* tree, const bxt_ray* ray,
                                     bxt_ray_visitor visitor, void* context,
                                     const bxt_face_options* options, bxt_error* error);
/// The first hits in the order of t, then of ids, as many as there is room for. `count` receives
/// how many; those behind them are misses. Takes time proportional to the room for each hit that is
/// met. It works in `hits`: where it fails they hold some of the hits.
BXT_API bxt_status bxt_tree_nearest_hits(const bxt_tree* tree, const bxt_ray* ray,
                                         bxt_ray_hit* hits, size_t capacity, size_t* count,
                                         const bxt_face_options* options, bxt_error* error);

/// The closest hit of each of `count` rays, to the bit what bxt_tree_closest_hit() says of it, in
/// less time, the more so the nearer consecutive rays are to each other. An error of a ray makes it
/// a miss; `statuses`, which may be NULL, receives each ray's own, and the first one is returned:
/// all rays are answered. Where another argument is not valid nothing is written. Less than 160 KB
/// of stack.
BXT_API bxt_status bxt_tree_closest_hits(const bxt_tree* tree, const bxt_ray* rays, size_t count,
                                         bxt_ray_hit* hits, bxt_status* statuses,
                                         const bxt_face_options* options, bxt_error* error);
/// The same for bxt_tree_any_hit().
BXT_API bxt_status bxt_tree_any_hits(const bxt_tree* tree, const bxt_ray* rays, size_t count,
                                     bxt_ray_hit* hits, bxt_status* statuses,
                                     const bxt_face_options* options, bxt_error* error);

// ---- Overlaps --------------------------------------------------------------------------------

/// Visits every face that touches the closed box along the axes from `min` to `max`, each once, in
/// no promised order. Exact. Errors: as of rays.
BXT_API bxt_status bxt_tree_overlap_box(const bxt_tree* tree, const bxt_vec3* min,
                                        const bxt_vec3* max, bxt_face_visitor visitor,
                                        void* context, const bxt_limits* limits, bxt_error* error);
/// Receives the number of a shape in its batch and a face that touches it; returns whether to go on
/// with this shape. Faces of other shapes may come in between.
typedef bool (*bxt_batch_face_visitor)(void* context, size_t number, const bxt_face* face);
/// Visits the faces that touch one of the `count` boxes from `mins[i]` to `maxs[i]`, for each box
/// those that bxt_tree_overlap_box() visits, in the same order: in less time, the more so the
/// nearer consecutive boxes are to each other. `statuses`: of each box, or null; returns the first
/// error of a box, all others are visited all the same. Takes up to 160 KB of stack.
BXT_API bxt_status bxt_tree_overlap_boxes(const bxt_tree* tree, const bxt_vec3* mins,
                                          const bxt_vec3* maxs, size_t count,
                                          bxt_batch_face_visitor visitor, void* context,
                                          const bxt_limits* limits, bxt_status* statuses,
                                          bxt_error* error);
/// The same of spheres around `centers[i]` with radius `radii[i]`.
BXT_API bxt_status bxt_tree_overlap_spheres(const bxt_tree* tree, const bxt_vec3* centers,
                                            const double* radii, size_t count,
                                            bxt_batch_face_visitor visitor, void* context,
                                            const bxt_limits* limits, bxt_status* statuses,
                                            bxt_error* error);
/// As bxt_tree_overlap_box() of a shape. Faces are touched, not solids: a shape inside a mesh
/// touches nothing. A hull takes up to 200 KB of stack.
BXT_API bxt_status bxt_tree_overlap(const bxt_tree* tree, const bxt_shape* shape,
                                    bxt_face_visitor visitor, void* context,
                                    const bxt_limits* limits, bxt_error* error);
/// The same of what lies inside six planes, as the view of a camera. A plane whose normal is 0 and
/// whose offset is 0 or more cuts nothing off.
BXT_API bxt_status bxt_tree_overlap_frustum(const bxt_tree* tree, const bxt_plane planes[6],
                                            bxt_face_visitor visitor, void* context,
                                            const bxt_limits* limits, bxt_error* error);

/// What z / w of clip space is for what is visible.
enum {
  BXT_CLIP_ZERO_TO_ONE = 0,      ///< Direct3D, Metal, Vulkan and others, also reversed.
  BXT_CLIP_MINUS_ONE_TO_ONE = 1  ///< OpenGL.
};
/// The planes of the matrix of four rows of four numbers, row after row, that takes the column
/// vector (x, y, z, 1) to clip space: left, right, bottom, top, least and greatest depth. Returns
/// false, and writes nothing, if `clip_depth` is neither.
BXT_API bool bxt_frustum_of_matrix(const double rows[16], uint32_t clip_depth, bxt_plane planes[6]);
/// Those around eight corners: four around the near side, and those behind them in the same order.
BXT_API void bxt_frustum_of_corners(const bxt_vec3 corners[8], bxt_plane planes[6]);

/// What is known of two things.
enum {
  BXT_OVERLAPPING = 0,  ///< Some face touches.
  BXT_DISJOINT = 1,     ///< None does.
  BXT_UNDECIDED = 2,    ///< Not told apart, and closer to each other than the given distance.
  BXT_BUDGET_SPENT = 3  ///< The budget ran out before anything was known.
};
/// Whether two surfaces, or a surface and a box, touch.
typedef struct bxt_overlap_answer {
  uint32_t struct_size;     ///< sizeof(bxt_overlap_answer).
  uint32_t overlap;         ///< BXT_OVERLAPPING, ...
  bxt_face first;           ///< Where they do: a face of the first tree, or of the only one.
  bxt_face second;          ///< A face of the second tree.
  uint64_t nodes_expanded;  ///< What the budget counts.
} bxt_overlap_answer;
/// Whether a box and the surface touch; may end undecided where they are closer than `distance`,
/// which is never so if it is 0, and with the budget spent.
BXT_API bxt_status bxt_tree_overlap_box_within(const bxt_tree* tree, const bxt_vec3* min,
                                               const bxt_vec3* max, double distance,
                                               uint64_t node_budget, bxt_overlap_answer* answer,
                                               bxt_error* error);

// ---- Closest points --------------------------------------------------------------------------

/// The point of a surface that is nearest to a given one.
typedef struct bxt_closest_point {
  uint32_t struct_size;     ///< sizeof(bxt_closest_point).
  bool is_found;            ///< Whether there is one within the distance.
  bool converged;           ///< Whether the bounds are as near to each other as was required.
  bxt_vec3 point;           ///< Where.
  double distance;          ///< How far away.
  bxt_face face;            ///< The face that it lies on.
  uint32_t triangle;        ///< 0, or 1 for the second half of a quad.
  double lower;             ///< The surface is at least this far away, all rounding included;
  double upper;             ///< and at most this far.
  uint64_t nodes_expanded;  ///< What the budget counts; 0 of exact queries.
} bxt_closest_point;

/// The nearest point within `max_distance` (INFINITY for any); of several the one with the smallest
/// id. `lower` and `upper` are the distance. Errors: as of rays.
BXT_API bxt_status bxt_tree_closest_point(const bxt_tree* tree, const bxt_vec3* point,
                                          double max_distance, const bxt_limits* limits,
                                          bxt_closest_point* answer, bxt_error* error);
/// The nearest point to each of `count` points, to the bit what bxt_tree_closest_point() says of
/// it, in less time, the more so the nearer consecutive points are to each other. An error of a
/// point leaves its answer empty; otherwise as bxt_tree_closest_hits().
BXT_API bxt_status bxt_tree_closest_points(const bxt_tree* tree, const bxt_vec3* points,
                                           size_t count, double max_distance,
                                           const bxt_limits* limits, bxt_closest_point* answers,
                                           bxt_status* statuses, bxt_error* error);
/// The nearest point as nearly as `options` require, within their budget. Up to 160 KB of stack.
BXT_API bxt_status bxt_tree_closest_point_within(const bxt_tree* tree, const bxt_vec3* point,
                                                 const bxt_approximation* options,
                                                 bxt_closest_point* answer, bxt_error* error);

// ---- Casts -----------------------------------------------------------------------------------

/// How a shape moves: at t it is where it started + t * direction, for 0 <= t <= t_max. It does not
/// turn.
typedef struct bxt_motion {
  uint32_t struct_size;  ///< sizeof(bxt_motion).
  uint32_t reserved;     ///< 0
  bxt_vec3 direction;    ///< Of any length, the unit of t; of zero it stays.
  double t_max;          ///< The end, 0 or more.
} bxt_motion;

/// The motion along a vector, up to its end: t is 0 at its start and 1 (`t_max`) at its end. For a
/// motion without an end, as C++'s Motion has by default, set `t_max` to INFINITY.
static inline bxt_motion bxt_motion_along(bxt_vec3 way) {
  bxt_motion motion = {sizeof(bxt_motion), 0, way, 1};
  return motion;
}

/// The first touch of a moving shape and a surface.
typedef struct bxt_cast_hit {
  uint32_t struct_size;  ///< sizeof(bxt_cast_hit).
  bool is_hit;           ///< Whether there is a touch; else the rest says: infinitely far, no face.
  bool initially_touching;  ///< Whether the shape touches the face at its start.
  bool is_active;        ///< Whether the feature may keep the normal; see bxt_tree_active_edges().
  uint8_t feature;       ///< BXT_FEATURE_FACE, ...: the part of the triangle that is touched.
  double t;              ///< The shape touches at t or before, in units of the direction,
  double t_lower;        ///< and touches nothing before t_lower: moving it there is safe.
  bxt_face face;         ///< The face that is touched.
  uint32_t triangle;     ///< 0, or 1 for the second half of a quad.
  bxt_vec3 point;        ///< Where they touch, on the surface.
  bxt_vec3 normal;       ///< Unit vector along which the surface pushes the shape back.
  bxt_vec3 face_normal;  ///< Orthogonal to the face, to the side to which the normal points.
  uint32_t
      feature_index;  ///< The corner of a vertex, or the one from which an edge leads on: 0 to 2.
  uint32_t reserved;  ///< 0
} bxt_cast_hit;

/// The first touch of the shape on its way; of several at the same t_lower the one with the
/// smallest id. Nothing is missed. A hull takes up to 200 KB of stack. Errors: as of rays.
BXT_API bxt_status bxt_tree_cast_closest(const bxt_tree* tree, const bxt_shape* shape,
                                         const bxt_motion* motion, const bxt_face_options* options,
                                         bxt_cast_hit* hit, bxt_error* error);
/// Some touch: cheaper where only the fact matters.
BXT_API bxt_status bxt_tree_cast_any(const bxt_tree* tree, const bxt_shape* shape,
                                     const bxt_motion* motion, const bxt_face_options* options,
                                     bxt_cast_hit* hit, bxt_error* error);
/// Receives one touch after the other; what it returns is as for bxt_ray_visitor.
typedef double (*bxt_cast_visitor)(void* context, const bxt_cast_hit* hit);
/// Visits every triangle that is touched on the way, each once, in no promised order.
BXT_API bxt_status bxt_tree_cast_all(const bxt_tree* tree, const bxt_shape* shape,
                                     const bxt_motion* motion, bxt_cast_visitor visitor,
                                     void* context, const bxt_face_options* options,
                                     bxt_error* error);
/// The normal along which a touch should act: its own, or the face's where the feature is not
/// active. `velocity` of the shape relative to the surface decides where the own one lies in the
/// face.
BXT_API bxt_vec3 bxt_cast_hit_resolved_normal(const bxt_cast_hit* hit, const bxt_vec3* velocity);

// ---- Contacts of a shape ---------------------------------------------------------------------

/// Where a shape and a triangle touch, and how to part them.
typedef struct bxt_contact {
  uint32_t struct_size;    ///< sizeof(bxt_contact).
  bool is_active;          ///< Whether the feature may keep the normal.
  uint8_t feature;         ///< BXT_FEATURE_FACE, ...
  uint16_t feature_index;  ///< As of bxt_cast_hit.
  bxt_face face;           ///< The face that is touched.
  uint32_t triangle;       ///< 0, or 1 for the second half of a quad.
  bxt_vec3 point;          ///< On the triangle, inside the shape or on its surface, to within rounding.
  bxt_vec3 normal;         ///< Unit vector along which the shape leaves the triangle soonest.
  bxt_vec3 face_normal;    ///< Orthogonal to the face, to the side to which the normal points.
  double depth;            ///< How far it has to move along the normal, 0 or more.
} bxt_contact;

/// Receives one contact after the other; returns whether to go on.
typedef bool (*bxt_contact_visitor)(void* context, const bxt_contact* contact);
/// Visits every triangle that the shape touches, each once, in no promised order. A hull takes up
/// to 200 KB of stack. Errors: as of rays.
BXT_API bxt_status bxt_tree_collide(const bxt_tree* tree, const bxt_shape* shape,
                                    bxt_contact_visitor visitor, void* context,
                                    const bxt_limits* limits, bxt_error* error);
/// As bxt_cast_hit_resolved_normal().
BXT_API bxt_vec3 bxt_contact_resolved_normal(const bxt_contact* contact, const bxt_vec3* velocity);
/// Of contacts of one shape keeps one of those that neighbouring triangles report of the same
/// point: within `distance` of each other, with normals whose cosine is at least `cosine` (0.999,
/// say). Keeps the deepest one, of equal depths the first, then the deepest of those that are
/// unlike it, and so on. Moves them to the front, in their order, and writes how many there are;
/// what is behind them is unspecified. Quadratic.
BXT_API bxt_status bxt_merge_contacts(bxt_contact* contacts, size_t count, double distance,
                                      double cosine, size_t* kept, bxt_error* error);

// ---- Two trees -------------------------------------------------------------------------------

/// Receives a face of the first and a face of the second body that touch; returns whether to go on.
typedef bool (*bxt_pair_visitor)(void* context, const bxt_face* first, const bxt_face* second);
/// Visits every pair of faces that share a point, each once. Poses, NULL for the identity, may be
/// any invertible affine map. Surfaces are compared, not solids. Up to 320 KB of stack. Errors:
/// BXT_INVALID_POSE, BXT_WORK_LIMIT, 33 to 41.
BXT_API bxt_status bxt_tree_overlap_pairs(const bxt_tree* first, const bxt_pose* first_pose,
                                          const bxt_tree* second, const bxt_pose* second_pose,
                                          bxt_pair_visitor visitor, void* context,
                                          const bxt_limits* limits, bxt_error* error);
/// Some such pair: cheaper where only the fact matters. `overlap` is BXT_OVERLAPPING or
/// BXT_DISJOINT.
BXT_API bxt_status bxt_tree_first_contact(const bxt_tree* first, const bxt_pose* first_pose,
                                          const bxt_tree* second, const bxt_pose* second_pose,
                                          const bxt_limits* limits, bxt_overlap_answer* answer,
                                          bxt_error* error);
/// The same, which may end undecided where both are closer than `distance` in the world, never if
/// it is 0, and with the budget spent. Up to 192 KB of stack.
BXT_API bxt_status bxt_tree_overlap_within(const bxt_tree* first, const bxt_pose* first_pose,
                                           const bxt_tree* second, const bxt_pose* second_pose,
                                           double distance, uint64_t node_budget,
                                           bxt_overlap_answer* answer, bxt_error* error);

/// Where two triangles touch, in the world.
typedef struct bxt_pair_contact {
  uint32_t struct_size;      ///< sizeof(bxt_pair_contact).
  uint32_t first_triangle;   ///< Of the first face: 0, or 1 for the second half of a quad.
  uint32_t second_triangle;  ///< Of the second one.
  uint32_t reserved;         ///< 0
  bxt_face first;            ///< The faces that they belong to.
  bxt_face second;           ///< The other one.
  bxt_vec3 start;   ///< The ends of the segment that both share, the same if that is a point.
  bxt_vec3 end;     ///< The other end.
  bxt_vec3 point;   ///< Between them, on both.
  bxt_vec3 normal;  ///< Unit vector along which the second leaves the first soonest.
  double depth;     ///< How far it has to move along it, 0 or more.
} bxt_pair_contact;

/// Receives one contact after the other; returns whether to go on.
typedef bool (*bxt_pair_contact_visitor)(void* context, const bxt_pair_contact* contact);
/// Visits every pair of triangles that share a point, with where they touch.
BXT_API bxt_status bxt_tree_pair_contacts(const bxt_tree* first, const bxt_pose* first_pose,
                                          const bxt_tree* second, const bxt_pose* second_pose,
                                          bxt_pair_contact_visitor visitor, void* context,
                                          const bxt_limits* limits, bxt_error* error);

/// Bounds of the distance of two surfaces, and what was found, in the world.
typedef struct bxt_distance {
  uint32_t struct_size;     ///< sizeof(bxt_distance).
  bool converged;           ///< Whether the bounds are as near to each other as was required.
  bool is_found;            ///< Whether there are faces and points below.
  double lower;             ///< At least this far apart, with all rounding included;
  double upper;             ///< and at most this far.
  bxt_face first;           ///< Faces that are `upper` apart.
  bxt_face second;          ///< The other one.
  bxt_vec3 first_point;     ///< A point of each.
  bxt_vec3 second_point;    ///< The other one.
  uint64_t nodes_expanded;  ///< What the budget counts.
} bxt_distance;
/// The distance of two surfaces, as nearly as `options` require. Half a megabyte of stack.
BXT_API bxt_status bxt_tree_distance(const bxt_tree* first, const bxt_pose* first_pose,
                                     const bxt_tree* second, const bxt_pose* second_pose,
                                     const bxt_approximation* options, bxt_distance* distance,
                                     bxt_error* error);

// ---- Traversals of your own ------------------------------------------------------------------

/// Receives a box that holds every triangle below a node; returns whether to look into it. Must
/// pass every box around one that it passes.
typedef bool (*bxt_box_test)(void* context, const bxt_vec3* min, const bxt_vec3* max);
/// Receives one triangle after the other; returns whether to go on.
typedef bool (*bxt_triangle_visitor)(void* context, const bxt_triangle* triangle,
                                     const bxt_face* face, uint32_t half);
/// Visits every triangle below boxes that all pass the test, each once; of faces that are copies of
/// others none. Errors: as of rays.
BXT_API bxt_status bxt_tree_traverse(const bxt_tree* tree, bxt_box_test test,
                                     bxt_triangle_visitor visitor, void* context,
                                     const bxt_limits* limits, bxt_error* error);

// ---- Scenes ----------------------------------------------------------------------------------

/// Placed trees of a file or of several.
typedef struct bxt_scene bxt_scene;

/// Kinds of queries, as bits.
enum {
  BXT_RAY_QUERIES = 1,    ///< Rays and casts.
  BXT_BOX_QUERIES = 2,    ///< What touches a shape at rest: overlaps, collide, frustums.
  BXT_POINT_QUERIES = 4,  ///< Closest points.
  BXT_PAIR_QUERIES = 8,   ///< Contacts and distances of instances, and of a tree with a scene.
  BXT_ALL_QUERIES = 15    ///< All of them.
};

/// The arrays of one tree with external geometry.
typedef struct bxt_scene_mesh {
  uint32_t struct_size;  ///< sizeof(bxt_scene_mesh).
  uint32_t tree;         ///< Its number in the file.
  const bxt_mesh* mesh;  ///< Its arrays.
} bxt_scene_mesh;

/// What is required of a scene when it is bound. NULL stands for nothing.
typedef struct bxt_scene_options {
  uint32_t struct_size;   ///< sizeof(bxt_scene_options).
  uint32_t queries;       ///< Kinds of queries that will be made: what was left out is told now.
  bool require_face_ids;  ///< As of bxt_tree_options, of every tree.
  bool require_active_edges;       ///< The same.
  bool require_materials;          ///< Of any of them.
  bool require_user_data;          ///< Of every tree.
  bool require_names;              ///< Some instance has a name.
  const bxt_scene_mesh* meshes;    ///< For external geometry.
  uint64_t mesh_count;             ///< How many.
  const uint32_t* moving;          ///< Static instances that bxt_scene_update() shall move, too.
  uint64_t moving_count;           ///< How many.
  const bxt_allocator* allocator;  ///< NULL for the allocator of C++.
} bxt_scene_options;

/// Binds the scene of a file, at a cost that grows with its trees and moving instances. `options`
/// may be NULL. Errors: BXT_NO_SCENE, BXT_PART_LEFT_OUT (naming the line of the profile),
/// BXT_INSTANCE_INDEX, BXT_RECORD_INVALID, those of bxt_tree_bind().
BXT_API bxt_status bxt_scene_bind(const bxt_file* file, const bxt_scene_options* options,
                                  bxt_scene** scene, bxt_error* error);

/// One instance of a scene that is assembled.
typedef struct bxt_placed_tree {
  uint32_t struct_size;  ///< sizeof(bxt_placed_tree).
  uint32_t tree;         ///< The number of its tree among those given.
  bxt_pose pose;         ///< Object space to world.
  uint32_t layer;        ///< The number of its layer, 0 to 31.
  bool moves;            ///< Whether bxt_scene_update() may move it.
  uint64_t user_data;    ///< What bxt_scene_user_data() answers.
  const char* name;      ///< NULL for none.
} bxt_placed_tree;
/// A layer of such a scene.
typedef struct bxt_scene_layer {
  uint32_t struct_size;    ///< sizeof(bxt_scene_layer).
  uint32_t collides_with;  ///< Layers with which there may be contacts, as bits.
  uint32_t queries;        ///< The kinds of queries that its instances answer, as bits.
  uint32_t reserved;       ///< 0
  const char* name;        ///< NULL for none.
} bxt_scene_layer;
/// Makes a scene of trees of any files, which must outlive it; the handles of trees need not. It
/// answers as one file with these instances would, but no edge is known to be inactive because the
/// surface goes on in another instance. `allocator` may be NULL. Errors, which name the instance:
/// BXT_TREE_INDEX, BXT_INVALID_POSE, BXT_INVALID_QUERY, BXT_MESH_TOO_LARGE, BXT_OUT_OF_MEMORY.
BXT_API bxt_status bxt_scene_assemble(const bxt_tree* const* trees, size_t tree_count,
                                      const bxt_placed_tree* instances, size_t instance_count,
                                      const bxt_scene_layer* layers, size_t layer_count,
                                      const bxt_allocator* allocator, bxt_scene** scene,
                                      bxt_error* error);
/// Releases it.
BXT_API void bxt_scene_release(bxt_scene* scene);

/// What is known of an instance.
typedef struct bxt_instance {
  uint32_t struct_size;  ///< sizeof(bxt_instance).
  uint32_t tree;         ///< The number of its tree.
  uint32_t id;           ///< Its number in the source, depth first; assembled: its number.
  uint32_t layer;        ///< The number of its layer.
  bool moves;            ///< Whether bxt_scene_update() may move it.
} bxt_instance;

/// How many instances it has, numbered from 0.
BXT_API uint32_t bxt_scene_instance_count(const bxt_scene* scene);
/// What is known of one. Errors: BXT_INSTANCE_INDEX, BXT_RECORD_INVALID.
BXT_API bxt_status bxt_scene_instance(const bxt_scene* scene, uint32_t number,
                                      bxt_instance* instance, bxt_error* error);
/// Its name; empty when it has none.
BXT_API size_t bxt_scene_instance_name(const bxt_scene* scene, uint32_t number, char* buffer,
                                       size_t capacity);
/// The number of the first instance with that name. Error: BXT_INSTANCE_INDEX.
BXT_API bxt_status bxt_scene_find_instance(const bxt_scene* scene, const char* name,
                                           uint32_t* number, bxt_error* error);
/// Its pose. Errors: as of bxt_scene_instance().
BXT_API bxt_status bxt_scene_pose(const bxt_scene* scene, uint32_t number, bxt_pose* pose,
                                  bxt_error* error);
/// How many trees it has, numbered from 0.
BXT_API uint32_t bxt_scene_tree_count(const bxt_scene* scene);
/// A handle of one of its trees, which must not outlive it. `allocator` may be NULL. Errors:
/// BXT_TREE_INDEX, BXT_OUT_OF_MEMORY.
BXT_API bxt_status bxt_scene_copy_tree(const bxt_scene* scene, uint32_t number,
                                       const bxt_allocator* allocator, bxt_tree** tree,
                                       bxt_error* error);
/// The kinds of queries that it was cooked for; all if it was assembled.
BXT_API uint32_t bxt_scene_query_kinds(const bxt_scene* scene);
/// How many layers it has, numbered from 0.
BXT_API uint32_t bxt_scene_layer_count(const bxt_scene* scene);
/// Name of a layer; empty when it has none.
BXT_API size_t bxt_scene_layer_name(const bxt_scene* scene, uint32_t layer, char* buffer,
                                    size_t capacity);
/// As bxt_tree_material(), ...
BXT_API uint32_t bxt_scene_material(const bxt_scene* scene, const bxt_face* face);
/// How many materials its files have, numbered from 0.
BXT_API uint32_t bxt_scene_material_count(const bxt_scene* scene);
/// Name of a material; empty when it has none.
BXT_API size_t bxt_scene_material_name(const bxt_scene* scene, uint32_t material, char* buffer,
                                       size_t capacity);
/// A triangle of a face that an answer names, in the world; as bxt_tree_triangle().
BXT_API bxt_status bxt_scene_triangle(const bxt_scene* scene, const bxt_face* face, uint32_t half,
                                      bxt_triangle* triangle, bxt_error* error);
/// As bxt_tree_active_edges(); edges at which the surface goes on in another instance are not
/// active.
BXT_API bxt_status bxt_scene_active_edges(const bxt_scene* scene, const bxt_face* face,
                                          uint32_t half, uint32_t* edges, bxt_error* error);

/// Whether queries see an instance. The first call allocates. Errors: BXT_INSTANCE_INDEX,
/// BXT_OUT_OF_MEMORY.
BXT_API bxt_status bxt_scene_set_enabled(bxt_scene* scene, uint32_t instance, bool is_enabled,
                                         bxt_error* error);
/// As last set [true]. False for numbers of no instance.
BXT_API bool bxt_scene_is_enabled(const bxt_scene* scene, uint32_t instance);
/// Keeps a number of the application's for an instance. The first call allocates. Errors: as there.
BXT_API bxt_status bxt_scene_set_user_data(bxt_scene* scene, uint32_t instance, uint64_t data,
                                           bxt_error* error);
/// As last set [0].
BXT_API uint64_t bxt_scene_user_data(const bxt_scene* scene, uint32_t instance);
/// Lets bxt_scene_update() move an instance. Allocates. Errors: BXT_INSTANCE_INDEX,
/// BXT_RECORD_INVALID, BXT_OUT_OF_MEMORY.
BXT_API bxt_status bxt_scene_make_movable(bxt_scene* scene, uint32_t instance, bxt_error* error);
/// Gives a moving instance another pose. Never allocates. Errors: BXT_INSTANCE_INDEX,
/// BXT_INSTANCE_STATIC, BXT_INVALID_POSE; then nothing has changed.
BXT_API bxt_status bxt_scene_update(bxt_scene* scene, uint32_t instance, const bxt_pose* pose,
                                    bxt_error* error);
/// Builds the tree over moving instances anew, for after many of them have gone far. Allocates.
/// Error: BXT_OUT_OF_MEMORY.
BXT_API bxt_status bxt_scene_rebuild(bxt_scene* scene, bxt_error* error);

// Queries: as those of a tree, for the instances of the given layers whose layer answers the kind,
// in coordinates of the world. Errors besides: BXT_PART_LEFT_OUT if the scene was cooked without
// the kind, BXT_RECORD_INVALID on corrupt bytes.

/// As bxt_tree_closest_hit().
BXT_API bxt_status bxt_scene_closest_hit(const bxt_scene* scene, const bxt_ray* ray,
                                         const bxt_face_options* options, bxt_ray_hit* hit,
                                         bxt_error* error);
/// As bxt_tree_any_hit().
BXT_API bxt_status bxt_scene_any_hit(const bxt_scene* scene, const bxt_ray* ray,
                                     const bxt_face_options* options, bxt_ray_hit* hit,
                                     bxt_error* error);
/// As bxt_tree_all_hits(); those of one instance come together.
BXT_API bxt_status bxt_scene_all_hits(const bxt_scene* scene, const bxt_ray* ray,
                                      bxt_ray_visitor visitor, void* context,
                                      const bxt_face_options* options, bxt_error* error);
/// As bxt_tree_nearest_hits().
BXT_API bxt_status bxt_scene_nearest_hits(const bxt_scene* scene, const bxt_ray* ray,
                                          bxt_ray_hit* hits, size_t capacity, size_t* count,
                                          const bxt_face_options* options, bxt_error* error);
/// As bxt_tree_closest_hits(), in the time of one by one.
BXT_API bxt_status bxt_scene_closest_hits(const bxt_scene* scene, const bxt_ray* rays, size_t count,
                                          bxt_ray_hit* hits, bxt_status* statuses,
                                          const bxt_face_options* options, bxt_error* error);
/// The same for bxt_scene_any_hit().
BXT_API bxt_status bxt_scene_any_hits(const bxt_scene* scene, const bxt_ray* rays, size_t count,
                                      bxt_ray_hit* hits, bxt_status* statuses,
                                      const bxt_face_options* options, bxt_error* error);
/// As bxt_tree_overlap_box().
BXT_API bxt_status bxt_scene_overlap_box(const bxt_scene* scene, const bxt_vec3* min,
                                         const bxt_vec3* max, bxt_face_visitor visitor,
                                         void* context, const bxt_limits* limits, bxt_error* error);
/// As bxt_tree_overlap_boxes(), in the time of one by one.
BXT_API bxt_status bxt_scene_overlap_boxes(const bxt_scene* scene, const bxt_vec3* mins,
                                           const bxt_vec3* maxs, size_t count,
                                           bxt_batch_face_visitor visitor, void* context,
                                           const bxt_limits* limits, bxt_status* statuses,
                                           bxt_error* error);
/// As bxt_tree_overlap_spheres(), in the time of one by one.
BXT_API bxt_status bxt_scene_overlap_spheres(const bxt_scene* scene, const bxt_vec3* centers,
                                             const double* radii, size_t count,
                                             bxt_batch_face_visitor visitor, void* context,
                                             const bxt_limits* limits, bxt_status* statuses,
                                             bxt_error* error);
/// As bxt_tree_overlap().
BXT_API bxt_status bxt_scene_overlap(const bxt_scene* scene, const bxt_shape* shape,
                                     bxt_face_visitor visitor, void* context,
                                     const bxt_limits* limits, bxt_error* error);
/// As bxt_tree_overlap_frustum().
BXT_API bxt_status bxt_scene_overlap_frustum(const bxt_scene* scene, const bxt_plane planes[6],
                                             bxt_face_visitor visitor, void* context,
                                             const bxt_limits* limits, bxt_error* error);
/// Receives one instance after the other; returns whether to go on.
typedef bool (*bxt_instance_visitor)(void* context, uint32_t instance);
/// Visits every instance that may touch the frustum, for culling: none is missed.
BXT_API bxt_status bxt_scene_instances_in_frustum(const bxt_scene* scene, const bxt_plane planes[6],
                                                  bxt_instance_visitor visitor, void* context,
                                                  const bxt_limits* limits, bxt_error* error);
/// As bxt_tree_closest_point().
BXT_API bxt_status bxt_scene_closest_point(const bxt_scene* scene, const bxt_vec3* point,
                                           double max_distance, const bxt_limits* limits,
                                           bxt_closest_point* answer, bxt_error* error);
/// As bxt_tree_closest_points(), in the time of one by one.
BXT_API bxt_status bxt_scene_closest_points(const bxt_scene* scene, const bxt_vec3* points,
                                            size_t count, double max_distance,
                                            const bxt_limits* limits, bxt_closest_point* answers,
                                            bxt_status* statuses, bxt_error* error);
/// As bxt_tree_cast_closest().
BXT_API bxt_status bxt_scene_cast_closest(const bxt_scene* scene, const bxt_shape* shape,
                                          const bxt_motion* motion, const bxt_face_options* options,
                                          bxt_cast_hit* hit, bxt_error* error);
/// As bxt_tree_cast_any().
BXT_API bxt_status bxt_scene_cast_any(const bxt_scene* scene, const bxt_shape* shape,
                                      const bxt_motion* motion, const bxt_face_options* options,
                                      bxt_cast_hit* hit, bxt_error* error);
/// As bxt_tree_cast_all().
BXT_API bxt_status bxt_scene_cast_all(const bxt_scene* scene, const bxt_shape* shape,
                                      const bxt_motion* motion, bxt_cast_visitor visitor,
                                      void* context, const bxt_face_options* options,
                                      bxt_error* error);
/// As bxt_tree_collide().
BXT_API bxt_status bxt_scene_collide(const bxt_scene* scene, const bxt_shape* shape,
                                     bxt_contact_visitor visitor, void* context,
                                     const bxt_limits* limits, bxt_error* error);
/// Visits every contact of moving instances with any other, each pair of faces once; the first face
/// is that of the moving one. Pairs whose layers do not collide are not looked at; `layers` of the
/// limits have to be BXT_ALL_LAYERS here and below. Up to 352 KB of stack.
BXT_API bxt_status bxt_scene_contacts(const bxt_scene* scene, bxt_pair_visitor visitor,
                                      void* context, const bxt_limits* limits, bxt_error* error);
/// Those of one instance, moving or not, whose faces are the first.
BXT_API bxt_status bxt_scene_contacts_of(const bxt_scene* scene, uint32_t instance,
                                         bxt_pair_visitor visitor, void* context,
                                         const bxt_limits* limits, bxt_error* error);
/// Visits every pair of a face of the scene and a face of a tree that is no part of it.
BXT_API bxt_status bxt_scene_overlap_pairs(const bxt_scene* scene, const bxt_tree* tree,
                                           const bxt_pose* pose, bxt_pair_visitor visitor,
                                           void* context, const bxt_limits* limits,
                                           bxt_error* error);
/// As bxt_scene_contacts(), with where triangles touch.
BXT_API bxt_status bxt_scene_pair_contacts(const bxt_scene* scene, bxt_pair_contact_visitor visitor,
                                           void* context, const bxt_limits* limits,
                                           bxt_error* error);
/// As bxt_scene_contacts_of(), likewise.
BXT_API bxt_status bxt_scene_pair_contacts_of(const bxt_scene* scene, uint32_t instance,
                                              bxt_pair_contact_visitor visitor, void* context,
                                              const bxt_limits* limits, bxt_error* error);
/// As bxt_scene_overlap_pairs(), likewise.
BXT_API bxt_status bxt_scene_pair_contacts_with(const bxt_scene* scene, const bxt_tree* tree,
                                                const bxt_pose* pose,
                                                bxt_pair_contact_visitor visitor, void* context,
                                                const bxt_limits* limits, bxt_error* error);
/// How far a tree that is no part of the scene is from the nearest instance of these layers (a bit
/// for each, BXT_ALL_LAYERS for all), as bxt_tree_distance() for one; `first` is a face of the
/// scene, `second` one of the tree. Up to 528 KB of stack, here and below.
BXT_API bxt_status bxt_scene_distance(const bxt_scene* scene, const bxt_tree* tree,
                                      const bxt_pose* pose, uint32_t layers,
                                      const bxt_approximation* options, bxt_distance* distance,
                                      bxt_error* error);
/// How far an instance, moving or not, is from the nearest other one whose layer collides with its
/// own; `first` is a face of the instance.
BXT_API bxt_status bxt_scene_distance_of(const bxt_scene* scene, uint32_t instance,
                                         const bxt_approximation* options, bxt_distance* distance,
                                         bxt_error* error);

#ifdef __cplusplus
}  // extern "C"
#endif

#endif  // BOXTREE_C_H
