// SPDX-License-Identifier: MIT
// Recommendations are minima over the points; their texts use the same figures.
#include "cooker/report/tradeoff_advice.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "cooker/quantise/grid.h"
#include "cooker/report/shell_word.h"
#include "cooker/system/path.h"
#include "cooker/text/at_most.h"

namespace boxtree::cooker {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

bool has_disturbed_times(const MeshTradeoff& mesh) {
  return mesh.timed && mesh.timed_work.is_disturbed();
}

// The point of wide8 with arrays; null if there is none.
const TradePoint* baseline_of(const MeshTradeoff& mesh) {
  const auto found =
      std::find_if(mesh.points.begin(), mesh.points.end(), [](const TradePoint& point) {
        return point.codec == CodecId::kWide8 && point.geometry == GeometryId::kArrays;
      });
  return found == mesh.points.end() ? nullptr : &*found;
}

// Whether cook takes arrays for the fewest bytes: clusters with the same nodes take more.
bool has_smaller_arrays(const MeshTradeoff& mesh, const TradePoint& clusters) {
  const auto geometry_bytes = [](const TradePoint& point) {
    return point.bytes.vertices + point.bytes.corners;
  };
  return std::any_of(mesh.points.begin(), mesh.points.end(), [&](const TradePoint& other) {
    return other.codec == clusters.codec && other.geometry == GeometryId::kArrays &&
           other.gates.pass() && geometry_bytes(other) < geometry_bytes(clusters);
  });
}

// The point that may be advised with the least score, of several the one that is least slow; empty
// if all scores are infinite.
std::optional<std::size_t> least(const std::vector<bool>& may_be_advised,
                                 const std::vector<double>& slower,
                                 const std::function<double(std::size_t)>& score) {
  std::optional<std::size_t> best;
  std::pair best_score{kInfinite, kInfinite};
  for (std::size_t i = 0; i < may_be_advised.size(); ++i) {
    if (!may_be_advised[i]) continue;
    const std::pair of_point{score(i), slower[i]};
    if (of_point.first < kInfinite && of_point < best_score) {
      best = i;
      best_score = of_point;
    }
  }
  return best;
}

// Whether cook tries a grid unless told one: that of a tolerance, else one of 24 bits, which --f64
// forbids.
bool is_cooks_grid(const MeshTradeoff& mesh, const TradePoint& point) {
  if (mesh.tolerance) return point.tolerance.has_value();
  return !mesh.is_f64 && point.grid_bits == GridChoice().bits;
}

}  // namespace

const char* contacts_name(const MeshTradeoff& mesh) {
  return mesh.timed ? "all contacts" : "shallow contacts";
}

namespace {

PageConclusion told(const MeshTradeoff& mesh, std::size_t place, const std::string& role,
                    double slowdown) {
  const TradePoint& point = mesh.points[place];
  const std::uint64_t bytes = point.bytes.total();
  const std::string surface = point.surface_max == 0
                                  ? fmt::format("No position changes by a single bit{}.",
                                                mesh.moved_by_f32 > 0 ? " of f32" : "")
                                  : fmt::format("No point of the surface moves by more than {}.",
                                                move_in_words(mesh, point.surface_max));
  const auto time = [&](std::size_t kind) {
    return time_in_words(mesh, mean_time_of(mesh, point, kind));
  };
  std::string times = fmt::format("a ray takes {}, a box {}, a closest point {}, {} {}", time(0),
                                  time(1), time(2), contacts_name(mesh), time(3));
  if (mesh.timed) {
    const auto rare = [&](std::size_t kind) {
      return time_in_words(mesh, point.times[kind].p99_ns);
    };
    times = fmt::format("In the mean {} (one in a hundred takes longer than {}, {}, {} and {}).",
                        times, rare(0), rare(1), rare(2), rare(3));
  } else {
    times = "By its counted work, in the mean " + times + ".";
  }
  return {
      role + ": " + point.name() + ".",
      fmt::format("{:.2f} bytes per triangle, a file of {} bytes, tree included: {:.0f} % of "
                  "what positions and corners of the source alone take; {:.2f} with geometry and "
                  "without face ids, as cook counts. {} {} "
                  "Slowdown: {:.2f}.",
                  mesh.per_triangle(bytes), bytes,
                  100.0 * static_cast<double>(bytes) / static_cast<double>(mesh.source.total()),
                  mesh.per_triangle(point.bytes.queried()), surface, times, slowdown),
      cook_command(mesh, point)};
}

// What an encoding is best in, and among which.
struct Role {
  std::string best;
  std::string among;
  std::size_t place;  // in MeshTradeoff::points
  bool is_exact = false;
};

// "Balanced, and also the fastest and smallest with every position bit for bit". Exact roles are
// the last. What keeps every bit needs no limit of how far the surface moves but one that was
// stated, and where it is the smallest of all, that says it.
std::string name_of(std::vector<Role> roles, bool has_tolerance) {
  const Role last = roles.back();
  std::string as_well;
  if (last.is_exact) {
    const auto first_exact = std::find_if(roles.begin(), roles.end(), std::mem_fn(&Role::is_exact));
    if (!has_tolerance) {
      for (auto role = roles.begin(); role != first_exact; ++role) role->among.clear();
    }
    const bool is_best_of_all = std::any_of(
        roles.begin(), first_exact, [&](const Role& role) { return role.best == last.best; });
    if (is_best_of_all) roles.pop_back();
    if (!roles.back().is_exact) as_well = "," + last.among;
  }
  std::string name;
  for (std::size_t i = 0; i < roles.size(); ++i) {
    if (i > 0) name += roles[i].among == roles[i - 1].among ? " and " : ", and also the ";
    name += roles[i].best;
    if (roles.size() == 1 && roles[i].best == "balanced") name += ", for most uses";
    if (i + 1 == roles.size() || roles[i + 1].among != roles[i].among) name += roles[i].among;
  }
  name[0] = static_cast<char>(name[0] - 'a' + 'A');  // in any locale
  return name + as_well;
}

}  // namespace

