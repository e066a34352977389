// SPDX-License-Identifier: MIT
// Readings of the sources: the largest coordinate, counts by cells, and faces into the places that
// their cells have in one temporary file. Then each cell is a PLY file.
#include "cooker/tile/tile_world.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <optional>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "cooker/farm/manifest.h"
#include "cooker/import/face_intake.h"
#include "cooker/import/weld.h"
#include "cooker/import/whole_file.h"
#include "cooker/system/input_failure.h"
#include "cooker/system/positioned.h"
#include "cooker/system/write_failure.h"
#include "cooker/text/counted.h"
#include "cooker/text/json.h"
#include "cooker/tile/tile_cells.h"
#include "cooker/tile/world_faces.h"
#include "cooker/write/atomic_file.h"
#include "cooker/write/outputs.h"
#include "cooker/write/temporary_file.h"
#include "format/limits.h"
#include "runtime/primitive/float_state.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

// A tile begins so, and nothing else that a person has.
// Of each job: what the faces of tiles are called. No other manifest has it.
constexpr std::array<const char*, 2> kTileOptions = {"--face-ids", kTileFaceIds};

constexpr std::string_view kTileStart =
    "ply\nformat binary_little_endian 1.0\ncomment a tile of a world, made by boxtree tile\n";

// Corners of a face in a tile: its list has a length of one byte.
constexpr std::size_t kMostCorners = 255;

// In the temporary file: the number of a face, that of its corners, and these.
constexpr std::uint64_t kFaceBytes = 8;
constexpr std::uint64_t kWorldCornerBytes = sizeof(WorldCorner);

// The least and most that are kept of a tile before they are written.
constexpr std::uint64_t kLeastBuffer = 4096, kMostBuffer = std::uint64_t{1} << 18;

// What a tile takes while it is written, for each triangle: where no two share a corner, 44 bytes
// in the temporary file, 36 of positions in an array that may be twice as long, 48 of the table of
// these, and 53 in the PLY file, in a text that may be twice as long.
constexpr std::uint64_t kTileBytesPerTriangle = 44 + 2 * 36 + 48 + 2 * 53;

// All are written as the machine has them.
static_assert(std::endian::native == std::endian::little);

std::uint64_t stored_bytes(const TileCounts& counts) {
  return kFaceBytes * counts.faces + kWorldCornerBytes * (counts.triangles + 2 * counts.faces);
}

template <class T>
void append_bytes(std::string& to, const T& value) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), &value, sizeof(T));
  to.append(bytes.data(), bytes.size());
}

Bytes bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text));
}

// Reads what append_bytes has written.
class Taker {
 public:
  explicit Taker(Bytes bytes) : bytes_(bytes) {}
  [[nodiscard]] bool is_empty() const { return bytes_.empty(); }
  // False where there are fewer bytes.
  template <class T>
  [[nodiscard]] bool take(T& out) {
    if (bytes_.size() < sizeof(T)) return false;
    std::memcpy(&out, bytes_.data(), sizeof(T));
    bytes_ = bytes_.subspan(sizeof(T));
    return true;
  }

 private:
  Bytes bytes_;
};

// Whether the file has exactly these bytes.
bool has_bytes(const fs::path& path, Bytes bytes) {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path, error);
  if (error || size != bytes.size()) return false;
  std::size_t at = 0;
  bool is_equal = true;
  const Status status = read_chunks(path, bytes.size(), [&](const char* chunk, std::size_t count) {
    is_equal =
        is_equal && count <= bytes.size() - at && std::memcmp(bytes.data() + at, chunk, count) == 0;
    at += count;
  });
  return status.ok() && is_equal && at == bytes.size();
}

// A place in the temporary file, and the bytes that are not written there yet.
struct TilePlace {
  std::uint64_t at = 0;
  std::uint64_t end = 0;
  std::string buffer;
};

class World {
 public:
  World(const TileOptions& options, const Progress& progress)
      : options_(options), progress_(progress) {}

