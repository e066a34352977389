// SPDX-License-Identifier: MIT
#include "cooker/import/reader_log.h"

#include <algorithm>
#include <mutex>
#include <string_view>

#include <assimp/DefaultLogger.hpp>
#include <assimp/Logger.hpp>
#include <fmt/format.h>

namespace boxtree::cooker {
namespace {

// Parts of messages, as assimp 5 and 6 spell them, behind which geometry is lost or made up. Not
// among them, since files that are whole cause them, too: what is said of materials, texture
// coordinates, bones, lights and animations; faces of DXF without a fourth corner ("invalid vertex
// index"); openings of walls in IFC, which it cuts itself.
constexpr std::string_view kLosses[] = {
    // Vertices that are not there: the face is left out, or gets another one.
    "3DS: Vertex index overflow", "AC3D: Invalid vertex reference",
    "Bad triangle index",                        // B3D
    "Face has an invalid index",                 // ASE
    "Invalid vertex index in frame vertex",      // MDL
    "Invalid vertex index. It will be ignored",  // ASE
    "IRRMESH: Index out of range", "IRRMESH: Not enough indices", "IRRMESH: Number if indices",
    "IRRMESH: Too many indices", "Index overflow in MDL7 vertex list",
    "Index overflow in MDLn vertex list", "Index overflow in Q1-MDL vertex list",
    "Index overflow in frame area", "LWO2: Failure evaluating face record",
    "LWOB: face index is out of range", "MD2: Vertex index is outside",
    "MDC vertex index is out of range", "NFF2: Vertex index overflow",
    // Faces of which a part is missing, or that it cannot read.
    "3DS: Chunk overflow",
    "A line may have either 9 or 12 floats",  // RAW
    "AC3D: SURF token was expected", "AC3D: The type flag of a surface is unknown",
    "AC3D: Unexpected EOF", "AC3D: Unexpected token", "AC3D: surface her zero vertex references",
    "DXF: more than 4 indices per face", "DXF: not enough vertices for polymesh",
    "NFF: Encountered unsupported ID", "NFF: Unexpected", "SIB: Chunk overflow",
    "STEP: ignoring unexpected EOF",
    "Submesh <face> has quads",            // Ogre
    "Unable to parse *MESH_FACE Element",  // ASE
    "Unable to parse float",               // ASE
    "Unable to parse long",                // ASE
    "Unexpected EOF/EOL while parsing",    // SMD
    "expected comma, failed to parse",     // XGL
    "failed to read float text",           // XGL
    "failed to read index",                // XGL
    "no ID attribute on <p>",              // XGL
    "unexpected EOL, failed to parse",     // XGL
    // Meshes, and what places them.
    "Collada: Unable to find geometry", "Collada: Unable to resolve reference to instanced node",
    "Collada: Unresolved reference format of node", "Collada: just one vertex position stream",
    "DXF: BLOCK rotation not currently implemented", "DXF: Failed to resolve block reference",
    "DXF: INSERT within a BLOCK", "IRR: Can't load another IRR file",
    "IRR: Unable to load external file", "IRR: Unsupported node",
    "LWS: Failed to read external file", "TER: Unsupported mapping mode",
    "Unsupported RotationMode",                   // FBX
    "failed to convert source object for Model",  // FBX
    "failed to read source object for incoming",  // FBX
    "found negative scaling in <transform>",      // XGL
    "in <transform> are skewing",                 // XGL
    "in <transform> is zero",                     // XGL
};

// Such faces get the first material of their instance, or of the file.
constexpr std::string_view kGuessedMaterial = "Collada: No material specified for subgroup";

bool tells_of_loss(std::string_view message) {
  return std::any_of(std::begin(kLosses), std::end(kLosses), [message](std::string_view part) {
    return message.find(part) != std::string_view::npos;
  });
}

thread_local ReaderLog* listener = nullptr;

}  // namespace

// assimp's log, which hands what a thread says to whoever listens on it.
class ThreadLogger final : public Assimp::Logger {
 public:
  bool attachStream(Assimp::LogStream*, unsigned int) override { return false; }
  bool detachStream(Assimp::LogStream*, unsigned int) override { return false; }

 protected:
  void OnDebug(const char*) override {}
  void OnVerboseDebug(const char*) override {}
  void OnInfo(const char*) override {}
  void OnWarn(const char* message) override { hear(message, false); }
  void OnError(const char* message) override { hear(message, true); }

 private:
  static void hear(const char* message, bool is_error) {
    if (listener != nullptr) listener->hear(message, is_error);
  }
};

ReaderLog::ReaderLog() : outer_(listener) {
  static std::once_flag is_set;
  std::call_once(is_set, [] { Assimp::DefaultLogger::set(new ThreadLogger); });  // assimp's own now
  listener = this;
}

ReaderLog::~ReaderLog() {
  listener = outer_;
}

void ReaderLog::hear(const char* message, bool is_error) {
  // Of readers that say the same a hundred thousand times (Blender's), each is looked at once.
  if (!loss_.empty() || last_ == message) return;
  last_ = message;
  if (guessed_material_.empty() && last_.find(kGuessedMaterial) != std::string::npos) {
    guessed_material_ = last_;
  }
  if (tells_of_loss(last_)) {
    loss_ = last_error_.empty() ? last_ : fmt::format("{}: {}", last_error_, last_);
  }
  last_error_ = is_error ? last_ : std::string();
}

}  // namespace boxtree::cooker
