// SPDX-License-Identifier: Apache-2.0
#include "jobs/rank_leader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "kelpie/core/error.hpp"

namespace kelpie::jobs {

RankLeader::RankLeader(Messenger& messenger, const Run& run, const std::string& version,
                       std::vector<bool>& left)
    : messenger_(messenger),
      run_(run),
      mine_{messenger.host(), version, run.identity},
      left_(left),
      order_(costly_first(run.jobs)),
      ranks_(messenger.size(), State::unknown),
      progress_(run) {
  ranks_[kLeader] = State::free;
}

bool RankLeader::run() {
  while (!settled()) {
    try {
      attend();
    } catch (...) {
      fail(std::current_exception());
    }
  }
  const bool complete = !error_ && !progress_.stopped();
  for (std::size_t rank = 1; rank < ranks_.size(); ++rank) {
    if (!left_[rank]) {
      messenger_.send(rank, static_cast<int>(Kind::over), complete ? "1" : "0");
    }
  }
  if (error_) {
    std::rethrow_exception(error_);
  }
  return complete;
}

// What has happened since, or a short sleep.
void RankLeader::attend() {
  while (const std::optional<Message> message = messenger_.receive()) {
    patience_.heard();
    take(*message);
  }
  hand_out();
  if (const std::optional<Outcome> outcome = own_.wait(patience_.next())) {
    ranks_[kLeader] = State::free;
    take(*outcome);
  }
  if (occasion_.due()) {
    progress_.look();
  }
  if (progress_.stopped()) {
    stop();
  }
}

void RankLeader::take(const Message& message) {
  switch (static_cast<Kind>(message.kind)) {
    case Kind::hello:
      greet(message.from, Greeting::of(message.text));
      break;
    case Kind::outcome:
      ranks_[message.from] = State::free;
      take(Outcome::of(message.text));
      break;
    case Kind::halt:
      progress_.stop();
      break;
    case Kind::bye:
      left_[message.from] = true;
      ranks_[message.from] = State::refused;
      throw Failure(fmt::format("rank {} has left before the work was done; see what it has said",
                                message.from));
    default:
      throw Failure(fmt::format("rank {} has said something that no kelpie says", message.from));
  }
}

void RankLeader::take(const Outcome& outcome) {
  if (outcome.how == Outcome::How::result) {
    progress_.finish(outcome.place, outcome.said);
  } else if (outcome.how == Outcome::How::stopped) {
    progress_.stop();
  } else {
    fail(outcome.error());
  }
}

void RankLeader::greet(std::size_t rank, const Greeting& other) {
  ranks_[rank] = State::refused;
  const std::string who = fmt::format("rank {} on {}", rank, other.host);
  if (other.version != mine_.version) {
    throw InputError(who, fmt::format("is kelpie {}, but rank {} on {}, which leads, is kelpie {}",
                                      other.version, kLeader, mine_.host, mine_.version));
  }
  if (other.identity != mine_.identity) {
    throw InputError(who, fmt::format("has other work, \"{}\", than rank {} on {}, which leads: "
                                      "\"{}\"",
                                      other.identity, kLeader, mine_.host, mine_.identity));
  }
  ranks_[rank] = State::free;
}

void RankLeader::hand_out() {
  for (std::size_t rank = 0; rank < ranks_.size() && next_ < order_.size(); ++rank) {
    if (ranks_[rank] != State::free || progress_.stopped()) {
      continue;
    }
    if (rank == kLeader) {
      Order order = next_order();
      const std::size_t place = order.place;
      own_.begin(std::move(order), run_.work,
                 [this, place](double share) { return progress_.advance(place, share); });
    } else {
      messenger_.send(rank, static_cast<int>(Kind::order), next_order().text());
    }
    ranks_[rank] = State::busy;
  }
}

Order RankLeader::next_order() {
  const std::size_t place = order_[next_++];
  return {place, run_.jobs[place]};
}

void RankLeader::fail(std::exception_ptr error) {
  error_ = error_ ? error_ : std::move(error);
  progress_.stop();
}

void RankLeader::stop() {
  if (!std::exchange(told_, true)) {
    next_ = order_.size();
    for (std::size_t rank = 1; rank < ranks_.size(); ++rank) {
      if (ranks_[rank] == State::busy) {
        messenger_.send(rank, static_cast<int>(Kind::stop), "");
      }
    }
  }
}

// Everybody is known, and nobody is at work or will be.
bool RankLeader::settled() const {
  return (next_ == order_.size() || progress_.stopped()) && !own_.busy() &&
         std::ranges::none_of(
             ranks_, [](State state) { return state == State::unknown || state == State::busy; });
}

}  // namespace kelpie::jobs
