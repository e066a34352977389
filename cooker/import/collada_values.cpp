// SPDX-License-Identifier: MIT
// Visits sources and primitives in the order in which assimp reads them: a name means what was last
// read by that name.
#include "cooker/import/collada_values.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include <fmt/format.h>

#include "cooker/import/collada_nodes.h"
#include "cooker/import/collada_text.h"
#include "cooker/import/text_tokens.h"

namespace boxtree::cooker {
namespace {

// Of inputs; documents have less than ten. A vertex has so many words in <p>.
constexpr std::uint64_t kMaxInputOffset = 255;

// Counted for a word of <vcount>: more than a file can have, and no overflow in any sum.
constexpr std::uint64_t kMaxCorners = std::uint64_t{1} << 32;

// Of <lines>, whose count exporters state wrongly (SketchUp 15) and assimp reserves memory for.
constexpr std::uint64_t kMaxLinesBeyond = std::uint64_t{1} << 20;

// Attributes of a vertex that assimp reads; others it leaves out, together with their offset.
constexpr std::array<std::string_view, 9> kSemantics = {"POSITION",    "VERTEX",  "NORMAL",
                                                        "TEXCOORD",    "COLOR",   "BINORMAL",
                                                        "TEXBINORMAL", "TANGENT", "TEXTANGENT"};

// Names of params, and the component that assimp takes from there.
struct ParamName {
  std::string_view name;
  std::size_t component;
};
constexpr std::array kParamNames = {ParamName{"X", 0}, ParamName{"Y", 1}, ParamName{"Z", 2},
                                    ParamName{"R", 0}, ParamName{"G", 1}, ParamName{"B", 2},
                                    ParamName{"A", 3}, ParamName{"S", 0}, ParamName{"T", 1},
                                    ParamName{"P", 2}, ParamName{"U", 0}, ParamName{"V", 1}};

enum class PrimitiveKind : std::uint8_t {
  kTriangles,
  kPolylist,
  kPolygons,
  kTrifans,
  kTristrips,
  kLines,
  kLinestrips
};
constexpr std::array<std::string_view, 7> kPrimitiveNames = {
    "triangles", "polylist", "polygons", "trifans", "tristrips", "lines", "linestrips"};

std::optional<PrimitiveKind> primitive_kind(std::string_view name) {
  const auto found = std::find(kPrimitiveNames.begin(), kPrimitiveNames.end(), name);
  if (found == kPrimitiveNames.end()) return std::nullopt;
  return static_cast<PrimitiveKind>(found - kPrimitiveNames.begin());
}

struct Accessor {
  pugi::xml_node element;
  std::string array;
  std::array<std::uint64_t, 4> component{};  // where each is behind the first number
};

struct Input {
  std::string semantic, source;
  std::uint64_t offset = 0;
};

// Of a geometry.
struct Vertices {
  bool is_there = false;
  std::string id;
  std::vector<Input> inputs;
};

// Of a <triangles> or the like, as far as it is read.
struct Primitive {
  PrimitiveKind kind;
  std::uint64_t stated = 0;  // its count
  std::vector<Input> inputs;
  bool are_inputs_checked = false;
  std::uint64_t stride = 1, vertex_offset = 0, positions = 0;  // by its inputs
  std::uint64_t polygons = 0, corners = 0;                     // by <vcount>
  std::uint64_t parts = 0, vertices = 0;                       // of <p>
};

class ColladaChecker {
 public:
  explicit ColladaChecker(ColladaFaults& faults) : faults_(faults) {}

  bool check(pugi::xml_node collada) {
    std::unordered_set<std::string> ids;
    for (const pugi::xml_node part : collada.children()) {
      const std::string_view name = part.name();
      if (name == "library_geometries") {
        for (const pugi::xml_node geometry : part.children("geometry")) {
          if (!check_geometry(geometry, ids)) return false;
        }
      } else if (name == "library_controllers" || name == "library_animations") {
        for (const pugi::xml_node each : part.children("controller")) {
          ids.insert(each.attribute("id").as_string());
        }
        if (!check_sources(part)) return false;
      }
    }
    return check_nodes(collada, ids, faults_);
  }

