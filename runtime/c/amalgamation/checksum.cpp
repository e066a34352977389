// SPDX-License-Identifier: MIT
// In the amalgamation, in place of runtime/file/checksum.cpp: XXH3-64 as its specification
// describes it (https://github.com/Cyan4973/xxHash/blob/dev/doc/xxhash_spec.md), without a seed and
// without vectors.
#include "runtime/file/checksum.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <new>

#include "format/bytes.h"
#include "runtime/file/checksum_stream.h"

namespace boxtree {
namespace {

// Multiplicands of the specification.
constexpr std::uint64_t kPrime32[] = {0x9e3779b1, 0x85ebca77, 0xc2b2ae3d};
constexpr std::uint64_t kPrime64[] = {0x9e3779b185ebca87, 0xc2b2ae3d27d4eb4f, 0x165667b19e3779f9,
                                      0x85ebca77c2b2ae63, 0x27d4eb2f165667c5};
constexpr std::uint64_t kMix1 = 0x165667919e3779f9, kMix2 = 0x9fb21c651e98df25;

// The default secret.
constexpr std::uint8_t kSecret[] = {
    0xb8, 0xfe, 0x6c, 0x39, 0x23, 0xa4, 0x4b, 0xbe, 0x7c, 0x01, 0x81, 0x2c, 0xf7, 0x21, 0xad, 0x1c,
    0xde, 0xd4, 0x6d, 0xe9, 0x83, 0x90, 0x97, 0xdb, 0x72, 0x40, 0xa4, 0xa4, 0xb7, 0xb3, 0x67, 0x1f,
    0xcb, 0x79, 0xe6, 0x4e, 0xcc, 0xc0, 0xe5, 0x78, 0x82, 0x5a, 0xd0, 0x7d, 0xcc, 0xff, 0x72, 0x21,
    0xb8, 0x08, 0x46, 0x74, 0xf7, 0x43, 0x24, 0x8e, 0xe0, 0x35, 0x90, 0xe6, 0x81, 0x3a, 0x26, 0x4c,
    0x3c, 0x28, 0x52, 0xbb, 0x91, 0xc3, 0x00, 0xcb, 0x88, 0xd0, 0x65, 0x8b, 0x1b, 0x53, 0x2e, 0xa3,
    0x71, 0x64, 0x48, 0x97, 0xa2, 0x0d, 0xf9, 0x4e, 0x38, 0x19, 0xef, 0x46, 0xa9, 0xde, 0xac, 0xd8,
    0xa8, 0xfa, 0x76, 0x3f, 0xe3, 0x9c, 0x34, 0x3f, 0xf9, 0xdc, 0xbb, 0xc7, 0xc7, 0x0b, 0x4f, 0x1d,
    0x8a, 0x51, 0xe0, 0x4b, 0xcd, 0xb4, 0x59, 0x31, 0xc8, 0x9f, 0x7e, 0xc9, 0xd9, 0x78, 0x73, 0x64,
    0xea, 0xc5, 0xac, 0x83, 0x34, 0xd3, 0xeb, 0xc3, 0xc5, 0x81, 0xa0, 0xff, 0xfa, 0x13, 0x63, 0xeb,
    0x17, 0x0d, 0xdd, 0x51, 0xb7, 0xf0, 0xda, 0x49, 0xd3, 0x16, 0x55, 0x26, 0x29, 0xd4, 0x68, 0x9e,
    0x2b, 0x16, 0xbe, 0x58, 0x7d, 0x47, 0xa1, 0xfc, 0x8f, 0xf8, 0xb8, 0xd1, 0x7a, 0xd0, 0x31, 0xce,
    0x45, 0xcb, 0x3a, 0x8f, 0x95, 0x16, 0x04, 0x28, 0xaf, 0xd7, 0xfb, 0xca, 0xbb, 0x4b, 0x40, 0x7e,
};

std::uint64_t word_at(const std::byte* bytes) noexcept {
  return load<std::uint64_t>(bytes);
}
std::uint64_t half_word_at(const std::byte* bytes) noexcept {
  return load<std::uint32_t>(bytes);
}
std::uint64_t secret_word(std::size_t at) noexcept {
  return word_at(reinterpret_cast<const std::byte*>(kSecret) + at);
}
std::uint64_t secret_half_word(std::size_t at) noexcept {
  return half_word_at(reinterpret_cast<const std::byte*>(kSecret) + at);
}

std::uint64_t reversed(std::uint64_t word) noexcept {
  std::uint64_t out = 0;
  for (int i = 0; i < 8; ++i) out |= ((word >> (8 * i)) & 0xff) << (56 - 8 * i);
  return out;
}

// Both halves of a product of 128 bits, combined.
std::uint64_t folded_product(std::uint64_t a, std::uint64_t b) noexcept {
  constexpr std::uint64_t kLow = 0xffffffff;
  const std::uint64_t low = (a & kLow) * (b & kLow);
  const std::uint64_t first = (a >> 32) * (b & kLow) + (low >> 32);
  const std::uint64_t second = (a & kLow) * (b >> 32) + (first & kLow);
  const std::uint64_t high = (a >> 32) * (b >> 32) + (first >> 32) + (second >> 32);
  return ((second << 32) | (low & kLow)) ^ high;
}

std::uint64_t avalanche(std::uint64_t hash) noexcept {
  hash = (hash ^ (hash >> 37)) * kMix1;
  return hash ^ (hash >> 32);
}
// That of XXH64, for the shortest inputs.
std::uint64_t avalanche64(std::uint64_t hash) noexcept {
  hash = (hash ^ (hash >> 33)) * kPrime64[1];
  hash = (hash ^ (hash >> 29)) * kPrime64[2];
  return hash ^ (hash >> 32);
}

std::uint64_t mixed(const std::byte* bytes, std::size_t secret) noexcept {
  return folded_product(word_at(bytes) ^ secret_word(secret),
                        word_at(bytes + 8) ^ secret_word(secret + 8));
}

// Up to 240 bytes in a row.
std::uint64_t checksum_of_short(const std::byte* bytes, std::size_t size) noexcept {
  if (size == 0) return avalanche64(secret_word(56) ^ secret_word(64));
  if (size <= 3) {
    const auto byte = [&](std::size_t i) { return std::to_integer<std::uint64_t>(bytes[i]); };
    const std::uint64_t all = byte(0) << 16 | byte(size / 2) << 24 | byte(size - 1) | size << 8;
    return avalanche64(all ^ secret_half_word(0) ^ secret_half_word(4));
  }
  if (size <= 8) {
    const std::uint64_t both = half_word_at(bytes + size - 4) + (half_word_at(bytes) << 32);
    std::uint64_t hash = both ^ secret_word(8) ^ secret_word(16);
    hash = (hash ^ std::rotl(hash, 49) ^ std::rotl(hash, 24)) * kMix2;
    hash = (hash ^ ((hash >> 35) + size)) * kMix2;
    return hash ^ (hash >> 28);
  }
  if (size <= 16) {
    const std::uint64_t low = word_at(bytes) ^ secret_word(24) ^ secret_word(32);
    const std::uint64_t high = word_at(bytes + size - 8) ^ secret_word(40) ^ secret_word(48);
    return avalanche(size + reversed(low) + high + folded_product(low, high));
  }
  std::uint64_t hash = size * kPrime64[0];
  if (size <= 128) {
    for (std::size_t i = (size - 1) / 32 + 1; i-- > 0;) {
      hash += mixed(bytes + 16 * i, 32 * i) + mixed(bytes + size - 16 * (i + 1), 32 * i + 16);
    }
    return avalanche(hash);
  }
  for (std::size_t i = 0; i < 8; ++i) hash += mixed(bytes + 16 * i, 16 * i);
  hash = avalanche(hash);
  for (std::size_t i = 8; i < size / 16; ++i) hash += mixed(bytes + 16 * i, 16 * (i - 8) + 3);
  return avalanche(hash + mixed(bytes + size - 16, 136 - 17));
}

constexpr std::size_t kStripe = 64;
constexpr std::size_t kShort = 240;

// Of more bytes, stripe by stripe.
class Accumulator {
 public:
  void add(const std::byte* stripe, std::size_t secret) noexcept {
    for (std::size_t i = 0; i < 8; ++i) {
      const std::uint64_t word = word_at(stripe + 8 * i);
      const std::uint64_t keyed = word ^ secret_word(secret + 8 * i);
      lane_[i ^ 1] += word;
      lane_[i] += (keyed & 0xffffffff) * (keyed >> 32);
    }
  }
  void scramble() noexcept {
    for (std::size_t i = 0; i < 8; ++i) {
      lane_[i] = (lane_[i] ^ (lane_[i] >> 47) ^ secret_word(sizeof kSecret - kStripe + 8 * i)) *
                 kPrime32[0];
    }
  }
  [[nodiscard]] std::uint64_t value(std::uint64_t size) const noexcept {
    std::uint64_t hash = size * kPrime64[0];
    for (std::size_t i = 0; i < 4; ++i) {
      hash += folded_product(lane_[2 * i] ^ secret_word(11 + 16 * i),
                             lane_[2 * i + 1] ^ secret_word(19 + 16 * i));
    }
    return avalanche(hash);
  }