  Result<TileReport> run() {
    if (Status status = check_jobs(); !status) return status.error();
    if (Status status = measure(); !status) return status.error();
    TileTree tree(tile_exponent(largest_), options_.triangles_per_tile);
    if (Status status = count(tree); !status) return status.error();
    for (const TileTree::Tile& tile : tree.tiles()) {
      report_.largest = std::max(report_.largest, tile.counts.triangles);
    }
    report_.tiles = tree.tiles().size();
    if (Status status = check_tiles(tree); !status) return status.error();
    Result<TemporaryFile> spool = TemporaryFile::create(
        folder_of(options_.jobs), options_.jobs.filename().string() + ".faces", kNewFileMode);
    if (!spool) return spool.error();
    if (Status status = distribute(tree, *spool); !status) return status.error();
    if (Status status = write_tiles(tree, *spool); !status) return status.error();
    if (Status status = write_jobs(tree); !status) return status.error();
    return report_;
  }

 private:
  [[nodiscard]] fs::path file_of(const TileTree::Tile& tile, const char* ending) const {
    return options_.folder / (tile.cell.name() + ending);
  }

  [[nodiscard]] Error needs_memory(const std::string& what, std::uint64_t bytes) const {
    return {Errc::kBudgetUnreachable,
            fmt::format("{} takes {} bytes, and {} are allowed; give more --memory, or change "
                        "--triangles-per-tile",
                        what, bytes, options_.memory)};
  }

  // A manifest is written over none but that of tiles, each of which says what its faces are
  // called.
  [[nodiscard]] Status check_jobs() const {
    const Status distinct = check_outputs(std::array{Output{options_.jobs}}, options_.sources);
    if (!distinct) return distinct;
    std::error_code error;
    if (!fs::exists(options_.jobs, error)) return {};
    const Result<std::string> text = read_whole_file(options_.jobs, kMaxManifestBytes);
    if (!text) return text.error();
    const auto jobs = parse_manifest(*text, options_.jobs.string());
    const auto is_tile = [](const ManifestLine& job) {
      return std::search(job.options.begin(), job.options.end(), kTileOptions.begin(),
                         kTileOptions.end()) != job.options.end();
    };
    if (jobs && std::all_of(jobs->begin(), jobs->end(), is_tile)) return {};
    return Error{Errc::kWriteFailed,
                 options_.jobs.string() +
                     ": expected a manifest of tiles, or no file, found another "
                     "one; it would be lost: remove it, or name another"};
  }

  // Calls visit(face, triangles) for each face of the world, with its number there.
  template <class Visit>
  Status read(const std::string& step, const Visit& visit) {
    ++report_.readings;
    std::uint64_t first = 0, skipped = 0;
    for (const fs::path& source : options_.sources) {
      announce(progress_, fmt::format("{} {}", step, source.filename().string()));
      const WorldReading reading{options_.memory, options_.skip_bad};
      const Result<WorldFaces> found =
          read_world_faces(source, reading, [&](const WorldFace& face) -> Status {
            const std::uint64_t id = first + face.id;
            if (Status status = check_face_count(id + 1, source.string()); !status) return status;
            if (face.corners.size() > kMostCorners) {
              return Error{
                  Errc::kMeshUnsupported,
                  fmt::format("{}: face {} has {} corners, those of tiles have {} at most",
                              source.string(), face.id, face.corners.size(), kMostCorners)};
            }
            return visit(WorldFace{static_cast<std::uint32_t>(id), face.corners, face.of_all_parts},
                         std::uint64_t{face.corners.size() - 2});
          });
      if (!found) return found.error();
      first += found->numbers;
      skipped += found->skipped;
    }
    report_.skipped = skipped;
    return {};
  }

  Status measure() {
    Status status = read("measure", [&](const WorldFace& face, std::uint64_t triangles) {
      for (const WorldCorner& corner : face.corners) {
        for (const float x : corner) largest_ = std::max(largest_, std::abs(x));
      }
      ++report_.faces;
      report_.triangles += triangles;
      return Status{};
    });
    if (!status || report_.faces > 0) return status;
    return Error{Errc::kNoFaces, options_.sources.front().string() + ": no faces"};
  }