 private:
  bool check_geometry(pugi::xml_node geometry, std::unordered_set<std::string>& ids) {
    const char* const id = geometry.attribute("id").as_string();
    of_geometry_ = fmt::format(" of geometry {}", in_quotes(id));
    ids.insert(id);
    if (!geometries_.insert(id).second) {
      faults_.enter(geometry);
      return faults_.fail("id", "one of its own, without which assimp leaves it out",
                          in_quotes(id) + " once more");
    }
    vertices_ = {};
    for (const pugi::xml_node mesh : geometry.children("mesh")) {
      pugi::xml_node element = next_element(mesh, mesh);
      for (; element; element = next_element(element, mesh)) {
        const std::string_view name = element.name();
        if (name == "source") {
          if (!check_source(element, true)) return false;
        } else if (name == "vertices") {
          if (!check_vertices(element)) return false;
        } else if (const auto kind = primitive_kind(name)) {
          if (!check_primitive(element, *kind)) return false;
        }
      }
    }
    return true;
  }

  bool check_sources(pugi::xml_node part) {
    of_geometry_.clear();
    for (pugi::xml_node element = next_element(part, part); element;
         element = next_element(element, part)) {
      if (std::string_view(element.name()) == "source" && !check_source(element, false))
        return false;
    }
    return true;
  }

  bool check_source(pugi::xml_node source, bool is_of_mesh) {
    for (pugi::xml_node element = next_element(source, source); element;
         element = next_element(element, source)) {
      const std::string_view name = element.name();
      faults_.enter(element, of_geometry_);
      if (name == "source") return faults_.fail("", "none within another source", "one");
      if (name == "float_array" || name == "IDREF_array" || name == "Name_array") {
        if (!check_array(element, is_of_mesh)) return false;
      } else if (name == "technique_common") {
        const pugi::xml_node accessor = element.child("accessor");
        if (accessor && !take_accessor(accessor, source.attribute("id").as_string())) return false;
      }
    }
    return true;
  }

  // Elsewhere than in meshes, where numbers are none of geometry, that its count is not too large.
  bool check_array(pugi::xml_node array, bool is_of_mesh) {
    const bool is_of_numbers = std::string_view(array.name()) == "float_array";
    const bool is_exact = is_of_mesh && is_of_numbers;
    std::uint64_t count = 0, words = 0;
    std::string_view text;
    if (!faults_.whole(array, "count", is_exact ? std::nullopt : std::optional<std::uint64_t>(0),
                       count) ||
        !faults_.text(array, text)) {
      return false;
    }
    const bool are_numbers = each_word(text, [&](std::string_view word) {
      ++words;
      return !is_exact || collada_number(word) ||
             faults_.fail("", "numbers, of at most 19 digits before the point", in_quotes(word));
    });
    if (!are_numbers) return false;
    if (is_exact ? count != words : count > words) {
      return faults_.fail("count", fmt::format("{}, as its text has", words),
                          std::to_string(count));
    }
    arrays_[array.attribute("id").as_string()] = is_of_numbers ? count : 0;
    return true;
  }

  bool take_accessor(pugi::xml_node element, const char* source) {
    faults_.enter(element, of_geometry_);
    Accessor& accessor = accessors_[source] = {element, {}, {}};
    if (!faults_.reference(element, "source", accessor.array)) return false;
    std::uint64_t params = 0;
    for (pugi::xml_node each = next_element(element, element); each;
         each = next_element(each, element)) {
      if (std::string_view(each.name()) != "param") continue;
      const std::string_view name = each.attribute("name").as_string();
      for (const ParamName& known : kParamNames) {
        if (name == known.name) accessor.component[known.component] = params;
      }
      ++params;
    }
    return true;
  }