 private:
  std::array<std::uint64_t, 8> lane_ = {kPrime32[2], kPrime64[0], kPrime64[1], kPrime64[2],
                                        kPrime64[3], kPrime32[1], kPrime64[4], kPrime32[0]};
};

// Bytes that come piece by piece.
struct State {
  // A stripe is accumulated when a byte follows it: the last one is read otherwise.
  void add(const std::byte* bytes, std::size_t count) noexcept {
    if (size < kShort) {
      std::copy_n(bytes, std::min(count, kShort - static_cast<std::size_t>(size)),
                  first.data() + size);
    }
    size += count;
    while (count > 0) {
      if (pending == kStripe) accumulate();
      const std::size_t taken = std::min(count, kStripe - pending);
      std::copy_n(bytes, taken, stripe.data() + pending);
      pending += taken;
      bytes += taken;
      count -= taken;
    }
  }

  [[nodiscard]] std::uint64_t value() const noexcept {
    if (size <= kShort) return checksum_of_short(first.data(), static_cast<std::size_t>(size));
    std::array<std::byte, kStripe> last;
    std::copy_n(before.data() + pending, kStripe - pending, last.data());
    std::copy_n(stripe.data(), pending, last.data() + (kStripe - pending));
    Accumulator all = accumulator;
    all.add(last.data(), sizeof kSecret - kStripe - 7);
    return all.value(size);
  }

