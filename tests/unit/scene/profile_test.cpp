// SPDX-License-Identifier: MIT
// Profiles as texts: what they say, with the lines that say it, and every way to say it wrong.
#include <algorithm>
#include <cstdlib>
#include <random>
#include <tests/unit/scene/profile_files.h>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "cooker/scene/profile_pose.h"

namespace boxtree::cooker {
namespace {

template <class T>
::testing::AssertionResult says(const Stated<T>& stated, const T& value, std::uint32_t line) {
  if (stated.value == value && stated.line == line) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure()
         << ::testing::PrintToString(stated.value) << " in line " << stated.line;
}
template <class T>
::testing::AssertionResult says(const std::optional<Stated<T>>& stated, const T& value,
                                std::uint32_t line) {
  if (!stated) return ::testing::AssertionFailure() << "not stated";
  return says(*stated, value, line);
}

TEST_F(ProfileTest, DefaultsKeepEverything) {
  for (const Profile& profile : {Profile(), load("")}) {
    ASSERT_EQ(profile.objects.size(), 1u);
    const ProfileObject& other = profile.objects[0];
    EXPECT_TRUE(says(other.name, std::string("other"), 0));
    EXPECT_FALSE(other.moves.value || other.leave_out.value);
    EXPECT_TRUE(says(other.needs.queries, kAllQueries, 0));
    EXPECT_TRUE(other.needs.face_ids.value && other.needs.materials.value);
    EXPECT_TRUE(other.needs.names.value);
    EXPECT_FALSE(other.needs.exact.value || other.needs.external.value);
    EXPECT_FALSE(other.needs.tolerance || other.needs.codec || other.needs.contact);
    EXPECT_EQ(other.needs.goal.value, Goal::kBalance);
    EXPECT_TRUE(profile.meshes.empty() && profile.instances.empty() && !profile.source);
  }
}

TEST_F(ProfileTest, SceneAndBudget) {
  const Profile profile = load(R"([scene]
source = "level.gltf"
queries = [
  "ray",
  "point" ]
face_ids = false
materials = false
names = false
tolerance = 0.001
for = "memory"
codec = "wide4"
largest_scale = 2
external = true
[budget]
bytes = 200_000
bytes_per_triangle = 8
slowdown = 1.5
)");
  ASSERT_TRUE(profile.source);
  EXPECT_TRUE(says(profile.source, folder_ / "level.gltf", 2));
  const Needs& needs = profile.scene;
  EXPECT_TRUE(says(needs.queries, static_cast<QueryKinds>(kRayQueries | kPointQueries), 3));
  EXPECT_TRUE(says(needs.face_ids, false, 6));
  EXPECT_TRUE(says(needs.materials, false, 7));
  EXPECT_TRUE(says(needs.names, false, 8));
  EXPECT_TRUE(says(needs.tolerance, 0.001, 9));
  EXPECT_TRUE(says(needs.goal, Goal::kMemory, 10));
  EXPECT_TRUE(says(needs.codec, CodecId::kWide4, 11));
  EXPECT_TRUE(says(needs.largest_scale, 2.0, 12));
  EXPECT_TRUE(says(needs.external, true, 13));
  EXPECT_TRUE(says(profile.budget.bytes, std::uint64_t{200000}, 15));
  EXPECT_TRUE(says(profile.budget.bytes_per_triangle, 8.0, 16));
  EXPECT_TRUE(says(profile.budget.slowdown, 1.5, 17));
  EXPECT_EQ(profile.cite(8), "scene.toml:8: names = false");
  EXPECT_EQ(profile.cite(5), "scene.toml:5: \"point\" ]");
  EXPECT_EQ(profile.cite(0), "default");
  EXPECT_EQ(Profile().cite(0), "no profile");
  EXPECT_EQ(profile.files_read, std::vector{folder_ / "scene.toml"});
}

TEST_F(ProfileTest, ObjectsTakeFromTheSceneWhatTheyDoNotSay) {
  const Profile profile = load(R"([scene]
tolerance = 0.01
face_ids = false
[[object]]
name = "scenery"
match = ["Tree*", "Rock?"]
codec = "wide4"
never_collides_with = ["hero", "other", "scenery"]
[[object]]
name = "hero"
motion = "moving"
exact = true
face_ids = true
[[object]]
name = "decals"
motion = "static"
leave_out = true
tolerance = 1
[[object]]
name = "free"
exact = false
)");
  ASSERT_EQ(profile.objects.size(), 5u);
  const ProfileObject& scenery = profile.objects[0];
  EXPECT_TRUE(says(scenery.name, std::string("scenery"), 5));
  ASSERT_EQ(scenery.match.size(), 2u);
  EXPECT_TRUE(says(scenery.match[1], std::string("Rock?"), 6));
  EXPECT_TRUE(says(scenery.needs.codec, CodecId::kWide4, 7));
  EXPECT_TRUE(says(scenery.needs.tolerance, 0.01, 2));
  EXPECT_TRUE(says(scenery.needs.face_ids, false, 3));
  ASSERT_EQ(scenery.never_collides_with.size(), 3u);
  EXPECT_TRUE(says(scenery.never_collides_with[0], 1u, 8));
  EXPECT_EQ(scenery.never_collides_with[1].value, 4u);
  EXPECT_EQ(scenery.never_collides_with[2].value, 0u);
  const ProfileObject& hero = profile.objects[1];
  EXPECT_TRUE(says(hero.moves, true, 11));
  EXPECT_TRUE(says(hero.needs.exact, true, 12));
  EXPECT_FALSE(hero.needs.tolerance) << "exact replaces the tolerance of the scene";
  EXPECT_TRUE(says(hero.needs.face_ids, true, 13));
  EXPECT_FALSE(hero.needs.codec);
  EXPECT_TRUE(says(profile.objects[2].leave_out, true, 17));
  EXPECT_TRUE(says(profile.objects[2].moves, false, 16));
  EXPECT_TRUE(says(profile.objects[2].needs.tolerance, 1.0, 18));
  EXPECT_TRUE(says(profile.objects[3].needs.tolerance, 0.01, 2));
  EXPECT_EQ(profile.objects[4].name.value, "other");
  EXPECT_TRUE(says(profile.objects[4].needs.tolerance, 0.01, 2));
}

TEST_F(ProfileTest, ToleranceReplacesExactOfTheScene) {
  const Profile profile = load(R"([scene]
exact = true
[[object]]
name = "far"
tolerance = 0.1
)");
  EXPECT_TRUE(says(profile.objects[0].needs.exact, false, 5));
  EXPECT_TRUE(says(profile.objects[0].needs.tolerance, 0.1, 5));
  EXPECT_TRUE(says(profile.objects[1].needs.exact, true, 2));
}

TEST_F(ProfileTest, Contact) {
  const Profile profile = load(R"([contact]
stiffness = 1e6
mass = 1
gravity = 1.62
[[object]]
name = "same"
[[object]]
name = "heavy"
mass = 80
[[object]]
name = "calm"
invisible = true
[[object]]
name = "jumpy"
jump = 0.5
)");
  ASSERT_TRUE(profile.scene.contact);
  EXPECT_TRUE(says(profile.scene.contact->stiffness, 1e6, 2));
  EXPECT_TRUE(says(profile.scene.contact->jump, 0.001, 0));
  EXPECT_FALSE(profile.objects[0].needs.contact->of_object);
  const ContactRule& heavy = *profile.objects[1].needs.contact;
  EXPECT_TRUE(heavy.of_object);
  EXPECT_TRUE(says(heavy.mass, 80.0, 9));
  EXPECT_TRUE(says(heavy.stiffness, 1e6, 2));
  EXPECT_TRUE(says(heavy.gravity, 1.62, 4));
  EXPECT_TRUE(says(profile.objects[2].needs.contact->invisible, true, 12));
  EXPECT_TRUE(says(profile.objects[3].needs.contact->jump, 0.5, 15));
  const Profile alone = load("[[object]]\nname = 'a'\nstiffness = 10\nmass = 2\n");
  ASSERT_TRUE(alone.objects[0].needs.contact);
  EXPECT_TRUE(says(alone.objects[0].needs.contact->gravity, 9.81, 0));
  EXPECT_FALSE(alone.objects[1].needs.contact);
}

TEST_F(ProfileTest, JumpReplacesInvisibleOfTheScene) {
  const Profile profile = load(R"([contact]
stiffness = 1e6
mass = 1
invisible = true
[[object]]
name = "jumpy"
jump = 0.5
)");
  EXPECT_TRUE(says(profile.objects[0].needs.contact->invisible, false, 7));
  EXPECT_TRUE(says(profile.objects[1].needs.contact->invisible, true, 4));
}

TEST_F(ProfileTest, MeshesAndInstances) {
  write("cellar.txt", "3-5\n9\n");
  const Profile profile = load(R"([[mesh]]
name = "crate"
file = "meshes/crate.obj"
external = true
spawned_as = "loose"
[[mesh]]
name = "house"
file = "house.obj"
hidden_faces = "cellar.txt"
[[object]]
name = "loose"
motion = "moving"
[[instance]]
mesh = "house"
[[instance]]
mesh = "crate"
name = "on the roof"
object = "loose"
translation = [1, 2.5, -3]
scale = [1, -2, 3]
[[instance]]
mesh = "crate"
object = "other"
matrix = [2, 0, 0, 10,  0, 3, 1, 20,  0, 0, 4, 30]
)");
  ASSERT_EQ(profile.meshes.size(), 2u);
  EXPECT_TRUE(says(profile.meshes[0].file, folder_ / "meshes/crate.obj", 3));
  EXPECT_TRUE(says(profile.meshes[0].external, true, 4));
  EXPECT_TRUE(says(profile.meshes[0].spawned_as, 0u, 5));
  EXPECT_EQ(profile.meshes[1].hidden_faces_line, 9u);
  ASSERT_EQ(profile.meshes[1].hidden_faces.size(), 2u);
  EXPECT_EQ(profile.meshes[1].hidden_faces[0].last, 5u);
  EXPECT_EQ(profile.files_read, (std::vector{folder_ / "scene.toml", folder_ / "cellar.txt"}));
  ASSERT_EQ(profile.instances.size(), 3u);
  EXPECT_EQ(profile.instances[0].name, "house");
  EXPECT_EQ(profile.instances[0].mesh, 1u);
  EXPECT_EQ(profile.instances[0].line, 13u);
  EXPECT_FALSE(profile.instances[0].object);
  EXPECT_EQ(profile.instances[0].pose.matrix(), Pose::Identity().matrix());
  EXPECT_EQ(profile.instances[1].name, "on the roof");
  EXPECT_TRUE(says(profile.instances[1].object, 0u, 18));
  EXPECT_EQ(profile.instances[1].pose * Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(2, 0.5, 0));
  EXPECT_TRUE(says(profile.instances[2].object, 1u, 23));
  EXPECT_EQ(profile.instances[2].pose * Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(12, 24, 34));
}

TEST(GlobMatches, StarsAndQuestionMarks) {
  EXPECT_TRUE(glob_matches("", ""));
  EXPECT_FALSE(glob_matches("", "a"));
  EXPECT_TRUE(glob_matches("*", ""));
  EXPECT_TRUE(glob_matches("Tree*", "Tree"));
  EXPECT_TRUE(glob_matches("Tree*", "Tree_07"));
  EXPECT_FALSE(glob_matches("Tree*", "tree_07"));
  EXPECT_FALSE(glob_matches("Tree", "Trees"));
  EXPECT_TRUE(glob_matches("Rock?", "Rock7"));
  EXPECT_FALSE(glob_matches("Rock?", "Rock"));
  EXPECT_TRUE(glob_matches("*a*b", "aaacab"));
  EXPECT_FALSE(glob_matches("*a*b", "aaacabc"));
  EXPECT_TRUE(glob_matches("a*?c", "abbc"));
  EXPECT_TRUE(glob_matches("*.col", "wall*.col"));
}

class ProfileFaultTest : public ProfileTest, public ::testing::WithParamInterface<ProfileFault> {};

TEST_P(ProfileFaultTest, NamesLineAndWhatWouldBeRight) {
  EXPECT_EQ(fault(GetParam().text), GetParam().message) << GetParam().text;
}

constexpr ProfileFault kTypes[] = {
    {"[scene]\nface_ids = 1\n", "scene.toml:2: face_ids: expected true or false, found 1"},
    {"[scene]\n\nnames = 'no'\n", "scene.toml:3: names: expected true or false, found \"no\""},
    {"[scene]\ntolerance = 'fine'\n",
     "scene.toml:2: tolerance: expected a number above 0, found \"fine\""},
    {"[scene]\nqueries = 'ray'\n",
     "scene.toml:2: queries: expected an array of texts, found \"ray\""},
    {"[scene]\nqueries = ['ray',\n 7]\n",
     "scene.toml:3: queries: expected texts that are not empty, found 7"},
    {"[scene]\nsource = ''\n",
     "scene.toml:2: source: expected a text that is not empty, found \"\""},
    // Found by an audit: names of files were cut at a NUL.
    {"[scene]\nsource = \"a\\u0000b.obj\"\n",
     "scene.toml:2: source: expected a text without NUL characters, found one at byte 2"},
    {"[scene]\nsource = 1979-05-27\n",
     "scene.toml:2: source: expected a text that is not empty, found a date or time"},
    {"scene = 3\n", "scene.toml:1: scene: expected a table [scene], found 3"},
    {"[object]\nname = 'a'\n",
     "scene.toml:1: object: expected [[object]] in double brackets, since there may be several, "
     "found [object]"},
    {"[object]\nname = 'a'\n[object]\nname = 'b'\n",
     "scene.toml:3: Error while parsing table header: cannot redefine existing table 'object'; "
     "expected [[object]] in double brackets, since there may be several"},
    {"[scene]\nexact = true\n[scene]\nqueries = ['ray']\n",
     "scene.toml:3: Error while parsing table header: cannot redefine existing table 'scene'"},
    {"[[scene]]\nexact = true\n",
     "scene.toml:1: scene: expected one table, [scene] in single brackets, found [[scene]]"},
    {"scene = []\n", "scene.toml:1: scene: expected a table [scene], found an array of 0"},
    {"mesh = [1]\n", "scene.toml:1: mesh: expected tables [[mesh]], found 1"},
    {"[budget]\nbytes = 1.5\n",
     "scene.toml:2: bytes: expected a whole number of 1 or more, found 1.5"},
    {"[[object]]\nname = 'a'\nmatch = [[]]\n",
     "scene.toml:3: match: expected texts that are not empty, found an array of 0"},
};
INSTANTIATE_TEST_SUITE_P(Types, ProfileFaultTest, ::testing::ValuesIn(kTypes));

constexpr ProfileFault kRanges[] = {
    {"[scene]\ntolerance = 0\n", "scene.toml:2: tolerance: expected a number above 0, found 0"},
    {"[scene]\ntolerance = -0.5\n",
     "scene.toml:2: tolerance: expected a number above 0, found -0.5"},
    {"[scene]\ntolerance = inf\n", "scene.toml:2: tolerance: expected a number above 0, found inf"},
    {"[scene]\ntolerance = nan\n", "scene.toml:2: tolerance: expected a number above 0, found nan"},
    {"[scene]\nactive_edges = 91\n",
     "scene.toml:2: active_edges: expected degrees from 0 to 90, found 91"},
    {"[scene]\nuser_data = 3\n",
     "scene.toml:2: user_data: expected a text that is not empty, found 3"},
    {"[scene]\nactive_edges = true\n",
     "scene.toml:2: active_edges: expected degrees from 0 to 90, found true"},
    {"[scene]\nlargest_scale = -1\n",
     "scene.toml:2: largest_scale: expected a number above 0, found -1"},
    {"[scene]\nqueries = []\n", "scene.toml:2: queries: expected at least one kind, found none"},
    {"[budget]\nbytes = 0\n", "scene.toml:2: bytes: expected a whole number of 1 or more, found 0"},
    {"[budget]\nbytes_per_triangle = 0\n",
     "scene.toml:2: bytes_per_triangle: expected a number above 0, found 0"},
    {"[budget]\nslowdown = 0\n", "scene.toml:2: slowdown: expected a number above 0, found 0"},
    {"[contact]\nstiffness = 0\nmass = 1\n",
     "scene.toml:2: stiffness: expected a number above 0, found 0"},
    {"[contact]\nstiffness = 1\nmass = 1\ngravity = -9.81\n",
     "scene.toml:4: gravity: expected a number above 0, found -9.81"},
    {"[contact]\nstiffness = 1\nmass = 1\njump = 0\n",
     "scene.toml:4: jump: expected a number above 0, found 0"},
    {"[[object]]\nname = 'a'\nstiffness = -1\nmass = 1\n",
     "scene.toml:3: stiffness: expected a number above 0, found -1"},
};
INSTANTIATE_TEST_SUITE_P(Ranges, ProfileFaultTest, ::testing::ValuesIn(kRanges));

constexpr ProfileFault kNames[] = {
    {"[scene]\ntolerence = 1\n",
     "scene.toml:2: [scene]: expected a known key (nearest: \"tolerance\"), found \"tolerence\""},
    {"[[object]]\nname = 'a'\ncodecs = 9\n",
     "scene.toml:3: [[object]]: expected a known key (nearest: \"codec\"), found \"codecs\""},
    {"[scene]\n[scenes]\n",
     "scene.toml:2: the profile: expected a known key (nearest: \"scene\"), found \"scenes\""},
    {"[level]\n",
     "scene.toml:1: the profile: expected a known key (scene, budget, contact, mesh, object or "
     "instance), found \"level\""},
    {"queries = ['ray']\n[budget]\nbytes = 1\n",
     "scene.toml:1: queries: expected it below [scene] or [[object]], found it outside of all "
     "tables"},
    {"match = ['a']\n",
     "scene.toml:1: match: expected it below [[object]], found it outside of all tables"},
    {"matches = ['a']\n",
     "scene.toml:1: matches: expected it below a table: [scene], [budget], [contact], [[object]], "
     "[[mesh]] or [[instance]], found it outside of all tables"},
    {"[scene]\nmotion = 'moving'\n",
     "scene.toml:2: [scene]: expected a key of this table, found \"motion\", a key of [[object]]"},
    {"[scene]\nmesh = 'a'\n",
     "scene.toml:2: [scene]: expected a key of this table, found \"mesh\", a key of [[instance]]"},
    {"[budget]\nexternal = true\n",
     "scene.toml:2: [budget]: expected a key of this table, found \"external\", a key of [scene], "
     "[[object]] or [[mesh]]"},
    {"[[object]]\nname = 'a'\ndegrees = 30\n",
     "scene.toml:3: [[object]]: expected a key of this table, found \"degrees\", a key of "
     "[[instance]]"},
    {"[[scen]]\nexact = true\n",
     "scene.toml:1: the profile: expected a known key (nearest: \"scene\"), found \"scen\""},
    {"[budget]\nbyte = 1\n",
     "scene.toml:2: [budget]: expected a known key (nearest: \"bytes\"), found \"byte\""},
    {"[contact]\nstiffness = 1\nmass = 1\nmas = 1\n",
     "scene.toml:4: [contact]: expected a known key (nearest: \"mass\"), found \"mas\""},
    {"[[object]]\nname = 'a'\nmove = true\n",
     "scene.toml:3: [[object]]: expected a known key (nearest: \"motion\"), found \"move\""},
    {"[[object]]\nname = 'a'\nbouncy = true\n",
     "scene.toml:3: [[object]]: expected a known key (name, match, motion, never_collides_with, "
     "leave_out, queries, face_ids, materials, names, tolerance, exact, largest_scale, codec, for, "
     "external, stiffness, mass, gravity, jump or invisible), found \"bouncy\""},
    // Found by a newcomer: the nearest name was one of another meaning, or of the opposite one.
    {"[[object]]\nname = 'a'\nexclude = true\n",
     "scene.toml:3: [[object]]: expected a known key (nearest: \"leave_out\"), found \"exclude\""},
    {"[[object]]\nname = 'a'\nmotion = 'dynamic'\n",
     "scene.toml:3: motion: expected static or moving (nearest: \"moving\"), found \"dynamic\""},
    {"[[object]]\nname = 'a'\nmotion = 'resting'\n",
     "scene.toml:3: motion: expected static or moving, found \"resting\""},
    {"[[mesh]]\nname = 'a'\npath = 'a.obj'\n",
     "scene.toml:3: [[mesh]]: expected a known key (nearest: \"file\"), found \"path\""},
    {"[[mesh]]\nname='m'\nfile='m'\n[[instance]]\nmesh='m'\nposition=[0,0,1]\n",
     "scene.toml:6: [[instance]]: expected a known key (nearest: \"translation\"), found "
     "\"position\""},
    {"[[mesh]]\nname='m'\nfile='m'\n[[instance]]\nmesh='m'\nquaternion=[0,0,0,1]\n",
     "scene.toml:6: [[instance]]: expected a known key (nearest: \"rotation\"), found "
     "\"quaternion\""},
    {"[[mesh]]\nname = 'a'\nflie = 'a.obj'\n",
     "scene.toml:3: [[mesh]]: expected a known key (nearest: \"file\"), found \"flie\""},
    {"[[mesh]]\nname='m'\nfile='m'\n[[instance]]\nmesh='m'\nscales=1\n",
     "scene.toml:6: [[instance]]: expected a known key (nearest: \"scale\"), found \"scales\""},
    {"[[mesh]]\nname='m'\nfile='m'\n[[instance]]\nmesh='m'\naxis=[0,0,1]\ndegree=30\n",
     "scene.toml:7: [[instance]]: expected a known key (nearest: \"degrees\"), found \"degree\""},
    {"[[mesh]]\nname='m'\nfile='m'\n[[instance]]\nmesh='m'\naxes=[0,0,1]\ndegrees=30\n",
     "scene.toml:6: [[instance]]: expected a known key (nearest: \"axis\"), found \"axes\""},
    {"[scene]\nqueries = ['rays']\n",
     "scene.toml:2: queries: expected ray, box, point or pair (nearest: \"ray\"), found \"rays\""},
    {"[scene]\ncodec = 'wide16'\n",
     "scene.toml:2: codec: expected the name of a codec (nearest: \"wide8\"), found \"wide16\""},
    {"[scene]\nfor = 'size'\n",
     "scene.toml:2: for: expected memory, speed or balance (nearest: \"memory\"), found \"size\""},
    {"[[object]]\nname = 'a'\nmotion = 'moves'\n",
     "scene.toml:3: motion: expected static or moving (nearest: \"moving\"), found \"moves\""},
    {"[[object]]\nname = 'hero'\nnever_collides_with = ['other',\n'hreo']\n",
     "scene.toml:4: never_collides_with: expected the name of an object (nearest: \"hero\"), found "
     "\"hreo\""},
    {"[[mesh]]\nname='crate'\nfile='m'\n[[instance]]\nmesh='crates'\n",
     "scene.toml:5: mesh: expected the name of a [[mesh]] (nearest: \"crate\"), found "
     "\"crates\""},
    {"[[instance]]\nmesh='crate'\n",
     "scene.toml:2: mesh: expected the name of a [[mesh]] (there are none), found \"crate\""},
    {"[[mesh]]\nname='m'\nfile='m'\n[[instance]]\nmesh='m'\nobject='hero'\n",
     "scene.toml:6: object: expected the name of an object (other), found \"hero\""},
    {"[[mesh]]\nname='m'\nspawned_as = 'x'\n",
     "scene.toml:3: spawned_as: expected the name of an object (other), found \"x\""},
};
INSTANTIATE_TEST_SUITE_P(Names, ProfileFaultTest, ::testing::ValuesIn(kNames));

constexpr ProfileFault kContradictions[] = {
    {"[scene]\nexact = true\ntolerance = 1\n",
     "scene.toml:3: tolerance: expected either \"tolerance\" or \"exact\", found both"},
    {"[[object]]\nname = \"a\"\nexternal = true\nface_ids = false\n",
     "scene.toml:4: face_ids: expected true, since with external = true they lead into the "
     "application's arrays, found false"},
    {"[contact]\nstiffness = 1\nmass = 1\njump = 1\ninvisible = true\n",
     "scene.toml:5: invisible: expected either \"jump\" or \"invisible\", found both"},
    {"[contact]\nstiffness = 1\n",
     "scene.toml:1: [contact]: expected the keys \"stiffness\" and \"mass\", found no \"mass\""},
    {"[[object]]\nname = 'a'\nmass = 1\n",
     "scene.toml:3: contact: expected the key \"stiffness\" as well, found none"},
    {"[scene]\nqueries = ['ray']\n[[object]]\nname = 'a'\nqueries = ['ray', 'box']\n",
     "scene.toml:5: queries: expected only kinds that [scene] states in line 2, found more"},
    {"[[object]]\nname = 'a'\n[[object]]\nname = 'b'\n[[object]]\nname = 'a'\n",
     "scene.toml:6: name: expected a name of its own, found \"a\", as in line 2"},
    {"[[mesh]]\nname = 'a'\n[[mesh]]\nname = 'a'\n",
     "scene.toml:4: name: expected a name of its own, found \"a\", as in line 2"},
    {"[[object]]\nname = 'other'\n",
     "scene.toml:2: name: expected another name: \"other\" is what is left over, found "
     "\"other\""},
    {"\n[[object]]\nmotion = 'moving'\n",
     "scene.toml:2: [[object]]: expected the key \"name\", found none"},
    {"[[mesh]]\nfile = 'a.obj'\n", "scene.toml:1: [[mesh]]: expected the key \"name\", found none"},
    {"[[mesh]]\nfile = 'a.obj'\nnmae = 'a'\n",
     "scene.toml:1: [[mesh]]: expected the key \"name\", found \"nmae\" in line 3"},
    {"[[instance]]\n", "scene.toml:1: [[instance]]: expected the key \"mesh\", found none"},
    {"[scene]\nsource = 'a.gltf'\n[[mesh]]\nname = 'm'\nfile = 'm.obj'\n",
     "scene.toml:5: file: expected no file, as [scene] states a source, found one"},
    {"[scene]\nsource = 'a.gltf'\n[[mesh]]\nname = 'm'\n[[instance]]\nmesh = 'm'\n",
     "scene.toml:5: [[instance]]: expected no instances, as [scene] states a source, found one"},
    {"[[mesh]]\nname = 'm'\n[[instance]]\nmesh = 'm'\n",
     "scene.toml:4: mesh: expected a mesh that states a file, found \"m\""},
    {"[[object]]\nname = 'a'\nleave_out = true\n[[mesh]]\nname = 'm'\nspawned_as = 'a'\n",
     "scene.toml:6: spawned_as: expected an object that is kept, found \"a\", which line 3 "
     "leaves out"},
};
INSTANTIATE_TEST_SUITE_P(Contradictions, ProfileFaultTest, ::testing::ValuesIn(kContradictions));

constexpr ProfileFault kToml[] = {
    {"[scene]\nnames = true\nnames = false\n", "scene.toml:3: "},
    {"[scene]\n\nnames = \n", "scene.toml:3: "},
    {"\xff", "scene.toml:1: "},
    {"[scene]\nnames = no\n",
     "scene.toml:2: Error while parsing floating-point: expected 'nan', saw 'no'; a text stands in "
     "quotes, and a flag is true or fals"},
};
class TomlFaultTest : public ProfileTest, public ::testing::WithParamInterface<ProfileFault> {};
TEST_P(TomlFaultTest, NamesTheLine) {
  const std::string message = fault(GetParam().text);
  EXPECT_EQ(message.rfind(GetParam().message, 0), 0u) << message;
  EXPECT_GT(message.size(), std::string(GetParam().message).size());
}
INSTANTIATE_TEST_SUITE_P(Toml, TomlFaultTest, ::testing::ValuesIn(kToml));

TEST_F(ProfileTest, TheFirstOfSeveralFaultsIsTold) {
  EXPECT_EQ(fault("[[object]]\nname = 'a'\nmotion = 1\n[scene]\nnames = 1\n"),
            "scene.toml:3: motion: expected a text that is not empty, found 1");
}

TEST_F(ProfileTest, AtMost31Objects) {
  std::string text;
  for (int k = 0; k < 31; ++k) text += "[[object]]\nname = 'o" + std::to_string(k) + "'\n";
  EXPECT_EQ(load(text).objects.size(), std::size_t{kMaxLayers});
  EXPECT_EQ(fault(text + "[[object]]\nname = 'more'\n"),
            "scene.toml:63: [[object]]: expected at most 31 objects, found 32");
}

TEST_F(ProfileTest, NamesAreNotLongerThanRecordsHold) {
  const std::string name(65536, 'n');
  EXPECT_EQ(fault("[[mesh]]\nname = '" + name + "'\n"),
            "scene.toml:2: name: expected at most 65535 bytes, found 65536");
}

TEST_F(ProfileTest, FaultsOfLists) {
  write("list.txt", "1\nx\n");
  EXPECT_EQ(fault("[[mesh]]\nname = 'm'\nhidden_faces = 'list.txt'\n"),
            "scene.toml:3: hidden_faces: list.txt:2: expected the number of a face, or a range as "
            "12-40, found \"x\"");
}

// Found by a newcomer: a list that another job had yet to write was a fault of the profile, so that
// a farm gave up.
TEST_F(ProfileTest, AListThatIsNotThereMayBeLater) {
  write("scene.toml", "[[mesh]]\nname = 'm'\nhidden_faces = 'none.txt'\n");
  const Result<Profile> read = read_profile(folder_ / "scene.toml");
  EXPECT_EQ(read.code(), Errc::kFileNotFound);
  EXPECT_EQ(read.error().detail, (folder_ / "scene.toml").string() + ":3: hidden_faces: " +
                                     (folder_ / "none.txt").string() + ": no such file; names in " +
                                     (folder_ / "scene.toml").string() +
                                     " are relative to its folder");
}

TEST_F(ProfileTest, FilesThatCannotBeRead) {
  EXPECT_EQ(read_profile(folder_ / "none.toml").code(), Errc::kFileNotFound);
  EXPECT_EQ(read_profile(folder_).code(), Errc::kFileUnreadable);
}

// Bytes changed, left out and doubled: read or refused with a line, whatever comes.
TEST_F(ProfileTest, MutatedProfilesAreReadOrRefused) {
  const std::string whole = R"([scene]
queries = ["ray", "pair"]
tolerance = 1e-3
[contact]
stiffness = 1e6
mass = 1.5
[[mesh]]
name = "crate"
file = "crate.obj"
[[object]]
name = "loose"
match = ["Crate*"]
motion = "moving"
never_collides_with = ["other"]
[[instance]]
mesh = "crate"
axis = [0, 0, 1]
degrees = 30.5
)";
  std::mt19937_64 random(11);
  int read = 0, refused = 0;
  for (int round = 0; round < 1000; ++round) {
    std::string text = whole;
    for (auto changes = random() % 2 + 1; changes > 0; --changes) {
      const std::size_t at = random() % text.size();
      switch (random() % 3) {
        case 0:
          text[at] = static_cast<char>(random());
          break;
        case 1:
          text.erase(at, random() % 8);
          break;
        default:
          text.insert(at, text.substr(random() % text.size(), random() % 30));
      }
    }
    const Result<Profile> profile = read_profile(write("scene.toml", text));
    if (profile) {
      ++read;
      EXPECT_EQ(profile->objects.back().name.value, "other");
      for (const ProfileInstance& instance : profile->instances) {
        ASSERT_LT(instance.mesh, profile->meshes.size());
        ASSERT_TRUE(is_invertible(instance.pose.linear()));
      }
      continue;
    }
    ++refused;
    ASSERT_EQ(profile.code(), Errc::kProfileInvalid);
    const std::string message = without_folder(profile.error().detail);
    ASSERT_EQ(message.rfind("scene.toml:", 0), 0u) << message;
    const int line = std::atoi(message.c_str() + 11);
    ASSERT_GE(line, 1) << message;
    ASSERT_LE(line, std::count(text.begin(), text.end(), '\n') + 1) << message;
  }
  EXPECT_GT(read, 30);
  EXPECT_GT(refused, 300);
}

TEST_F(ProfileTest, DeepNestingIsRefused) {
  std::string text = "a = ";
  text.append(100000, '[');
  EXPECT_EQ(fault(text).rfind("scene.toml:1: ", 0), 0u);
}

}  // namespace
}  // namespace boxtree::cooker
