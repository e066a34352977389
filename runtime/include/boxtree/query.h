// SPDX-License-Identifier: MIT
// What all queries share: how faces are named in answers, poses, and how visitors are passed.
#pragma once

#include <cstdint>
#include <memory>
#include <type_traits>
#include <utility>

#include <Eigen/Geometry>

#include "format/result.h"
#include "runtime/tree/tree.h"

namespace boxtree {

/// A face in an answer.
struct FaceRef {
  std::uint32_t id;     // number in the source mesh; kNoFaceId when the file has no ids
  std::uint32_t order;  // number in the tree's own order: the key of leaf_triangles' `face`
};

/// Object space to world. Unaligned, so that its layout does not depend on compiler options.
using Pose = Eigen::Transform<double, 3, Eigen::Affine, Eigen::DontAlign>;

/// A borrowed callable: no allocation, valid during the call it is passed to.
template <class Signature>
class FunctionRef;
template <class R, class... Args>
class FunctionRef<R(Args...)> {
 public:
  // The constraint keeps it from standing in for the copy constructor.
  template <class F,
            class = std::enable_if_t<!std::is_same_v<std::remove_cvref_t<F>, FunctionRef> &&
                                     std::is_invocable_r_v<R, F&, Args...>>>
  FunctionRef(F&& callable) noexcept
      : object_(const_cast<void*>(static_cast<const void*>(std::addressof(callable)))),
        call_([](void* object, Args... args) -> R {
          return (*static_cast<std::remove_reference_t<F>*>(object))(std::forward<Args>(args)...);
        }) {}
  R operator()(Args... args) const { return call_(object_, std::forward<Args>(args)...); }

 private:
  void* object_;
  R (*call_)(void*, Args...);
};

/// Receives one face after the other; returns whether to go on.
using FaceVisitor = FunctionRef<bool(const FaceRef&)>;

/// A face of the first tree and a face of the second one that touch.
struct FacePair {
  FaceRef first;
  FaceRef second;
};

/// Receives one pair after the other; returns whether to go on.
using PairVisitor = FunctionRef<bool(const FacePair&)>;

/// How a query with a visitor ended.
enum class Visit : std::uint8_t {
  kComplete,  // every answer was visited
  kStopped,   // the visitor asked to stop
};

}  // namespace boxtree
