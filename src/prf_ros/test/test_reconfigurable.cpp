// SPDX-License-Identifier: BSD-3-Clause
// Changes of parameters through the service, as dynparam and rqt_reconfigure make them.
#include "prf_ros/reconfigurable.hpp"

#include <dynamic_reconfigure/ConfigDescription.h>
#include <gtest/gtest.h>
#include <ros/ros.h>

#include <limits>
#include <prf_core/require.hpp>

namespace prf_ros {
namespace {

using Values = ReconfigurableParams::Values;
using Doubles = std::vector<std::pair<std::string, double>>;

const Values kStart{{"gain", 1.0}, {"wait", 0.3}};

Values values_of(const dynamic_reconfigure::Config& config) {
  Values values;
  for (const auto& number : config.doubles) values[number.name] = number.value;
  return values;
}

class Reconfigurable : public testing::Test {
 protected:
  // Applied: the gain must be positive; both values are noted together.
  void apply(const Values& values) {
    prf_core::require_positive("gain", values.at("gain"));
    applied_.push_back(values);
  }

  bool set(const Doubles& doubles, const std::string& text = "") {
    dynamic_reconfigure::Reconfigure service;
    for (const auto& [name, value] : doubles) {
      service.request.config.doubles.emplace_back();
      service.request.config.doubles.back().name = name;
      service.request.config.doubles.back().value = value;
    }
    if (!text.empty()) {
      service.request.config.strs.emplace_back();
      service.request.config.strs.back().name = text;
    }
    const bool accepted = ros::service::call("~set_parameters", service);
    if (accepted) {
      EXPECT_EQ(values_of(service.response.config), applied_.back());
    }
    return accepted;
  }

  double on_server(const std::string& name) const {
    return handle_.param(name, std::numeric_limits<double>::quiet_NaN());
  }

  template <typename Message>
  boost::shared_ptr<const Message> latched(const std::string& topic) {
    return ros::topic::waitForMessage<Message>(topic, handle_, ros::Duration(10.0));
  }

  ros::NodeHandle handle_{"~"};
  std::vector<Values> applied_;
  ReconfigurableParams params_{handle_,
                               {{"gain", 1.0, "of the loop"}, {"wait", 0.3, "s"}},
                               [this](const Values& values) { apply(values); }};
};

TEST_F(Reconfigurable, DescribesItsParametersToWhoeverComesLater) {
  const auto description =
      latched<dynamic_reconfigure::ConfigDescription>("parameter_descriptions");
  ASSERT_TRUE(description);
  ASSERT_EQ(description->groups.size(), 1u);
  ASSERT_EQ(description->groups[0].parameters.size(), 2u);
  EXPECT_EQ(description->groups[0].parameters[0].name, "gain");
  EXPECT_EQ(description->groups[0].parameters[0].type, "double");
  EXPECT_EQ(description->groups[0].parameters[0].description, "of the loop");
  EXPECT_EQ(values_of(description->dflt), kStart);
  const auto config = latched<dynamic_reconfigure::Config>("parameter_updates");
  ASSERT_TRUE(config);
  EXPECT_EQ(values_of(*config), kStart);
}

TEST_F(Reconfigurable, AppliesAChangeAsAWholeAndTellsIt) {
  ASSERT_TRUE(set({{"wait", 0.5}, {"gain", 2.0}}));
  EXPECT_EQ(applied_, (std::vector<Values>{{{"gain", 2.0}, {"wait", 0.5}}}));
  EXPECT_EQ(on_server("gain"), 2.0);
  EXPECT_EQ(on_server("wait"), 0.5);
  const auto config = latched<dynamic_reconfigure::Config>("parameter_updates");
  ASSERT_TRUE(config);
  EXPECT_EQ(values_of(*config), applied_.back());
}

TEST_F(Reconfigurable, KeepsWhatAChangeDoesNotName) {
  ASSERT_TRUE(set({{"wait", 0.7}}));
  ASSERT_TRUE(set({{"gain", 3.0}}));
  EXPECT_EQ(applied_.back(), (Values{{"gain", 3.0}, {"wait", 0.7}}));
}

// Fault 29: a change while it runs with one bad value -> refused as a whole, nothing has changed
TEST_F(Reconfigurable, RefusesAChangeAsAWhole) {
  ASSERT_TRUE(set({{"gain", 1.5}, {"wait", 0.4}}));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(set({{"wait", 0.9}, {"gain", -1.0}}));   // refused by the node
  EXPECT_FALSE(set({{"wait", 0.9}, {"gain", nan}}));    // not finite
  EXPECT_FALSE(set({{"wait", 0.9}, {"rate", 100.0}}));  // not reconfigurable
  EXPECT_FALSE(set({{"wait", 0.9}}, "planner"));        // of another type
  EXPECT_EQ(applied_.size(), 1u);
  EXPECT_EQ(on_server("wait"), 0.4);
  const auto config = latched<dynamic_reconfigure::Config>("parameter_updates");
  ASSERT_TRUE(config);
  EXPECT_EQ(values_of(*config), applied_.back());
  ASSERT_TRUE(set({{"gain", 2.0}}));
  EXPECT_EQ(applied_.back(), (Values{{"gain", 2.0}, {"wait", 0.4}}));
}

}  // namespace
}  // namespace prf_ros

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "reconfigurable_test");
  ros::NodeHandle handle;
  ros::AsyncSpinner spinner(1);
  spinner.start();
  return RUN_ALL_TESTS();
}
