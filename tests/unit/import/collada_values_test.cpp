// SPDX-License-Identifier: MIT
// What decides geometry in a Collada document and that assimp reads past, or takes for something
// else: each is refused by its place.
#include "cooker/import/collada_values.h"

#include <string>
#include <string_view>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "cooker/import/node_nesting.h"
#include "temp_files.h"

namespace boxtree::cooker {
namespace {

constexpr std::string_view kTriangles = R"(<triangles count="3"><input semantic="VERTEX")"
                                        R"( source="#v" offset="0"/><p>0 1 2 1 3 2 1 4 3</p>)"
                                        "</triangles>";
constexpr std::string_view kArray = R"(<float_array id="a" count="15">)"
                                    "0 0 0 1 0 0 0 1 0 1 1 0 2 1 0</float_array>";
constexpr std::string_view kAccessor = R"(<accessor source="#a" count="5" stride="3">)";
constexpr std::string_view kPlaced = R"(<instance_geometry url="#g"/>)";

// Three triangles of five vertices, as lines of which messages name one.
std::string document() {
  return fmt::format(
      R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<library_geometries><geometry id="g"><mesh><source id="p">
{}<technique_common>
{}<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor>
</technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
{}
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s">
<node id="n">{}</node>
</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>
)",
      kArray, kAccessor, kTriangles, kPlaced);
}

// The document with `to` in the place of `from`.
std::string with(std::string_view from, std::string_view to) {
  std::string text = document();
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

std::string fault_of(const std::string& text, Errc code = Errc::kImportFailed) {
  const Status status = check_collada(text);
  if (status.ok()) return "";
  EXPECT_EQ(status.error().code, code);
  return status.error().detail;
}
std::string fault(std::string_view from, std::string_view to, Errc code = Errc::kImportFailed) {
  return fault_of(with(from, to), code);
}

std::string primitive(const char* name, const char* count, std::string_view rest) {
  return fmt::format(R"(<{} count="{}"><input semantic="VERTEX" source="#v"/>{}</{}>)", name, count,
                     rest, name);
}
std::string fault_of_primitive(const char* name, const char* count, std::string_view rest) {
  return fault(kTriangles, primitive(name, count, rest));
}

TEST(ColladaValues, WhatExportersWriteIsPassed) {
  EXPECT_EQ(fault_of(document()), "");
  EXPECT_EQ(fault(kTriangles, ""), "");
  EXPECT_EQ(fault("2 1 0<", "2,0 +1. .5e0 <"), "");  // FCollada's commas
  EXPECT_EQ(fault_of_primitive("triangles", "0", "<p/>"), "");
  EXPECT_EQ(fault_of_primitive("triangles", "0", ""), "");
  EXPECT_EQ(fault_of_primitive("polylist", "0", "<vcount/><p/>"), "");
  EXPECT_EQ(fault_of_primitive("polylist", "3", "<vcount>3 0 4</vcount><p>0 1 2 0 1 3 2</p>"), "");
  EXPECT_EQ(fault_of_primitive("polygons", "2", "<p>0 1 2</p><p>0 1 3 2</p>"), "");
  EXPECT_EQ(fault_of_primitive("tristrips", "2", "<p>0 1 2 3</p>"), "");
  EXPECT_EQ(fault_of_primitive("trifans", "1", "<p>0 1 2</p>"), "");
  EXPECT_EQ(fault_of_primitive("lines", "9", "<p>0 1 2 3</p>"), "");  // SketchUp's count
  EXPECT_EQ(fault(kPlaced,
                  "<rotate>0 0 0 0</rotate><matrix>1 0 0 5 0 1 0 6 0 0 1 7 0 0 0 1"
                  "</matrix><translate>1 2 3</translate><scale>1 1 1</scale>"),
            "");
  for (const char* text : {"<a/>", "<COLLADA/>", "<COLLADA><library_geometries/></COLLADA>"}) {
    EXPECT_EQ(fault_of(text), "") << text;
  }
}

TEST(ColladaValues, XmlIsWhole) {
  EXPECT_EQ(fault_of(document().substr(0, 120)),
            "its XML is broken in line 3, at byte 119 of 120: Error parsing start element tag");
  EXPECT_EQ(fault_of("solid"),
            "its XML is broken in line 1, at byte 5 of 5: No document element "
            "found");
  std::string deep = "<COLLADA>";
  for (int i = 0; i < kMaxXmlDepth; ++i) deep += "<a>";
  for (int i = 0; i < kMaxXmlDepth; ++i) deep += "</a>";
  EXPECT_EQ(fault_of(deep + "</COLLADA>"), "XML elements nest more than 1024 deep");
}

// Entities of a DOCTYPE are not expanded, neither here nor by assimp.
TEST(ColladaValues, EntitiesStayWords) {
  EXPECT_EQ(fault(R"(<?xml version="1.0"?>)",
                  R"(<!DOCTYPE COLLADA [<!ENTITY a "0"><!ENTITY b "&a;&a;&a;&a;">]>)"),
            "");
  EXPECT_EQ(fault("1 4 3", "1 &b; 3"),
            "line 8, triangles of geometry 'g': p: expected whole numbers, found '&b;'");
}

TEST(ColladaValues, ArraysHaveAsManyNumbersAsTheySay) {
  const std::string place = "line 4, float_array of geometry 'g': ";
  EXPECT_EQ(fault(R"(count="15")", R"(count="12")"),
            place + "count: expected 15, as its text has, found 12");
  EXPECT_EQ(fault(R"(count="15")", R"(count="4294967295")"),
            place + "count: expected 15, as its text has, found 4294967295");
  EXPECT_EQ(fault(R"(count="15")", R"(count="-1")"),
            place + "count: expected a whole number of 0 or more, found '-1'");
  EXPECT_EQ(fault(R"( count="15")", ""),
            place + "count: expected a whole number of 0 or more, found none");
  for (const char* word : {"x", "1;5", "1,", "0x10", "1-2", "123456789012345678901"}) {
    EXPECT_EQ(
        fault("2 1 0<", fmt::format("2 {} 0<", word)),
        place + "expected numbers, of at most 19 digits before the point, found '" + word + "'");
  }
  EXPECT_EQ(fault("2 1 0<", "2 <!-- --> 1 0<"),
            place +
                "float_array: expected text in one piece, of which assimp reads the first "
                "alone, found a comment or an element in it");
  EXPECT_EQ(fault("<library_geometries>",
                  R"(<library_animations><animation><source id="o"><Name_array id="m" count="9">)"
                  R"(LINEAR</Name_array></source></animation></library_animations>)"
                  "<library_geometries>"),
            "line 3, Name_array: count: expected 1, as its text has, found 9");
}

TEST(ColladaValues, AccessorsEndWithinTheirArray) {
  const std::string place = "line 5, accessor of geometry 'g': ";
  const auto beyond = [&](const char* offset, const char* stride, const char* count) {
    return fmt::format(
        "{}count: expected no more than the 15 numbers of array 'a' hold, with "
        "offset {} and stride {}, found {}",
        place, offset, stride, count);
  };
  EXPECT_EQ(fault(kAccessor, R"(<accessor source="#a" count="6" stride="3">)"),
            beyond("0", "3", "6"));
  EXPECT_EQ(fault(kAccessor, R"(<accessor source="#a" count="5" stride="3" offset="1">)"),
            beyond("1", "3", "5"));
  EXPECT_EQ(fault(kAccessor, R"(<accessor source="#a" count="5" stride="4">)"),
            beyond("0", "4", "5"));
  constexpr const char* kMost = "18446744073709551615";
  EXPECT_EQ(
      fault(kAccessor, fmt::format(R"(<accessor source="#a" count="{0}" stride="{0}">)", kMost)),
      beyond("0", kMost, kMost));
  for (const char* stride : {"0", "2"}) {
    EXPECT_EQ(
        fault(kAccessor, fmt::format(R"(<accessor source="#a" count="5" stride="{}">)", stride)),
        place + "stride: expected 3 or more, found " + stride);
  }
  EXPECT_EQ(fault(R"(source="#a")", R"(source="#b")"),
            place + "source: expected the id of a float_array, found 'b'");
  EXPECT_EQ(fault(R"(source="#a")", R"(source="a")"),
            place + "source: expected '#' and an id of this file, found 'a'");
  EXPECT_EQ(fault(R"(name="Z")", R"(name="z")"),
            place + "param: expected X, Y and Z, from which assimp takes positions, found others");
}

TEST(ColladaValues, InputsLeadToPositions) {
  EXPECT_EQ(fault("POSITION", "NORMAL"),
            "line 7, vertices of geometry 'g': input: expected one POSITION, found 0");
  EXPECT_EQ(fault(R"(source="#p")", R"(source="#q")"),
            "line 8, triangles of geometry 'g': POSITION: source: expected the id of a source with "
            "an accessor, found 'q'");
  const std::string place = "line 8, triangles of geometry 'g': ";
  EXPECT_EQ(fault("VERTEX", "NORMAL"), place + "input: expected one VERTEX, found none");
  EXPECT_EQ(fault(R"(source="#v")", R"(source="#w")"),
            place + "input: source: expected <vertices> 'v', found 'w'");
  EXPECT_EQ(fault(R"(offset="0")", R"(offset="4294967295")"),
            place + "input: offset: expected at most 255, found 4294967295");
  EXPECT_EQ(fault(R"(offset="0")", R"(offset="x")"),
            place + "input: offset: expected a whole number of 0 or more, found 'x'");
  EXPECT_EQ(fault("<p>0", R"(<input semantic="UV" source="#p" offset="1"/><p>0)"),
            place +
                "input: expected semantics at the last offset that assimp reads, as NORMAL, "
                "found 'UV'");
  EXPECT_EQ(fault("<p>0", R"(<input semantic="POSITION" source="#p" offset="1"/><p>0)"),
            place + "input: expected POSITION in <vertices>, found it here");
}

TEST(ColladaValues, IndicesAreWholeNumbersOfVertices) {
  const std::string place = "line 8, triangles of geometry 'g': p: ";
  for (const char* word : {"4.5", "x", "1e0", "99999999999999999999"}) {
    EXPECT_EQ(fault("1 4 3", fmt::format("1 {} 3", word)),
              place + "expected whole numbers, found '" + word + "'");
  }
  for (const char* word : {"5", "-1", "4294967295", "4294967296"}) {
    EXPECT_EQ(fault("1 4 3", fmt::format("1 {} 3", word), Errc::kMeshIndexOutOfRange),
              place + "expected indices of the 5 vertices, found " + word);
  }
  EXPECT_EQ(fault(R"(offset="0"/>)", R"(offset="1"/>)"),
            place + "expected 2 numbers for each vertex, found 1 for the last");
}

TEST(ColladaValues, CountsAgreeWithIndices) {
  EXPECT_EQ(fault(R"(<triangles count="3")", R"(<triangles count="4294967295")"),
            "line 8, triangles of geometry 'g': count: expected a third of the 9 vertices in <p>, "
            "found 4294967295");
  const auto place = [](const char* name) {
    return fmt::format("line 8, {} of geometry 'g': ", name);
  };
  EXPECT_EQ(fault_of_primitive("polylist", "2", "<vcount>3 4000000000</vcount><p>0 1 2</p>"),
            place("polylist") + "vcount: expected 3 corners in all, as in <p>, found 4000000003");
  EXPECT_EQ(fault_of_primitive("polylist", "3", "<vcount>3</vcount><p>0 1 2</p>"),
            place("polylist") + "count: expected 1, as <vcount> has, found 3");
  EXPECT_EQ(fault_of_primitive("polylist", "1", "<vcount>-3</vcount><p>0 1 2</p>"),
            place("polylist") + "vcount: expected whole numbers, found '-3'");
  EXPECT_EQ(fault_of_primitive("polylist", "1", "<p>0 1 2</p>"),
            place("polylist") + "count: expected as many as <vcount> has before <p>, found 1");
  EXPECT_EQ(fault_of_primitive("polygons", "4", "<p>0 1 2</p>"),
            place("polygons") + "count: expected 1, one for each <p>, found 4");
  EXPECT_EQ(fault_of_primitive("polygons", "1", "<ph><p>0 1 2</p><h>0 1 2</h></ph>"),
            place("polygons") +
                "ph: expected none, since assimp's reader has no holes, found one; "
                "export triangles");
  EXPECT_EQ(fault_of_primitive("tristrips", "1", "<p/>"),
            place("tristrips") + "p: expected 2 or more vertices, found 0");
  EXPECT_EQ(fault_of_primitive("tristrips", "0", "<p>0 1 2</p>"),
            place("tristrips") + "count: expected 1 or more for the 3 vertices in <p>, found 0");
  EXPECT_EQ(fault_of_primitive("trifans", "1", "<p>0 1 2 3</p>"),
            place("trifans") +
                "p: expected at most 3 vertices, as assimp takes a fan for a polygon, "
                "found 4; export triangles");
  EXPECT_EQ(fault_of_primitive("lines", "4294967295", "<p>0 1 2 3</p>"),
            place("lines") + "count: expected half of the 4 vertices in <p>, found 4294967295");
}

TEST(ColladaValues, IdsOfGeometriesAreTheirOwn) {
  EXPECT_EQ(fault("</geometry>", R"(</geometry><geometry id="g"/>)"),
            "line 9, geometry: id: expected one of its own, without which assimp leaves it out, "
            "found 'g' once more");
}

TEST(ColladaValues, TransformsHaveTheirNumbers) {
  const auto in_node = [](const char* transforms) {
    return fault(kPlaced, fmt::format("{}{}", transforms, kPlaced));
  };
  const std::string place = "line 11, node 'n': ";
  EXPECT_EQ(in_node("<translate>1 2</translate>"),
            place + "translate: expected 3 numbers, found 2");
  EXPECT_EQ(in_node("<scale>1 2 3 4</scale>"), place + "scale: expected 3 numbers, found 4");
  EXPECT_EQ(in_node("<lookat>1 2 3</lookat>"), place + "lookat: expected 9 numbers, found 3");
  EXPECT_EQ(in_node("<rotate>1 0 0 x</rotate>"), place + "rotate: expected numbers, found 'x'");
  EXPECT_EQ(in_node("<matrix/>"), place + "matrix: expected 16 numbers, found 0");
  EXPECT_EQ(in_node("<matrix>1 0 0 0 0 1 0 0 0 0 1 0 5 6 7 1</matrix>"),
            place + "matrix: expected 0, 0, 0, 1 as its last row, found 5 in column 0");
  EXPECT_EQ(in_node("<rotate>0 0 2 90</rotate>"),
            place +
                "rotate: expected an axis of length 1, which assimp takes it for, found length "
                "2");
  EXPECT_EQ(in_node("<skew>45 0 1 0 1 0 0</skew>"),
            place +
                "skew: expected none, since assimp's reader crashes on it, found one; export "
                "without skew, as a matrix");
}

TEST(ColladaValues, InstancesNameWhatIsThere) {
  const std::string place = "line 11, node 'n': ";
  EXPECT_EQ(fault(kPlaced, R"(<instance_geometry url="#h"/>)"),
            place +
                "instance_geometry: url: expected the id of a geometry or controller, found "
                "'h'");
  EXPECT_EQ(fault(kPlaced, R"(<instance_node url="#h"/>)"),
            place +
                "instance_node: url: expected the id of a node of the scene, or of one right in "
                "library_nodes, found 'h'");
  EXPECT_EQ(fault(kPlaced, R"(<instance_node url="other.dae#h"/>)"),
            place + "instance_node: url: expected '#' and an id of this file, found 'other.dae#h'");
  // One by its name, which is not placed.
  EXPECT_EQ(fault("</visual_scene>", R"(<node name="m"/></visual_scene><visual_scene id="unused">)"
                                     R"(<node><instance_node url="#h"/></node></visual_scene>)"),
            "");
  EXPECT_EQ(fault(kPlaced, R"(<instance_node url="#m"/><node name="m"/>)"), "");
}

TEST(ColladaValues, NodesNestWithinLimits) {
  EXPECT_EQ(fault(kPlaced, R"(<instance_node url="#n"/>)"),
            "line 11, node 'n': expected instances of nodes that end, found it is below itself");
  EXPECT_EQ(fault(kPlaced, R"(<node><instance_node url="#s"/></node>)"),
            "line 10, visual_scene 's': expected instances of nodes that end, found it is below "
            "itself");
  // Each node has ten of the next.
  std::string library = "<library_nodes>";
  for (int i = 0; i < 8; ++i) {
    library += fmt::format("\n<node id='l{}'>", i);
    for (int k = 0; k < 10; ++k) library += fmt::format("<instance_node url='#l{}'/>", i + 1);
    library += "</node>";
  }
  library += "<node id='l8'/></library_nodes>";
  std::string text = with(kPlaced, R"(<instance_node url="#l0"/>)");
  text.insert(text.find("<library_visual"), library);
  EXPECT_EQ(fault_of(text),
            "line 17, node 'l6': expected instances of nodes that end, found shared by so many "
            "parents that more than 262155 instances arise");
}

// A node below a cycle is not told as one of it.
TEST(ColladaValues, ACycleIsToldByANodeOfIt) {
  const auto fault = find_nesting_fault({{1, 2}, {}, {3}, {2, 1}});
  ASSERT_TRUE(fault.has_value());
  EXPECT_EQ(fault->node, 2u);
  EXPECT_EQ(fault->what, "it is below itself");
}

class ColladaImport : public ImportTest {};

TEST_F(ColladaImport, ReadsWhatIsPassed) {
  const Imported imported = load("a.dae", document());
  EXPECT_EQ(imported.mesh.faces.size(), 3u);
  EXPECT_EQ(imported.mesh.positions.size(), 5u);
  EXPECT_EQ(load("comma.DAE", with("2 1 0<", "2,5 1 0<")).mesh.positions[4].x(), 2.5);
}

// Heap memory reached the cooked file.
TEST_F(ColladaImport, NothingIsReadBeyondAnArray) {
  EXPECT_TRUE(has(fail("a.dae", with(R"(count="15")", R"(count="12")")).detail,
                  "a.dae: line 4, float_array of geometry 'g': count: expected 15"));
  EXPECT_TRUE(
      has(fail("b.dae", with(kAccessor, R"(<accessor source="#a" count="6" stride="3">)")).detail,
          "b.dae: line 5, accessor of geometry 'g': count: expected no more"));
  // Assimp goes by the contents of files that end so.
  EXPECT_TRUE(has(fail("c.xml", with(R"(count="15")", R"(count="12")")).detail, "c.xml: line 4, "));
}

// They became vertex 0.
TEST_F(ColladaImport, IndicesOutOfRangeAreRefused) {
  for (const char* word : {"-1", "4294967295", "4294967296"}) {
    EXPECT_EQ(fail("a.dae", with("1 4 3", fmt::format("1 {} 3", word))).code,
              Errc::kMeshIndexOutOfRange);
  }
}

// They cost half a minute, and half of the machine's memory.
TEST_F(ColladaImport, WordsThatAreNoIndexAreRefusedAtOnce) {
  for (const char* word : {"4.5", "x"}) {
    EXPECT_EQ(fail("a.dae", with("1 4 3", fmt::format("1 {} 3", word))).code, Errc::kImportFailed);
  }
}

// They ended in out_of_memory, as if the machine was too small.
TEST_F(ColladaImport, CountsDoNotReserveMemory) {
  EXPECT_EQ(fail("a.dae", with(R"(count="15")", R"(count="4294967295")")).code,
            Errc::kImportFailed);
  EXPECT_EQ(fail("b.dae", with(R"(<triangles count="3")", R"(<triangles count="4294967295")")).code,
            Errc::kImportFailed);
}

// They were told as crashes.
TEST_F(ColladaImport, WhatAssimpCrashesOnIsToldByItsPlace) {
  EXPECT_TRUE(has(fail("a.dae", with(kPlaced, "<skew>45 0 1 0 1 0 0</skew>")).detail,
                  "node 'n': skew: expected none"));
  EXPECT_TRUE(has(fail("b.dae", with(kPlaced, R"(<instance_node url="#n"/>)")).detail,
                  "node 'n': expected instances of nodes that end"));
  EXPECT_TRUE(
      has(fail("c.dae", with(kTriangles, primitive("polygons", "4", "<p>0 1 2</p>"))).detail,
          "polygons of geometry 'g': count: expected 1"));
}

// They had the material of others, and a filter by it let them through.
TEST_F(ColladaImport, FacesWithoutAMaterialGetNoOther) {
  const std::string of_one = primitive("triangles", R"(1" material="m)", "<p>0 1 2</p>");
  const std::string of_none = primitive("triangles", "1", "<p>1 4 3</p>");
  constexpr std::string_view kMaterial =
      R"(<library_materials><material id="M" name="M"><instance_effect url="#e"/></material>)"
      R"(</library_materials><library_effects><effect id="e"><profile_COMMON/></effect>)"
      "</library_effects><library_geometries>";
  constexpr std::string_view kBound =
      R"(<instance_geometry url="#g"><bind_material><technique_common>)"
      R"(<instance_material symbol="m" target="#M"/></technique_common></bind_material>)"
      "</instance_geometry>";
  const auto file = [&](const std::string& name, const std::string& primitives) {
    std::string text = document();
    const auto replace = [&](std::string_view from, std::string_view to) {
      text.replace(text.find(from), from.size(), to);
    };
    replace(kTriangles, primitives);
    replace(kPlaced, kBound);
    replace("<library_geometries>", kMaterial);
    return write(name, text);
  };
  const ImportOptions with_materials{.materials = true};
  const Result<Imported> all = import_mesh(file("all.dae", of_one), with_materials);
  ASSERT_TRUE(all.ok());
  EXPECT_EQ(all->materials.names, std::vector<std::string>{"M"});
  const auto some = file("some.dae", of_one + of_none);
  EXPECT_TRUE(import_mesh(some).ok());
  const Result<Imported> refused = import_mesh(some, with_materials);
  ASSERT_EQ(refused.code(), Errc::kImportFailed);
  EXPECT_TRUE(has(refused.error().detail, "give each a material, or cook without --materials"));
  EXPECT_FALSE(list_source_files(some, with_materials).ok());
  // Of a file without any.
  const Result<Imported> none = import_mesh(write("none.dae", document()), with_materials);
  ASSERT_TRUE(none.ok());
  EXPECT_TRUE(none->report.has_no_materials);
}

}  // namespace
}  // namespace boxtree::cooker
