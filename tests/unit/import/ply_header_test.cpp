// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <boxtree/cooker/import/ply_header.h>

namespace boxtree::cooker {
namespace {

constexpr std::string_view kHeader =
    "ply\r\nformat binary_big_endian 1.0\r\ncomment element vertex 5\nobj_info x\n\n"
    "element vertex 12\nproperty float x\nproperty float64 y\nproperty uint8 red\n"
    "element face 3\nproperty list uchar int vertex_indices\nend_header\r\nbody";

TEST(PlyHeader, ElementsAndProperties) {
  const auto header = read_ply_header(kHeader);
  ASSERT_TRUE(header);
  EXPECT_TRUE(header->is_plain);
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

TEST(PlyHeader, WhatItDoesNotKnow) {
  EXPECT_FALSE(read_ply_header("ply\nformat ascii 1.0\nelement vertex 3\n"));
  EXPECT_FALSE(read_ply_header("ply\nformat ascii 1.0\nelement vertex\nend_header\n"));
  EXPECT_FALSE(read_ply_header("ply\nformat ascii 1.0\nelement vertex -1\nend_header\n"));
  EXPECT_FALSE(read_ply_header(""));
  EXPECT_FALSE(read_ply_header("ply\nend\nformat ascii 1.0\nend_header\n")->is_plain);
  EXPECT_FALSE(read_ply_header("plz\nformat ascii 1.0\nend_header\n")->is_plain);
  EXPECT_FALSE(read_ply_header("ply\nformat binary 1.0\nend_header\n")->is_plain);
  const auto odd =
      read_ply_header("ply\nformat ascii 1.0\nelement vertex 1\nproperty half x\nend_header\n");
  ASSERT_TRUE(odd);
  EXPECT_FALSE(odd->elements[0].is_understood);
  for (const char* list : {"list", "list uchar", "list uchar int", "list uchar half x", "float"}) {
    const auto cut = read_ply_header("ply\nformat ascii 1.0\nelement face 1\nproperty " +
                                     std::string(list) + "\nend_header\n");
    ASSERT_TRUE(cut);
    EXPECT_FALSE(cut->elements[0].is_understood) << list;
  }
}

TEST(PlyHeader, HasAnEnd) {
  EXPECT_TRUE(has_ply_header_end(kHeader));
  EXPECT_TRUE(has_ply_header_end("ply\r\nend_header\r"));
  EXPECT_TRUE(has_ply_header_end("ply\ncomment end_header of\n end_header \nbody"));
  for (const char* file : {"", "ply\n", "ply\nend_header", "end_header\n", "ply\nend_headers\n",
                           "ply\ncomment end_header\n"}) {
    EXPECT_FALSE(has_ply_header_end(file)) << file;
  }
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
