// SPDX-License-Identifier: BSD-3-Clause
//
// The active facets of a dual active-set method and the factor of their Gram matrix
//   M_ab = N_a' H^-1 N_b = L L'.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "step_chain.hpp"

namespace elte_planner {

// normal . x <= offset, where x is the position of node `index`, or its step from the node before.
struct Facet {
  Eigen::Index index = 0;
  bool on_step = false;
  bool equality = false;
  int constraint = 0;  // which constraint it belongs to; step bounds come after the point ones
  double offset = 0.0;
  double multiplier = 0.0;
  Eigen::Index column = 0;  // response of the nodes to a unit force there, one dimension

  bool same_place(const Facet& other) const {
    return index == other.index && on_step == other.on_step;
  }
};

class ActiveSet {
 public:
  void reset(const StepChain* chain, Eigen::Index nodes, Eigen::Index dimensions);

  Eigen::Index size() const { return static_cast<Eigen::Index>(facets_.size()); }
  Facet& operator[](Eigen::Index a) { return facets_[static_cast<std::size_t>(a)]; }
  const Facet& operator[](Eigen::Index a) const { return facets_[static_cast<std::size_t>(a)]; }
  auto normal(Eigen::Index a) const { return normals_.col(a); }
  auto column(Eigen::Index a) const { return columns_.col((*this)[a].column); }

  // Makes `candidate` the facet that may enter: its column, its products with the active ones and
  //   r = M^-1 N' H^-1 n      change of the multipliers per unit of the candidate's
  //   pivot = n' H^-1 n - (that explained by the active ones)
  void propose(const Facet& candidate, const Eigen::Ref<const Eigen::VectorXd>& normal);
  void update_direction();
  const Facet& candidate() const { return candidate_; }
  double pivot() const { return pivot_; }
  double own_product() const { return own_product_; }
  double direction(Eigen::Index a) const { return direction_[a]; }
  bool depends_on_active_facets_of_its_node();

  void accept(double multiplier);  // the candidate becomes the last facet
  void drop(Eigen::Index a);

  const std::vector<Facet>& facets() const { return facets_; }
  void set_multipliers(const std::vector<Facet>& facets) { facets_ = facets; }

  // y -= step * H^-1 (n - N r), the primal direction of the candidate; y is nodes x dimensions.
  void move(double step, Eigen::MatrixXd& y) const;

  // values <- M^-1 values.
  void solve_gram(Eigen::VectorXd& values) const;

 private:
  void orthogonalise(Eigen::Index vector);  // to those before it in basis_
  double value_at(const Facet& place, Eigen::Index column) const;
  void ensure_capacity(Eigen::Index facets);
  Eigen::Index column_for(const Facet& place);

  const StepChain* chain_ = nullptr;
  Eigen::Index nodes_ = 0;
  Eigen::Index capacity_ = 0;
  std::vector<Facet> facets_;
  std::vector<int> column_users_;
  Eigen::MatrixXd normals_;  // dimensions x capacity; the candidate's is at size()
  Eigen::MatrixXd columns_;  // nodes x capacity
  Eigen::MatrixXd factor_;   // L, lower
  Facet candidate_;
  Eigen::MatrixXd basis_;      // dimensions x (dimensions + 1), of the normals at one place
  Eigen::VectorXd products_;   // N' H^-1 n
  Eigen::VectorXd reduced_;    // L^-1 products
  Eigen::VectorXd direction_;  // r
  double own_product_ = 0.0;
  double pivot_ = 0.0;
};

}  // namespace elte_planner
