// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Eigenvalues>

#include "edit_workspace.hpp"

namespace elte_planner {

// Where the Hessian is singular, the problem is solved with a proximal term around (start, slope)
// in its place. The centre that the solution itself takes is the answer; the map from one to the
// other is piecewise affine, so that Newton's method ends after a few steps. Directions that
// nothing determines stay as they are.
bool EditSolver::Workspace::move_proximal_centre() {
  const bool slope_free = chain_.slope_is_free();
  const bool start_free = chain_.start_is_free();
  const Eigen::Index size = d_ * (int{start_free} + int{slope_free});
  const auto centre_of = [&](const Eigen::MatrixXd& y) {
    Eigen::VectorXd centre(size);
    if (start_free) centre.head(d_) = y.row(0).transpose();
    if (slope_free) centre.tail(d_) = (y.row(1) - y.row(0)).transpose();
    return centre;
  };
  Eigen::VectorXd centre(size);
  if (start_free) centre.head(d_) = start_.transpose();
  if (slope_free) centre.tail(d_) = slope_.transpose();
  const Eigen::VectorXd residual = centre_of(y_) - centre;

  // The residual is minus the gradient of a convex function of the centre. Where the last step went
  // far beyond its minimum along the step, the centre goes back to the secant's zero.
  if (centre_step_.size() == size) {
    const double before = last_residual_.dot(centre_step_);
    const double after = residual.dot(centre_step_);
    if (after < -0.5 * before && centre_step_.cwiseAbs().maxCoeff() > 1e-12 * extent_) {
      centre_step_ *= before / (before - after);
      set_centre(last_centre_ + centre_step_);
      return true;
    }
  }

  Eigen::MatrixXd jacobian(size, size);
  Eigen::MatrixXd change(n_, d_);
  for (Eigen::Index column = 0; column < size; ++column) {
    respond_to_centre(column % d_, !start_free || column >= d_, change);
    jacobian.col(column) = -centre_of(change);
    jacobian(column, column) += 1.0;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(0.5 *
                                                             (jacobian + jacobian.transpose()));
  Eigen::VectorXd step = eigen.eigenvectors().transpose() * residual;
  for (Eigen::Index i = 0; i < size; ++i) {
    if (eigen.eigenvalues()[i] > 1e-10) step[i] /= eigen.eigenvalues()[i];
  }
  step = eigen.eigenvectors() * step;
  // Below this the steps are made of rounding; they stop getting shorter.
  const double length = step.cwiseAbs().maxCoeff();
  if (length <= 1e-10 * extent_ && !(length < 0.5 * last_centre_step_)) return false;
  last_centre_step_ = length;
  last_centre_ = centre;
  last_residual_ = residual;
  centre_step_ = step;
  set_centre(centre + step);
  return true;
}

void EditSolver::Workspace::set_centre(const Eigen::VectorXd& centre) {
  if (chain_.start_is_free()) start_ = centre.head(d_).transpose();
  if (chain_.slope_is_free()) slope_ = centre.tail(d_).transpose();
}

// Derivative of the positions by one coordinate of the proximal centre on the active set.
void EditSolver::Workspace::respond_to_centre(Eigen::Index j, bool slope, Eigen::MatrixXd& change) {
  change.setZero();
  if (slope) {
    chain_.respond_to_step_force(1, change.col(j).data());
    change.col(j) *= chain_.proximal_weight();
  } else {
    change.col(j).setOnes();
  }
  values_.resize(std::max<Eigen::Index>(values_.size(), active_.size()));
  for (Eigen::Index a = 0; a < active_.size(); ++a) {
    const Facet& facet = active_[a];
    const double before = facet.on_step ? change(facet.index - 1, j) : 0.0;
    values_[a] = active_.normal(a)[j] * (change(facet.index, j) - before);
  }
  active_.solve_gram(values_);
  for (Eigen::Index a = 0; a < active_.size(); ++a) {
    const Eigen::VectorXd weights = values_[a] * active_.normal(a);
    change -= active_.column(a) * weights.transpose();
  }
}

}  // namespace elte_planner