  [[nodiscard]] Error changed() const {
    return {Errc::kFileUnreadable, options_.sources.front().string() +
                                       ": it, or a source after it, changed while it was cut; "
                                       "run the command again"};
  }

  // Nothing for a corner that was not there when the world was measured.
  [[nodiscard]] std::optional<TilePath> path_of(const WorldFace& face, int exponent) const {
    for (const WorldCorner& corner : face.of_all_parts) {
      for (const float x : corner) {
        if (std::abs(x) > largest_) return std::nullopt;
      }
    }
    return tile_path(face.of_all_parts, exponent);
  }

  Status count(TileTree& tree) {
    while (tree.is_open()) {
      if (tree.round_bytes() > options_.memory / 4) {
        return needs_memory("counting faces by cells", 4 * tree.round_bytes());
      }
      tree.begin_round();
      Status status = read("count", [&](const WorldFace& face, std::uint64_t triangles) -> Status {
        const std::optional<TilePath> path = path_of(face, tree.exponent());
        if (!path) return changed();
        tree.count(*path, triangles);
        return {};
      });
      if (!status) return status;
      tree.end_round();
    }
    return {};
  }

  // Before anything is written: what tiles would replace, and what they take.
  Status check_tiles(const TileTree& tree) {
    const std::uint64_t least = 4 * kLeastBuffer * report_.tiles;
    if (least > options_.memory) {
      return needs_memory("writing " + counted(report_.tiles, "tile"), least);
    }
    const std::uint64_t largest = kTileBytesPerTriangle * report_.largest;
    if (largest > options_.memory) {
      return needs_memory("a tile of " + counted(report_.largest, "triangle"), largest);
    }
    std::error_code error;
    fs::create_directories(options_.folder, error);
    if (error) {
      return Error{Errc::kWriteFailed,
                   options_.folder.string() + ": cannot be made: " + error.message()};
    }
    for (const TileTree::Tile& tile : tree.tiles()) {
      const fs::path path = file_of(tile, ".ply");
      if (!fs::exists(path, error)) continue;
      const Status distinct = check_outputs(std::array{Output{path}}, options_.sources);
      if (!distinct) return distinct;
      std::string start;
      if (const FileHandle file = open_to_read(path)) {
        start.resize(kTileStart.size());
        start.resize(std::fread(start.data(), 1, start.size(), file.get()));
      }
      if (start == kTileStart) continue;
      return Error{Errc::kWriteFailed,
                   path.string() +
                       ": expected a tile, or no file, found another one; it would be "
                       "lost: remove it, or name another folder"};
    }
    return {};
  }

  Status distribute(const TileTree& tree, const TemporaryFile& spool) {
    places_.clear();
    std::uint64_t at = 0;
    for (const TileTree::Tile& tile : tree.tiles()) {
      places_.push_back({at, at + stored_bytes(tile.counts), {}});
      at += stored_bytes(tile.counts);
    }
    const auto most = static_cast<std::size_t>(
        std::clamp(options_.memory / 4 / report_.tiles, kLeastBuffer, kMostBuffer));
    for (TilePlace& place : places_) {
      place.buffer.reserve(
          static_cast<std::size_t>(std::min<std::uint64_t>(place.end - place.at, most)));
    }
    const auto flush = [&](TilePlace& place) -> Status {
      if (place.buffer.size() > place.end - place.at) return changed();
      if (!write_at(spool.descriptor(), place.at, bytes_of(place.buffer))) {
        return write_failure(spool.path(), "cannot write");
      }
      place.at += place.buffer.size();
      place.buffer.clear();
      return {};
    };
    Status status = read("cut", [&](const WorldFace& face, std::uint64_t) -> Status {
      const std::optional<TilePath> path = path_of(face, tree.exponent());
      const std::optional<std::uint32_t> tile = path ? tree.tile_of(*path) : std::nullopt;
      if (!tile) return changed();
      TilePlace& place = places_[*tile];
      const std::size_t bytes = kFaceBytes + face.corners.size_bytes();
      if (!place.buffer.empty() && place.buffer.size() + bytes > most) {
        if (Status flushed = flush(place); !flushed) return flushed;
      }
      append_bytes(place.buffer, face.id);
      append_bytes(place.buffer, static_cast<std::uint32_t>(face.corners.size()));
      place.buffer.append(reinterpret_cast<const char*>(face.corners.data()),
                          face.corners.size_bytes());
      return {};
    });
    for (TilePlace& place : places_) {
      if (!status) break;
      status = flush(place);
      if (status && place.at != place.end) status = changed();
      place.buffer = {};
    }
    return status;
  }