double mean_time_of(const MeshTradeoff& mesh, const TradePoint& point, std::size_t kind) {
  return mesh.timed ? point.times[kind].mean_ns : point.modelled[kind];
}

bool goes_by_work(const MeshTradeoff& mesh) {
  return !mesh.timed || has_disturbed_times(mesh);
}

std::vector<double> slowdowns_of(const MeshTradeoff& mesh) {
  const TradePoint* const baseline = baseline_of(mesh);
  const bool is_by_work = goes_by_work(mesh);
  const auto time_of = [&](const TradePoint& point, std::size_t kind) {
    return is_by_work ? point.modelled[kind] : point.times[kind].mean_ns;
  };
  std::vector<double> slower;
  for (const TradePoint& point : mesh.points) {
    double sum = 0;
    for (std::size_t kind = 0; kind < kQueryKinds; ++kind) {
      const double time = time_of(point, kind);
      const double base = baseline == nullptr ? 0 : time_of(*baseline, kind);
      sum += time > 0 && base > 0 ? time / base : 1;  // else below the clock's resolution
    }
    slower.push_back(sum / kQueryKinds);
  }
  return slower;
}

std::vector<bool> may_be_advised(const MeshTradeoff& mesh) {
  const auto passes_wide = [](const TradePoint& point) {
    return point.gates.pass() && is_wide(point.codec);
  };
  const bool any_wide = std::any_of(mesh.points.begin(), mesh.points.end(), passes_wide);
  std::vector<bool> may;
  for (const TradePoint& point : mesh.points) {
    const bool is_read = any_wide ? passes_wide(point) : point.gates.pass();
    may.push_back(is_read &&
                  !(point.geometry == GeometryId::kExact && has_smaller_arrays(mesh, point)));
  }
  return may;
}

std::optional<Advice> advise(const MeshTradeoff& mesh) {
  const std::vector<double> slower = slowdowns_of(mesh);
  const std::vector<bool> may = may_be_advised(mesh);
  const auto bytes = [&](std::size_t i) {
    return static_cast<double>(mesh.points[i].bytes.total());
  };
  const auto moved = [&](std::size_t i) { return mesh.points[i].surface_max; };
  const auto is_exact = [&](std::size_t i) { return is_lossless(mesh.points[i].geometry); };
  const double coarse = mesh.tolerance ? mesh.tolerance_left : kCoarse;
  const double fine = mesh.tolerance ? mesh.tolerance_left : kFine;
  const auto smallest =
      least(may, slower, [&](std::size_t i) { return moved(i) <= coarse ? bytes(i) : kInfinite; });
  const auto balanced = least(may, slower, [&](std::size_t i) {
    return moved(i) <= fine ? bytes(i) * slower[i] : kInfinite;
  });
  // Among equal surfaces: triangles that a coarse grid makes points take no time.
  const auto fastest =
      least(may, slower, [&](std::size_t i) { return is_exact(i) ? slower[i] : kInfinite; });
  const auto exact =
      least(may, slower, [&](std::size_t i) { return is_exact(i) ? bytes(i) : kInfinite; });
  if (!smallest || !balanced || !fastest || !exact) return std::nullopt;
  return Advice{*smallest, *balanced, *fastest, *exact};
}

