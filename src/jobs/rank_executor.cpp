// SPDX-License-Identifier: Apache-2.0
#include "jobs/rank_executor.hpp"

#include <algorithm>
#include <thread>
#include <utility>
#include <vector>

#include "jobs/rank_follower.hpp"
#include "jobs/rank_leader.hpp"

namespace kelpie::jobs {
namespace {

class RankExecutor final : public Executor {
 public:
  RankExecutor(std::unique_ptr<Messenger> messenger, std::string version)
      : messenger_(std::move(messenger)),
        version_(std::move(version)),
        left_(messenger_->size(), false) {
    left_[kLeader] = true;
  }
  ~RankExecutor() override {
    if (leads()) {
      dismiss();
    } else {
      leave();
    }
  }
  RankExecutor(const RankExecutor&) = delete;
  RankExecutor(RankExecutor&&) = delete;
  RankExecutor& operator=(const RankExecutor&) = delete;
  RankExecutor& operator=(RankExecutor&&) = delete;

  bool leads() const override { return messenger_->rank() == kLeader; }
  std::size_t workers() const override { return messenger_->size(); }

  bool run(const Run& run) override {
    if (leads()) {
      return RankLeader(*messenger_, run, version_, left_).run();
    }
    if (leader_gone_) {
      return false;
    }
    const std::optional<bool> complete = RankFollower(*messenger_, run).run(version_);
    leader_gone_ = !complete;
    return complete.value_or(false);
  }

 private:
  // No message may be under way when a messenger ends: each side waits for the other's last.
  void dismiss() {
    for (std::size_t rank = 1; rank < left_.size(); ++rank) {
      messenger_->send(rank, static_cast<int>(Kind::gone), "");
    }
    await(
        [&](const Message& message) {
          left_[message.from] = left_[message.from] || message.kind == static_cast<int>(Kind::bye);
        },
        [&] { return std::ranges::find(left_, false) == left_.end(); });
  }

  void leave() {
    messenger_->send(kLeader, static_cast<int>(Kind::bye), "");
    await(
        [&](const Message& message) {
          leader_gone_ = leader_gone_ || message.kind == static_cast<int>(Kind::gone);
        },
        [&] { return leader_gone_; });
  }

  template <typename Take, typename Done>
  void await(Take take, Done done) {
    Patience patience;
    while (!done()) {
      if (const std::optional<Message> message = messenger_->receive()) {
        take(*message);
      } else {
        std::this_thread::sleep_for(patience.next());
      }
    }
  }

  std::unique_ptr<Messenger> messenger_;
  std::string version_;
  std::vector<bool> left_;    // the leader: who has said bye
  bool leader_gone_ = false;  // the others
};

}  // namespace

std::unique_ptr<Executor> make_rank_executor(std::unique_ptr<Messenger> messenger,
                                             std::string version) {
  return std::make_unique<RankExecutor>(std::move(messenger), std::move(version));
}

}  // namespace kelpie::jobs
