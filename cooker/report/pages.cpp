// SPDX-License-Identifier: MIT
// Counts pages by protecting the mapped file: the first read of a page raises a signal, whose
// handler records the page and makes it readable. Unlike counts of faults or resident pages, this
// excludes pages that a kernel maps or reads ahead, and needs no privileges. Compiled on Windows,
// this is nothing: see pages_windows.cpp.
#ifndef _WIN32
#include "cooker/report/pages.h"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <fcntl.h>
#include <random>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <boxtree/boxtree.h>

#include "cooker/choose/measure.h"
#include "cooker/choose/workload.h"
#include "format/limits.h"
#include "runtime/tree/bound_tree.h"
#include "runtime/walk/work.h"

namespace boxtree::cooker {
namespace {

constexpr std::size_t kPage = 4096;

// The file that is watched, one at a time. Plain memory: a signal handler may use nothing else.
struct Watched {
  std::byte* begin = nullptr;
  std::size_t bytes = 0;
  std::size_t unit = 0;             // the machine's unit of protection, at least one page of 4 KiB
  std::uint8_t* is_read = nullptr;  // one element per unit
};
Watched watched;
struct sigaction previous_action;

void note_page(int, siginfo_t* info, void*) {
  const auto at = reinterpret_cast<std::uintptr_t>(info->si_addr);
  const auto begin = reinterpret_cast<std::uintptr_t>(watched.begin);
  if (at < begin || at - begin >= watched.bytes) {
    ::sigaction(SIGSEGV, &previous_action, nullptr);  // not ours: raised again at once
    return;
  }
  const std::size_t unit = (at - begin) / watched.unit;
  watched.is_read[unit] = 1;
  ::mprotect(watched.begin + unit * watched.unit, watched.unit, PROT_READ);
}

// Maps a file to be watched and installs the signal handler during its lifetime.
class Watch {
 public:
  explicit Watch(const std::filesystem::path& path) {
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    struct stat info {};
    if (file < 0 || ::fstat(file, &info) != 0 || info.st_size == 0) {
      if (file >= 0) ::close(file);
      return;
    }
    bytes_ = static_cast<std::size_t>(info.st_size);
    void* const data = ::mmap(nullptr, bytes_, PROT_NONE, MAP_PRIVATE, file, 0);
    ::close(file);
    if (data == MAP_FAILED) return;
    data_ = static_cast<std::byte*>(data);
    unit_ = std::max(kPage, static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)));
    is_read_.resize((bytes_ + unit_ - 1) / unit_);
    watched = {data_, bytes_, unit_, is_read_.data()};
    struct sigaction action {};
    action.sa_sigaction = note_page;
    action.sa_flags = SA_SIGINFO;
    ::sigaction(SIGSEGV, &action, &previous_action);
  }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;
  ~Watch() {
    if (data_ == nullptr) return;
    ::sigaction(SIGSEGV, &previous_action, nullptr);
    watched = {};
    ::munmap(data_, bytes_);
  }

  [[nodiscard]] bool is_mapped() const { return data_ != nullptr; }
  [[nodiscard]] Bytes bytes() const { return {data_, bytes_}; }
  [[nodiscard]] std::size_t pages() const { return is_read_.size(); }

  // Resets all pages to unread.
  void forget() {
    ::mprotect(data_, bytes_, PROT_NONE);
    std::fill(is_read_.begin(), is_read_.end(), std::uint8_t{0});
  }
  [[nodiscard]] std::size_t count() const {
    return static_cast<std::size_t>(std::count(is_read_.begin(), is_read_.end(), 1));
  }
  [[nodiscard]] std::vector<std::size_t> numbers() const {
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < is_read_.size(); ++i) {
      if (is_read_[i] != 0) numbers.push_back(i);
    }
    return numbers;
  }

 private:
  std::byte* data_ = nullptr;
  std::size_t bytes_ = 0;
  std::size_t unit_ = kPage;
  std::vector<std::uint8_t> is_read_;
};

// Cubes at the centres of leaves, which are found by descending to random children. Each cube is as
// large as a leaf of kLeafFaces would be if the triangles were spread evenly over a square of the
// tree's extent.
Result<std::vector<Eigen::AlignedBox3d>> local_boxes(const Tree& tree, std::size_t count) {
  const double extent = bounds_in_object_space(tree).sizes().maxCoeff();
  const double faces = std::max(tree.face_count(), kLeafFaces);
  const double half_edge = extent * std::sqrt(kLeafFaces / faces) / 2;
  const Eigen::Vector3d half = Eigen::Vector3d::Constant(half_edge);
  std::mt19937 random(1);
  std::vector<Eigen::AlignedBox3d> boxes;
  while (boxes.size() < count && !tree.empty()) {
    Node node = BoundTree::of(tree).root();
    NodeChildren children;
    WalkBound bound(BoundTree::of(tree).node_count());
    while (!node.is_leaf) {
      const Errc error = bound.count(BoundTree::of(tree).expand(node, children));
      if (error != Errc::kOk) return error;
      if (children.count == 0) return Errc::kNodeCorrupt;
      node = children.child[random() % children.count];
    }
    const Eigen::Vector3d center = BoundTree::of(tree).to_object(node.box).center();
    boxes.emplace_back(center - half, center + half);
  }
  return boxes;
}

