// SPDX-License-Identifier: MIT
// Writes PLY and STL records through one buffer.
#include "tests/bench/mesh_files.h"

#include <bit>
#include <fstream>
#include <span>
#include <stdexcept>
#include <string>

namespace boxtree::bench {
namespace {

static_assert(std::endian::native == std::endian::little, "files are written as memory holds them");

constexpr std::size_t kFlushBytes = std::size_t{1} << 20;

class Output {
 public:
  explicit Output(const std::filesystem::path& path) : file_(path, std::ios::binary) {}

  template <class T>
  void put(const T& value) {
    buffer_.append(reinterpret_cast<const char*>(&value), sizeof(value));
    if (buffer_.size() >= kFlushBytes) flush();
  }
  void put_text(const std::string& text) { buffer_ += text; }

  void finish(const std::filesystem::path& path) {
    flush();
    file_.close();
    if (!file_) throw std::runtime_error(path.string() + ": cannot be written");
  }

 private:
  void flush() {
    file_.write(buffer_.data(), std::ssize(buffer_));
    buffer_.clear();
  }

  std::ofstream file_;
  std::string buffer_;
};

void put_ply(const cooker::SourceMesh& mesh, Output& out) {
  out.put_text("ply\nformat binary_little_endian 1.0\nelement vertex " +
               std::to_string(mesh.positions.size()) +
               "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
               std::to_string(mesh.faces.size()) +
               "\nproperty list uchar int vertex_indices\nend_header\n");
  for (const float coordinate : mesh.positions.f32) out.put(coordinate);
  for (const cooker::Face& face : mesh.faces) {
    out.put(std::uint8_t{3});
    for (const std::uint32_t corner : std::span(face.corner).first<3>()) out.put(corner);
  }
}

// Normals are zero, so readers compute them from the winding.
void put_stl(const cooker::SourceMesh& mesh, Output& out) {
  out.put_text(std::string(80, ' '));
  out.put(static_cast<std::uint32_t>(mesh.faces.size()));
  for (const cooker::Face& face : mesh.faces) {
    for (int axis = 0; axis < 3; ++axis) out.put(0.0f);
    for (const std::uint32_t corner : std::span(face.corner).first<3>()) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        out.put(mesh.positions.f32[std::size_t{3} * corner + axis]);
      }
    }
    out.put(std::uint16_t{0});
  }
}

}  // namespace

void write_mesh(const cooker::SourceMesh& mesh, const std::filesystem::path& path) {
  Output out(path);
  if (path.extension() == ".ply") {
    put_ply(mesh, out);
  } else if (path.extension() == ".stl") {
    put_stl(mesh, out);
  } else {
    throw std::runtime_error(path.string() + ": is neither .ply nor .stl");
  }
  out.finish(path);
}

}  // namespace boxtree::bench
