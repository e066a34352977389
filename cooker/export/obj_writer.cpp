// SPDX-License-Identifier: MIT
// Writes one tree or instance after another; vertices are numbered through the whole file, from 1.
#include "cooker/export/obj_writer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cooker/export/placed_shape.h"
#include "cooker/version.h"
#include "cooker/write/byte_sink.h"
#include "runtime/tree/bound_tree.h"

namespace boxtree::cooker {
namespace {

// A line end, and a backslash before one, would end the name early.
std::string object_name(std::string name) {
  const auto breaks = [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\\'; };
  std::replace_if(name.begin(), name.end(), breaks, '_');
  return name;
}

// Names of groups are single words, because a line may list several names.
std::string group_name(const std::string& object, const std::string& part) {
  std::string name = object_name(object + "_" + part);
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}

class ObjText {
 public:
  ObjText(bool solid_boxes, ByteSink& out) : solid_boxes_(solid_boxes), out_(out) {}

  void add(const ShownTree& tree) {
    is_f32_ = has_f32_positions(tree.tree);
    add_object(tree, tree.name);
  }

  void add(const ShownTree& tree, const ShownInstance& instance) {
    is_f32_ = false;
    to_world_.reset();
    if (!is_identity(instance.pose)) to_world_ = map_of(instance.pose);
    mirrors_ = mirrors(instance.pose);
    add_object(tree, instance.name);
  }

 private:
  void add_object(const ShownTree& shown, const std::string& name) {
    out_.print("o {}\n", object_name(name));
    if (shown.faces) {
      out_.print("g {}\n", group_name(name, "triangles"));
      add_faces(*shown.faces);
    }
    for (const BoxGroup& group : shown.boxes) {
      out_.print("g {}\n", group_name(name, group.name()));
      visit_group(shown.tree, group, [&](const Box<double>& box) {
        add_box(BoundTree::of(shown.tree).to_object(box));
      });
    }
  }

  void add_faces(const DecodedFaces& faces) {
    for (std::uint32_t v = 0; v < faces.vertex_count(); ++v) add_vertex(faces.position(v));
    for (std::uint32_t f = 0; f < faces.face_count(); ++f) {
      add_face(faces.face(f));
    }
    next_ += faces.vertex_count();
  }

  void add_face(const std::array<std::uint32_t, 4>& corner) {
    const std::size_t last = corner[3] == kMissingCorner ? 2 : 3;
    out_.print("f {}", next_ + corner[0]);
    for (std::size_t i = 1; i <= last; ++i) {
      out_.print(" {}", next_ + corner[mirrors_ ? last + 1 - i : i]);
    }
    out_.print("\n");
  }

  void add_box(const Eigen::AlignedBox3d& box) {
    for (unsigned corner = 0; corner < 8; ++corner) {
      Eigen::Vector3d position;
      for (int axis = 0; axis < 3; ++axis) {
        position[axis] =
            (corner >> axis & 1u) != 0 ? above(box.max()[axis]) : below(box.min()[axis]);
      }
      add_vertex(position);
    }
    if (solid_boxes_) {
      for (const auto& side : kBoxSides) add_face(side);
    } else {
      for (const auto& edge : kBoxEdges) {
        out_.print("l {} {}\n", next_ + edge[0], next_ + edge[1]);
      }
    }
    next_ += 8;
  }

  void add_vertex(const Eigen::Vector3d& object) {
    const Eigen::Vector3d p = to_world_ ? to_world_->apply(object) : object;
    if (is_f32_) {
      out_.print("v {} {} {}\n", f32_digits(static_cast<float>(p[0])),
                 f32_digits(static_cast<float>(p[1])), f32_digits(static_cast<float>(p[2])));
    } else {
      out_.print("v {} {} {}\n", p[0], p[1], p[2]);  // the fewest digits that give it back
    }
  }

  // Boxes around f32 positions are written as f32, too: any reader's conversion of digits keeps
  // their order. No finite position is beyond the largest finite number.
  [[nodiscard]] double below(double value) const {
    return is_f32_ ? f32_below(value) : std::max(value, std::numeric_limits<double>::lowest());
  }
  [[nodiscard]] double above(double value) const {
    return is_f32_ ? f32_above(value) : std::min(value, std::numeric_limits<double>::max());
  }

  bool solid_boxes_;
  ByteSink& out_;
  bool is_f32_ = false;
  bool mirrors_ = false;
  std::optional<AffineMap> to_world_;  // empty: points are unchanged, including signs of zeros
  std::uint64_t next_ = 1;             // number of the next vertex
};

}  // namespace

std::string f32_digits(float value) {
  // Nine significant digits distinguish all f32. From 1e-7 on they end within 15 decimals; up to
  // 1e15 an integer is exact in the 64 bits in which readers collect digits.
  constexpr int kDigits = 9;
  constexpr float kSmallestFixed = 1e-7f;
  constexpr float kLargestFixed = 1e15f;
  const float magnitude = std::abs(value);
  if (magnitude == 0) return std::signbit(value) ? "-0" : "0";
  if (magnitude < kSmallestFixed || magnitude > kLargestFixed) {
    return fmt::format("{:.{}e}", value, kDigits - 1);
  }
  const int exponent = static_cast<int>(std::floor(std::log10(double{magnitude})));
  const int decimals = std::clamp(kDigits - 1 - exponent, 0, 15);
  std::string digits = fmt::format("{:.{}f}", value, decimals);
  if (decimals > 0) {
    digits.erase(digits.find_last_not_of('0') + 1);
    if (digits.back() == '.') digits.pop_back();
  }
  return digits;
}

void write_obj(const Shown& shown, bool solid_boxes, ByteSink& out) {
  out.print("# boxtree {}\n", kVersion);
  ObjText text(solid_boxes, out);
  if (!shown.instances) {
    for (const ShownTree& tree : shown.trees) text.add(tree);
    return;
  }
  for (const ShownInstance& instance : *shown.instances) {
    text.add(shown.trees[instance.tree], instance);
  }
}

}  // namespace boxtree::cooker
