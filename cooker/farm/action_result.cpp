// SPDX-License-Identifier: MIT
#include "cooker/farm/action_result.h"

#include <cstdint>
#include <utility>

#include <fmt/format.h>

namespace boxtree::cooker {
namespace {

// Types of fields on the wire.
enum class Wire : std::uint8_t { kNumber = 0, kFixed64 = 1, kText = 2, kFixed32 = 5 };

// Numbers of fields.
namespace action_result {
constexpr std::uint64_t kOutputFiles = 2, kStderrRaw = 7;
}
namespace output_file {
constexpr std::uint64_t kPath = 1, kDigest = 2;
}
namespace file_digest {
constexpr std::uint64_t kHash = 1, kSizeBytes = 2;
}

// Seven bits a byte, the lowest first; the highest bit says that more come.
void add_number(std::string& out, std::uint64_t number) {
  for (; number >= 0x80; number >>= 7) out += static_cast<char>(number | 0x80);
  out += static_cast<char>(number);
}

void add_tag(std::string& out, std::uint64_t field, Wire wire) {
  add_number(out, field << 3 | static_cast<std::uint64_t>(wire));
}

void add_text(std::string& out, std::uint64_t field, std::string_view text) {
  add_tag(out, field, Wire::kText);
  add_number(out, text.size());
  out += text;
}

// The fields of a message, one after the other.
class Fields {
 public:
  explicit Fields(std::string_view bytes) : rest_(bytes) {}

  // False at the end and before what is no field.
  bool next() {
    is_valid_ = is_valid_ && (rest_.empty() || take());
    return is_valid_ && std::exchange(is_taken_, false);
  }

  // Whether there was nothing but fields.
  [[nodiscard]] bool is_at_end() const { return is_valid_ && rest_.empty(); }

  [[nodiscard]] bool is(std::uint64_t field, Wire wire) const {
    return field_ == field && wire_ == wire;
  }
  [[nodiscard]] std::uint64_t number() const { return number_; }
  [[nodiscard]] std::string_view text() const { return text_; }

 private:
  bool take() {
    const std::optional<std::uint64_t> tag = take_number();
    if (!tag) return false;
    field_ = *tag >> 3;
    wire_ = static_cast<Wire>(*tag & 7);
    number_ = 0;
    text_ = {};
    is_taken_ = take_value();
    return is_taken_;
  }

  bool take_value() {
    std::optional<std::uint64_t> number;
    switch (wire_) {
      case Wire::kNumber:
        number = take_number();
        number_ = number.value_or(0);
        return number.has_value();
      case Wire::kFixed64:
        return take_text(8);
      case Wire::kText:
        number = take_number();
        return number && take_text(*number);
      case Wire::kFixed32:
        return take_text(4);
    }
    return false;  // a type that is none, or a group, which nobody writes any more
  }

  std::optional<std::uint64_t> take_number() {
    std::uint64_t number = 0;
    for (int shift = 0; shift < 64 && !rest_.empty(); shift += 7) {
      const auto byte = static_cast<unsigned char>(rest_.front());
      rest_.remove_prefix(1);
      number |= std::uint64_t{byte & 0x7fu} << shift;
      if (byte < 0x80) return number;
    }
    return std::nullopt;
  }

  bool take_text(std::uint64_t size) {
    if (size > rest_.size()) return false;
    text_ = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return true;
  }

  std::string_view rest_;
  std::uint64_t field_ = 0, number_ = 0;
  Wire wire_ = Wire::kNumber;
  std::string_view text_;
  bool is_taken_ = false;
  bool is_valid_ = true;
};

std::string name_of(const Digest& key, const CookCache::Entry& entry) {
  return hex_of(sha256_of(fmt::format("boxtree cache 1\n{}\n{}\n{}\n{}", hex_of(key),
                                      hex_of(entry.output), entry.bytes, entry.report))) +
         ".bxt";
}

bool read_digest(std::string_view bytes, CookCache::Entry& entry) {
  std::optional<Digest> hash;
  Fields fields(bytes);
  while (fields.next()) {
    if (fields.is(file_digest::kHash, Wire::kText)) hash = digest_of(fields.text());
    if (fields.is(file_digest::kSizeBytes, Wire::kNumber)) entry.bytes = fields.number();
  }
  if (!hash || !fields.is_at_end()) return false;
  entry.output = *hash;
  return true;
}

bool read_output_file(std::string_view bytes, CookCache::Entry& entry, std::string& name) {
  bool has_digest = false;
  Fields fields(bytes);
  while (fields.next()) {
    if (fields.is(output_file::kPath, Wire::kText)) name = fields.text();
    if (fields.is(output_file::kDigest, Wire::kText))
      has_digest = read_digest(fields.text(), entry);
  }
  return has_digest && fields.is_at_end();
}

}  // namespace

std::string action_result_of(const Digest& key, const CookCache::Entry& entry) {
  std::string digest;
  add_text(digest, file_digest::kHash, hex_of(entry.output));
  add_tag(digest, file_digest::kSizeBytes, Wire::kNumber);
  add_number(digest, entry.bytes);
  std::string file;
  add_text(file, output_file::kPath, name_of(key, entry));
  add_text(file, output_file::kDigest, digest);
  std::string result;
  add_text(result, action_result::kOutputFiles, file);
  add_text(result, action_result::kStderrRaw, entry.report);
  return result;
}

std::optional<CookCache::Entry> entry_in_action_result(std::string_view bytes, const Digest& key) {
  CookCache::Entry entry{};
  std::string name;
  Fields fields(bytes);
  while (fields.next()) {
    if (fields.is(action_result::kOutputFiles, Wire::kText) &&
        !read_output_file(fields.text(), entry, name)) {
      return std::nullopt;
    }
    if (fields.is(action_result::kStderrRaw, Wire::kText)) entry.report = fields.text();
  }
  // Whatever the bytes say beside it, the seal is of one entry.
  if (!fields.is_at_end() || name != name_of(key, entry)) return std::nullopt;
  return entry;
}

}  // namespace boxtree::cooker
