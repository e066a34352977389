// SPDX-License-Identifier: MIT
// In place of assimp_import.cpp in builds without assimp (BOXTREE_ASSIMP=OFF): its formats are
// known by their endings, so that such a file is not called something else, and refused.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "cooker/import/assimp_import.h"

namespace boxtree::cooker {
namespace {

// Nearly all that assimp 5.2.5 reads.
constexpr std::array kEndings = {
    "3d",    "3ds", "3mf",     "ac",        "ac3d",    "acc",  "amf",     "ase",  "assbin", "b3d",
    "blend", "bsp", "bvh",     "cob",       "csm",     "dae",  "dxf",     "enff", "fbx",    "glb",
    "gltf",  "hmp", "ifc",     "ifczip",    "iqm",     "irr",  "irrmesh", "lwo",  "lws",    "lxo",
    "md2",   "md3", "md5anim", "md5camera", "md5mesh", "mdc",  "mdl",     "mesh", "mot",    "ms3d",
    "ndo",   "nff", "obj",     "off",       "ogex",    "pk3",  "ply",     "pmx",  "prj",    "q3o",
    "q3s",   "raw", "scn",     "sib",       "smd",     "step", "stl",     "stp",  "ter",    "uc",
    "vta",   "x",   "x3d",     "x3db",      "xgl",     "xml",  "zae",     "zgl"};

Error unsupported(const SourceFile& source) {
  return {Errc::kFeatureUnsupported,
          fmt::format("{}: expected .obj, .off, .ply or .stl, which this boxtree reads, found {}: "
                      "it was built without assimp (BOXTREE_ASSIMP=OFF); cook it by one that has "
                      "it, or convert it",
                      source.title(), source.path().extension().string())};
}

}  // namespace

Status import_with_assimp(const SourceFile& source, const ImportOptions& /*options*/,
                          ImportWanted /*wanted*/, ImportedFile& /*out*/) {
  return unsupported(source);
}

Result<SourceFileList> list_assimp_files(const SourceFile& source,
                                         const ImportOptions& /*options*/) {
  return unsupported(source);
}

std::vector<std::string> assimp_endings() {
  return {kEndings.begin(), kEndings.end()};
}

std::string assimp_version() {
  return "none";
}

}  // namespace boxtree::cooker
