// SPDX-License-Identifier: MIT
// What all queries share: poses, visitors, limits, allowed errors, and answers that may be nothing.
// Queries are safe from many threads at once, and take at most 64 KB of stack where their page does
// not say otherwise.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

#include <Eigen/Geometry>

#include <boxtree/error.h>
#include <boxtree/tree.h>

namespace boxtree {

/// Object space to world. Unaligned, so that its layout does not depend on compiler options.
using Pose = Eigen::Transform<double, 3, Eigen::Affine, Eigen::DontAlign>;

/// What a query for one thing returns: an answer, nothing, or an error.
///
///   if (const auto hit = closest_hit(tree, ray)) use(hit->t);   // neither a miss nor an error
///   else if (!hit.ok()) report(hit.code());
///
/// Where there is no answer the value is the one that T starts with, so a miss that is read all the
/// same says "infinitely far, no face".
template <class T>
class [[nodiscard]] QueryResult {
 public:
  /// Nothing.
  QueryResult() = default;
  /// An answer.
  QueryResult(const T& answer) : value_(answer), has_value_(true) {}
  /// An error. `detail`: a text that outlives it.
  QueryResult(Errc code, const char* detail = "") noexcept : detail_(detail), code_(code) {}

  /// Whether there is an answer.
  [[nodiscard]] bool has_value() const noexcept { return has_value_; }
  /// The same.
  explicit operator bool() const noexcept { return has_value_; }
  /// The answer, or the value that T starts with.
  const T& operator*() const noexcept { return value_; }
  /// A member of it.
  const T* operator->() const noexcept { return &value_; }
  /// The answer for code that takes `std::optional`; an error is nothing, too.
  [[nodiscard]] std::optional<T> as_optional() const {
    return has_value_ ? std::optional<T>(value_) : std::nullopt;
  }

  /// Whether the query was carried out, be there an answer or not.
  [[nodiscard]] bool ok() const noexcept { return code_ == Errc::kOk; }
  /// The error, or Errc::kOk.
  [[nodiscard]] Errc code() const noexcept { return code_; }
  /// The same for code that takes an Error, with its detail: of kInvalidQuery the argument, or the
  /// field of it, that is not valid.
  [[nodiscard]] Error error() const { return {code_, detail_}; }

 private:
  T value_{};
  const char* detail_ = "";
  Errc code_ = Errc::kOk;
  bool has_value_ = false;
};

/// A borrowed callable: no allocation, valid during the call it is passed to. What it throws ends
/// that call and passes to the caller.
template <class Signature>
class FunctionRef;
/// A borrowed callable that takes `Args` and returns `R`.
template <class R, class... Args>
class FunctionRef<R(Args...)> {
 public:
  /// Borrows a lambda, function object or function.
  // The constraint keeps it from standing in for the copy constructor.
  template <class F,
            class = std::enable_if_t<!std::is_same_v<std::remove_cvref_t<F>, FunctionRef> &&
                                     std::is_invocable_r_v<R, F&, Args...>>>
  FunctionRef(F&& callable) noexcept {
    if constexpr (std::is_function_v<std::remove_reference_t<F>>) {
      target_.function = reinterpret_cast<void (*)()>(&callable);
      call_ = [](Target target, Args... args) -> R {
        return reinterpret_cast<std::remove_reference_t<F>*>(target.function)(
            std::forward<Args>(args)...);
      };
    } else {
      target_.object = const_cast<void*>(static_cast<const void*>(std::addressof(callable)));
      call_ = [](Target target, Args... args) -> R {
        return (*static_cast<std::remove_reference_t<F>*>(target.object))(
            std::forward<Args>(args)...);
      };
    }
  }
  /// Of a callable that takes the arguments and returns nothing, or something else: says what it
  /// must return.
  template <class F, std::enable_if_t<std::is_invocable_v<F&, Args...> &&
                                          !std::is_invocable_r_v<R, F&, Args...>,
                                      int> = 0>
  FunctionRef(F&&) noexcept {
    constexpr bool fits = std::is_invocable_r_v<R, F&, Args...>;
    static_assert(fits || !std::is_same_v<R, bool>,
                  "must return bool: a visitor true to go on, a filter true for what may be hit");
    static_assert(fits || std::is_same_v<R, bool>,
                  "must return R; where that is double, the largest t that is still of interest");
  }
  /// Calls it.
  R operator()(Args... args) const { return call_(target_, std::forward<Args>(args)...); }

