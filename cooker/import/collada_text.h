// SPDX-License-Identifier: MIT
// What checks of a Collada document share: its elements in order, words and numbers, and the first
// fault.
#pragma once

#include <cstdint>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>

#include <boxtree/error.h>

namespace boxtree::cooker {

/// The element after `element` in the order of the document, among those in `root`; none behind the
/// last.
[[nodiscard]] pugi::xml_node next_element(pugi::xml_node element, pugi::xml_node root);

/// Calls visit(word) with each word of `text` until it returns false; returns whether none did.
template <class Visit>
bool each_word(std::string_view text, Visit visit) {
  constexpr std::string_view kBlanks = " \t\r\n";
  const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; };
  std::size_t at = text.find_first_not_of(kBlanks);
  while (at < text.size()) {
    std::size_t end = at + 1;
    while (end < text.size() && !is_blank(text[end])) ++end;
    if (!visit(text.substr(at, end - at))) return false;
    for (at = end; at < text.size() && is_blank(text[at]);) ++at;
  }
  return true;
}

/// Holds the first fault of a document. Methods return whether there is none yet.
class ColladaFaults {
 public:
  /// `text` is what the elements were read from.
  explicit ColladaFaults(std::string_view text) : text_(text) {}

  /// Where the next checks look.
  void enter(pugi::xml_node element, std::string of_what = {}) {
    element_ = element;
    of_what_ = std::move(of_what);
  }
  bool fail(std::string_view key, std::string_view expected, std::string_view found,
            Errc code = Errc::kImportFailed);

  /// All text in `element`, of which assimp reads no more than one piece.
  bool text(pugi::xml_node element, std::string_view& out);
  /// The name behind "#" in an attribute.
  bool reference(pugi::xml_node element, const char* key, std::string& out);
  /// An attribute that is a whole number; `otherwise` if it is not there.
  bool whole(pugi::xml_node element, const char* key, std::optional<std::uint64_t> otherwise,
             std::uint64_t& out);

  [[nodiscard]] Status status() const;

 private:
  std::string_view text_;
  pugi::xml_node element_;
  std::string of_what_;
  std::optional<Error> fault_;
};

/// A word for a message.
[[nodiscard]] std::string in_quotes(std::string_view word);

/// The number that assimp takes `word` for; empty for what is none, and for more than 19 digits
/// before the point, of which it takes none. Exporters write a comma, too, by the language of the
/// machine.
[[nodiscard]] std::optional<double> collada_number(std::string_view word);

}  // namespace boxtree::cooker
