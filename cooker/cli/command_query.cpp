// SPDX-License-Identifier: MIT
// `boxtree query`: asks one tree of a mapped file, or two trees against each other.
#include <charconv>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include <boxtree/cooker/cli/output.h>
#include <boxtree/runtime/boxtree.h>

namespace boxtree::cooker {
namespace {

struct Arguments {
  std::filesystem::path file;
  std::string tree = "0";
  bool json = false;
  VectorOption origin, direction, low, high, center, at;
  double radius = 0;
  double max_distance = std::numeric_limits<double>::infinity();
  double t_max = std::numeric_limits<double>::infinity();
  bool any = false;
  std::filesystem::path second_file;
  std::string second_tree = "0";
  std::string pose;
  bool first_only = false;
};

// A file and one of its trees, chosen by number or by name.
struct Opened {
  File file;
  Tree tree;
};

Result<Opened> open_tree(const std::filesystem::path& path, const std::string& which) {
  Result<File> file = File::open(path);
  if (!file) return file.error();
  std::uint32_t index = 0;
  const auto [end, error] = std::from_chars(which.data(), which.data() + which.size(), index);
  if (error != std::errc() || end != which.data() + which.size()) {
    const Result<std::uint32_t> found = file->find_tree(which);
    if (!found) return found.error();
    index = *found;
  }
  Result<Tree> tree = Tree::bind(*file, index);
  if (!tree) return tree.error();
  return Opened{std::move(*file), std::move(*tree)};
}

Json vector_json(const Eigen::Vector3d& v) {
  return {v[0], v[1], v[2]};
}

Json face_json(const FaceRef& face) {
  return face.id == kNoFaceId ? Json(nullptr) : Json(face.id);
}

int answer(const Arguments& arguments, const Json& json) {
  if (arguments.json) {
    print(json);
  } else {
    for (const auto& [key, value] : json.items()) fmt::print("{}: {}\n", key, value.dump());
  }
  return 0;
}

int ask_ray(const Arguments& arguments) {
  const Result<Opened> opened = open_tree(arguments.file, arguments.tree);
  if (!opened) return fail(opened.error());
  const Ray ray{arguments.origin.value, arguments.direction.value, 0, arguments.t_max};
  const auto hit = arguments.any ? any_hit(opened->tree, ray) : closest_hit(opened->tree, ray);
  if (!hit) return fail(hit.error());
  Json json = {{"hit", hit->has_value()}};
  if (*hit) {
    const RayHit& found = **hit;
    json["t"] = found.t;
    json["face"] = face_json(found.face);
    json["triangle"] = found.triangle;
    json["point"] = vector_json(ray.origin + found.t * ray.direction);
    json["barycentric"] = {1 - found.u - found.v, found.u, found.v};
  }
  return answer(arguments, json);
}

template <class Ask>
int ask_faces(const Arguments& arguments, Ask ask) {
  const Result<Opened> opened = open_tree(arguments.file, arguments.tree);
  if (!opened) return fail(opened.error());
  Json faces = Json::array();
  std::size_t count = 0;
  const Result<Visit> visit = ask(opened->tree, [&](const FaceRef& face) {
    ++count;
    faces.push_back(face_json(face));
    return true;
  });
  if (!visit) return fail(visit.error());
  return answer(arguments, {{"count", count}, {"faces", faces}});
}

int ask_point(const Arguments& arguments) {
  const Result<Opened> opened = open_tree(arguments.file, arguments.tree);
  if (!opened) return fail(opened.error());
  const auto closest = closest_point(opened->tree, arguments.at.value, arguments.max_distance);
  if (!closest) return fail(closest.error());
  Json json = {{"found", closest->has_value()}};
  if (*closest) {
    json["distance"] = (*closest)->distance;
    json["point"] = vector_json((*closest)->point);
    json["face"] = face_json((*closest)->face);
    json["triangle"] = (*closest)->triangle;
  }
  return answer(arguments, json);
}

// A translation "X,Y,Z" or the first three rows of a matrix, row by row: 12 numbers.
std::optional<Pose> parse_pose(const std::string& text) {
  std::array<double, 12> number{};
  std::size_t count = 0;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (true) {
    if (count == number.size()) return std::nullopt;
    const auto [next, error] = std::from_chars(at, end, number[count++]);
    if (error != std::errc()) return std::nullopt;
    at = next;
    if (at == end) break;
    if (*at++ != ',') return std::nullopt;
  }
  Pose pose = Pose::Identity();
  if (count == 3) {
    pose.translation() = Eigen::Vector3d(number[0], number[1], number[2]);
    return pose;
  }
  if (count != 12) return std::nullopt;
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < 4; ++column) {
      pose.matrix()(row, column) = number[static_cast<std::size_t>(4 * row + column)];
    }
  }
  return pose;
}