  bool check_vertices(pugi::xml_node element) {
    faults_.enter(element, of_geometry_);
    vertices_.is_there = true;
    vertices_.id = element.attribute("id").as_string();
    for (const pugi::xml_node input : element.children("input")) {
      if (!take_input(input, vertices_.inputs)) return false;
    }
    const auto positions =
        std::count_if(vertices_.inputs.begin(), vertices_.inputs.end(), is_position);
    return positions == 1 || faults_.fail("input", "one POSITION", std::to_string(positions));
  }
  static bool is_position(const Input& input) { return input.semantic == "POSITION"; }

  bool take_input(pugi::xml_node element, std::vector<Input>& inputs) {
    Input input{element.attribute("semantic").as_string(), {}, 0};
    if (!faults_.reference(element, "source", input.source) ||
        !faults_.whole(element, "offset", 0, input.offset)) {
      return false;
    }
    if (input.offset > kMaxInputOffset) {
      return faults_.fail("input: offset", fmt::format("at most {}", kMaxInputOffset),
                          std::to_string(input.offset));
    }
    inputs.push_back(std::move(input));
    return true;
  }

  bool check_primitive(pugi::xml_node element, PrimitiveKind kind) {
    enter_primitive(element);
    Primitive primitive{.kind = kind};
    if (!faults_.whole(element, "count", std::nullopt, primitive.stated)) return false;
    for (pugi::xml_node each = next_element(element, element); each;
         each = next_element(each, element)) {
      const std::string_view name = each.name();
      if (name == "input") {
        primitive.are_inputs_checked = false;
        if (!take_input(each, primitive.inputs)) return false;
      } else if (name == "ph") {
        return faults_.fail("ph", "none, since assimp's reader has no holes",
                            "one; export triangles");
      } else if (name == "vcount") {
        if (!check_vcount(each, primitive)) return false;
      } else if (name == "p") {
        if (!primitive.are_inputs_checked && !check_inputs(element, primitive)) return false;
        if (!check_indices(each, primitive)) return false;
      }
    }
    return check_count(primitive);
  }

  void enter_primitive(pugi::xml_node element) { faults_.enter(element, of_geometry_); }

  // Assimp reads as many words as the count says; those of a polylist are used.
  bool check_vcount(pugi::xml_node vcount, Primitive& primitive) {
    std::string_view text;
    if (!faults_.text(vcount, text)) return false;
    const bool are_whole = each_word(text, [&](std::string_view word) {
      const std::optional<std::uint64_t> corners = read_count(word);
      if (!corners) return faults_.fail("vcount", "whole numbers", in_quotes(word));
      ++primitive.polygons;
      primitive.corners += std::min(*corners, kMaxCorners);
      return true;
    });
    if (!are_whole) return false;
    return primitive.polygons == primitive.stated ||
           faults_.fail("count", fmt::format("{}, as <vcount> has", primitive.polygons),
                        std::to_string(primitive.stated));
  }

  // Those before a <p>, which assimp reads it by.
  bool check_inputs(pugi::xml_node element, Primitive& primitive) {
    primitive.are_inputs_checked = true;
    const Input* vertex = nullptr;
    const Input* last = nullptr;
    std::uint64_t stride_read = 1;
    for (const Input& input : primitive.inputs) {
      const bool is_read =
          std::find(kSemantics.begin(), kSemantics.end(), input.semantic) != kSemantics.end();
      if (is_read) stride_read = std::max(stride_read, input.offset + 1);
      if (last == nullptr || input.offset >= last->offset) last = &input;
      if (input.semantic == "VERTEX") {
        if (vertex != nullptr) return faults_.fail("input", "one VERTEX", "more");
        vertex = &input;
      }
      if (is_position(input)) return faults_.fail("input", "POSITION in <vertices>", "it here");
    }
    if (vertex == nullptr) return faults_.fail("input", "one VERTEX", "none");
    primitive.stride = last->offset + 1;
    primitive.vertex_offset = vertex->offset;
    if (primitive.stride != stride_read) {
      return faults_.fail("input", "semantics at the last offset that assimp reads, as NORMAL",
                          in_quotes(last->semantic));
    }
    if (!vertices_.is_there || vertex->source != vertices_.id) {
      return faults_.fail(
          "input: source",
          vertices_.is_there ? fmt::format("<vertices> {}", in_quotes(vertices_.id)) : "<vertices>",
          in_quotes(vertex->source));
    }
    for (const auto* inputs : {&vertices_.inputs, &primitive.inputs}) {
      for (const Input& input : *inputs) {
        enter_primitive(element);
        if (input.semantic != "VERTEX" && !check_accessor(input, primitive.positions)) return false;
      }
    }
    enter_primitive(element);
    return true;
  }

