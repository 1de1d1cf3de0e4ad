// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/view_keeper.hpp"

#include <gtest/gtest.h>

namespace prf_decision {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

const Vector3d kTarget(1, 0.2, 0.6);

TEST(ViewKeeper, TurnsTheHandAsItsLineOfSight) {
  const Pose hand{{0.5, -0.3, 0.4}, Quaterniond(AngleAxisd(0.4, Vector3d(1, 2, 3).normalized()))};
  ViewKeeper view;
  view.set_out(hand, kTarget);
  const Vector3d seen = hand.orientation.conjugate() * (kTarget - hand.position).normalized();
  for (const Vector3d& position : {hand.position, Vector3d(0.3, 0.1, 0.5), Vector3d(0.6, 0, 0)}) {
    const Quaterniond orientation = view.orientation_at(position, kTarget);
    EXPECT_LT((orientation.conjugate() * (kTarget - position).normalized() - seen).norm(), 1e-9);
  }
  EXPECT_LT(view.orientation_at(hand.position, kTarget).angularDistance(hand.orientation), 1e-7);
  view.set_out({{0, 0, 0}, Quaterniond::Identity()}, kTarget);  // it has set out already
  EXPECT_LT(view.orientation_at(hand.position, kTarget).angularDistance(hand.orientation), 1e-7);
}

TEST(ViewKeeper, FadesOutAlongTheFirstHalfOfTheSkill) {
  const Quaterniond start(AngleAxisd(0.3, Vector3d::UnitX()));
  const Quaterniond reached(AngleAxisd(-0.5, Vector3d::UnitY()));
  ViewKeeper view;
  view.set_out({{0, 0, 0}, reached}, kTarget);
  EXPECT_TRUE(view.is_under_way());
  view.arrive(start, reached);
  EXPECT_FALSE(view.is_under_way());
  EXPECT_LT(view.on_skill(start, 0).angularDistance(reached), 1e-7);
  double before = start.angularDistance(reached);
  for (double fraction = 0.05; fraction < 0.5; fraction += 0.05) {
    const double off = view.on_skill(start, fraction).angularDistance(start);
    EXPECT_LT(off, before);
    before = off;
  }
  for (const double fraction : {0.5, 0.8, 1.0}) {
    EXPECT_LT(view.on_skill(start, fraction).angularDistance(start), 1e-7);
  }
  view.reset();
  EXPECT_EQ(view.on_skill(start, 0).coeffs(), start.coeffs());
}

}  // namespace
}  // namespace prf_decision
