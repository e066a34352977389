// SPDX-License-Identifier: MIT
// Medians over whole workloads: single queries are shorter than a clock can tell.
#include <sys/resource.h>

#include <boxtree/cooker/report/measure.h>
#include <boxtree/runtime/boxtree.h>

namespace boxtree::cooker {
namespace {

// Seconds a question, and the first error that any gave.
template <class Questions, class Ask>
double per_question(const Questions& questions, std::size_t runs, Status& status, Ask ask) {
  if (questions.empty()) return 0;
  const double seconds = median_seconds(runs, [&] {
    for (const auto& question : questions) {
      if (const Errc error = ask(question); error != Errc::kOk && status.ok()) status = error;
    }
  });
  return seconds / static_cast<double>(questions.size());
}

}  // namespace

Result<QueryFigures> measure_queries(const Tree& tree, const Workload& workload, std::size_t runs) {
  QueryFigures figures;
  Status status;
  const std::uint64_t rounds = runs + 1;  // every round adds the same to the counts
  figures.ray_ns = 1e9 * per_question(workload.rays, runs, status, [&](const Ray& ray) {
                     const auto hit = closest_hit(tree, ray);
                     if (hit) figures.ray_hits += hit->has_value() ? 1u : 0u;
                     return hit.code();
                   });
  figures.box_ns =
      1e9 * per_question(workload.boxes, runs, status, [&](const Eigen::AlignedBox3d& box) {
        return overlap_box(tree, box,
                           [&](const FaceRef&) {
                             ++figures.box_faces;
                             return true;
                           })
            .code();
      });
  figures.point_ns =
      1e9 * per_question(workload.points, runs, status, [&](const Eigen::Vector3d& point) {
        const auto closest = closest_point(tree, point);
        if (closest && *closest) figures.point_distance += (*closest)->distance;
        return closest.code();
      });
  const Pose here = Pose::Identity();
  figures.pair_first_us = 1e6 * per_question(workload.poses, runs, status, [&](const Pose& pose) {
                            const auto contact = first_contact(tree, here, tree, pose);
                            if (contact) figures.pair_hits += contact->has_value() ? 1u : 0u;
                            return contact.code();
                          });
  figures.pair_all_us = 1e6 * per_question(workload.poses, runs, status, [&](const Pose& pose) {
                          return overlap_pairs(tree, here, tree, pose,
                                               [&](const FacePair&) {
                                                 ++figures.pair_pairs;
                                                 return true;
                                               })
                              .code();
                        });
  if (!status) return status.error();
  figures.ray_hits /= rounds;
  figures.box_faces /= rounds;
  figures.point_distance /= static_cast<double>(rounds);
  figures.pair_hits /= rounds;
  figures.pair_pairs /= rounds;
  return figures;
}

Result<OpenFigures> measure_open(const std::filesystem::path& path, std::uint32_t tree,
                                 std::size_t runs) {
  using Clock = std::chrono::steady_clock;
  OpenFigures figures;
  std::vector<double> open_us;
  std::vector<double> answer_us;
  const auto micros = [](Clock::duration d) {
    return std::chrono::duration<double, std::micro>(d).count();
  };
  for (std::size_t i = 0; i <= runs; ++i) {
    rusage before{};
    rusage after{};
    ::getrusage(RUSAGE_SELF, &before);
    const Clock::time_point start = Clock::now();
    const Result<File> file = File::open(path);
    if (!file) return file.error();
    const Result<Tree> bound = Tree::bind(*file, tree);
    if (!bound) return bound.error();
    const Clock::time_point opened = Clock::now();
    const Eigen::AlignedBox3d bounds = bounds_in_object_space(*bound);
    const Eigen::Vector3d along(0.1, 0.2, -1);
    const auto hit = closest_hit(*bound, {bounds.center() - bounds.sizes().norm() * along, along});
    const Clock::time_point answered = Clock::now();
    if (!hit) return hit.error();
    ::getrusage(RUSAGE_SELF, &after);
    if (i == 0) continue;
    open_us.push_back(micros(opened - start));
    answer_us.push_back(micros(answered - start));
    figures.page_faults = static_cast<std::uint64_t>(after.ru_minflt - before.ru_minflt);
  }
  figures.open_us = median(open_us);
  figures.first_answer_us = median(answer_us);
  return figures;
}

Eigen::AlignedBox3d bounds_in_object_space(const Tree& tree) {
  if (tree.empty()) return {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  return tree.to_object(tree.root().box);
}

}  // namespace boxtree::cooker
