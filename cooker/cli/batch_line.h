// SPDX-License-Identifier: MIT
// Queries from lines of a batch.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <boxtree/error.h>

#include "cooker/cli/query_request.h"

namespace boxtree::cooker {

/// What a line of a batch may leave to the command line.
struct RequestDefaults {
  std::string kind;
  QueryRequest request;            // what lines of its kind do not say is as it is here ...
  std::vector<std::string> given;  // ... but of keys that are needed only these
};

/// A line of a batch.
struct BatchRequest {
  QueryRequest request;
  std::vector<std::string> moves;  // of instances of a scene, for this request: "INSTANCE=POSE"
};

/// A request from one line of a batch: an object with the names of the options as keys, with - or
/// _, as in {"kind":"ray","origin":[0,0,9],"direction":[0,0,-1]}; those of a second tree are
/// "file", "tree", a name or a number, "mesh" and "pose", text or an array of 3 or 12 numbers.
/// "move" is a text as --move takes it, or an array of such. A line with "file" takes nothing of
/// the second tree of the command line if that names a file, too. Error: kInvalidQuery with kind,
/// key, what was expected and what was found.
Result<BatchRequest> parse_request(std::string_view line, const RequestDefaults& defaults);

}  // namespace boxtree::cooker