  // Sets the `positions` if it is of them.
  bool check_accessor(const Input& input, std::uint64_t& positions) {
    if (std::find(kSemantics.begin(), kSemantics.end(), input.semantic) == kSemantics.end())
      return true;
    const auto found = accessors_.find(input.source);
    if (found == accessors_.end()) {
      return faults_.fail(fmt::format("{}: source", input.semantic),
                          "the id of a source with an accessor", in_quotes(input.source));
    }
    const Accessor& accessor = found->second;
    faults_.enter(accessor.element, of_geometry_);
    const auto array = arrays_.find(accessor.array);
    if (array == arrays_.end()) {
      return faults_.fail("source", "the id of a float_array", in_quotes(accessor.array));
    }
    std::uint64_t count = 0, offset = 0, stride = 0;
    if (!(faults_.whole(accessor.element, "count", std::nullopt, count) &&
          faults_.whole(accessor.element, "offset", 0, offset) &&
          faults_.whole(accessor.element, "stride", 1, stride))) {
      return false;
    }
    if (is_position(input)) {
      positions = count;
      if (stride < 3) return faults_.fail("stride", "3 or more", std::to_string(stride));
      const auto& [x, y, z, w] = accessor.component;
      if (x == y || y == z || z == x) {
        return faults_.fail("param", "X, Y and Z, from which assimp takes positions", "others");
      }
    }
    const std::uint64_t size =
        *std::max_element(accessor.component.begin(), accessor.component.end()) + 1;
    const std::uint64_t numbers = array->second;
    const bool fits =
        count == 0 || (size <= numbers && offset <= numbers - size &&
                       (stride == 0 || count - 1 <= (numbers - size - offset) / stride));
    return fits || faults_.fail("count",
                                fmt::format("no more than the {} numbers of array {} hold, with "
                                            "offset {} and stride {}",
                                            numbers, in_quotes(accessor.array), offset, stride),
                                std::to_string(count));
  }

  bool check_indices(pugi::xml_node p, Primitive& primitive) {
    std::string_view text;
    if (!faults_.text(p, text)) return false;
    std::uint64_t slot = 0, vertices = 0;
    const bool are_indices = each_word(text, [&](std::string_view word) {
      const std::optional<std::int64_t> index = read_integer(word);
      if (!index) return faults_.fail(p.name(), "whole numbers", in_quotes(word));
      if (slot == primitive.vertex_offset &&
          (*index < 0 || static_cast<std::uint64_t>(*index) >= primitive.positions)) {
        return faults_.fail(p.name(),
                            fmt::format("indices of the {} vertices", primitive.positions),
                            std::to_string(*index), Errc::kMeshIndexOutOfRange);
      }
      if (++slot == primitive.stride) {
        slot = 0;
        ++vertices;
      }
      return true;
    });
    if (!are_indices) return false;
    if (slot != 0) {
      return faults_.fail(p.name(), fmt::format("{} numbers for each vertex", primitive.stride),
                          fmt::format("{} for the last", slot));
    }
    ++primitive.parts;
    primitive.vertices += vertices;
    return check_part(vertices, primitive);
  }

