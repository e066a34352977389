// SPDX-License-Identifier: MIT
// The profile: the requirements of a scene, written by hand as TOML. Every value keeps its line, so
// that decisions can be traced to it. Reference of all keys: docs/PROFILE.md.
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

/// A value and its line in the profile, from 1; line 0 is a default.
template <class T>
struct Stated {
  T value{};
  std::uint32_t line = 0;
};

/// Bodies rest on a surface by a penalty force. The rule limits the error of that surface (rule S3,
/// see largest_surface_error). Units are the world's; defaults are in metres and seconds.
struct ContactRule {
  Stated<double> stiffness;       // force per length
  Stated<double> mass;            // of the lightest body that touches the surface
  Stated<double> gravity{9.81};   // acceleration
  Stated<double> jump{0.001};     // world length; largest jump of a body at rest
  Stated<bool> invisible{false};  // use a tenth of the penetration at rest instead of `jump`
  bool of_object = false;         // stated for the object itself, not in [contact]
};

/// The requirements for the instances of one object; values not stated come from [scene].
struct Needs {
  Stated<QueryKinds> queries{kAllQueries};
  Stated<bool> face_ids{true};
  Stated<bool> materials{true};
  Stated<bool> names{true};
  std::optional<Stated<double>> tolerance;  // world length; never together with exact = true
  Stated<bool> exact{false};
  std::optional<Stated<double>> largest_scale;  // of poses that the program sets
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
  std::vector<Stated<std::uint32_t>> never_collides_with;  // indices into Profile::objects
  Stated<bool> leave_out{false};
  Needs needs;
};

/// Name of the object of all instances without another object; it has the needs of [scene].
inline constexpr std::string_view kOtherObject = "other";

/// Source faces `first` to `last`, inclusive.
struct FaceRange {
  std::uint32_t first;
  std::uint32_t last;
};

/// A mesh that the profile lists, or its settings for a mesh of the source.
struct ProfileMesh {
  Stated<std::string> name;
  std::optional<Stated<std::filesystem::path>> file;  // empty: a mesh of the source
  std::optional<Stated<bool>> external;
  std::optional<Stated<std::uint32_t>> spawned_as;  // object of bodies that the program places
  /// Faces that may be dropped, from a list file: ascending, disjoint.
  std::vector<FaceRange> hidden_faces;
  std::uint32_t hidden_faces_line = 0;
};

/// An instance that the profile places.
struct ProfileInstance {
  std::string name;
  std::uint32_t mesh = 0;                       // index into Profile::meshes
  std::optional<Stated<std::uint32_t>> object;  // stated directly; else by ProfileObject::match
  Pose pose = Pose::Identity();
  std::uint32_t line = 0;  // of its header
};

/// Limits of the file as a whole.
struct SceneBudget {
  std::optional<Stated<std::uint64_t>> bytes;
  std::optional<Stated<double>> bytes_per_triangle;  // nodes and geometry
  std::optional<Stated<double>> slowdown;            // see slowdowns() in choose.h
};

/// The default is a scene without a profile: everything kept, everything static.
struct Profile {
  Profile();

  std::filesystem::path path;  // empty: no profile
  std::vector<std::string> lines;
  /// The profile and all lists it refers to, in order of first read; for build systems.
  std::vector<std::filesystem::path> files_read;

  std::optional<Stated<std::filesystem::path>> source;  // never together with `instances`
  Needs scene;
  std::optional<Stated<double>> active_edges;    // degrees; empty: they are left out
  std::optional<Stated<std::string>> user_data;  // see ImportOptions; empty: it is left out
  SceneBudget budget;
  std::vector<ProfileObject> objects;  // in the order of matching; the last is "other"
  std::vector<ProfileMesh> meshes;
  std::vector<ProfileInstance> instances;

  /// "scene.toml:12: face_ids = false"; "no profile" or "default" for line 0. Without folders,
  /// because it goes into files.
  [[nodiscard]] std::string cite(std::uint32_t line) const;
};

/// Reads a profile. Paths in it are relative to its folder and returned joined with it. Errors:
/// kFileNotFound, kFileUnreadable; kProfileInvalid with the first fault of the file, as
/// "scene.toml:12: tolerance: expected a number above 0, found -1".
Result<Profile> read_profile(const std::filesystem::path& path);

/// Whether a glob matches the whole of `name`: '*' any characters, '?' one. Usually linear, at most
/// the product of both lengths.
[[nodiscard]] bool glob_matches(std::string_view glob, std::string_view name) noexcept;

}  // namespace boxtree::cooker
