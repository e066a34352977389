// SPDX-License-Identifier: MIT
// A linear model, and the fit of its constants.
#include "cooker/choose/cost.h"

#include <algorithm>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace boxtree::cooker {

QueryCost cost_of(const WorkOfKinds& work, CodecId codec, GeometryId geometry, Precision precision,
                  std::span<const CodecCost> costs) {
  const GeometryId stored = geometry == GeometryId::kExternal ? GeometryId::kArrays : geometry;
  if (!has_cost(codec, stored, precision)) precision = Precision::kF32;
  QueryCost cost{};
  for (const CodecCost& known : costs) {
    if (known.codec != codec || known.geometry != stored || known.precision != precision) continue;
    for (std::size_t kind = 0; kind < kQueryKinds; ++kind) {
      const StepCost& step = known.of_kind[kind];
      cost[kind] = step.query + work[kind].nodes * step.node + work[kind].leaves * step.leaf;
    }
  }
  return cost;
}

StepCost fit_steps(std::span<const Measured> measured) {
  // With so few unknowns, the best fit without negative steps is the best of all fits in which some
  // steps are zero.
  constexpr Eigen::Index kSteps = 3;
  std::vector<Eigen::Vector3d> rows;
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Measured& m : measured) {
    const Eigen::Vector3d row = Eigen::Vector3d(1, m.work.nodes, m.work.leaves) / m.ns;
    rows.push_back(row);
    products += row * row.transpose();
    sum += row;
  }
  Eigen::Vector3d best = Eigen::Vector3d::Zero();
  double least = std::numeric_limits<double>::infinity();
  for (unsigned kept = 1; kept < (1u << kSteps); ++kept) {
    // The normal equations; those of a step that is left out say that it is zero.
    Eigen::Matrix3d left = products;
    Eigen::Vector3d right = sum;
    for (Eigen::Index k = 0; k < kSteps; ++k) {
      if (((kept >> k) & 1u) != 0) continue;
      left.row(k).setZero();
      left.col(k).setZero();
      left(k, k) = 1;
      right[k] = 0;
    }
    const Eigen::Vector3d steps = left.ldlt().solve(right);
    double error = 0;
    for (const Eigen::Vector3d& row : rows) {
      const double off = row.dot(steps) - 1;
      error += off * off;
    }
    if (!(steps.minCoeff() >= 0) || !(error < least)) continue;
    least = error;
    best = steps;
  }
  return {best[0], best[1], best[2]};
}

StepCost fit_leaf(std::span<const Measured> measured, const StepCost& known) {
  double products = 0, squares = 0;
  for (const Measured& m : measured) {
    const double left = m.ns - known.query - m.work.nodes * known.node;
    products += m.work.leaves * left / (m.ns * m.ns);
    squares += m.work.leaves * m.work.leaves / (m.ns * m.ns);
  }
  return {known.query, known.node, std::max(0.0, products / squares)};
}

}  // namespace boxtree::cooker
