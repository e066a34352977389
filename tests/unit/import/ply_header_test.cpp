// SPDX-License-Identifier: MIT
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "cooker/import/ply_layout.h"

namespace boxtree::cooker {
namespace {

constexpr std::string_view kHeader =
    "ply\r\nformat binary_big_endian 1.0\r\ncomment element vertex 5\nobj_info x\n\n"
    "element vertex 12\nproperty float x\nproperty float64 y\nproperty uint8 red\n"
    "element face 3\nproperty list uchar int vertex_indices\nend_header\r\nbody";

TEST(PlyHeader, ElementsAndProperties) {
  const auto header = read_ply_header(kHeader);
  ASSERT_TRUE(header.ok());
  EXPECT_EQ(header->lines, 12u);
  EXPECT_EQ(header->form, PlyHeader::Form::kBigEndian);
  EXPECT_EQ(kHeader.substr(header->bytes), "body");
  ASSERT_EQ(header->elements.size(), 2u);
  const PlyElement &vertex = header->elements[0], &face = header->elements[1];
  EXPECT_EQ(vertex.name, "vertex");
  EXPECT_EQ(vertex.count, 12u);
  EXPECT_FALSE(vertex.has_lists());
  ASSERT_EQ(vertex.properties.size(), 3u);
  EXPECT_EQ(vertex.properties[1].name, "y");
  EXPECT_EQ(vertex.properties[1].type, PlyType::kFloat64);
  EXPECT_EQ(vertex.properties[2].type, PlyType::kUint8);
  EXPECT_TRUE(face.has_lists());
  EXPECT_EQ(face.properties[0].name, "vertex_indices");
  EXPECT_EQ(face.properties[0].length, PlyType::kUint8);
  EXPECT_EQ(face.properties[0].type, PlyType::kInt32);
}

// What is wrong with a header that has `lines` behind the format.
std::string wrong_with(const std::string& lines) {
  const auto header = read_ply_header("ply\nformat ascii 1.0\n" + lines + "end_header\n");
  return header.ok() ? "nothing" : header.error().detail;
}

TEST(PlyHeader, WhatIsNoHeader) {
  for (const char* file : {"", "ply", "PLY\nformat ascii 1.0\nend_header\n", "end_header\n",
                           "plz\nformat ascii 1.0\nend_header\n"}) {
    const auto header = read_ply_header(file);
    ASSERT_FALSE(header.ok()) << file;
    EXPECT_EQ(header.error().code, Errc::kImportFailed);
    EXPECT_EQ(header.error().detail, "no PLY file: its first line is not 'ply'") << file;
  }
  for (const char* file :
       {"ply\n", "ply\nformat ascii 1.0\nend_header", "ply\ncomment end_header\n",
        "ply\nformat ascii 1.0\nelement vertex 3\n"}) {
    const auto header = read_ply_header(file);
    ASSERT_FALSE(header.ok()) << file;
    EXPECT_NE(header.error().detail.find("no 'end_header'"), std::string::npos) << file;
  }
  EXPECT_EQ(read_ply_header("ply\ncomment none\nend_header\n").error().detail,
            "line 3: the header ends without a 'format'");
  EXPECT_EQ(read_ply_header("ply\nformat binary 1.0\nend_header\n").error().detail,
            "line 2: one 'format' is expected: ascii, binary_little_endian or binary_big_endian");
  EXPECT_TRUE(read_ply_header("ply\n\ncomment first\nformat ascii 1.0\n end_header \nx").ok());
}

TEST(PlyHeader, StatementsThatCannotBeRead) {
  EXPECT_EQ(wrong_with(""), "nothing");
  EXPECT_EQ(wrong_with("format ascii 1.0\n").substr(0, 20), "line 3: one 'format'");
  EXPECT_EQ(wrong_with("propetry float x\n"),
            "line 3: no statement of a PLY header begins with \"propetry\"");
  for (const char* element :
       {"element", "element vertex", "element vertex -1", "element vertex 1.5",
        "element vertex 3 4", "element vertex 99999999999999999999"}) {
    EXPECT_EQ(wrong_with(std::string(element) + "\n"),
              "line 3: 'element' is to be followed by a name and a count");
  }
  EXPECT_EQ(wrong_with("property float x\n"), "line 3: a property before the first element");
  const auto property = [](const std::string& text) {
    return wrong_with("element face 1\nproperty " + text + "\n");
  };
  EXPECT_EQ(property("float x"), "nothing");
  EXPECT_EQ(property("half x"), "line 4: PLY has no type \"half\"");
  EXPECT_EQ(property("list uchar half x"), "line 4: PLY has no type \"half\"");
  EXPECT_EQ(property("list byte int x"), "line 4: PLY has no type \"byte\"");
  EXPECT_EQ(property("list float int x"),
            "line 4: the length of a list is to be an integer, not \"float\"");
  for (const char* cut : {"", "float", "float x y", "list", "list uchar", "list uchar int"}) {
    EXPECT_EQ(property(cut).substr(0, 25), "line 4: 'property' is to ") << cut;
  }
}

// What is wrong with a file of these elements.
std::string wrong_parts(const std::string& elements) {
  PlyLayout layout;
  Result<PlyHeader> header = read_ply_header("ply\nformat ascii 1.0\n" + elements + "end_header\n");
  EXPECT_TRUE(header.ok());
  layout.header = std::move(*header);
  const Status status = find_ply_parts(layout);
  return status.ok() ? "nothing" : status.error().message();
}

TEST(PlyHeader, ElementsThatAreNoMesh) {
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  const std::string vertex = "element vertex 3\n" + xyz;
  const std::string list = "property list uchar int vertex_indices\n";
  const std::string face = "element face 1\n" + list;
  const auto expect = [](const std::string& elements, std::string_view why) {
    const std::string wrong = wrong_parts(elements);
    EXPECT_NE(wrong.find(why), std::string::npos) << wrong;
  };
  expect(vertex + face, "nothing");
  expect(vertex + "element tristrips 1\n" + list, "nothing");
  expect(vertex + "element extra 1\nproperty int x\n" + face, "nothing");
  expect(vertex, "no faces");
  expect(vertex + "element face 0\n", "no faces");
  expect(face, "no element 'vertex'");
  expect(face + vertex, "'face' comes before 'vertex'");
  expect(vertex + face + face, "two elements 'face'");
  expect(vertex + vertex + face, "two elements 'vertex'");
  expect(vertex + "element face 1\nproperty list uchar int corners\n", "no 'vertex_indices'");
  expect(vertex + face + "property list uchar int vertex_index\n", "one list of integers");
  expect(vertex + "element face 1\nproperty int vertex_index\n", "one list of integers");
  expect(vertex + "element face 1\nproperty list int float vertex_index\n", "one list of integers");
  expect(vertex + "property double y\n" + face, "'y' twice");
  expect("element vertex 3\nproperty float x\nproperty float y\n" + face, "no 'z'");
  expect("element vertex 3\nproperty list int float x\nproperty float y\nproperty float z\n" + face,
         "as a list");
}

TEST(PlyHeader, Values) {
  const char bytes[] = {'\x01', '\x02', '\x03', '\xff', '\0', '\0', '\0', '\0'};
  EXPECT_EQ(load_ply_integer(bytes, PlyType::kInt32, false), -16580095);
  EXPECT_EQ(load_ply_integer(bytes, PlyType::kUint32, false), 0xff030201);
  EXPECT_EQ(load_ply_integer(bytes, PlyType::kUint32, true), 0x010203ff);
  EXPECT_EQ(load_ply_integer(bytes + 3, PlyType::kInt8, false), -1);
  EXPECT_EQ(load_ply_integer(bytes + 3, PlyType::kUint8, true), 255);
  EXPECT_EQ(load_ply_integer(bytes + 2, PlyType::kInt16, true), 0x3ff);
  EXPECT_EQ(load_ply_integer(bytes + 2, PlyType::kUint16, false), 0xff03);
  EXPECT_EQ(load_ply_value(bytes + 3, PlyType::kInt8, false), -1.0);
  const char one[] = {'\x3f', '\xf0', '\0', '\0', '\0', '\0', '\0', '\0'};
  EXPECT_EQ(load_ply_value(one, PlyType::kFloat64, true), 1.0);
  EXPECT_EQ(load_ply_value("\0\0\x80\x3f", PlyType::kFloat32, false), 1.0);
}

}  // namespace
}  // namespace boxtree::cooker
