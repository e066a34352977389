// SPDX-License-Identifier: MIT
// Measures all boxtree codecs through the public queries.
#include <stdexcept>

#include <boxtree/blob.h>
#include <boxtree/boxtree.h>

#include "cooker/choose/measure.h"
#include "cooker/cook.h"
#include "cooker/report/scratch_file.h"
#include "runtime/paper/any_codec.h"
#include "runtime/query/pair_walk.h"
#include "runtime/tree/bound_tree.h"
#include "tests/bench/subject.h"
#include "tests/support/require.h"

namespace boxtree::bench {
namespace {

using test::require;

cooker::EncodedTree cook(const TriangleMesh& mesh, CodecId codec,
                         const cooker::CookOptions& options) {
  return require(cooker::cook_as(mesh.source, codec, options));
}

// The address of a node's bytes.
template <class Cut>
Bytes node_bytes(const PlainCodec<Cut>& codec, NodeRef ref) {
  constexpr std::size_t kBytes = sizeof(typename PlainCodec<Cut>::Node);
  return {codec.nodes + std::size_t{ref.first} * kBytes, kBytes};
}
template <PackedCut K>
Bytes node_bytes(const PackedCodec<K>& codec, NodeRef ref) {
  const auto& array = codec.arrays[ref.second];
  const std::uint64_t first = std::uint64_t{ref.first} * array.layout.bits;
  return {array.bits + first / 8, (first % 8 + array.layout.bits + 7) / 8};
}

template <class Node>
Bytes node_bytes(const WideCodec<Node>& codec, NodeRef ref) {
  return {codec.nodes + std::size_t{ref.first} * sizeof(Node), sizeof(Node)};
}

// Counts the work of a walk of one tree against itself, and passes the addresses read to the cache
// model. Cuts in dedup's table are found through the nodes.
template <Codec C>
struct Listener {
  const C* codec;
  const cooker::EncodedGeometry* geometry;
  PairWork* work;
  CacheModel* cache;

  void node_pair(NodeRef first, bool first_is_leaf, NodeRef second, bool second_is_leaf) {
    ++work->node_pairs;
    if (!first_is_leaf) read_node(first);
    if (!second_is_leaf) read_node(second);
  }
  void leaf_pair(NodeRef first, NodeRef second) {
    ++work->leaf_tests;
    for (const NodeRef leaf : {first, second}) {
      for (std::uint32_t face = leaf.first; face < leaf.first + leaf.second; ++face) {
        read_face(face);
      }
    }
  }

 private:
  void read_node(NodeRef ref) {
    const Bytes bytes = node_bytes(*codec, ref);
    cache->read(bytes.data(), bytes.size());
    if constexpr (std::is_same_v<C, PackedCodec<PackedCut::kTable>>) {
      if (codec->cut_count == 0) return;
      const auto& array = codec->arrays[ref.second];
      for (const std::uint8_t at : array.layout.cut_at) {
        const std::uint64_t number = read_bits(
            array.bits, std::uint64_t{ref.first} * array.layout.bits + at, codec->cut_bits);
        cache->read(codec->cuts + number * sizeof(float), sizeof(float));
      }
    }
  }
  void read_face(std::uint32_t face) {
    const std::size_t bytes = std::size_t{geometry->corner_bytes} * geometry->corners_per_face;
    const std::byte* const corners = geometry->corners.data() + face * bytes;
    cache->read(corners, bytes);
    for (std::size_t i = 0; i < geometry->corners_per_face; ++i) {
      const std::uint32_t vertex = geometry->corner_bytes == 2 ? load<std::uint16_t>(corners, i)
                                                               : load<std::uint32_t>(corners, i);
      constexpr std::size_t kVertexBytes = 3 * sizeof(float);
      cache->read(geometry->vertices.data() + vertex * kVertexBytes, kVertexBytes);
    }
  }
};

// Calls use(shape) with the shape in our terms.
template <class Use>
void with_shape(const PlacedShape& placed, const Use& use) {
  const auto& [center, radius, kind] = placed;
  const Eigen::Vector3d up(0, 0, radius);
  if (kind == ShapeKind::kSphere) return use(Sphere{center, radius});
  if (kind == ShapeKind::kCapsule) return use(Capsule{center - up, center + up, radius});
  use(OrientedBox{center, {radius, radius, radius}, kCubeRotation});
}

class BoxtreeSubject : public Subject {
 public:
  BoxtreeSubject(const TriangleMesh& mesh, CodecId codec, const cooker::CookOptions& options)
      : encoded_(cook(mesh, codec, options)), tree_(require(cooker::bind_encoded(encoded_))) {}

