// SPDX-License-Identifier: MIT
// From counted work to time, by constants of each codec and geometry store.
#pragma once

#include <array>
#include <span>

#include "cooker/choose/work.h"
#include "format/codec.h"

namespace boxtree::cooker {

/// Nanoseconds of one query, on the machine that the constants were measured on, for each kind.
using QueryCost = std::array<double, kQueryKinds>;

/// Nanoseconds of the steps of a query of one kind.
struct StepCost {
  double query = 0;
  double node = 0;
  double leaf = 0;
};

/// Of one codec with one geometry store.
struct CodecCost {
  CodecId codec;
  GeometryId geometry;
  std::array<StepCost, kQueryKinds> of_kind;
};

/// The constants that the cooker chooses by, as `boxtree bench --calibrate` measured them; compiled
/// in, so that the choice is the same on every machine.
[[nodiscard]] std::span<const CodecCost> compiled_costs() noexcept;

/// The cost of that work. External geometry costs what exact geometry does.
[[nodiscard]] QueryCost cost_of(const WorkOfKinds& work, CodecId codec, GeometryId geometry,
                                std::span<const CodecCost> costs = compiled_costs());

/// One mesh measured: mean work and mean time of a query of one kind.
struct Measured {
  Work work;
  double ns = 0;
};

/// The steps, none below zero, that explain the times best: least squares of relative errors.
/// Precondition: some time is above zero.
[[nodiscard]] StepCost fit_steps(std::span<const Measured> measured);

}  // namespace boxtree::cooker
