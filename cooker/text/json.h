// SPDX-License-Identifier: MIT
// JSON documents to build, print and read. nlohmann/json prints and parses them, in json.cpp alone:
// its templates take seconds of each source that builds a document with them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace boxtree::cooker {

/// Of all documents of this program (docs/JSON.md).
inline constexpr int kJsonSchema = 1;

/// A value of JSON; members of objects stay in the order in which they were added. Built from lists
/// in braces: one of pairs that begin with a text is an object, any other an array.
class Json {
 public:
  class Item;
  struct Member;

  Json() noexcept = default;  // null
  Json(std::nullptr_t) noexcept {}
  Json(bool value) noexcept : kind_(Kind::kFlag) { value_.flag = value; }
  Json(int value) noexcept : Json(static_cast<long long>(value)) {}
  Json(unsigned value) noexcept : Json(static_cast<unsigned long long>(value)) {}
  Json(long value) noexcept : Json(static_cast<long long>(value)) {}
  Json(unsigned long value) noexcept : Json(static_cast<unsigned long long>(value)) {}
  Json(long long value) noexcept : kind_(Kind::kSigned) { value_.whole = value; }
  Json(unsigned long long value) noexcept : kind_(Kind::kUnsigned) { value_.natural = value; }
  /// What is not finite is printed as null.
  Json(double value) noexcept : kind_(Kind::kReal) { value_.real = value; }
  Json(const char* text) : Json(std::string_view(text)) {}
  Json(const std::string& text) : Json(std::string_view(text)) {}
  Json(std::string_view text);
  Json(std::initializer_list<Item> list);

  Json(const Json& other);
  Json(Json&& other) noexcept { swap(other); }
  Json& operator=(Json other) noexcept {
    swap(other);
    return *this;
  }
  ~Json() {
    if (kind_ >= Kind::kText) destroy();
  }
  void swap(Json& other) noexcept {
    std::swap(kind_, other.kind_);
    std::swap(value_, other.value_);
  }

  static Json array(std::initializer_list<Item> list = {});
  static Json array_of(std::vector<Json> elements);
  static Json array_of(std::span<const float> numbers);
  static Json array_of(std::span<const std::uint32_t> numbers);
  static Json array_of(std::span<const std::string> texts);
  static Json object();
  /// Precondition: no two have the same name.
  static Json object_of(std::vector<Member> members);

  [[nodiscard]] bool is_null() const { return kind_ == Kind::kNull; }
  [[nodiscard]] bool is_boolean() const { return kind_ == Kind::kFlag; }
  [[nodiscard]] bool is_number() const { return kind_ >= Kind::kSigned && kind_ <= Kind::kReal; }
  /// Without a sign, a point and an exponent.
  [[nodiscard]] bool is_number_unsigned() const { return kind_ == Kind::kUnsigned; }
  [[nodiscard]] bool is_number_float() const { return kind_ == Kind::kReal; }
  [[nodiscard]] bool is_string() const { return kind_ == Kind::kText; }
  [[nodiscard]] bool is_array() const { return kind_ == Kind::kArray; }
  [[nodiscard]] bool is_object() const { return kind_ == Kind::kObject; }
  [[nodiscard]] bool is_structured() const { return is_array() || is_object(); }
  /// "null", "boolean", "number", "string", "array" or "object".
  [[nodiscard]] const char* type_name() const;

  /// The value as a bool, a double, an unsigned integer of 32 or 64 bits or a std::string.
  /// Precondition: it is of that type; a number is of each of the three.
  template <class T>
  [[nodiscard]] T get() const = delete;

  /// Of an array or an object; 0 for null.
  [[nodiscard]] std::size_t size() const;
  [[nodiscard]] bool empty() const { return size() == 0; }

  /// The member of that name, which is added as null if there is none. Precondition: an object, or
  /// null, which becomes one. find(): O(log members); to add one moves at most as many numbers.
  Json& operator[](std::string_view key);
  /// Precondition: an object that has it.
  const Json& operator[](std::string_view key) const;
  /// Null if there is none, or if this is no object.
  [[nodiscard]] const Json* find(std::string_view key) const;
  [[nodiscard]] bool contains(std::string_view key) const { return find(key) != nullptr; }
  /// The members of an object; none of another value.
  [[nodiscard]] std::span<Member> items();
  [[nodiscard]] std::span<const Member> items() const;
  /// Takes the members of another object, in place of its own of the same names.
  void update(const Json& other);