  // What one <p> has to have.
  bool check_part(std::uint64_t vertices, const Primitive& primitive) {
    switch (primitive.kind) {
      case PrimitiveKind::kTrifans:
        if (vertices > 3) {
          return faults_.fail("p", "at most 3 vertices, as assimp takes a fan for a polygon",
                              fmt::format("{}; export triangles", vertices));
        }
        break;
      case PrimitiveKind::kTristrips:  // assimp subtracts 2
      case PrimitiveKind::kLinestrips:
        if (vertices < 2) return faults_.fail("p", "2 or more vertices", std::to_string(vertices));
        break;
      case PrimitiveKind::kPolylist:
        if (primitive.polygons != primitive.stated) {
          return faults_.fail("count", "as many as <vcount> has before <p>",
                              std::to_string(primitive.stated));
        }
        break;
      default:
        break;
    }
    return true;
  }

  // What all <p> together have to have.
  bool check_count(const Primitive& primitive) {
    const std::uint64_t stated = primitive.stated, vertices = primitive.vertices;
    const auto wrong = [&](std::string_view expected) {
      return faults_.fail("count", expected, std::to_string(stated));
    };
    switch (primitive.kind) {
      case PrimitiveKind::kTriangles:
        return (vertices % 3 == 0 && vertices / 3 == stated) ||
               wrong(fmt::format("a third of the {} vertices in <p>", vertices));
      case PrimitiveKind::kPolylist:
        return vertices == primitive.corners ||
               faults_.fail("vcount", fmt::format("{} corners in all, as in <p>", vertices),
                            std::to_string(primitive.corners));
      case PrimitiveKind::kPolygons:
        return primitive.parts == stated ||
               wrong(fmt::format("{}, one for each <p>", primitive.parts));
      case PrimitiveKind::kLines:
        return stated <= vertices + kMaxLinesBeyond ||
               wrong(fmt::format("half of the {} vertices in <p>", vertices));
      default:
        return stated > 0 || vertices == 0 ||
               wrong(fmt::format("1 or more for the {} vertices in <p>", vertices));
    }
  }

  ColladaFaults& faults_;
  std::unordered_set<std::string> geometries_;
  std::string of_geometry_;                                // for messages
  std::unordered_map<std::string, std::uint64_t> arrays_;  // how many numbers
  std::unordered_map<std::string, Accessor> accessors_;    // by the id of their source
  Vertices vertices_;
};

bool is_too_deep(pugi::xml_node document) {
  int depth = 0;
  pugi::xml_node node = document;
  while (true) {
    if (const pugi::xml_node child = node.first_child()) {
      if (++depth > kMaxXmlDepth) return true;
      node = child;
      continue;
    }
    while (node != document && !node.next_sibling()) {
      node = node.parent();
      --depth;
    }
    if (node == document) return false;
    node = node.next_sibling();
  }
}

}  // namespace

Status check_collada(std::string_view file) {
  // Assimp reads as far, with these options.
  const std::string_view text = file.substr(0, file.find('\0'));
  pugi::xml_document document;
  const pugi::xml_parse_result parsed =
      document.load_buffer(text.data(), text.size(), pugi::parse_full, pugi::encoding_utf8);
  if (!parsed) {
    const auto at = static_cast<std::size_t>(std::max<std::ptrdiff_t>(parsed.offset, 0));
    const std::string_view before = text.substr(0, std::min(at, text.size()));
    return Error{Errc::kImportFailed,
                 fmt::format("its XML is broken in line {}, at byte {} of {}: {}",
                             std::count(before.begin(), before.end(), '\n') + 1, before.size(),
                             file.size(), parsed.description())};
  }
  if (is_too_deep(document)) {
    return Error{Errc::kImportFailed,
                 fmt::format("XML elements nest more than {} deep", kMaxXmlDepth)};
  }
  ColladaFaults faults(text);
  ColladaChecker(faults).check(document.child("COLLADA"));
  return faults.status();
}

}  // namespace boxtree::cooker
