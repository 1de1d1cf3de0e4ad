// SPDX-License-Identifier: BSD-3-Clause
#include "platform_sim/contacts.hpp"

namespace platform_sim {

void ContactRecorder::add_step(const std::vector<ContactPoint>& points) {
  std::map<Pair, Contact> step;
  std::map<Pair, double> strongest;
  for (const ContactPoint& point : points) {
    Pair pair(point.link_a, point.link_b);
    if (pair.second < pair.first) std::swap(pair.first, pair.second);
    Contact& contact = step[pair];
    contact.link_a = pair.first;
    contact.link_b = pair.second;
    contact.force += point.force;
    const auto [strongest_force, is_first] = strongest.try_emplace(pair, point.force);
    if (is_first || point.force > strongest_force->second) {
      strongest_force->second = point.force;
      contact.position = point.position;
    }
  }
  for (const auto& [pair, contact] : step) {
    const auto [recorded, is_new] = contacts_.try_emplace(pair, contact);
    if (!is_new && contact.force > recorded->second.force) recorded->second = contact;
  }
}

std::vector<Contact> ContactRecorder::take() {
  std::vector<Contact> result;
  result.reserve(contacts_.size());
  for (const auto& entry : contacts_) result.push_back(entry.second);
  contacts_.clear();
  return result;
}

}  // namespace platform_sim
