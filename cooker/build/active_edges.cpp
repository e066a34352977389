// SPDX-License-Identifier: MIT
// Sides of faces are sorted by the smaller vertex of their edge, then those of each vertex by the
// larger one; what lies next to each other meets at an edge.
#include "cooker/build/active_edges.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "cooker/import/weld.h"
#include "runtime/primitive/normal.h"
#include "runtime/primitive/orientation.h"
#include "runtime/primitive/vector3.h"

namespace boxtree::cooker {
namespace {

std::size_t corner_count(const Face& face) {
  return face.is_quad() ? 4 : 3;
}

// Vertex numbers by position.
std::vector<std::uint32_t> welded_numbers(const Positions& positions) {
  std::vector<double> kept;
  Welder<double> welder(kept, positions.size());
  std::vector<std::uint32_t> numbers;
  numbers.reserve(positions.size());
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const Eigen::Vector3d p = positions[v];
    numbers.push_back(welder.add({p[0] + 0.0, p[1] + 0.0, p[2] + 0.0}));  // -0 + 0 is 0
  }
  return numbers;
}

// A face at an edge whose smaller vertex is known.
struct Side {
  std::uint32_t other;  // the larger vertex
  std::uint32_t face;
  std::uint8_t edge;
  bool is_reversed;  // the face goes from the larger vertex to the smaller
};

class ActiveEdgesFinder {
 public:
  // `edges`: of each face, those to look at; empty: all.
  ActiveEdgesFinder(const MeshView& mesh, double degrees, std::span<const std::uint8_t> edges)
      : mesh_(mesh),
        edges_(edges),
        angle_(EdgeAngle::of_degrees(degrees)),
        numbers_(welded_numbers(mesh.positions)) {
    found_.degrees = degrees;
    found_.of_face.resize(mesh.faces.size());
  }

  ActiveEdges run() {
    sort_sides();
    std::size_t first = 0;
    for (const std::size_t end : ends_) {
      const auto begin = sides_.begin() + static_cast<std::ptrdiff_t>(first);
      const auto past = sides_.begin() + static_cast<std::ptrdiff_t>(end);
      first = end;
      std::sort(begin, past, [](const Side& a, const Side& b) {
        return a.other != b.other ? a.other < b.other
                                  : FaceEdge{a.face, a.edge} < FaceEdge{b.face, b.edge};
      });
      for (auto side = begin; side != past;) {
        const auto next =
            std::find_if(side, past, [&](const Side& each) { return each.other != side->other; });
        visit({side, next});
        side = next;
      }
    }
    std::sort(found_.open.begin(), found_.open.end());
    return std::move(found_);
  }

 private:
  using Corners = std::array<std::uint32_t, 4>;

  // The vertices of a face, ascending.
  [[nodiscard]] Corners vertices_of(std::uint32_t face) const {
    const Face& corners = mesh_.faces[face];
    Corners out{kNoCorner, kNoCorner, kNoCorner, kNoCorner};
    for (std::size_t i = 0; i < corner_count(corners); ++i) {
      out[i] = numbers_[corners.corner[i]];
    }
    std::sort(out.begin(), out.end());
    return out;
  }

  // Calls visit(smaller vertex, side) for each side of each face that has an area.
  template <class Visit>
  void visit_sides(Visit visit) const {
    for (std::uint32_t f = 0; f < mesh_.faces.size(); ++f) {
      if (!has_area_[f]) continue;
      const Face& face = mesh_.faces[f];
      const std::size_t count = corner_count(face);
      for (std::size_t i = 0; i < count; ++i) {
        if (!edges_.empty() && (edges_[f] >> i & 1u) == 0) continue;
        const std::uint32_t a = numbers_[face.corner[i]];
        const std::uint32_t b = numbers_[face.corner[(i + 1) % count]];
        if (a == b) continue;  // of a quad
        visit(std::min(a, b), Side{std::max(a, b), f, static_cast<std::uint8_t>(i), a > b});
      }
    }
  }

  void sort_sides() {
    has_area_.reserve(mesh_.faces.size());
    for (std::uint32_t f = 0; f < mesh_.faces.size(); ++f) {
      has_area_.push_back(!side_of(mesh_, {f, 0}).normal.isZero(0));
      // Until a neighbour says otherwise.
      found_.of_face[f] = static_cast<std::uint8_t>((1u << corner_count(mesh_.faces[f])) - 1);
    }
    ends_.assign(mesh_.positions.size() + 1, 0);
    visit_sides([&](std::uint32_t vertex, const Side&) { ++ends_[vertex + 1]; });
    for (std::size_t v = 1; v < ends_.size(); ++v) ends_[v] += ends_[v - 1];
    sides_.resize(ends_.back());
    visit_sides([&](std::uint32_t vertex, const Side& side) { sides_[ends_[vertex]++] = side; });
    ends_.pop_back();
  }