  /// Precondition: an array, or null, which becomes one.
  void push_back(Json element) { emplace_back() = std::move(element); }
  Json& emplace_back();
  /// Precondition for these: an array that has the element.
  Json& operator[](std::size_t i) { return begin()[i]; }
  const Json& operator[](std::size_t i) const { return begin()[i]; }
  [[nodiscard]] const Json& front() const { return *begin(); }
  [[nodiscard]] const Json& back() const { return *(end() - 1); }
  /// The elements of an array; none of another value.
  [[nodiscard]] Json* begin();
  [[nodiscard]] Json* end();
  [[nodiscard]] const Json* begin() const;
  [[nodiscard]] const Json* end() const;

  /// As text: with line ends and `indent` spaces a level, or without any if it is negative. Bytes
  /// that are no UTF-8 become U+FFFD. `ascii`: all other characters as \uXXXX.
  [[nodiscard]] std::string dump(int indent = -1, bool ascii = false) const;

 private:
  struct Object;
  // Those from kText on are on the heap.
  enum class Kind : std::uint8_t {
    kNull,
    kFlag,
    kSigned,
    kUnsigned,
    kReal,
    kText,
    kArray,
    kObject,
  };
  union Value {
    bool flag;
    std::int64_t whole;
    std::uint64_t natural;
    double real;
    std::string* text;
    std::vector<Json>* array;
    Object* object;
  };

  void destroy() noexcept;

  Kind kind_ = Kind::kNull;
  Value value_{};
};

struct Json::Member {
  std::string key;
  Json value;
};

/// An element of a list in braces. It only refers to texts and lists, which live as long as the
/// statement.
class Json::Item {
 public:
  Item(std::nullptr_t) noexcept {}
  Item(bool value) noexcept : kind_(Kind::kFlag) { value_.flag = value; }
  Item(int value) noexcept : Item(static_cast<long long>(value)) {}
  Item(unsigned value) noexcept : Item(static_cast<unsigned long long>(value)) {}
  Item(long value) noexcept : Item(static_cast<long long>(value)) {}
  Item(unsigned long value) noexcept : Item(static_cast<unsigned long long>(value)) {}
  Item(long long value) noexcept : kind_(Kind::kSigned) { value_.whole = value; }
  Item(unsigned long long value) noexcept : kind_(Kind::kUnsigned) { value_.natural = value; }
  Item(double value) noexcept : kind_(Kind::kReal) { value_.real = value; }
  Item(const char* text) noexcept : Item(std::string_view(text)) {}
  Item(const std::string& text) noexcept : Item(std::string_view(text)) {}
  Item(std::string_view text) noexcept : kind_(Kind::kText), size_(text.size()) {
    value_.text = text.data();
  }
  Item(const Json& json) noexcept : kind_(Kind::kCopied) { value_.json = &json; }
  Item(Json&& json) noexcept : kind_(Kind::kMoved) { value_.moved = &json; }
  Item(std::initializer_list<Item> list) noexcept : kind_(Kind::kList), size_(list.size()) {
    value_.list = list.begin();
  }

 private:
  friend class Json;

  enum class Kind : std::uint8_t {
    kNull,
    kFlag,
    kSigned,
    kUnsigned,
    kReal,
    kText,
    kCopied,
    kMoved,
    kList,
  };
  union Value {
    bool flag;
    std::int64_t whole;
    std::uint64_t natural;
    double real;
    const char* text;
    const Json* json;
    Json* moved;
    const Item* list;
  };

  static Json json_of(std::span<const Item> list);
  [[nodiscard]] Json json() const;
  [[nodiscard]] bool is_member() const;

  Kind kind_ = Kind::kNull;
  std::size_t size_ = 0;  // of a text or a list
  Value value_{};
};

template <>
bool Json::get() const;
template <>
double Json::get() const;
template <>
std::uint32_t Json::get() const;
template <>
std::uint64_t Json::get() const;
template <>
std::string Json::get() const;

/// A text that was read as JSON.
struct ParsedJson {
  enum class Fault {
    kNone,
    kNoJson,    // at `byte`
    kTooDeep,   // a value in more than `deepest` arrays and objects
    kTooLarge,  // a number beyond what a double holds
  };
  Fault fault = Fault::kNone;
  std::size_t byte = 0;  // counted from 1
  Json value;            // null after a fault
  /// Those of the outermost object, in its order and each as often as it is there; up to the fault
  /// kTooDeep.
  std::vector<std::string> keys;
  /// A name that several members of one object have.
  std::optional<std::string> twice;
};

/// Reads a whole text. Of members with the same name the last one counts, in the place of the
/// first. O(bytes log bytes).
[[nodiscard]] ParsedJson parse_json(std::string_view text, std::size_t deepest = 64);

}  // namespace boxtree::cooker
