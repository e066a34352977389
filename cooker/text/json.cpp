// SPDX-License-Identifier: MIT
#include "cooker/text/json.h"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <utility>

#include <nlohmann/json.hpp>

namespace boxtree::cooker {
namespace {

using Library = nlohmann::ordered_json;

template <class Values>
std::vector<Json> elements_of(const Values& values) {
  std::vector<Json> elements;
  elements.reserve(values.size());
  for (const auto& value : values) elements.emplace_back(value);
  return elements;
}

Library library_value(const Json& json) {
  if (json.is_null()) return nullptr;
  if (json.is_boolean()) return json.get<bool>();
  if (json.is_number_unsigned()) return json.get<std::uint64_t>();
  if (json.is_number_float()) return json.get<double>();
  if (json.is_number()) return static_cast<std::int64_t>(json.get<std::uint64_t>());
  if (json.is_string()) return json.get<std::string>();
  if (json.is_array()) {
    Library array = Library::array();
    array.get_ref<Library::array_t&>().reserve(json.size());
    for (const Json& each : json) array.push_back(library_value(each));
    return array;
  }
  Library object = Library::object();
  auto& members = object.get_ref<Library::object_t&>();
  for (const auto& [key, value] : json.items()) members.emplace_back(key, library_value(value));
  return object;
}

// Of members with the same name the last value stays, in the place of the first. Returns such a
// name.
std::optional<std::string> unite_members(std::vector<Json::Member>& members) {
  std::vector<std::size_t> order(members.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto name = [&members](std::size_t i) { return std::string_view(members[i].key); };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return name(a) < name(b); });
  std::optional<std::string> twice;
  std::vector<bool> is_united(members.size());
  std::size_t first = 0;
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (name(order[i]) != name(order[first])) {
      first = i;
      continue;
    }
    twice = members[order[i]].key;
    members[order[first]].value.swap(members[order[i]].value);
    is_united[order[i]] = true;
  }
  if (twice) {
    std::vector<Json::Member> kept;
    for (std::size_t i = 0; i < members.size(); ++i) {
      if (!is_united[i]) kept.push_back(std::move(members[i]));
    }
    members = std::move(kept);
  }
  return twice;
}

// Builds a document of what the library's parser meets.
class JsonBuilder {
 public:
  JsonBuilder(ParsedJson& parsed, std::size_t deepest) : parsed_(parsed), deepest_(deepest) {}

  bool null() { return put(nullptr); }
  bool boolean(bool value) { return put(value); }
  bool number_integer(std::int64_t value) { return put(value); }
  bool number_unsigned(std::uint64_t value) { return put(value); }
  bool number_float(double value, const std::string& /*text*/) { return put(value); }
  bool string(const std::string& value) { return put(value); }
  bool binary(const Library::binary_t& /*value*/) { return false; }  // JSON has none

  bool start_object(std::size_t /*size*/) { return open(true); }
  bool start_array(std::size_t /*size*/) { return open(false); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }

  bool key(const std::string& name) {
    if (is_storing()) {
      if (depth_ == 1) parsed_.keys.push_back(name);
      open_.back().members.push_back({name, {}});
    }
    return true;
  }

  bool parse_error(std::size_t byte, const std::string& /*token*/,
                   const Library::exception& error) {
    const bool is_too_large = dynamic_cast<const Library::out_of_range*>(&error) != nullptr;
    parsed_.fault = is_too_large ? ParsedJson::Fault::kTooLarge : ParsedJson::Fault::kNoJson;
    parsed_.byte = byte;
    return false;
  }

 private:
  // An array or object whose end was not met yet.
  struct Open {
    bool is_object;
    std::vector<Json::Member> members;
    std::vector<Json> elements;
  };

  // What is nested too deep is still read to its end: text that is no JSON is the fault to name.
  bool is_storing() {
    if (depth_ > deepest_) parsed_.fault = ParsedJson::Fault::kTooDeep;
    return parsed_.fault == ParsedJson::Fault::kNone;
  }

  bool put(Json value) {
    if (!is_storing()) return true;
    if (open_.empty()) {
      parsed_.value = std::move(value);
    } else if (open_.back().is_object) {
      open_.back().members.back().value = std::move(value);
    } else {
      open_.back().elements.push_back(std::move(value));
    }
    return true;
  }

  bool open(bool is_object) {
    if (is_storing()) open_.push_back({is_object, {}, {}});
    ++depth_;
    return true;
  }

