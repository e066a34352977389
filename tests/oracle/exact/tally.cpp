// SPDX-License-Identifier: MIT
// Cases in words and hexadecimal numbers.
#include "tests/oracle/exact/tally.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

namespace boxtree::oracle {
namespace {

bool prints_whole_meshes = false;

}  // namespace

void print_whole_meshes(bool whole) {
  prints_whole_meshes = whole;
}

std::string text(double x) {
  return fmt::format("{:a}", x);
}
std::string text(const Point& p) {
  return fmt::format("{{{:a}, {:a}, {:a}}}", p[0], p[1], p[2]);
}
std::string text(const Face& t) {
  return fmt::format("{{{}, {}, {}}}", text(t[0]), text(t[1]), text(t[2]));
}
std::string text(const Pose& pose) {
  std::string rows;
  for (Eigen::Index i = 0; i < 3; ++i) {
    rows += fmt::format("{}{{{:a}, {:a}, {:a}, {:a}}}", i == 0 ? "" : ", ", pose.linear()(i, 0),
                        pose.linear()(i, 1), pose.linear()(i, 2), pose.translation()[i]);
  }
  return fmt::format("{{{}}}", rows);
}

std::string text(const cooker::SourceMesh& mesh, const std::vector<std::uint32_t>& faces) {
  const std::size_t few = prints_whole_meshes ? mesh.faces.size() : 12;
  std::vector<std::uint32_t> shown = faces;
  if (mesh.faces.size() <= few) {
    shown.resize(mesh.faces.size());
    std::iota(shown.begin(), shown.end(), 0u);
  }
  std::sort(shown.begin(), shown.end());
  shown.erase(std::unique(shown.begin(), shown.end()), shown.end());
  if (shown.size() > few) shown.resize(few);
  std::string all = fmt::format("{} of {} faces", mesh.name, mesh.faces.size());
  for (const std::uint32_t f : shown) {
    all += fmt::format("\n      face {}:", f);
    for (const std::uint32_t c : mesh.faces[f].corner) {
      if (c == cooker::kNoCorner) continue;
      const Eigen::Vector3d p = mesh.positions[c];
      all += fmt::format(" {}", text(Point{p[0], p[1], p[2]}));
    }
  }
  return all;
}

}  // namespace boxtree::oracle
