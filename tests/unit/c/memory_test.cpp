// SPDX-License-Identifier: MIT
// What handles allocate: from the allocator that is given and from operator new, which this program
// counts and lets fail. Everything is given back, with the size and alignment that were requested.
#include <boxtree_c.h>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <new>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/scenes.h"
#include "tests/support/temp_folder.h"
#include "tests/unit/c/queries.h"
#include "tests/unit/c/subjects.h"

namespace {
bool counts = false;          // what follows is about calls of the C interface alone
std::size_t until_fails = 0;  // that many more calls of operator new succeed
std::size_t news = 0;
std::ptrdiff_t living = 0;

void* allocate(std::size_t size, std::size_t alignment) {
  if (counts) {
    ++news;
    if (until_fails-- == 0) {
      until_fails = 0;
      throw std::bad_alloc();
    }
    ++living;
  }
  void* place = nullptr;
  if (::posix_memalign(&place, alignment, size) != 0) throw std::bad_alloc();
  return place;
}
void release(void* place) noexcept {
  if (counts && place != nullptr) --living;
  std::free(place);
}
}  // namespace

void* operator new(std::size_t size) {
  return allocate(size, __STDCPP_DEFAULT_NEW_ALIGNMENT__);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  return allocate(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* place) noexcept {
  release(place);
}
void operator delete(void* place, std::size_t) noexcept {
  release(place);
}
void operator delete(void* place, std::align_val_t) noexcept {
  release(place);
}
void operator delete(void* place, std::size_t, std::align_val_t) noexcept {
  release(place);
}

namespace boxtree {
namespace {

// An allocator of the application's.
class Counting {
 public:
  // Fails at its call number `fails_at`, from 0.
  explicit Counting(std::size_t fails_at = SIZE_MAX) : fails_at_(fails_at) {
    hooks_.struct_size = sizeof hooks_;
    hooks_.context = this;
    hooks_.allocate = [](void* context, std::size_t size, std::size_t alignment) {
      return static_cast<Counting*>(context)->allocate(size, alignment);
    };
    hooks_.release = [](void* context, void* memory, std::size_t size, std::size_t alignment) {
      static_cast<Counting*>(context)->release(memory, size, alignment);
    };
  }

  [[nodiscard]] const bxt_allocator* hooks() const { return &hooks_; }
  [[nodiscard]] std::size_t calls() const { return calls_; }
  [[nodiscard]] int living() const { return living_; }
  [[nodiscard]] bool is_kept() const { return is_kept_; }

 private:
  // In front of each piece, what was requested; the piece is at no higher multiple than that.
  struct Header {
    std::size_t size, alignment;
  };

  void* allocate(std::size_t size, std::size_t alignment) {
    if (calls_++ == fails_at_) return nullptr;
    if (alignment == 0 || (alignment & (alignment - 1)) != 0) is_kept_ = false;
    ++living_;
    auto* const place = static_cast<std::byte*>(std::malloc(size + 4 * alignment + sizeof(Header)));
    auto at = reinterpret_cast<std::uintptr_t>(place) + sizeof(Header) + sizeof(void*);
    at = (at + 2 * alignment - 1) / (2 * alignment) * (2 * alignment) + alignment;
    auto* const memory = reinterpret_cast<std::byte*>(at);
    std::memcpy(memory - sizeof(void*), &place, sizeof place);
    const Header header{size, alignment};
    std::memcpy(place, &header, sizeof header);
    return memory;
  }
  void release(void* memory, std::size_t size, std::size_t alignment) {
    std::byte* place;
    std::memcpy(&place, static_cast<std::byte*>(memory) - sizeof(void*), sizeof place);
    Header header;
    std::memcpy(&header, place, sizeof header);
    if (header.size != size || header.alignment != alignment) is_kept_ = false;
    --living_;
    std::free(place);
  }

  bxt_allocator hooks_ = {};
  std::size_t fails_at_;
  std::size_t calls_ = 0;
  int living_ = 0;
  bool is_kept_ = true;
};

// Everything that makes a handle or allocates, once; returns the first error.
class Work {
 public:
  Work() {
    const test::CookedScene scene =
        test::cook_scene({test::torus(8, 6)}, test::random_parts(9, 1, 3, 2, 1));
    scene_bytes_ = scene.bytes;
    path_ = folder_
                .write("scene.bxt",
                       {reinterpret_cast<const char*>(scene_bytes_.data()), scene_bytes_.size()})
                .string();
    tree_bytes_ = test::cook_bytes(test::torus(8, 6), CodecId::kWide8);
  }

  // Of operator new, by all handles at the end of run().
  [[nodiscard]] std::ptrdiff_t kept() const { return kept_; }

  bxt_status run(const bxt_allocator* allocator) {
    bxt_file* file = nullptr;
    bxt_file* of_tree = nullptr;
    bxt_tree* tree = nullptr;
    bxt_tree* copy = nullptr;
    bxt_tree* part = nullptr;
    bxt_scene* scene = nullptr;
    bxt_scene* assembled = nullptr;
    bxt_file_options file_options = {};
    file_options.struct_size = sizeof file_options;
    file_options.copy = true;
    file_options.allocator = allocator;
    bxt_tree_options tree_options = {};
    tree_options.struct_size = sizeof tree_options;
    tree_options.allocator = allocator;
    const std::uint32_t moving = 1;
    bxt_scene_options scene_options = {};
    scene_options.struct_size = sizeof scene_options;
    scene_options.moving = &moving;
    scene_options.moving_count = 1;
    scene_options.allocator = allocator;
    bxt_placed_tree placed = {};
    placed.struct_size = sizeof placed;
    placed.pose = bxt_identity();
    placed.moves = true;
    placed.user_data = 1;
    placed.name = "a name that is longer than short strings are";
    bxt_scene_layer layer = {};
    layer.struct_size = sizeof layer;
    layer.name = "another name that is longer than short strings are";
    const bxt_pose pose = bxt_identity();

    const auto first_error = [&](auto... steps) {
      bxt_status status = BXT_OK;
      static_cast<void>((((status = steps()) == BXT_OK) && ...));
      return status;
    };
    const bxt_status status = first_error(
        [&] { return bxt_file_open(path_.c_str(), &file_options, &file, nullptr); },
        [&] { return bxt_scene_bind(file, &scene_options, &scene, nullptr); },
        [&] { return bxt_scene_set_enabled(scene, 0, false, nullptr); },
        [&] { return bxt_scene_set_user_data(scene, 0, 1, nullptr); },
        [&] { return bxt_scene_make_movable(scene, 4, nullptr); },
        [&] { return bxt_scene_update(scene, 4, &pose, nullptr); },
        [&] { return bxt_scene_rebuild(scene, nullptr); },
        [&] { return bxt_scene_copy_tree(scene, 0, allocator, &part, nullptr); },
        [&] {
          file_options.copy = false;
          return bxt_file_open_memory(tree_bytes_.data(), tree_bytes_.size(), &file_options,
                                      &of_tree, nullptr);
        },
        [&] { return bxt_tree_bind(of_tree, 0, &tree_options, &tree, nullptr); },
        [&] { return bxt_tree_copy_without_duplicates(tree, allocator, &copy, nullptr); },
        [&] {
          const bxt_tree* const trees[] = {tree};
          return bxt_scene_assemble(trees, 1, &placed, 1, &layer, 1, allocator, &assembled,
                                    nullptr);
        });
    kept_ = living;
    bxt_scene_release(assembled);
    bxt_tree_release(copy);
    bxt_tree_release(tree);
    bxt_file_close(of_tree);
    bxt_tree_release(part);
    bxt_scene_release(scene);
    bxt_file_close(file);
    return status;
  }

 private:
  test::TempFolder folder_;
  std::string path_;
  std::vector<std::byte> scene_bytes_, tree_bytes_;
  std::ptrdiff_t kept_ = 0;
};

struct Outcome {
  bxt_status status;
  std::size_t news;
  std::ptrdiff_t living;
};

// The work while operator new succeeds that often.
Outcome run(Work& work, const bxt_allocator* allocator, std::size_t until) {
  news = 0;
  living = 0;
  until_fails = until;
  counts = true;
  const bxt_status status = work.run(allocator);
  counts = false;
  return {status, news, living};
}

// With all that they own: files, trees, scenes.
TEST(CMemory, OfHandlesComesFromTheAllocatorAndGoesBack) {
  Work work;
  const Outcome plain = run(work, nullptr, SIZE_MAX);
  EXPECT_EQ(plain.status, BXT_OK);
  EXPECT_EQ(plain.living, 0);
  EXPECT_GT(work.kept(), 20);
  const Counting counting;
  const Outcome with = run(work, counting.hooks(), SIZE_MAX);
  EXPECT_EQ(with.status, BXT_OK);
  EXPECT_EQ(with.living, 0);
  EXPECT_EQ(work.kept(), 0);
  EXPECT_GT(counting.calls(), 20u);
  EXPECT_LE(with.news, 1u);  // the name of a file
  EXPECT_EQ(counting.living(), 0);
  EXPECT_TRUE(counting.is_kept());
}

TEST(CMemory, ThatTheAllocatorDoesNotHaveIsAnError) {
  Work work;
  const Counting all;
  run(work, all.hooks(), SIZE_MAX);
  for (std::size_t i = 0; i < all.calls(); ++i) {
    const Counting counting(i);
    const Outcome outcome = run(work, counting.hooks(), SIZE_MAX);
    EXPECT_EQ(outcome.status, BXT_OUT_OF_MEMORY);
    EXPECT_EQ(outcome.living, 0);
    EXPECT_EQ(counting.calls(), i + 1);
    EXPECT_EQ(counting.living(), 0);
    EXPECT_TRUE(counting.is_kept());
  }
}

TEST(CMemory, ThatOperatorNewDoesNotHaveIsAnError) {
  Work work;
  const std::size_t all = run(work, nullptr, SIZE_MAX).news;
  ASSERT_GT(all, 20u);
  for (std::size_t i = 0; i < all; ++i) {
    const Outcome outcome = run(work, nullptr, i);
    EXPECT_EQ(outcome.status, BXT_OUT_OF_MEMORY) << i;
    EXPECT_EQ(outcome.living, 0) << i;
  }
}

// Found by a tester: an instance that could not be made movable was in no answer, and an update of
// it crashed.
TEST(CMemory, ThatASceneDoesNotGetLeavesItAsItWas) {
  const test::CookedScene cooked =
      test::cook_scene({test::torus(12, 8), test::city(4, 1)}, test::random_parts(40, 2, 6, 1, 1));
  const test::CFile file = test::open_c(cooked.bytes);
  const test::CScene scene = test::bind_scene_c(file);
  const auto faces = [&] {
    std::size_t count = 0;
    const bxt_vec3 low{-1e9, -1e9, -1e9}, high{1e9, 1e9, 1e9};
    const auto add = [](void* context, const bxt_face*) {
      ++*static_cast<std::size_t*>(context);
      return true;
    };
    EXPECT_EQ(bxt_scene_overlap_box(scene.get(), &low, &high, add, &count, nullptr, nullptr),
              BXT_OK);
    return count;
  };
  const std::size_t all = faces();
  const bxt_pose pose{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}};
  std::size_t failures = 0;
  for (std::uint32_t i = 0; i < bxt_scene_instance_count(scene.get()); ++i) {
    bxt_instance instance{};
    instance.struct_size = sizeof(instance);
    ASSERT_EQ(bxt_scene_instance(scene.get(), i, &instance, nullptr), BXT_OK);
    for (std::size_t until = 0;; ++until) {
      until_fails = until;
      counts = true;
      const bxt_status status = instance.moves ? bxt_scene_rebuild(scene.get(), nullptr)
                                               : bxt_scene_make_movable(scene.get(), i, nullptr);
      counts = false;
      ASSERT_EQ(faces(), all) << "instance " << i << ", allocation " << until;
      if (status == BXT_OK) break;
      ASSERT_EQ(status, BXT_OUT_OF_MEMORY);
      ++failures;
      if (!instance.moves) {
        ASSERT_EQ(bxt_scene_update(scene.get(), i, &pose, nullptr), BXT_INSTANCE_STATIC);
      }
    }
  }
  EXPECT_GT(failures, 20u);
}

TEST(CMemory, IsNotTakenByQueries) {
  const test::CookedScene cooked =
      test::cook_scene({test::torus(12, 8), test::city(4, 1)}, test::random_parts(40, 2, 6, 1, 1));
  const std::vector<std::byte> bytes = test::cook_bytes(test::torus(20, 12), CodecId::kWide8);
  const test::CFile file = test::open_c(bytes), scene_file = test::open_c(cooked.bytes);
  const test::CTree tree = test::bind_c(file);
  const test::CScene scene = test::bind_scene_c(scene_file);
  for (const test::CQuery& query : test::c_queries(tree.get(), scene.get(), {1, 0, 0}, 3)) {
    news = 0;
    until_fails = SIZE_MAX;
    counts = true;
    const bxt_status status = query.run();
    counts = false;
    EXPECT_EQ(status, BXT_OK) << query.name;
    EXPECT_EQ(news, 0u) << query.name;
  }
}

// The message of an error takes memory in C++; what is out of memory has a message all the same.
TEST(CMemory, ThatTheTextOfAnErrorNeedsMayBeMissing) {
  bxt_error error = {};
  error.struct_size = sizeof error;
  const std::string path(100, 'x');
  bxt_file* file = nullptr;
  until_fails = 0;
  living = 0;
  counts = true;
  const bxt_status status = bxt_file_open(path.c_str(), nullptr, &file, &error);
  counts = false;
  EXPECT_EQ(status, BXT_OUT_OF_MEMORY);
  EXPECT_STREQ(error.message, "out_of_memory: no memory left");
  EXPECT_EQ(living, 0);
  EXPECT_EQ(file, nullptr);
}

}  // namespace
}  // namespace boxtree