// Opens and binds, and runs each query on a cold file.
class ColdFile {
 public:
  ColdFile(Watch& watch, std::uint32_t index) : watch_(watch), index_(index) {}

  template <class RunQuery>
  Result<std::size_t> pages(RunQuery run_query) {
    watch_.forget();
    const Result<File> file = File::open(watch_.bytes());
    if (!file) return file.error();
    const Result<Tree> tree = Tree::bind(*file, index_);
    if (!tree) return tree.error();
    const auto answer = run_query(*tree);
    if (!answer.ok()) return answer.error();
    return watch_.count();
  }

  template <class Query, class RunQuery>
  Result<PageCount> pages_of_all(const std::vector<Query>& queries, RunQuery run_query) {
    std::vector<std::size_t> counts;
    for (const Query& query : queries) {
      const Result<std::size_t> count =
          pages([&](const Tree& tree) { return run_query(tree, query); });
      if (!count) return count.error();
      counts.push_back(*count);
    }
    if (counts.empty()) return PageCount();
    std::sort(counts.begin(), counts.end());
    return PageCount{counts.size(), counts[counts.size() / 2], counts.back()};
  }

 private:
  Watch& watch_;
  std::uint32_t index_;
};

}  // namespace

Result<std::vector<std::size_t>> pages_read(const std::filesystem::path& path,
                                            const std::function<Status(Bytes file)>& read) {
  const Watch watch(path);
  if (!watch.is_mapped()) return Error{Errc::kMapFailed, path.string()};
  if (const Status status = read(watch.bytes()); !status) return status.error();
  return watch.numbers();
}

Result<std::vector<FirstRays>> measure_first_rays(const std::filesystem::path& path,
                                                  std::uint32_t index, std::size_t rays) {
  const Result<File> file = File::open(path);
  if (!file) return file.error();
  const Result<Tree> tree = Tree::bind(*file, index);
  if (!tree) return tree.error();
  const Workload workload = make_workload(bounds_in_object_space(*tree), {rays, 0, 0, 0});

  Watch watch(path);
  if (!watch.is_mapped()) return Error{Errc::kMapFailed, path.string()};
  ColdFile cold(watch, index);
  std::vector<FirstRays> figures;
  for (std::uint32_t levels = 0; levels <= BoundTree::of(*tree).depth(); ++levels) {
    FirstRays first{levels, 0, 0, 0};
    const Result<std::size_t> pages = cold.pages([&](const Tree& bound) -> Status {
      first.nodes = bound.prefetch(levels);
      first.pages_before = watch.count();
      for (const Ray& ray : workload.rays) {
        const auto hit = closest_hit(bound, ray);
        if (!hit.ok()) return hit.error();
      }
      return {};
    });
    if (!pages) return pages.error();
    first.pages_more = *pages - first.pages_before;
    figures.push_back(first);
  }
  return figures;
}

Result<PageFigures> measure_pages(const std::filesystem::path& path, std::uint32_t index,
                                  std::size_t queries) {
  const Result<File> file = File::open(path);
  if (!file) return file.error();
  const Result<Tree> tree = Tree::bind(*file, index);
  if (!tree) return tree.error();
  const Workload workload = make_workload(bounds_in_object_space(*tree), {queries, 0, 0, 0});
  const Result<std::vector<Eigen::AlignedBox3d>> boxes = local_boxes(*tree, queries);
  if (!boxes) return boxes.error();

  Watch watch(path);
  if (!watch.is_mapped()) return Error{Errc::kMapFailed, path.string()};
  ColdFile cold(watch, index);
  PageFigures figures;
  figures.file_pages = watch.pages();
  const auto open = cold.pages([](const Tree&) { return Status(); });
  if (!open) return open.error();
  figures.open = *open;
  const auto ray = cold.pages_of_all(
      workload.rays, [](const Tree& t, const Ray& query) { return closest_hit(t, query); });
  if (!ray) return ray.error();
  figures.ray = *ray;
  const auto box = cold.pages_of_all(*boxes, [](const Tree& t, const Eigen::AlignedBox3d& query) {
    return overlap_box(t, query, [](const FaceRef&) { return true; });
  });
  if (!box) return box.error();
  figures.box = *box;
  const auto point = cold.pages_of_all(*boxes, [](const Tree& t, const Eigen::AlignedBox3d& query) {
    return closest_point(t, query.center());
  });
  if (!point) return point.error();
  figures.point = *point;
  return figures;
}

}  // namespace boxtree::cooker
#endif
