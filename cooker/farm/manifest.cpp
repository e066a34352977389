// SPDX-License-Identifier: MIT
#include "cooker/farm/manifest.h"

#include <algorithm>
#include <array>
#include <type_traits>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "cooker/farm/real_names.h"
#include "cooker/system/path.h"
#include "cooker/text/json.h"
#include "cooker/text/nearest_name.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

// An object of arrays of texts.
constexpr std::size_t kDeepest = 2;

class LineReader {
 public:
  explicit LineReader(std::string place) : place_(std::move(place)) {}

  Result<ManifestLine> read(std::string_view text, std::size_t number) {
    if (const std::size_t start = text.find_first_not_of(" \t");
        start != std::string_view::npos && text[start] == '[') {
      return fault("expected a JSON object in each line, found [; no list stands around them");
    }
    const ParsedJson parsed = parse_json(text, kDeepest);
    if (parsed.fault == ParsedJson::Fault::kTooDeep) {
      return fault("expected arrays of texts, found arrays or objects in them");
    }
    if (parsed.fault != ParsedJson::Fault::kNone) {
      return fault(
          fmt::format("expected one JSON object in this line, found none at byte {}", parsed.byte));
    }
    if (!parsed.value.is_object()) {
      return fault(fmt::format("expected a JSON object, found {}", parsed.value.type_name()));
    }
    ManifestLine line;
    line.line = number;
    static const std::array<std::string, 4> kKeys = {"inputs", "output", "options", "profile"};
    for (auto key = parsed.keys.begin(); key != parsed.keys.end(); ++key) {
      if (std::find(kKeys.begin(), kKeys.end(), *key) == kKeys.end()) {
        return fault(fmt::format("expected {}, found \"{}\"{}", listed(kKeys), *key,
                                 suggestion(*key, kKeys)));
      }
      if (std::find(parsed.keys.begin(), key, *key) != key) {
        return fault(*key + ": expected once, found twice");
      }
    }
    const Json& object = parsed.value;
    if (Status status = take_texts(object, "inputs", line.inputs); !status) return status.error();
    if (Status status = take_texts(object, "options", line.options); !status) return status.error();
    if (Status status = take_text(object, "output", line.output); !status) return status.error();
    if (Status status = take_text(object, "profile", line.profile); !status) return status.error();
    if (line.output.empty()) return fault("output: expected the name of a file, found none");
    if (line.inputs.empty() && line.profile.empty()) {
      return fault("inputs: expected names of meshes, or \"profile\" with a source; found neither");
    }
    return line;
  }

 private:
  [[nodiscard]] Error fault(const std::string& what) const {
    return {Errc::kDocumentInvalid, place_ + ": " + what};
  }

  Status check_text(const Json& value, const char* key) {
    if (!value.is_string()) {
      return fault(fmt::format("{}: expected a text, found {}", key, value.type_name()));
    }
    const std::string text = value.get<std::string>();
    if (text.empty()) return fault(fmt::format("{}: found an empty text", key));
    // The system takes a name to end there.
    if (const std::size_t nul = text.find('\0'); nul != std::string::npos) {
      return fault(fmt::format("{}: expected a text without NUL characters, found one at byte {}",
                               key, nul + 1));
    }
    return {};
  }

  Status take_text(const Json& object, const char* key, fs::path& out) {
    const Json* const value = object.find(key);
    if (value == nullptr) return {};
    if (Status status = check_text(*value, key); !status) return status;
    out = named_path(value->get<std::string>());
    if (out == "-") return fault(fmt::format("{}: expected a file, found -", key));
    return {};
  }

  template <class T>
  Status take_texts(const Json& object, const char* key, std::vector<T>& out) {
    const Json* const values = object.find(key);
    if (values == nullptr) return {};
    if (!values->is_array()) {
      return fault(fmt::format("{0}: expected an array of texts, as \"{0}\": [\"...\"], found {1}",
                               key, values->type_name()));
    }
    for (const Json& value : *values) {
      if (Status status = check_text(value, key); !status) return status;
      if constexpr (std::is_same_v<T, fs::path>) {
        out.push_back(named_path(value.get<std::string>()));
      } else {
        out.push_back(value.get<std::string>());
      }
      if (out.back() == "-") return fault(fmt::format("{}: expected a file, found -", key));
    }
    return {};
  }

  const std::string place_;
};

// Outputs of one run that would overwrite each other, or what another job reads.
Status check_paths(const std::vector<ManifestLine>& lines, const std::string& name) {
  RealNames names;
  std::unordered_map<std::string, std::size_t> outputs;  // and their lines
  for (const ManifestLine& line : lines) {
    const auto [first, is_new] = outputs.emplace(names.of(line.output), line.line);
    if (is_new) continue;
    return Error{Errc::kDocumentInvalid,
                 fmt::format("{}:{}: output: {} is that of line {}, too", name, line.line,
                             line.output.string(), first->second)};
  }
  for (const ManifestLine& line : lines) {
    std::vector<fs::path> read = line.inputs;
    if (!line.profile.empty()) read.push_back(line.profile);
    for (const fs::path& input : read) {
      const auto output = outputs.find(names.of(input));
      if (output == outputs.end()) continue;
      return Error{Errc::kDocumentInvalid,
                   fmt::format("{}:{}: inputs: {} is the output of line {}", name, line.line,
                               input.string(), output->second)};
    }
  }
  return {};
}

}  // namespace

Result<std::vector<ManifestLine>> parse_manifest(std::string_view text, const std::string& name) {
  std::vector<ManifestLine> lines;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
    if (line.find_first_not_of(" \t\r") == std::string_view::npos) continue;
    Result<ManifestLine> read = LineReader(fmt::format("{}:{}", name, number)).read(line, number);
    if (!read) return read.error();
    lines.push_back(std::move(*read));
  }
  if (Status status = check_paths(lines, name); !status) return status.error();
  return lines;
}

}  // namespace boxtree::cooker
