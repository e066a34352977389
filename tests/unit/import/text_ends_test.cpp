// SPDX-License-Identifier: MIT
// Texts of formats that assimp reads: whole, and cut short at every byte.
#include "cooker/import/text_ends.h"

#include <span>
#include <string>
#include <string_view>

#include <assimp/IOStream.hpp>
#include <gtest/gtest.h>

#include "cooker/import/import.h"
#include "cooker/import/recording_io.h"
#include "tests/support/temp_folder.h"

namespace boxtree::cooker {
namespace {

constexpr std::string_view kAc =
    "AC3Db\nMATERIAL \"\" rgb 1 1 1 amb 1 1 1 emis 0 0 0 spec 0 0 0 shi 0 trans 0\n"
    "OBJECT world\nkids 2\n"
    "OBJECT poly\ndata 5\nhello\nnumvert 3\n0 0 0\n1 0 0\n0 1 0\nnumsurf 1\n"
    "SURF 0x20\nmat 0\nrefs 3\n0 0 0\n1 0 0\n2 0 0\nkids 0\n"
    "OBJECT group\nkids 1\n"
    "OBJECT poly\nnumvert 3\n0 0 1\n1 0 1\n0 1 1\nnumsurf 1\n"
    "SURF 0x20\nmat 0\nrefs 3\n0 0 0\n1 0 0\n2 0 0\nkids 0\n";

constexpr std::string_view kDxf =
    "0\nSECTION\n2\nENTITIES\n0\n3DFACE\n8\n0\n10\n0.0\n20\n0.0\n30\n0.0\n11\n1.0\n21\n0.0\n31\n"
    "0.0\n12\n1.0\n22\n1.0\n32\n0.0\n13\n0.0\n23\n1.0\n33\n0.0\n0\n3DFACE\n8\n0\n10\n0.0\n20\n"
    "0.0\n30\n1.0\n11\n1.0\n21\n0.0\n31\n1.0\n12\n1.0\n22\n1.0\n32\n1.0\n13\n0.0\n23\n1.0\n33\n"
    "1.0\n0\nENDSEC\n0\nEOF\n";

// Each prefix is refused, or gives the same faces as the whole: what is missing were blanks.
void check_prefixes(const char* name, std::string_view whole) {
  const test::TempFolder folder;
  const auto read = [&](std::string_view text) { return import_mesh(folder.write(name, text)); };
  const Result<Imported> all = read(whole);
  ASSERT_TRUE(all.ok()) << all.error().detail;
  ASSERT_EQ(all->mesh.faces.size(), 2u);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const Result<Imported> part = read(whole.substr(0, size));
    if (!part.ok()) continue;
    EXPECT_EQ(part->mesh.positions.f32, all->mesh.positions.f32) << size;
    EXPECT_EQ(part->mesh.faces.size(), 2u) << size;
    EXPECT_GE(size + 3, whole.size());
  }
}

TEST(TextEnds, EveryPrefixOfAc3dIsRefused) {
  check_prefixes("two.ac", kAc);
}

TEST(TextEnds, EveryPrefixOfDxfIsRefused) {
  check_prefixes("two.dxf", kDxf);
}

constexpr std::string_view kSmd =
    "version 1\nnodes\n0 \"end\" -1\nend\nskeleton\ntime 0\n0 0 0 0 0 0 "
    "0\nend\ntriangles\nend.bmp\n"
    "0 0 0 0 0 0 1 0 0\n0 1 0 0 0 0 1 0 0\n0 0 1 0 0 0 1 0 0\nskin.bmp\n"
    "0 0 0 1 0 0 1 0 0\n0 1 0 1 0 0 1 0 0\n0 0 1 1 0 0 1 0 0\nend\n";

TEST(TextEnds, EveryPrefixOfSmdIsRefused) {
  check_prefixes("two.smd", kSmd);
  EXPECT_TRUE(check_smd_end(kSmd).ok());
  EXPECT_EQ(check_smd_end("triangles\nend.bmp\n").code(), Errc::kImportFailed);
}

// Assimp's reader of SMD skips what follows "end", even if that is the end of its buffer.
TEST(TextEnds, ReadersGetALastLineThatEnds) {
  const test::TempFolder folder;
  const auto given = [](const SourceFile& source, TextMends mends) {
    SourceUse use;
    RecordingIo files(source, use, mends);
    Assimp::IOStream* const stream = files.Open(source.path().c_str());
    std::string text(stream->FileSize(), ' ');
    EXPECT_EQ(stream->Read(text.data(), 1, text.size()), text.size());
    files.Close(stream);
    return text;
  };
  for (const std::string whole : {"triangles\nend\n", "triangles\nend\r"}) {
    const std::string open = whole.substr(0, whole.size() - 1);
    EXPECT_EQ(given(folder.write("whole.smd", whole), {.line_end = true}), whole);
    EXPECT_EQ(given(folder.write("open.smd", open), {.line_end = true}), open + "\n");
    EXPECT_EQ(given(folder.write("open.smd", open), {}), open);
    const SourceBytes bytes{"-", "standard input", "stdin.smd", std::as_bytes(std::span(open))};
    EXPECT_EQ(given(SourceFile("-", bytes), {.line_end = true}), open + "\n");
  }
}

// RAW states no end: a last line that does not end is told.
TEST(TextEnds, OpenEndsAreTold) {
  const test::TempFolder folder;
  const std::string raw = "0 0 0 1 0 0 0 1 0\n0 0 1 1 0 1 0 1 1\n";
  const auto is_open = [&](std::size_t bytes) {
    const Result<Imported> got = import_mesh(folder.write("a.raw", raw.substr(0, bytes)));
    EXPECT_TRUE(got.ok());
    return got.ok() && got->report.has_open_end;
  };
  EXPECT_FALSE(is_open(raw.size()));
  EXPECT_TRUE(is_open(raw.size() - 1));
  // Of a line that lacks numbers its reader would make no triangle.
  EXPECT_EQ(import_mesh(folder.write("a.raw", raw.substr(0, raw.size() - 5))).code(),
            Errc::kImportFailed);
}

TEST(TextEnds, Ac3dObjectsFollowWhereTheyAreStated) {
  EXPECT_TRUE(check_ac_end(kAc).ok());
  EXPECT_TRUE(check_ac_end("AC3Db\nOBJECT world\nkids 0\nOBJECT world\nkids 0").ok());
  EXPECT_TRUE(check_ac_end("OBJECT world\ndata 14\nOBJECT\nkids 9\n\nkids 0").ok());
  for (const std::string_view cut :
       {"AC3Db\nOBJECT world\nkids 1\n", "AC3Db\nOBJECT world\n",
        "OBJECT world\nOBJECT poly\nkids 0\n", "OBJECT world\nkids 18446744073709551615\n",
        "OBJECT world\ndata 99999\nkids 0\n"}) {
    EXPECT_EQ(check_ac_end(cut).code(), Errc::kImportFailed) << cut;
  }
}

TEST(TextEnds, BlocksAreClosed) {
  EXPECT_TRUE(check_blocks_end("*A 1\n*B {\n *C \"{\" { }\n}\n").ok());
  EXPECT_TRUE(check_blocks_end("} } {}").ok());
  EXPECT_TRUE(check_blocks_end("").ok());
  EXPECT_EQ(check_blocks_end("*B {\n *C \"}\" {\n }\n").code(), Errc::kImportFailed);
}

TEST(TextEnds, DxfEndsWithEof) {
  EXPECT_TRUE(check_dxf_end("  0\r\nEOF\r\n\x1a").ok());
  EXPECT_TRUE(check_dxf_end("EOF").ok());
  EXPECT_TRUE(check_dxf_end("AutoCAD Binary DXF\r\n\x1a").ok());
  for (const std::string_view cut : {"", "0\nSECTION\n", "0\nTHEOF", "0\nEO", "0\nEOF\n0\n"}) {
    EXPECT_EQ(check_dxf_end(cut).code(), Errc::kImportFailed) << cut;
  }
}

}  // namespace
}  // namespace boxtree::cooker