  Status write_tiles(const TileTree& tree, const TemporaryFile& spool) {
    std::uint64_t at = 0;
    for (std::size_t i = 0; i < tree.tiles().size(); ++i) {
      const TileTree::Tile& tile = tree.tiles()[i];
      const fs::path path = file_of(tile, ".ply");
      announce(progress_, fmt::format("write tile {} of {}", i + 1, tree.tiles().size()));
      std::string stored(static_cast<std::size_t>(stored_bytes(tile.counts)), '\0');
      if (!read_at(spool.descriptor(), at, std::as_writable_bytes(std::span(stored)))) {
        return input_failure(spool.path().string(), errno);
      }
      at += stored.size();
      const std::optional<std::string> ply = ply_of(tile.counts, stored);
      if (!ply) return changed();
      if (has_bytes(path, bytes_of(*ply))) continue;  // and keeps its time, which journals compare
      Result<AtomicFile> file = AtomicFile::create(path);
      if (!file) return file.error();
      Status status = file->write(bytes_of(*ply));
      if (status) status = file->commit();
      if (!status) return status;
      ++report_.written;
    }
    return {};
  }

  // The faces of a tile as a PLY file. Nothing if they are not as they were counted.
  static std::optional<std::string> ply_of(const TileCounts& counts, std::string& stored) {
    std::vector<float> positions;
    Welder<float> welder(positions);
    std::string faces;
    Taker taker(bytes_of(stored));
    std::uint64_t count = 0;
    while (!taker.is_empty()) {
      std::uint32_t id = 0, corners = 0;
      if (!taker.take(id) || !taker.take(corners) || corners > kMostCorners) return std::nullopt;
      faces += static_cast<char>(corners);
      for (std::uint32_t i = 0; i < corners; ++i) {
        WorldCorner corner;
        if (!taker.take(corner)) return std::nullopt;
        append_bytes(faces, welder.add(corner));
      }
      append_bytes(faces, id);
      ++count;
    }
    if (count != counts.faces) return std::nullopt;
    stored = {};
    positions.resize(3 * welder.size());
    std::string ply(kTileStart);
    ply += fmt::format(
        "element vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
        "element face {}\nproperty list uchar uint vertex_indices\nproperty uint {}\nend_header\n",
        welder.size(), counts.faces, kTileFaceIds);
    ply.append(reinterpret_cast<const char*>(positions.data()), positions.size() * sizeof(float));
    ply += faces;
    return ply;
  }

  Status write_jobs(const TileTree& tree) const {
    Json words = Json::array();
    for (const std::string& word : options_.cook_options) words.push_back(word);
    for (const char* word : kTileOptions) words.push_back(word);
    std::string lines;
    for (const TileTree::Tile& tile : tree.tiles()) {
      const Json job = {{"inputs", Json::array({file_of(tile, ".ply").generic_string()})},
                        {"output", file_of(tile, ".bxt").generic_string()},
                        {"options", words}};
      lines += job.dump() + "\n";
    }
    if (has_bytes(options_.jobs, bytes_of(lines))) return {};
    Result<AtomicFile> file = AtomicFile::create(options_.jobs);
    if (!file) return file.error();
    if (Status status = file->write(bytes_of(lines)); !status) return status;
    return file->commit();
  }

  const TileOptions& options_;
  const Progress& progress_;
  float largest_ = 0;  // coordinate, in magnitude
  std::vector<TilePlace> places_;
  TileReport report_;
};

}  // namespace

Result<TileReport> tile_world(const TileOptions& options, const Progress& progress) {
  const DefaultFloatState state;
  return World(options, progress).run();
}

}  // namespace boxtree::cooker