  std::uint64_t size = 0;
  std::array<std::byte, kShort> first;  // all, as long as they are few
  std::array<std::byte, kStripe> stripe, before;
  std::size_t pending = 0;  // of `stripe`
  std::size_t of_block = 0;
  Accumulator accumulator;

 private:
  void accumulate() noexcept {
    constexpr std::size_t kSecretStep = 8;
    constexpr std::size_t kStripesOfBlock = (sizeof kSecret - kStripe) / kSecretStep;
    accumulator.add(stripe.data(), of_block * kSecretStep);
    if (++of_block == kStripesOfBlock) {
      accumulator.scramble();
      of_block = 0;
    }
    before = stripe;
    pending = 0;
  }
};

}  // namespace

std::uint64_t checksum(Bytes head, Bytes tail) noexcept {
  State state;
  state.add(head.data(), head.size());
  state.add(tail.data(), tail.size());
  return state.value();
}

ChecksumStream::ChecksumStream() noexcept {
  static_assert(sizeof(state_) >= sizeof(State) && alignof(ChecksumStream) >= alignof(State));
  ::new (state_.data()) State;
}

void ChecksumStream::add(Bytes bytes) noexcept {
  std::launder(reinterpret_cast<State*>(state_.data()))->add(bytes.data(), bytes.size());
}

std::uint64_t ChecksumStream::value() const noexcept {
  return std::launder(reinterpret_cast<const State*>(state_.data()))->value();
}

}  // namespace boxtree
