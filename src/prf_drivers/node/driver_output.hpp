// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include <memory>

#include "params.hpp"

namespace prf_drivers {

// Says a command in the words of one kind of driver.
class DriverOutput {
 public:
  virtual ~DriverOutput() = default;
  virtual void send(const DriverCommand& command) = 0;
  [[nodiscard]] virtual unsigned subscribers() const = 0;
};

[[nodiscard]] std::unique_ptr<DriverOutput> make_output(ros::NodeHandle& node,
                                                        const AdapterNodeParams& params);

}  // namespace prf_drivers
