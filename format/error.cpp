// SPDX-License-Identifier: MIT
// The error table: one row per code, with its name, meaning and exit status.
#include <algorithm>
#include <array>

#include <boxtree/error.h>

namespace boxtree {
namespace {

// Exit statuses of the command line (docs/GUIDE.md): 1 invalid query, 2 input/output, 3 bad input,
// 4 internal or out of memory, 5 unsupported.
constexpr std::array kTable = {
    ErrcInfo{Errc::kOk, "ok", "no error", 0},
    ErrcInfo{Errc::kBadMagic, "bad_magic", "not a .bxt file", 3},
    ErrcInfo{Errc::kTruncated, "truncated", "the file is not as long as its sections", 3},
    ErrcInfo{Errc::kVersionUnsupported, "version_unsupported",
             "written by a newer format than this reader knows", 5},
    ErrcInfo{Errc::kFeatureUnsupported, "feature_unsupported",
             "uses a feature that a reader must know and this one does not", 5},
    ErrcInfo{Errc::kHeaderCorrupt, "header_corrupt", "header or section table is damaged", 3},
    ErrcInfo{Errc::kTooManySections, "too_many_sections", "more sections than the limit", 3},
    ErrcInfo{Errc::kSectionOrder, "section_order", "sections are out of order, or one occurs twice",
             3},
    ErrcInfo{Errc::kSectionMissing, "section_missing", "a section that the tree needs is absent",
             3},
    ErrcInfo{Errc::kSectionSize, "section_size", "a section's size contradicts its records", 3},
    ErrcInfo{Errc::kSectionUnknown, "section_unknown",
             "a section that a reader must know and this one does not", 5},
    ErrcInfo{Errc::kPaddingNotZero, "padding_not_zero", "padding or reserved bytes are not zero",
             3},
    ErrcInfo{Errc::kChecksumMismatch, "checksum_mismatch", "a section's bytes have changed", 3},
    ErrcInfo{Errc::kBlobLimit, "blob_limit", "decompressing would take more memory than allowed",
             3},
    ErrcInfo{Errc::kBlobCorrupt, "blob_corrupt", "a compressed file is damaged", 3},
    ErrcInfo{Errc::kCodecUnsupported, "codec_unsupported", "unknown node codec", 5},
    ErrcInfo{Errc::kGeometryUnsupported, "geometry_unsupported", "unknown geometry store", 5},
    ErrcInfo{Errc::kRecordInvalid, "record_invalid", "a tree record contradicts itself", 3},
    ErrcInfo{Errc::kNodeCorrupt, "node_corrupt", "a node points outside its own subtree", 3},
    ErrcInfo{Errc::kDepthExceeded, "depth_exceeded", "the tree is deeper than it states", 3},
    ErrcInfo{Errc::kFaceOutOfRange, "face_out_of_range", "a leaf names a face that is not there",
             3},
    ErrcInfo{Errc::kVertexOutOfRange, "vertex_out_of_range",
             "a face names a vertex that is not there", 3},
    ErrcInfo{Errc::kBoxEscape, "box_escape", "a triangle sticks out of a box above it", 3},
    ErrcInfo{Errc::kFaceUnreachable, "face_unreachable", "no leaf holds this face", 3},
    ErrcInfo{Errc::kFaceRepeated, "face_repeated", "more than one leaf holds this face", 3},
    ErrcInfo{Errc::kVertexNotFinite, "vertex_not_finite", "a stored vertex is NaN or infinite", 3},
    ErrcInfo{Errc::kDuplicateDiffers, "duplicate_differs",
             "a face listed as a copy of another one is not the same", 3},
    ErrcInfo{Errc::kInvalidQuery, "invalid_query", "NaN, infinite or empty query", 1},
    ErrcInfo{Errc::kInvalidPose, "invalid_pose", "pose is not finite, not invertible or leads too far away", 1},
    ErrcInfo{Errc::kPartLeftOut, "part_left_out",
             "a needed part was left out; require it when the file is bound, which tells the line",
             5},
    ErrcInfo{Errc::kExternalMeshNeeded, "external_mesh_needed",
             "the tree was cooked without geometry; give the mesh when binding", 1},
    ErrcInfo{Errc::kExternalMeshMismatch, "external_mesh_mismatch",
             "the mesh given is not the one the tree was cooked from", 3},
    ErrcInfo{Errc::kTreeIndex, "tree_index", "no tree with this number in the file", 1},
    ErrcInfo{Errc::kNoScene, "no_scene",
             "the file holds trees but no scene; bind one of its trees", 1},
    ErrcInfo{Errc::kInstanceIndex, "instance_index", "no instance with this number in the scene",
             1},
    ErrcInfo{Errc::kInstanceStatic, "instance_static",
             "an instance that was bound as static cannot be moved; make_movable() allows it", 1},
    ErrcInfo{Errc::kWorkLimit, "work_limit", "the query would cost more than its caller allows", 1},
    ErrcInfo{Errc::kFileNotFound, "file_not_found", "no such file", 2},
    ErrcInfo{Errc::kFileUnreadable, "file_unreadable", "the file cannot be read", 2},
    ErrcInfo{Errc::kMapFailed, "map_failed", "the file cannot be mapped", 2},
    ErrcInfo{Errc::kWriteFailed, "write_failed", "the file cannot be written", 2},
    ErrcInfo{Errc::kOutOfMemory, "out_of_memory", "there is too little memory", 4},
    ErrcInfo{Errc::kImportFailed, "import_failed", "the mesh cannot be read", 3},
    ErrcInfo{Errc::kNoFaces, "no_faces", "the mesh has no faces", 3},
    ErrcInfo{Errc::kMeshNotFinite, "mesh_not_finite", "a vertex is NaN or infinite", 3},
    ErrcInfo{Errc::kMeshIndexOutOfRange, "mesh_index_out_of_range",
             "a face names a vertex that is not there", 3},
    ErrcInfo{Errc::kMeshTooLarge, "mesh_too_large", "more faces or vertices than the format holds",
             5},
    ErrcInfo{Errc::kMeshUnsupported, "mesh_unsupported",
             "the mesh cannot be stored in the way requested", 5},
    ErrcInfo{Errc::kBudgetUnreachable, "budget_unreachable",
             "no encoding keeps to the bytes and the time requested", 1},
    ErrcInfo{Errc::kProfileInvalid, "profile_invalid",
             "a profile says what it must not, or of nothing that is there", 3},
    ErrcInfo{Errc::kDocumentInvalid, "document_invalid", "a JSON document is not what it should be",
             3},
    ErrcInfo{Errc::kInternal, "internal", "an internal error; please report it", 4},
};

static_assert(std::is_sorted(kTable.begin(), kTable.end(),
                             [](const ErrcInfo& a, const ErrcInfo& b) { return a.code < b.code; }));

}  // namespace

std::span<const ErrcInfo> error_table() noexcept {
  return kTable;
}

const ErrcInfo& error_info(Errc code) noexcept {
  const auto row = std::find_if(kTable.begin(), kTable.end(),
                                [code](const ErrcInfo& info) { return info.code == code; });
  return row != kTable.end() ? *row : kTable.back();
}

}  // namespace boxtree
