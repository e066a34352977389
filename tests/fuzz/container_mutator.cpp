// SPDX-License-Identifier: MIT
// How inputs that are a .bxt file and a query are changed: inside their sections, with the
// checksums made right again, so that what lies behind the checks of the container is reached.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <random>
#include <vector>

#include "format/container.h"
#include "tests/fuzz/query_input.h"
#include "tests/support/cooked.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace boxtree::fuzz {
namespace {

using Random = std::minstd_rand;
using FileBytes = std::vector<std::byte>;

std::size_t below(Random& random, std::size_t end) {
  return end == 0 ? 0 : random() % end;
}

// Sections that can be changed.
std::vector<SectionEntry> sections_of(const FileBytes& file) {
  std::vector<SectionEntry> sections = test::sections_of(file);
  std::erase_if(sections, [](const SectionEntry& entry) { return entry.size == 0; });
  return sections;
}

// A number as records hold them: at the ends of its range, near another one, a power of two.
template <class T>
T lie(Random& random, T before) {
  switch (random() % 6) {
    case 0:
      return static_cast<T>(before + T{1});
    case 1:
      return static_cast<T>(before - T{1});
    case 2:
      return static_cast<T>(~T{0});
    case 3:
      return static_cast<T>(T{1} << below(random, 8 * sizeof(T)));
    case 4:
      return static_cast<T>(before ^ (T{1} << below(random, 8 * sizeof(T))));
    default:
      return T{0};
  }
}

template <class T>
void lie_at(Random& random, std::byte* at) {
  const T value = lie<T>(random, load<T>(at));
  std::memcpy(at, &value, sizeof(value));
}

// Changes some bytes of [begin, begin + size), which is not empty, in place.
void change_bytes(Random& random, std::byte* begin, std::size_t size) {
  const std::size_t width = std::size_t{1} << below(random, 4);
  if (width > size || random() % 4 == 0) {
    const std::size_t length = std::min<std::size_t>(size, 1 + below(random, 16));
    std::byte* const at = begin + below(random, size - length + 1);
    LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(at), length, length);
    return;
  }
  // Numbers lie at multiples of their size.
  std::byte* const at = begin + width * below(random, size / width);
  switch (width) {
    case 1:
      return lie_at<std::uint8_t>(random, at);
    case 2:
      return lie_at<std::uint16_t>(random, at);
    case 4:
      return lie_at<std::uint32_t>(random, at);
    default:
      return lie_at<std::uint64_t>(random, at);
  }
}

// Another part of the file in place of one: children shared, records repeated.
void copy_bytes(Random& random, std::byte* begin, std::size_t size, const FileBytes& from) {
  constexpr std::array<std::size_t, 8> kLengths = {1, 2, 4, 8, 16, 24, 80, 128};
  const std::size_t length = std::min(size, kLengths[random() % kLengths.size()]);
  if (from.size() < length) return;
  std::byte* const to = begin + below(random, size - length + 1);
  std::memmove(to, from.data() + below(random, from.size() - length + 1), length);
}

void change_file(Random& random, FileBytes& file, std::size_t most) {
  const std::vector<SectionEntry> sections = sections_of(file);
  const unsigned kind = random() % 64;
  if (sections.empty() || kind == 0) {  // anything, and sizes
    const std::size_t before = file.size();
    file.resize(std::max(before, most));
    file.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(file.data()), before, most));
    return;
  }
  if (kind <= 3) {  // header and section table
    const std::size_t table = table_end(load<FileHeader>(file.data()).section_count);
    change_bytes(random, file.data(), std::min(table, file.size()));
    return;
  }
  // Sections of few bytes, which hold what counts, as often as those of many.
  const SectionEntry& section = sections[random() % sections.size()];
  std::byte* const begin = file.data() + section.offset;
  const std::size_t times = 1 + random() % 3;
  for (std::size_t i = 0; i < times; ++i) {
    if (random() % 4 == 0) {
      copy_bytes(random, begin, section.size, file);
    } else {
      change_bytes(random, begin, section.size);
    }
  }
}

}  // namespace
}  // namespace boxtree::fuzz

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
  using namespace boxtree;
  using namespace boxtree::fuzz;
  if (size <= kQueryBytes || most <= kQueryBytes) return LLVMFuzzerMutate(data, size, most);
  Random random(seed);
  std::uint8_t* const query = data + (size - kQueryBytes);
  if (random() % 3 == 0) {
    const std::size_t at = below(random, kQueryBytes - 4);
    const std::size_t length = random() % 2 == 0 ? 4 : kQueryBytes - at;
    LLVMFuzzerMutate(query + at, length, length);
    return size;
  }
  const auto* const bytes = reinterpret_cast<const std::byte*>(data);
  FileBytes file(bytes, bytes + (size - kQueryBytes));
  const std::vector<std::byte> tail(bytes + (size - kQueryBytes), bytes + size);
  change_file(random, file, most - kQueryBytes);
  if (random() % 32 != 0) test::repair_checksums(file);
  file.insert(file.end(), tail.begin(), tail.end());
  std::memcpy(data, file.data(), file.size());
  return file.size();
}

extern "C" std::size_t LLVMFuzzerCustomCrossOver(const std::uint8_t* first, std::size_t first_size,
                                                 const std::uint8_t* second,
                                                 std::size_t second_size, std::uint8_t* out,
                                                 std::size_t most, unsigned seed) {
  using namespace boxtree;
  using namespace boxtree::fuzz;
  if (first_size <= kQueryBytes || second_size <= kQueryBytes || first_size > most) return 0;
  Random random(seed);
  const auto* const a = reinterpret_cast<const std::byte*>(first);
  const auto* const b = reinterpret_cast<const std::byte*>(second);
  FileBytes file(a, a + (first_size - kQueryBytes));
  const FileBytes other(b, b + (second_size - kQueryBytes));
  // A section of the other file's that has a place in this one.
  const std::vector<SectionEntry> from = sections_of(other);
  const std::vector<SectionEntry> to = sections_of(file);
  if (from.empty() || to.empty()) return 0;
  const SectionEntry& source = from[random() % from.size()];
  for (const SectionEntry& target : to) {
    if (target.kind != source.kind) continue;
    std::memcpy(file.data() + target.offset, other.data() + source.offset,
                std::min(target.size, source.size));
  }
  test::repair_checksums(file);
  const FileBytes& query = random() % 2 == 0 ? other : file;
  const auto* const tail = &query == &other ? second + other.size() : first + file.size();
  std::memcpy(out, file.data(), file.size());
  std::memcpy(out + file.size(), tail, kQueryBytes);
  return file.size() + kQueryBytes;
}
