// SPDX-License-Identifier: BSD-3-Clause
#include "active_set.hpp"

#include <algorithm>
#include <cmath>

namespace elte_planner {

void ActiveSet::reset(const StepChain* chain, Eigen::Index nodes, Eigen::Index dimensions) {
  chain_ = chain;
  if (nodes != nodes_ || dimensions != normals_.rows()) {
    nodes_ = nodes;
    capacity_ = 0;
    normals_.resize(dimensions, 0);
    basis_.resize(dimensions, dimensions + 1);
  }
  facets_.clear();
  column_users_.assign(column_users_.size(), 0);
  ensure_capacity(8);
}

void ActiveSet::ensure_capacity(Eigen::Index facets) {
  if (facets < capacity_) return;
  capacity_ = std::max<Eigen::Index>(2 * facets, 16);
  normals_.conservativeResize(Eigen::NoChange, capacity_);
  columns_.conservativeResize(nodes_, capacity_);
  factor_.conservativeResize(capacity_, capacity_);
  for (Eigen::VectorXd* vector : {&products_, &reduced_, &direction_}) {
    vector->conservativeResize(capacity_);
  }
  facets_.reserve(static_cast<std::size_t>(capacity_));
  column_users_.resize(static_cast<std::size_t>(capacity_), 0);
}

double ActiveSet::value_at(const Facet& place, Eigen::Index column) const {
  const double* y = columns_.col(column).data();
  return place.on_step ? y[place.index] - y[place.index - 1] : y[place.index];
}

Eigen::Index ActiveSet::column_for(const Facet& place) {
  for (const Facet& facet : facets_) {
    if (facet.same_place(place)) return facet.column;
  }
  const auto unused = std::find(column_users_.begin(), column_users_.end(), 0);
  const Eigen::Index column = unused - column_users_.begin();
  if (place.on_step) {
    chain_->respond_to_step_force(place.index, columns_.col(column).data());
  } else {
    chain_->respond_to_node_force(place.index, columns_.col(column).data());
  }
  return column;
}

void ActiveSet::propose(const Facet& candidate, const Eigen::Ref<const Eigen::VectorXd>& normal) {
  ensure_capacity(size() + 1);
  candidate_ = candidate;
  candidate_.column = column_for(candidate);
  normals_.col(size()) = normal;
  own_product_ = normal.squaredNorm() * value_at(candidate_, candidate_.column);
  update_direction();
}

void ActiveSet::update_direction() {
  const Eigen::Index m = size();
  const auto normal = normals_.col(m);
  double explained = 0.0;
  for (Eigen::Index a = 0; a < m; ++a) {
    const double alignment = normals_.col(a).dot(normal);
    products_[a] = alignment == 0.0 ? 0.0 : alignment * value_at((*this)[a], candidate_.column);
    double sum = products_[a];
    for (Eigen::Index b = 0; b < a; ++b) sum -= factor_(a, b) * reduced_[b];
    reduced_[a] = sum / factor_(a, a);
    explained += reduced_[a] * reduced_[a];
  }
  pivot_ = own_product_ - explained;
  for (Eigen::Index a = m - 1; a >= 0; --a) {
    double sum = reduced_[a];
    for (Eigen::Index b = a + 1; b < m; ++b) sum -= factor_(b, a) * direction_[b];
    direction_[a] = sum / factor_(a, a);
  }
}

// Gram and Schmidt, twice for accuracy.
void ActiveSet::orthogonalise(Eigen::Index vector) {
  for (int pass = 0; pass < 2; ++pass) {
    for (Eigen::Index b = 0; b < vector; ++b) {
      const double share = basis_.col(b).dot(basis_.col(vector));
      basis_.col(vector) -= share * basis_.col(b);
    }
  }
}

bool ActiveSet::depends_on_active_facets_of_its_node() {
  Eigen::Index rank = 0;
  for (Eigen::Index a = 0; a < size(); ++a) {
    if (!(*this)[a].same_place(candidate_)) continue;
    basis_.col(rank) = normals_.col(a);
    orthogonalise(rank);
    basis_.col(rank++).normalize();
  }
  if (rank == 0) return false;
  basis_.col(rank) = normals_.col(size());
  orthogonalise(rank);
  return basis_.col(rank).norm() < 1e-9 * normals_.col(size()).norm();
}

void ActiveSet::accept(double multiplier) {
  const Eigen::Index m = size();
  factor_.row(m).head(m) = reduced_.head(m).transpose();
  factor_(m, m) = std::sqrt(pivot_);
  candidate_.multiplier = multiplier;
  ++column_users_[static_cast<std::size_t>(candidate_.column)];
  facets_.push_back(candidate_);
}

void ActiveSet::drop(Eigen::Index a) {
  const Eigen::Index m = size();
  --column_users_[static_cast<std::size_t>((*this)[a].column)];
  facets_.erase(facets_.begin() + a);
  for (Eigen::Index b = a; b < m; ++b) normals_.col(b) = normals_.col(b + 1);
  // Rows below move up; plane rotations clear what then stands right of the diagonal.
  for (Eigen::Index row = a; row + 1 < m; ++row) {
    for (Eigen::Index k = 0; k <= row + 1; ++k) factor_(row, k) = factor_(row + 1, k);
  }
  for (Eigen::Index k = a; k + 1 < m; ++k) {
    const double length = std::hypot(factor_(k, k), factor_(k, k + 1));
    const double c = factor_(k, k) / length;
    const double s = factor_(k, k + 1) / length;
    for (Eigen::Index row = k; row + 1 < m; ++row) {
      const double left = factor_(row, k);
      const double right = factor_(row, k + 1);
      factor_(row, k) = c * left + s * right;
      factor_(row, k + 1) = c * right - s * left;
    }
  }
}

void ActiveSet::move(double step, Eigen::MatrixXd& y) const {
  const Eigen::Index first = chain_->first_step() - 1;
  const Eigen::Index count = nodes_ - first;
  for (Eigen::Index j = 0; j < y.cols(); ++j) {
    auto target = y.col(j).tail(count);
    const double own = step * normals_(j, size());
    if (own != 0.0) target -= own * columns_.col(candidate_.column).tail(count);
    for (Eigen::Index a = 0; a < size(); ++a) {
      const double weight = step * direction_[a] * normals_(j, a);
      if (weight != 0.0) target += weight * columns_.col((*this)[a].column).tail(count);
    }
  }
}

void ActiveSet::solve_gram(Eigen::VectorXd& values) const {
  const auto factor = factor_.topLeftCorner(size(), size()).triangularView<Eigen::Lower>();
  auto head = values.head(size());
  factor.solveInPlace(head);
  factor.transpose().solveInPlace(head);
}

}  // namespace elte_planner
