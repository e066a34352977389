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
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(measured.size()), kSteps);
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const Measured& m = measured[i];
    rows.row(static_cast<Eigen::Index>(i)) =
        Eigen::RowVector3d(1, m.work.nodes, m.work.leaves) / m.ns;
  }
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(rows.rows());
  Eigen::Vector3d best = Eigen::Vector3d::Zero();
  double least = std::numeric_limits<double>::infinity();
  for (unsigned kept = 1; kept < (1u << kSteps); ++kept) {
    std::vector<Eigen::Index> columns;
    for (Eigen::Index k = 0; k < kSteps; ++k) {
      if (((kept >> k) & 1u) != 0) columns.push_back(k);
    }
    const Eigen::MatrixXd part = rows(Eigen::all, columns);
    const Eigen::VectorXd steps = (part.transpose() * part).ldlt().solve(part.transpose() * ones);
    const double error = (part * steps - ones).squaredNorm();
    if (!(steps.minCoeff() >= 0) || !(error < least)) continue;
    least = error;
    best.setZero();
    best(columns) = steps;
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
