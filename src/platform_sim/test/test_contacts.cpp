// SPDX-License-Identifier: BSD-3-Clause
#include "platform_sim/contacts.hpp"

#include <gtest/gtest.h>

namespace platform_sim {
namespace {

TEST(ContactRecorder, SumsThePointsOfAPairWhateverTheirOrder) {
  ContactRecorder recorder;
  recorder.add_step({{"box", "hand", 2.0, {1, 0, 0}}, {"hand", "box", 3.0, {0, 1, 0}}});
  const std::vector<Contact> contacts = recorder.take();
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_EQ(contacts[0].link_a, "box");
  EXPECT_EQ(contacts[0].link_b, "hand");
  EXPECT_EQ(contacts[0].force, 5.0);
  EXPECT_EQ(contacts[0].position, Eigen::Vector3d(0, 1, 0));
}

TEST(ContactRecorder, KeepsTheStrongestStepOfThePeriod) {
  ContactRecorder recorder;
  recorder.add_step({{"a", "b", 1.0, {1, 0, 0}}});
  recorder.add_step({{"a", "b", 4.0, {2, 0, 0}}});
  recorder.add_step({{"a", "b", 2.0, {3, 0, 0}}});
  const std::vector<Contact> contacts = recorder.take();
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_EQ(contacts[0].force, 4.0);
  EXPECT_EQ(contacts[0].position.x(), 2.0);
}

TEST(ContactRecorder, ListsPairsInAlphabeticalOrderAndForgetsThem) {
  ContactRecorder recorder;
  recorder.add_step({{"z", "y", 1.0, {}}, {"b", "c", 1.0, {}}, {"c", "a", 1.0, {}}});
  const std::vector<Contact> contacts = recorder.take();
  ASSERT_EQ(contacts.size(), 3u);
  EXPECT_EQ(contacts[0].link_a + contacts[0].link_b, "ac");
  EXPECT_EQ(contacts[1].link_a + contacts[1].link_b, "bc");
  EXPECT_EQ(contacts[2].link_a + contacts[2].link_b, "yz");
  EXPECT_TRUE(recorder.take().empty());
}

}  // namespace
}  // namespace platform_sim