  [[nodiscard]] SubjectBytes bytes() const override {
    const auto tree = static_cast<double>(encoded_.nodes.bytes.size());
    return {tree, tree + static_cast<double>(encoded_.geometry.vertices.size() +
                                             encoded_.geometry.corners.size())};
  }
  [[nodiscard]] std::optional<SubjectOpen> open(std::size_t runs) override {
    const std::vector<std::byte> bytes = cooker::serialize(std::span(&encoded_, 1));
    const cooker::ScratchFile file = require(cooker::ScratchFile::create(bytes));
    const auto figures = require(cooker::measure_open(file.path(), 0, 20 * runs));
    return SubjectOpen{figures.first_answer_us, static_cast<double>(bytes.size()), 0};
  }

  bool rays(std::span<const Ray> rays, std::span<double> out) override {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const auto hit = require(closest_hit(tree_, rays[i]));
      out[i] = hit ? hit->t : std::numeric_limits<double>::infinity();
    }
    return true;
  }
  [[nodiscard]] bool ends_rays() const override { return true; }
  bool ray_batches(std::span<const Ray> rays, std::span<double> out) override {
    hits_.resize(rays.size());
    if (!closest_hits(tree_, rays, hits_)) throw std::runtime_error("a batch failed");
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const auto hit = require(hits_[i]);
      out[i] = hit ? hit->t : std::numeric_limits<double>::infinity();
    }
    return true;
  }
  bool casts(std::span<const ShapeCast> casts, std::span<double> out) override {
    for (std::size_t i = 0; i < casts.size(); ++i) {
      const ShapeCast& cast = casts[i];
      const Motion motion{cast.ray.direction};
      with_shape({cast.ray.origin, cast.radius, cast.kind}, [&](const auto& shape) {
        const auto hit = require(cast_closest(tree_, shape, motion));
        out[i] = hit ? hit->t : std::numeric_limits<double>::infinity();
      });
    }
    return true;
  }
  bool overlaps(std::span<const PlacedShape> shapes, std::span<double> out) override {
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      out[i] = 0;
      const auto count = [&](const FaceRef&) { return ++out[i], true; };
      with_shape(shapes[i], [&]<class Shape>(const Shape& shape) {
        if constexpr (std::is_same_v<Shape, Sphere>) {
          static_cast<void>(require(overlap_sphere(tree_, shape.center, shape.radius, count)));
        } else if constexpr (std::is_same_v<Shape, Capsule>) {
          static_cast<void>(require(overlap_capsule(tree_, shape, count)));
        } else {
          static_cast<void>(require(overlap_oriented_box(tree_, shape, count)));
        }
      });
    }
    return true;
  }
  bool contacts(std::span<const PlacedShape> shapes, std::span<double> out) override {
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      out[i] = 0;
      with_shape(shapes[i], [&](const auto& shape) {
        static_cast<void>(
            require(collide(tree_, shape, [&](const Contact&) { return ++out[i], true; })));
      });
    }
    return true;
  }
  bool boxes(std::span<const Eigen::AlignedBox3d> boxes, std::span<double> out) override {
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      out[i] = 0;
      static_cast<void>(require(overlap_box(tree_, boxes[i], [&](const FaceRef&) {
        ++out[i];
        return true;
      })));
    }
    return true;
  }
  bool points(std::span<const Eigen::Vector3d> points, std::span<double> out) override {
    for (std::size_t i = 0; i < points.size(); ++i) {
      out[i] = require(closest_point(tree_, points[i]))->distance;
    }
    return true;
  }
  // The upper bound, which some two points attain, as other libraries return it.
  bool distances(std::span<const DistanceRequest> queries, std::span<double> out) override {
    for (std::size_t i = 0; i < queries.size(); ++i) {
      DistanceOptions options;
      options.relative_error = queries[i].relative_error;
      out[i] = require(distance(tree_, Pose::Identity(), tree_, queries[i].pose, options)).upper;
    }
    return true;
  }
  bool first_contacts(std::span<const Pose> poses, std::span<double> out) override {
    const Pose here = Pose::Identity();
    for (std::size_t i = 0; i < poses.size(); ++i) {
      out[i] = require(first_contact(tree_, here, tree_, poses[i])) ? 1 : 0;
    }
    return true;
  }
  bool all_pairs(std::span<const Pose> poses, std::span<double> out) override {
    const Pose here = Pose::Identity();
    for (std::size_t i = 0; i < poses.size(); ++i) {
      out[i] = 0;
      static_cast<void>(require(overlap_pairs(tree_, here, tree_, poses[i], [&](const FacePair&) {
        ++out[i];
        return true;
      })));
    }
    return true;
  }

  [[nodiscard]] std::optional<PairWork> pair_work(std::span<const Pose> poses, bool first_only,
                                                  CacheModel& cache) override {
    if (has_clusters(encoded_.geometry.geometry)) return {};  // walks arrays only
    PairWork work;
    const BoundTree& tree = BoundTree::of(tree_);
    for (const Pose& pose : poses) {
      const auto relative = RelativePose::make(tree, Pose::Identity(), tree, pose);
      if (!relative) throw std::runtime_error(std::string(error_info(Errc::kInvalidPose).name));
      with_codec(tree, [&]<class C>(const C& codec) {
        const Listener<C> listener{&codec, &encoded_.geometry, &work, &cache};
        const auto visitor = [&](const FacePair&) { return !first_only; };
        PairBound bound(tree, tree, nullptr);
        static_cast<void>(require(PairWalk<C, C, Listener<C>>(tree, codec, tree, codec, *relative,
                                                              visitor, bound, listener)
                                      .run()));
      });
    }
    return work;
  }

 private:
  cooker::EncodedTree encoded_;
  Tree tree_;
  std::vector<RayResult> hits_;  // of the last batch
};

