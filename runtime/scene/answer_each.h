// SPDX-License-Identifier: MIT
// Batches of queries of a scene, which are answered one by one.
#pragma once

#include <cstddef>
#include <span>

#include "runtime/query/invalid_query.h"

namespace boxtree {

template <class Query, class Result, class Answer>
[[nodiscard]] Status answer_each(std::span<const Query> queries, std::span<Result> results,
                                 const Answer& answer) {
  if (results.size() != queries.size()) return invalid_query("results.size()");
  for (std::size_t i = 0; i < queries.size(); ++i) results[i] = answer(queries[i]);
  return {};
}

}  // namespace boxtree