  // Precondition: all sides of one edge.
  void visit(std::span<const Side> sides) {
    // What is one sheet: faces with the same vertices.
    std::vector<Corners>& sheets = sheets_;
    sheets.clear();
    sheet_of_.clear();
    for (const Side& side : sides) {
      const Corners vertices = vertices_of(side.face);
      const auto known = std::find(sheets.begin(), sheets.end(), vertices);
      sheet_of_.push_back(static_cast<std::size_t>(known - sheets.begin()));
      if (known == sheets.end()) sheets.push_back(vertices);
    }
    if (sheets.size() == 1) {
      for (const Side& side : sides) found_.open.push_back({side.face, side.edge});
    }
    if (sheets.size() != 2) return;
    std::size_t active = 0;
    for (std::size_t i = 0; i < sides.size(); ++i) {
      if (is_active(sides, i)) {
        ++active;
      } else {
        found_.of_face[sides[i].face] &= static_cast<std::uint8_t>(~(1u << sides[i].edge));
      }
    }
    found_.is_by_face |= active != 0 && active != sides.size();
  }

  // Of two sheets, side i next to the other one: to the layer with its front on the same side.
  [[nodiscard]] bool is_active(std::span<const Side> sides, std::size_t i) const {
    const Side* next = nullptr;
    for (std::size_t j = 0; j < sides.size(); ++j) {
      if (sheet_of_[j] == sheet_of_[i]) continue;
      if (next == nullptr || sides[j].is_reversed != sides[i].is_reversed) next = &sides[j];
    }
    return bends_away(side_of(mesh_, {sides[i].face, sides[i].edge}),
                      side_of(mesh_, {next->face, next->edge}),
                      next->is_reversed == sides[i].is_reversed, angle_);
  }

  const MeshView& mesh_;
  std::span<const std::uint8_t> edges_;
  EdgeAngle angle_;
  std::vector<std::uint32_t> numbers_;
  std::vector<bool> has_area_;
  std::vector<std::size_t> ends_;  // of the sides of each vertex
  std::vector<Side> sides_;
  std::vector<Corners> sheets_;
  std::vector<std::size_t> sheet_of_;
  ActiveEdges found_;
};

}  // namespace

// The series converge in double after 20 terms up to a right angle.
EdgeAngle EdgeAngle::of_degrees(double degrees) noexcept {
  if (degrees == 90) return {0, 1};
  const double x = degrees * (std::numbers::pi / 180);
  EdgeAngle angle{1, x};
  double term = x;
  for (int n = 2; n <= 40; ++n) {
    term = term * x / n;
    double& sum = n % 2 == 0 ? angle.cosine : angle.sine;
    sum = n / 2 % 2 == 0 ? sum + term : sum - term;
  }
  return angle;
}

EdgeSide side_of(const MeshView& mesh, const FaceEdge& edge) {
  const Face& face = mesh.faces[edge.face];
  const std::uint32_t count = static_cast<std::uint32_t>(corner_count(face));
  const auto corner = [&](std::uint32_t i) { return mesh.positions[face.corner[i % count]]; };
  EdgeSide side{corner(edge.edge), corner(edge.edge + 1), corner(edge.edge + 2), {}};
  if (count == 4 && edge.edge % 2 == 1)
    side.apex = corner(edge.edge + 3);  // halves (0,1,2), (0,2,3)
  side.normal = unit_normal({{side.from, side.to, side.apex}});
  if (count == 4 && side.normal.isZero(0)) {
    side.apex = corner(edge.edge + (edge.edge % 2 == 1 ? 2 : 3));
    side.normal = unit_normal({{side.from, side.to, side.apex}});
  }
  return side;
}

// With both angles between 0 and 180 degrees, the sine of their difference tells the larger one.
bool bends_away(const EdgeSide& face, const EdgeSide& next, bool is_turned,
                const EdgeAngle& angle) {
  const double facing = dot(face.normal, next.normal);
  const double cosine = is_turned ? -facing : facing;
  const int below = orient3d(face.from, face.to, face.apex, next.apex);
  if (below == 0) return cosine < 0;  // folded, not flat
  if (below < 0) return false;
  const double sine = std::sqrt(squared_length(cross(face.normal, next.normal)));
  return sine * angle.cosine - cosine * angle.sine > 0;
}

ActiveEdges find_active_edges(const MeshView& mesh, double degrees) {
  return ActiveEdgesFinder(mesh, degrees, {}).run();
}

ActiveEdges find_active_edges(const MeshView& mesh, double degrees,
                              std::span<const std::uint8_t> edges) {
  return ActiveEdgesFinder(mesh, degrees, edges).run();
}

}  // namespace boxtree::cooker
