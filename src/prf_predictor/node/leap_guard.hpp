// SPDX-License-Identifier: BSD-3-Clause
// Tells a lone stamp far in the future from a clock that has leapt forward: what comes more than
// kLimit after all before is held until the next stamp says whether time goes on from there or
// goes back by more than that. Depends on the order of the stamps alone.
#pragma once

#include <ros/time.h>

#include <optional>
#include <utility>
#include <vector>

namespace prf_predictor {

template <typename Message>
class LeapGuard {
 public:
  struct Answer {
    std::vector<Message> taken;  // in order
    bool refused = false;        // what was held
  };

  Answer take(const ros::Time& stamp, const Message& message) {
    Answer answer;
    if (held_) {
      answer.refused = stamp + kLimit < held_->first;
      if (!answer.refused) {
        newest_ = held_->first;
        answer.taken.push_back(std::move(held_->second));
      }
      held_.reset();
    }
    if (!newest_.isZero() && newest_ + kLimit < stamp) {
      held_.emplace(stamp, message);
    } else {
      newest_ = stamp;
      answer.taken.push_back(message);
    }
    return answer;
  }

 private:
  const ros::Duration kLimit{1.0};
  ros::Time newest_;
  std::optional<std::pair<ros::Time, Message>> held_;
};

}  // namespace prf_predictor
