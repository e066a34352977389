// SPDX-License-Identifier: MIT
// Converts counted work to time, with constants for each codec and geometry store.
#pragma once

#include <array>
#include <span>

#include "cooker/choose/work.h"
#include "cooker/import/source_mesh.h"
#include "format/codec.h"

namespace boxtree::cooker {

/// Nanoseconds per query of each kind, on the machine on which the constants were measured.
using QueryCost = std::array<double, kQueryKinds>;

/// Nanoseconds per step of a query of one kind.
struct StepCost {
  double query = 0;
  double node = 0;
  double leaf = 0;
};

/// Steps of one codec with one geometry store.
struct CodecCost {
  CodecId codec;
  GeometryId geometry;
  std::array<StepCost, kQueryKinds> of_kind;
  Precision precision = Precision::kF32;  // of positions
};

/// Whether a codec has steps of its own with a store of positions of `precision`. Binary codecs
/// have arrays in place of exact, and read f64 as they read f32. No grid has positions of f64.
[[nodiscard]] constexpr bool has_cost(CodecId codec, GeometryId geometry,
                                      Precision precision) noexcept {
  if (!is_wide(codec)) return geometry != GeometryId::kExact && precision == Precision::kF32;
  return geometry != GeometryId::kGrid || precision == Precision::kF32;
}

/// The constants that the cooker uses, measured by `boxtree bench --calibrate`. They are compiled
/// in, so that the choice is the same on every machine.
[[nodiscard]] std::span<const CodecCost> compiled_costs() noexcept;

/// The cost of `work` on a mesh with positions of `precision`. External geometry costs as much as
/// arrays.
[[nodiscard]] QueryCost cost_of(const WorkOfKinds& work, CodecId codec, GeometryId geometry,
                                Precision precision = Precision::kF32,
                                std::span<const CodecCost> costs = compiled_costs());

/// A measurement of one mesh: mean work and mean time of a query of one kind.
struct Measured {
  Work work;
  double ns = 0;
};

/// The non-negative steps that fit the times best: least squares of relative errors. Precondition:
/// some time is above zero.
[[nodiscard]] StepCost fit_steps(std::span<const Measured> measured);

/// The same for another store of a codec whose steps are known: walks over nodes are the same
/// whatever store they lead to, so only a leaf's part is fitted. Fits of all three would share the
/// time among them anew for each store, and rate stores of the same few leaves by that.
/// Precondition: some mesh has leaves.
[[nodiscard]] StepCost fit_leaf(std::span<const Measured> measured, const StepCost& known);

}  // namespace boxtree::cooker