// A compressed file has only an opening time and a size: once open it is its plain-f32 tree.
class BlobSubject : public Subject {
 public:
  BlobSubject(const TriangleMesh& mesh, BlobMethod method, const cooker::CookOptions& options)
      : encoded_(cook(mesh, CodecId::kPlainF32, options)),
        file_(cooker::serialize(std::span(&encoded_, 1))),
        blob_(require(make_blob(file_, method))),
        tree_bytes_(static_cast<double>(require(compressed_size(encoded_.nodes.bytes, method)))) {}

  [[nodiscard]] SubjectBytes bytes() const override {
    return {tree_bytes_, static_cast<double>(blob_.size())};
  }
  [[nodiscard]] std::optional<SubjectOpen> open(std::size_t runs) override {
    const cooker::ScratchFile file = require(cooker::ScratchFile::create(blob_));
    const double seconds = cooker::median_seconds(runs, [&] {
      const File opened = require(open_blob(file.path()));
      const Tree tree = require(Tree::bind(opened, 0));
      if (const Status queried = cooker::first_query(tree); !queried) {
        throw std::runtime_error(queried.error().message());
      }
    });
    return SubjectOpen{1e6 * seconds, static_cast<double>(blob_.size()),
                       static_cast<double>(file_.size())};
  }

 private:
  cooker::EncodedTree encoded_;
  std::vector<std::byte> file_;
  std::vector<std::byte> blob_;
  double tree_bytes_;
};

}  // namespace

void add_boxtree(std::vector<Library>& libraries, cooker::Builder builder) {
  cooker::CookOptions options;
  options.builder = builder;
  options.face_ids = false;
  const auto add = [&](const char* library, const std::string& variant, CodecId codec) {
    libraries.push_back({library, variant, [codec, options](const TriangleMesh& mesh) {
                           return std::make_unique<BoxtreeSubject>(mesh, codec, options);
                         }});
  };
  for (const CodecInfo& codec : kCodecs) add("boxtree", std::string(codec.name), codec.id);
  for (const auto& [name, method] :
       {std::pair("blob-lzma", BlobMethod::kLzma), std::pair("blob-zstd", BlobMethod::kZstd)}) {
    libraries.push_back({"boxtree", name, [method = method, options](const TriangleMesh& mesh) {
                           return std::make_unique<BlobSubject>(mesh, method, options);
                         }});
  }
  options.geometry = GeometryId::kArrays;
  for (const CodecId codec : {CodecId::kWide8, CodecId::kWide4}) {
    add("boxtree", std::string(codec_name(codec)) + "-arrays", codec);
  }
  // A separate library: its answers are those of the mesh on the grid.
  options.geometry = GeometryId::kGrid;
  for (const int bits : {24, 16}) {
    options.grid.bits = bits;
    for (const CodecId codec : {CodecId::kWide8, CodecId::kWide4}) {
      add("boxtree-grid", std::string(codec_name(codec)) + "-" + std::to_string(bits), codec);
    }
  }
}

}  // namespace boxtree::bench