int ask_pair(const Arguments& arguments) {
  const std::optional<Pose> pose =
      arguments.pose.empty() ? Pose(Pose::Identity()) : parse_pose(arguments.pose);
  if (!pose) {
    fmt::print(stderr, "boxtree: --pose: expected X,Y,Z or 12 numbers, found \"{}\"\n",
               arguments.pose);
    return kExitUsage;
  }
  const Result<Opened> first = open_tree(arguments.file, arguments.tree);
  if (!first) return fail(first.error());
  const Result<Opened> second = open_tree(arguments.second_file, arguments.second_tree);
  if (!second) return fail(second.error());
  Json pairs = Json::array();
  std::size_t count = 0;
  const Result<Visit> visit =
      overlap_pairs(first->tree, Pose::Identity(), second->tree, *pose, [&](const FacePair& pair) {
        ++count;
        pairs.push_back({face_json(pair.first), face_json(pair.second)});
        return !arguments.first_only;
      });
  if (!visit) return fail(visit.error());
  return answer(arguments, {{"hit", count > 0}, {"count", count}, {"pairs", pairs}});
}

void add_kinds(CLI::App& query, const std::shared_ptr<Arguments>& arguments, int& status) {
  CLI::App& ray = *query.add_subcommand("ray", "Closest hit of a ray");
  arguments->origin.add_to(ray, "--origin", "Where it starts", true);
  arguments->direction.add_to(ray, "--direction", "Where it goes; t counts in its length", true);
  ray.add_option("--t-max", arguments->t_max, "Where it ends");
  ray.add_flag("--any", arguments->any, "Any hit, not the closest");
  ray.callback([arguments, &status] { status = ask_ray(*arguments); });

  CLI::App& box = *query.add_subcommand("box", "Faces that touch an axis-aligned box");
  arguments->low.add_to(box, "--min", "Lower corner", true);
  arguments->high.add_to(box, "--max", "Upper corner", true);
  box.callback([arguments, &status] {
    status = ask_faces(*arguments, [&](const Tree& tree, FaceVisitor visitor) {
      return overlap_box(tree, {arguments->low.value, arguments->high.value}, visitor);
    });
  });

  CLI::App& sphere = *query.add_subcommand("sphere", "Faces within a radius of a point");
  arguments->center.add_to(sphere, "--center", "The point", true);
  sphere.add_option("--radius", arguments->radius, "The radius")->required();
  sphere.callback([arguments, &status] {
    status = ask_faces(*arguments, [&](const Tree& tree, FaceVisitor visitor) {
      return overlap_sphere(tree, arguments->center.value, arguments->radius, visitor);
    });
  });

  CLI::App& point = *query.add_subcommand("point", "Closest point of the surface");
  arguments->at.add_to(point, "--at", "The point", true);
  point.add_option("--max-distance", arguments->max_distance, "Look no farther");
  point.callback([arguments, &status] { status = ask_point(*arguments); });

  CLI::App& pair = *query.add_subcommand("pair", "Pairs of faces of two trees that touch");
  pair.add_option("file2", arguments->second_file, "The second .bxt file")->required();
  pair.add_option("--tree2", arguments->second_tree, "Its tree, by number or name");
  pair.add_option("--pose", arguments->pose,
                  "Pose of the second tree: X,Y,Z or the 12 numbers of a 3x4 matrix, row by row");
  pair.add_flag("--first", arguments->first_only, "Stop at the first contact");
  pair.callback([arguments, &status] { status = ask_pair(*arguments); });
}

}  // namespace

void add_query_command(CLI::App& app, int& status) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App& command = *app.add_subcommand("query", "Ask a .bxt file");
  command.add_option("file", arguments->file, "A .bxt file")->required();
  command.add_option("--tree", arguments->tree, "Which tree, by number or name");
  command.add_flag("--json", arguments->json, "Print one JSON document");
  command.require_subcommand(1);
  command.fallthrough();
  add_kinds(command, arguments, status);
}

}  // namespace boxtree::cooker