  bool close() {
    --depth_;
    if (!is_storing()) return true;
    Open closed = std::move(open_.back());
    open_.pop_back();
    if (!closed.is_object) return put(Json::array_of(std::move(closed.elements)));
    if (std::optional<std::string> twice = unite_members(closed.members); twice && !parsed_.twice) {
      parsed_.twice = std::move(twice);
    }
    return put(Json::object_of(std::move(closed.members)));
  }

  ParsedJson& parsed_;
  const std::size_t deepest_;
  std::size_t depth_ = 0;
  std::vector<Open> open_;
};

}  // namespace

// Of an object with few members each is compared with a name; of others they are sorted, so that a
// text with very many takes no longer than another of its size.
struct Json::Object {
  explicit Object(std::vector<Member> from) : members(std::move(from)) { sort_many(); }

  [[nodiscard]] Member* find(std::string_view name) {
    if (by_name.empty()) {
      const auto found = std::find_if(members.begin(), members.end(),
                                      [name](const Member& each) { return each.key == name; });
      return found == members.end() ? nullptr : &*found;
    }
    const auto at = place_of(name);
    return at != by_name.end() && members[*at].key == name ? &members[*at] : nullptr;
  }

  // Precondition: there is none of that name.
  Member& add(std::string_view name) {
    if (!by_name.empty()) {
      by_name.insert(place_of(name), static_cast<std::uint32_t>(members.size()));
    }
    members.push_back({std::string(name), {}});
    if (by_name.empty()) sort_many();
    return members.back();
  }

  std::vector<Member> members;
  std::vector<std::uint32_t> by_name;  // their numbers in the order of their names; empty if few

 private:
  static constexpr std::size_t kFew = 16;

  void sort_many() {
    if (members.size() <= kFew) return;
    by_name.resize(members.size());
    std::iota(by_name.begin(), by_name.end(), std::uint32_t{0});
    std::sort(by_name.begin(), by_name.end(),
              [this](std::uint32_t a, std::uint32_t b) { return members[a].key < members[b].key; });
  }

  std::vector<std::uint32_t>::iterator place_of(std::string_view name) {
    return std::lower_bound(
        by_name.begin(), by_name.end(), name,
        [this](std::uint32_t i, std::string_view key) { return members[i].key < key; });
  }
};

Json::Json(std::string_view text) : kind_(Kind::kText) {
  value_.text = new std::string(text);
}
Json::Json(std::initializer_list<Item> list) : Json(Item::json_of(list)) {}

Json::Json(const Json& other) : kind_(other.kind_), value_(other.value_) {
  if (kind_ == Kind::kText) value_.text = new std::string(*other.value_.text);
  if (kind_ == Kind::kArray) value_.array = new std::vector<Json>(*other.value_.array);
  if (kind_ == Kind::kObject) value_.object = new Object(*other.value_.object);
}

void Json::destroy() noexcept {
  if (kind_ == Kind::kText) delete value_.text;
  if (kind_ == Kind::kArray) delete value_.array;
  if (kind_ == Kind::kObject) delete value_.object;
}

Json Json::array(std::initializer_list<Item> list) {
  std::vector<Json> elements;
  elements.reserve(list.size());
  for (const Item& item : list) elements.push_back(item.json());
  return array_of(std::move(elements));
}
Json Json::array_of(std::vector<Json> elements) {
  Json json;
  json.value_.array = new std::vector<Json>(std::move(elements));
  json.kind_ = Kind::kArray;
  return json;
}
Json Json::array_of(std::span<const float> numbers) {
  return array_of(elements_of(numbers));
}
Json Json::array_of(std::span<const std::uint32_t> numbers) {
  return array_of(elements_of(numbers));
}
Json Json::array_of(std::span<const std::string> texts) {
  return array_of(elements_of(texts));
}

Json Json::object() {
  return object_of({});
}
Json Json::object_of(std::vector<Member> members) {
  Json json;
  json.value_.object = new Object(std::move(members));
  json.kind_ = Kind::kObject;
  return json;
}

bool Json::Item::is_member() const {
  return kind_ == Kind::kList && size_ == 2 && value_.list->kind_ == Kind::kText;
}

