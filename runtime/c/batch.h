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

/// The status of each query of a batch.
class BatchStatuses {
 public:
  /// `statuses` may be null.
  BatchStatuses(bxt_status* statuses, bxt_error* error) noexcept
      : statuses_(statuses), error_(error) {}

  template <class Result>
  void write(std::size_t i, const Result& result) {
    const auto status = static_cast<bxt_status>(result.code());
    if (statuses_ != nullptr) statuses_[i] = status;
    if (status != BXT_OK && first_error_ == BXT_OK) first_error_ = finish(result, error_);
  }

  /// The first error of a query; its message has been written.
  [[nodiscard]] bxt_status first_error() const noexcept { return first_error_; }

 private:
  bxt_status* const statuses_;
  bxt_error* const error_;
  bxt_status first_error_ = BXT_OK;
};

/// And its answers, an array of structs.
template <class T>
class BatchAnswers : public BatchStatuses {
 public:
  /// Precondition: has_size(answers).
  BatchAnswers(T* answers, bxt_status* statuses, bxt_error* error) noexcept
      : BatchStatuses(statuses, error), answers_(answers) {}

  template <class Result>
  void write(std::size_t i, const T& answer, const Result& result) {
    answers_.write(i, answer);
    BatchStatuses::write(i, result);
  }

 private:
  const Elements<T> answers_;
};

/// Whole packets of C++'s batches.
inline constexpr std::size_t kQueriesAtATime = 64;

/// Calls answer_all(begin, queries, results) with queries, those of query_at(i) from `begin` on,
/// and room for their results, of as many, and then write(i, result) with each.
template <class Result, class QueryAt, class AnswerAll, class Write>
void answer_in_chunks(std::size_t count, const QueryAt& query_at, const AnswerAll& answer_all,
                      const Write& write) {
  std::array<decltype(query_at(0)), kQueriesAtATime> chunk;
  std::array<Result, kQueriesAtATime> results;
  for (std::size_t begin = 0; begin < count; begin += kQueriesAtATime) {
    const std::size_t n = std::min(kQueriesAtATime, count - begin);
    for (std::size_t i = 0; i < n; ++i) chunk[i] = query_at(begin + i);
    // Their numbers are the same, so it returns kOk.
    static_cast<void>(
        answer_all(begin, std::span(std::as_const(chunk)).first(n), std::span(results).first(n)));
    for (std::size_t i = 0; i < n; ++i) write(begin + i, results[i]);
  }
}

}  // namespace boxtree::c
