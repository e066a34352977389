// SPDX-License-Identifier: MIT
// The profile: what a scene needs, written by hand as TOML. Every value keeps the line that states
// it, so that whatever follows from it can be traced back. Reference of all keys: docs/PROFILE.md.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <boxtree/error.h>
#include <boxtree/query.h>

#include "cooker/choose/choose.h"
#include "format/codec.h"
#include "format/scene_record.h"

namespace boxtree::cooker {

/// A value and the line of the profile that states it, from 1; line 0: nobody does, a default.
template <class T>
struct Stated {
  T value{};
  std::uint32_t line = 0;
};

/// Bodies that rest on a surface by a penalty force: how far that surface may be off (rule S3,
/// see largest_surface_error). Units are the world's; defaults are those of metres and seconds.
struct ContactRule {
  Stated<double> stiffness;       // force a length
  Stated<double> mass;            // of the lightest body that touches the surface
  Stated<double> gravity{9.81};   // acceleration
  Stated<double> jump{0.001};     // world length that a body at rest may be thrown up
  Stated<bool> invisible{false};  // instead of `jump`: a tenth of the penetration at rest
  bool of_object = false;         // stated for the object itself, not in [contact]
};

/// What is required of the instances of one object; each value its own or that of [scene].
struct Needs {
  Stated<QueryKinds> queries{kAllQueries};
  Stated<bool> face_ids{true};
  Stated<bool> materials{true};
  Stated<bool> names{true};
  std::optional<Stated<double>> tolerance;  // world length; never together with exact = true
  Stated<bool> exact{false};
  std::optional<Stated<double>> largest_scale;  // of instances that are placed later
  std::optional<Stated<CodecId>> codec;
  Stated<Goal> goal{Goal::kBalance};
  Stated<bool> external{false};
  std::optional<ContactRule> contact;
};

/// A class of instances; in the file, a layer.
struct ProfileObject {
  Stated<std::string> name;
  std::vector<Stated<std::string>> match;  // globs on names of instances and meshes
  Stated<bool> moves{false};
  std::vector<Stated<std::uint32_t>> never_collides_with;  // numbers in Profile::objects
  Stated<bool> leave_out{false};
  Needs needs;
};

/// Name of the object of all instances that belong to no other; it has the needs of [scene].
inline constexpr std::string_view kOtherObject = "other";

/// Source faces `first` to `last`, both included.
struct FaceRange {
  std::uint32_t first;
  std::uint32_t last;
};

/// A mesh that the profile lists, or what it says of a mesh of the source.
struct ProfileMesh {
  Stated<std::string> name;
  std::optional<Stated<std::filesystem::path>> file;  // nothing: a mesh of the source
  std::optional<Stated<bool>> external;
  std::optional<Stated<std::uint32_t>> spawned_as;  // object whose instances are placed later
  /// Faces that the user allows to be dropped, from a list of their own: ascending, apart.
  std::vector<FaceRange> hidden_faces;
  std::uint32_t hidden_faces_line = 0;
};

/// An instance that the profile places.
struct ProfileInstance {
  std::string name;
  std::uint32_t mesh = 0;                       // in Profile::meshes
  std::optional<Stated<std::uint32_t>> object;  // said outright; else by ProfileObject::match
  Pose pose = Pose::Identity();
  std::uint32_t line = 0;  // of its header
};

/// Limits of the file as a whole.
struct SceneBudget {
  std::optional<Stated<std::uint64_t>> bytes;
  std::optional<Stated<double>> bytes_per_triangle;  // nodes and geometry
  std::optional<Stated<double>> slowdown;            // times the fastest candidate
};

/// By default what a scene without a profile gets: everything kept, everything static.
struct Profile {
  Profile();

  std::filesystem::path path;  // empty: no profile
  std::vector<std::string> lines;
  /// The profile and all lists that it names, in order of first read; for build systems.
  std::vector<std::filesystem::path> files_read;

  std::optional<Stated<std::filesystem::path>> source;  // never together with `instances`
  Needs scene;
  SceneBudget budget;
  std::vector<ProfileObject> objects;  // in the order in which they are tried; the last: "other"
  std::vector<ProfileMesh> meshes;
  std::vector<ProfileInstance> instances;

  /// "scene.toml:12: face_ids = false"; "no profile" or "default" for line 0. Free of folders, as
  /// it goes into files.
  [[nodiscard]] std::string cite(std::uint32_t line) const;
};

/// Reads a profile. Paths in it count from its own folder, and are returned joined with that.
/// Errors: kFileNotFound, kFileUnreadable; kProfileInvalid, of several the one that stands first,
/// as "scene.toml:12: tolerance: expected a number above 0, found -1".
Result<Profile> read_profile(const std::filesystem::path& path);

/// Whether a glob matches the whole of `name`: '*' any characters, '?' one. Linear in practice,
/// never more than the product of both lengths.
[[nodiscard]] bool glob_matches(std::string_view glob, std::string_view name) noexcept;

}  // namespace boxtree::cooker
