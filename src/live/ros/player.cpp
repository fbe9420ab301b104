// SPDX-License-Identifier: Apache-2.0
#include "ros/player.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

#include "kelpie/core/error.hpp"
#include "live/pace.hpp"
#include "ros/tuning.hpp"

namespace kelpie::ros {
namespace {

using Clock = std::chrono::steady_clock;

// False where `is_over` came first.
bool sleep_until(Clock::time_point due, const std::function<bool()>& is_over) {
  for (;;) {
    if (is_over()) {
      return false;
    }
    const Clock::time_point now = Clock::now();
    if (now >= due) {
      return true;
    }
    std::this_thread::sleep_until(std::min(due, now + kTuning.play_step));
  }
}

}  // namespace

Player::Player(bag::MessageReader& bag, const NodeSettings& settings, double speed)
    : bag_(bag), settings_(settings), speed_(speed), participant_(settings.network) {}

void Player::open_publications() {
  while (publications_.size() < bag_.topics().size()) {
    const bag::Topic& topic = bag_.topics()[publications_.size()];
    publications_.emplace_back();
    if (topic.encoding != "cdr") {
      left_out_.push_back(topic.name + ": its messages are " + topic.encoding + ", not cdr");
      continue;
    }
    try {
      publications_.back() = std::make_unique<dds::Publication>(
          participant_, settings_.names.full_name(topic.name), topic.type, settings_.published);
    } catch (const InputError& error) {
      left_out_.push_back(topic.name + ": " + error.what());
    }
  }
}

bool Player::has_subscriber() const {
  return std::ranges::any_of(publications_, [](const auto& publication) {
    return publication != nullptr && publication->subscribers() > 0;
  });
}

void Player::play(const std::function<bool()>& is_over) {
  bag::Message message;
  bool has_message = bag_.next(message);
  open_publications();
  const Clock::time_point patience = Clock::now() + kTuning.longest_wait;
  while (!has_subscriber() && Clock::now() < patience && !is_over()) {
    std::this_thread::sleep_for(kTuning.play_step);
  }
  const Clock::time_point begin = Clock::now() + kTuning.settling;
  live::Pace pace(speed_);
  for (; has_message; has_message = bag_.next(message)) {
    open_publications();
    if (!sleep_until(pace.next(message.receive_ns, begin), is_over)) {
      return;
    }
    if (const auto& publication = publications_[message.topic]; publication != nullptr) {
      messages_ += publication->publish(message.data) ? 1 : 0;
    }
  }
  // Lets the last messages arrive before subscribers lose their publisher.
  std::this_thread::sleep_for(kTuning.settling);
}

}  // namespace kelpie::ros
