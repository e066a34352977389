// SPDX-License-Identifier: MIT
// Batches in C: queries are brought to C++ some at a time, on the stack, and answers are written
// into arrays of the caller.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <utility>

#include "runtime/c/call.h"
#include "runtime/c/convert.h"

namespace boxtree::c {

/// The answers of a batch, an array of structs, and the status of each.
template <class T>
class BatchAnswers {
 public:
  /// Precondition: has_size(answers). `statuses` may be null.
  BatchAnswers(T* answers, bxt_status* statuses, bxt_error* error) noexcept
      : answers_(answers), statuses_(statuses), error_(error) {}

  template <class Result>
  void write(std::size_t i, const T& answer, const Result& result) {
    answers_.write(i, answer);
    const auto status = static_cast<bxt_status>(result.code());
    if (statuses_ != nullptr) statuses_[i] = status;
    if (status != BXT_OK && first_error_ == BXT_OK) first_error_ = finish(result, error_);
  }

  /// The first error of a query; its message has been written.
  [[nodiscard]] bxt_status first_error() const noexcept { return first_error_; }

 private:
  const Elements<T> answers_;
  bxt_status* const statuses_;
  bxt_error* const error_;
  bxt_status first_error_ = BXT_OK;
};

/// Whole packets of closest_hits() and closest_points().
inline constexpr std::size_t kQueriesAtATime = 64;

/// Calls `answer_all` with queries and room for their results, of as many, and then write(i,
/// result) with each.
template <class Result, class Query, class AnswerAll, class Write>
void answer_in_chunks(const Query* queries, std::size_t count, const AnswerAll& answer_all,
                      const Write& write) {
  std::array<decltype(to_cpp(*queries)), kQueriesAtATime> chunk;
  std::array<Result, kQueriesAtATime> results;
  for (std::size_t begin = 0; begin < count; begin += kQueriesAtATime) {
    const std::size_t n = std::min(kQueriesAtATime, count - begin);
    for (std::size_t i = 0; i < n; ++i) chunk[i] = to_cpp(queries[begin + i]);
    // Their numbers are the same, so it returns kOk.
    static_cast<void>(
        answer_all(std::span(std::as_const(chunk)).first(n), std::span(results).first(n)));
    for (std::size_t i = 0; i < n; ++i) write(begin + i, results[i]);
  }
}

}  // namespace boxtree::c
