// SPDX-License-Identifier: Apache-2.0
#include "jobs/rank_follower.hpp"

namespace kelpie::jobs {

std::optional<bool> RankFollower::run(const std::string& version) {
  const Greeting mine{messenger_.host(), version, run_.identity};
  messenger_.send(kLeader, static_cast<int>(Kind::hello), mine.text());
  while (!end_ || own_.busy()) {
    attend();
  }
  return end_->kind == static_cast<int>(Kind::over) ? std::optional(end_->text == "1")
                                                    : std::nullopt;
}

// What has happened since, or a short sleep.
void RankFollower::attend() {
  while (!end_) {  // what comes after it is of the next run
    const std::optional<Message> message = messenger_.receive();
    if (!message) {
      break;
    }
    patience_.heard();
    take(*message);
  }
  if (const std::optional<Outcome> outcome = own_.wait(patience_.next())) {
    patience_.heard();
    messenger_.send(kLeader, static_cast<int>(Kind::outcome), outcome->text());
  }
  if (occasion_.due()) {
    look();
  }
  if (unwilling_ && !halted_) {
    halted_ = true;
    messenger_.send(kLeader, static_cast<int>(Kind::halt), "");
  }
}

void RankFollower::take(const Message& message) {
  switch (static_cast<Kind>(message.kind)) {
    case Kind::order:
      own_.begin(Order::of(message.text), run_.work,
                 [this](double share) { return advance(share); });
      break;
    case Kind::stop:
      stopped_ = true;
      break;
    default:  // over or gone
      stopped_ = true;
      end_ = message;
  }
}

bool RankFollower::advance(double share) {
  const std::scoped_lock lock(mutex_);
  share_ = share;
  ask();
  return !stopped_;
}

// Jobs may tell how far they are without a pause: who sends and receives mustn't wait for one.
void RankFollower::look() {
  if (const std::unique_lock lock(mutex_, std::try_to_lock); lock) {
    ask();
  }
}

void RankFollower::ask() {
  if (!unwilling_ && !run_.keep_going(share_)) {
    unwilling_ = true;
    stopped_ = true;  // written only where it is so: stop may have come in between
  }
}

}  // namespace kelpie::jobs