 protected:
  /// For what does not compile.
  FunctionRef() noexcept = default;

 private:
  union Target {
    void* object;
    void (*function)();
  };
  Target target_;
  R (*call_)(Target, Args...);
};

/// The same for what keeps it beyond a call, options say: a callable that has a name. A temporary
/// one would be gone before the query, so it does not compile.
template <class Signature>
class NamedFunctionRef : public FunctionRef<Signature> {
  template <class F>
  static constexpr bool kIsRefused =
      !std::is_base_of_v<FunctionRef<Signature>, std::remove_cvref_t<F>> &&
      !std::is_same_v<std::remove_cvref_t<F>, std::nullopt_t> &&
      !(std::is_lvalue_reference_v<F> && std::is_convertible_v<F, FunctionRef<Signature>>);

 public:
  /// Borrows a lambda, function object or function.
  template <class F, class = std::enable_if_t<std::is_convertible_v<F&, FunctionRef<Signature>> &&
                                              !std::is_base_of_v<FunctionRef<Signature>, F>>>
  NamedFunctionRef(F& callable) noexcept : FunctionRef<Signature>(callable) {}
  /// Of a temporary, or of what is called otherwise: says what is expected.
  template <class F, std::enable_if_t<kIsRefused<F>, int> = 0>
  NamedFunctionRef(F&&) noexcept {
    constexpr bool fits =
        std::is_convertible_v<std::remove_reference_t<F>&, FunctionRef<Signature>>;
    static_assert(fits,
                  "must be a callable that takes what a filter is shown and returns bool: a filter "
                  "of FaceOptions takes a const FaceRef&, one of SceneFaceOptions a const "
                  "SceneFace&, an instance_filter a std::uint32_t");
    static_assert(!fits,
                  "a temporary callable would be gone before the query: give it a name, as in "
                  "const auto is_wanted = [](const FaceRef& face) { ... }; options.filter = "
                  "is_wanted;");
  }
};

/// Receives one face after the other; returns whether to go on.
using FaceVisitor = FunctionRef<bool(const FaceRef&)>;

/// A face of the first tree and a face of the second one that touch.
struct FacePair {
  FaceRef first;   ///< Of the first tree.
  FaceRef second;  ///< Of the second tree.
};

/// Receives one pair after the other; returns whether to go on.
using PairVisitor = FunctionRef<bool(const FacePair&)>;

/// How a query with a visitor ended.
enum class Visit : std::uint8_t {
  kComplete,  ///< Every answer was visited.
  kStopped,   ///< The visitor stopped it.
};

/// No limit of the nodes that a query may visit.
inline constexpr std::uint64_t kUnlimitedNodes = (std::numeric_limits<std::uint64_t>::max)();

/// What a caller lets one query cost; SECURITY.md states what each may cost without. A query that
/// would cost more ends with kWorkLimit; what its visitor was given until then is true.
struct QueryLimits {
  /// Nodes expanded, or pairs of a node with a node or leaf, and instances visited [unlimited].
  /// For each at most 8 leaves, or pairs of leaves, are compared.
  std::uint64_t nodes = kUnlimitedNodes;
};

/// How near to the truth an answer has to be, and what it may cost. An answer [lower, upper] has
/// converged if `upper <= lower * (1 + relative_error)` or `upper <= lower + absolute_error`:
/// whichever allows more, but for what rounding takes from both, some 2^-44 of the extent and the
/// distance. Zeros require all that double tells.
struct Approximation {
  double relative_error = 0;  ///< 0 or more [0].
  double absolute_error = 0;  ///< A length, 0 or more [0].
  /// A length: nothing farther is looked for [infinity].
  double max_distance = std::numeric_limits<double>::infinity();
  /// Nodes expanded and leaves read (pairs of them, for two trees) before the query ends with what
  /// it knows [unlimited].
  std::uint64_t node_budget = kUnlimitedNodes;
};

}  // namespace boxtree
