// SPDX-License-Identifier: MIT
// What the cases share.
#include "tests/stiff/cases.h"

#include <algorithm>

#include <fmt/format.h>

#include "format/codec.h"
#include "runtime/file/checksum.h"

namespace boxtree::stiff {

std::vector<Shape> all_shapes(const SourceMesh& mesh, const Store& store) {
  std::vector<Shape> shapes;
  for (const CodecInfo& codec : kCodecs) shapes.push_back(make_shape(mesh, codec.id, store));
  shapes.push_back(make_scan(mesh, store));
  return shapes;
}

std::size_t distinct(std::vector<std::uint64_t> values) {
  std::sort(values.begin(), values.end());
  return static_cast<std::size_t>(std::unique(values.begin(), values.end()) - values.begin());
}

std::uint64_t checksum_of(const std::vector<std::uint64_t>& values) {
  return checksum(std::as_bytes(std::span(values)));
}

std::string power_name(double value) {
  std::string name = fmt::format("{:.0e}", value);  // 1e+05
  name.erase(std::remove(name.begin(), name.end(), '+'), name.end());
  const std::size_t zeros = name.find("e0");
  if (zeros != std::string::npos) name.erase(zeros + 1, 1);
  return name;
}

}  // namespace boxtree::stiff