std::optional<std::size_t> cooks_choice(const MeshTradeoff& mesh, Goal goal) {
  Contest contest;
  contest.triangles = static_cast<std::uint32_t>(mesh.triangles);
  if (const TradePoint* const baseline = baseline_of(mesh)) contest.baseline = baseline->modelled;
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    const TradePoint& point = mesh.points[i];
    if (point.grid_bits != 0 && !is_cooks_grid(mesh, point)) continue;
    Candidate candidate;
    candidate.codec = point.codec;
    candidate.geometry = point.geometry;
    candidate.tree_bytes = point.bytes.nodes;
    candidate.geometry_bytes = point.bytes.vertices + point.bytes.corners;
    candidate.work = point.work;
    candidate.cost = point.modelled;
    candidate.gates = point.gates;
    contest.candidates.push_back(std::move(candidate));
    places.push_back(i);
  }
  Wishes wishes;
  wishes.goal = goal;
  const auto chosen = choose(std::span(&contest, 1), wishes);
  if (!chosen) return std::nullopt;
  return places[chosen->front()];
}

std::vector<PageConclusion> advice_in_words(const MeshTradeoff& mesh) {
  const std::optional<Advice> advice = advise(mesh);
  if (!advice) return {{"No encoding passed its gates.", "Use none, and report this as a defect."}};
  const std::vector<double> slower = slowdowns_of(mesh);
  const auto within = [&](const char* share) {
    return mesh.tolerance ? fmt::format(" (surface within the tolerance of {})", *mesh.tolerance)
                          : fmt::format(" (surface within {} of the diagonal)", share);
  };
  const std::string every_bit = mesh.moved_by_f32 > 0 ? " with every f32 position bit for bit"
                                                      : " with every position bit for bit";
  const std::array roles = {Role{"balanced", within("a millionth"), advice->balanced},
                            Role{"smallest", within("a ten-thousandth"), advice->smallest},
                            Role{"fastest", every_bit, advice->fastest_exact, true},
                            Role{"smallest", every_bit, advice->smallest_exact, true}};
  static_assert(kFine == 1e-6 && kCoarse == 1e-4, "as the words say");
  // An encoding that is best in several ways is listed once.
  std::vector<std::vector<Role>> merged;
  for (const Role& role : roles) {
    const auto same = std::find_if(merged.begin(), merged.end(), [&](const auto& group) {
      return group.front().place == role.place;
    });
    if (same == merged.end()) {
      merged.push_back({role});
    } else {
      same->push_back(role);
    }
  }
  std::vector<PageConclusion> words;
  for (const std::vector<Role>& group : merged) {
    const std::size_t place = group.front().place;
    words.push_back(told(mesh, place, name_of(group, mesh.tolerance.has_value()), slower[place]));
  }
  return words;
}

std::string cook_command(const MeshTradeoff& mesh, const TradePoint& point) {
  std::string source = "MESH";
  std::string output = "FILE.bxt";
  if (!mesh.file_name.empty()) {
    source = shell_word(mesh.file_name);
    output = shell_word(named_path(mesh.file_name).stem().string() + ".bxt");
  }
  return fmt::format("boxtree cook {} -o {} {}", source, output, cook_options(mesh, point));
}

std::string import_options(const MeshTradeoff& mesh) {
  return fmt::format("{}{}", mesh.is_f64 ? " --f64" : "", mesh.skipped > 0 ? " --skip-bad" : "");
}

std::string cook_options(const MeshTradeoff& mesh, const TradePoint& point) {
  const auto positions = [&]() -> std::string {
    switch (point.geometry) {
      case GeometryId::kGrid:
        // A tolerance may take a store that keeps every bit.
        return point.tolerance ? fmt::format("--grid-step 2^{}", point.grid_step_exponent)
                               : fmt::format("--grid-bits {}", point.grid_bits);
      case GeometryId::kArrays:  // of the two stores that keep every bit, the faster
        return "--exact --for speed";
      case GeometryId::kExact:  // and the smaller
        return "--exact --for memory";
      case GeometryId::kExternal:
        break;
    }
    return "--external";
  };
  return fmt::format("--codec {} {}{} --flatten --strip", codec_name(point.codec), positions(),
                     import_options(mesh));
}

std::string time_in_words(double nanoseconds) {
  if (nanoseconds < 1e3) return fmt::format("{:.0f} ns", nanoseconds);
  if (nanoseconds < 1e6) return fmt::format("{:.3g} µs", nanoseconds / 1e3);
  return fmt::format("{:.3g} ms", nanoseconds / 1e6);
}

std::string time_in_words(const MeshTradeoff& mesh, double nanoseconds) {
  return (has_disturbed_times(mesh) ? "~" : "") + time_in_words(nanoseconds);
}

std::string disturbance_in_words(const MeshTradeoff& mesh) {
  if (!has_disturbed_times(mesh)) return {};
  return mesh.timed_work.disturbance() +
         ", so times may be wrong; slowdowns, and what is recommended by them, are by counted "
         "work, as with --no-times. Measure again when the machine, and its host, do nothing else";
}

std::string move_in_words(const MeshTradeoff& mesh, double share) {
  return share == 0 ? "0"
                    : fmt::format("{} of the diagonal ({} units of the mesh)", at_most(share, 2),
                                  at_most(share * mesh.diagonal, 2));
}

}  // namespace boxtree::cooker