Json Json::Item::json_of(std::span<const Item> list) {
  if (std::all_of(list.begin(), list.end(), [](const Item& item) { return item.is_member(); })) {
    Json object = Json::object();
    for (const Item& item : list) {
      const Item* const pair = item.value_.list;
      object[std::string_view(pair->value_.text, pair->size_)] = pair[1].json();
    }
    return object;
  }
  std::vector<Json> elements;
  elements.reserve(list.size());
  for (const Item& item : list) elements.push_back(item.json());
  return array_of(std::move(elements));
}

Json Json::Item::json() const {
  switch (kind_) {
    case Kind::kNull:
      return nullptr;
    case Kind::kFlag:
      return value_.flag;
    case Kind::kSigned:
      return static_cast<long long>(value_.whole);
    case Kind::kUnsigned:
      return static_cast<unsigned long long>(value_.natural);
    case Kind::kReal:
      return value_.real;
    case Kind::kText:
      return std::string_view(value_.text, size_);
    case Kind::kCopied:
      return *value_.json;
    case Kind::kMoved:
      return std::move(*value_.moved);
    case Kind::kList:
      return json_of(std::span(value_.list, size_));
  }
  return nullptr;
}

const char* Json::type_name() const {
  switch (kind_) {
    case Kind::kNull:
      return "null";
    case Kind::kFlag:
      return "boolean";
    case Kind::kSigned:
    case Kind::kUnsigned:
    case Kind::kReal:
      return "number";
    case Kind::kText:
      return "string";
    case Kind::kArray:
      return "array";
    case Kind::kObject:
      return "object";
  }
  return "";
}

template <>
bool Json::get() const {
  assert(is_boolean());
  return value_.flag;
}
template <>
double Json::get() const {
  assert(is_number());
  if (kind_ == Kind::kSigned) return static_cast<double>(value_.whole);
  if (kind_ == Kind::kUnsigned) return static_cast<double>(value_.natural);
  return value_.real;
}
template <>
std::uint64_t Json::get() const {
  assert(is_number());
  if (kind_ == Kind::kSigned) return static_cast<std::uint64_t>(value_.whole);
  return kind_ == Kind::kReal ? static_cast<std::uint64_t>(value_.real) : value_.natural;
}
template <>
std::uint32_t Json::get() const {
  return static_cast<std::uint32_t>(get<std::uint64_t>());
}
template <>
std::string Json::get() const {
  assert(is_string());
  return *value_.text;
}

std::size_t Json::size() const {
  if (kind_ == Kind::kArray) return value_.array->size();
  return kind_ == Kind::kObject ? value_.object->members.size() : 0;
}

Json& Json::operator[](std::string_view key) {
  if (is_null()) *this = object();
  assert(is_object());
  Member* const found = value_.object->find(key);
  return (found != nullptr ? *found : value_.object->add(key)).value;
}

const Json& Json::operator[](std::string_view key) const {
  const Json* const found = find(key);
  assert(found != nullptr);
  return *found;
}

const Json* Json::find(std::string_view key) const {
  if (!is_object()) return nullptr;
  const Member* const found = value_.object->find(key);
  return found == nullptr ? nullptr : &found->value;
}

std::span<Json::Member> Json::items() {
  return is_object() ? std::span(value_.object->members) : std::span<Member>();
}
std::span<const Json::Member> Json::items() const {
  return is_object() ? std::span<const Member>(value_.object->members) : std::span<const Member>();
}

void Json::update(const Json& other) {
  for (const auto& [key, value] : other.items()) (*this)[key] = value;
}

Json& Json::emplace_back() {
  if (is_null()) *this = array();
  assert(is_array());
  return value_.array->emplace_back();
}

Json* Json::begin() {
  return is_array() ? value_.array->data() : nullptr;
}
Json* Json::end() {
  return is_array() ? value_.array->data() + value_.array->size() : nullptr;
}
const Json* Json::begin() const {
  return is_array() ? value_.array->data() : nullptr;
}
const Json* Json::end() const {
  return is_array() ? value_.array->data() + value_.array->size() : nullptr;
}

std::string Json::dump(int indent, bool ascii) const {
  return library_value(*this).dump(indent, ' ', ascii, Library::error_handler_t::replace);
}

ParsedJson parse_json(std::string_view text, std::size_t deepest) {
  ParsedJson parsed;
  JsonBuilder builder(parsed, deepest);
  Library::sax_parse(text, &builder);
  if (parsed.fault != ParsedJson::Fault::kNone) parsed.value = nullptr;
  return parsed;
}

}  // namespace boxtree::cooker
