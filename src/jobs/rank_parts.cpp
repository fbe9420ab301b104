// SPDX-License-Identifier: Apache-2.0
#include "jobs/rank_parts.hpp"

#include <algorithm>
#include <atomic>
#include <thread>
#include <utility>

#include "kelpie/core/archive.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::jobs {
namespace {

constexpr std::chrono::microseconds kShortestSleep{20};
constexpr std::chrono::microseconds kLongestSleep{500};
constexpr std::chrono::milliseconds kBetweenOccasions{50};

// An archive's texts are short; those of jobs and results stand behind it as they are.
constexpr std::size_t kOrderHead = 24;
constexpr std::size_t kOutcomeHead = 16;

struct OrderHead {
  std::size_t place = 0;
  std::size_t key_size = 0;
  double cost = 0.0;

  void visit(Archive& archive) {
    archive.whole(place);
    archive.whole(key_size);
    archive.number(cost);
  }
};

struct OutcomeHead {
  std::size_t place = 0;
  int how = 0;

  void visit(Archive& archive) {
    archive.whole(place);
    archive.whole(how, 0, static_cast<int>(Outcome::How::failed));
  }
};

template <typename Head>
std::string head_bytes(Head head) {
  Archive archive;
  head.visit(archive);
  return archive.bytes();
}

template <typename Head>
Head head_of(std::string_view text) {
  Archive archive(text);
  Head head;
  head.visit(archive);
  return head;
}

std::string_view take_line(std::string_view& text) {
  const std::string_view line = text.substr(0, text.find('\n'));
  text.remove_prefix(std::min(text.size(), line.size() + 1));
  return line;
}

Outcome outcome_of(const Order& order, const Work& work, const Advance& advance) {
  using How = Outcome::How;
  std::atomic<bool> stopped{false};
  try {
    std::string result = work(order.job, [&](double share) {
      if (!stopped && !advance(share)) {
        stopped = true;  // written only where it is so: a job may ask from several threads
      }
      return !stopped;
    });
    if (result.size() > Messenger::kMostBytes / 2) {
      throw Failure(order.job.key + ": its result is too large to be sent");
    }
    return {order.place, stopped ? How::stopped : How::result, std::move(result)};
  } catch (const InputError& error) {
    return {order.place, How::bad_input, error.what()};
  } catch (const std::exception& error) {
    return {order.place, How::failed, error.what()};
  } catch (...) {
    return {order.place, How::failed, order.job.key + ": failed for no reason that it names"};
  }
}

}  // namespace

Greeting Greeting::of(std::string_view text) {
  Greeting greeting;
  greeting.host = take_line(text);
  greeting.version = take_line(text);
  greeting.identity = text;
  return greeting;
}

std::string Order::text() const {
  return head_bytes(OrderHead{place, job.key.size(), job.cost}) + job.key + job.task;
}

Order Order::of(std::string_view text) {
  const auto head = head_of<OrderHead>(text);
  const std::string_view texts = text.substr(kOrderHead);
  return {head.place,
          {std::string(texts.substr(0, head.key_size)), std::string(texts.substr(head.key_size)),
           head.cost}};
}

std::string Outcome::text() const {
  return head_bytes(OutcomeHead{place, static_cast<int>(how)}) + said;
}

Outcome Outcome::of(std::string_view text) {
  const auto head = head_of<OutcomeHead>(text);
  return {head.place, static_cast<How>(head.how), std::string(text.substr(kOutcomeHead))};
}

std::exception_ptr Outcome::error() const {
  return how == How::bad_input ? std::make_exception_ptr(InputError(said))
                               : std::make_exception_ptr(Failure(said));
}

JobThread::~JobThread() {
  const std::scoped_lock lock(mutex_);
  ended_ = true;
  changed_.notify_all();
}

void JobThread::begin(Order order, const Work& work, Advance advance) {
  busy_ = true;
  {
    const std::scoped_lock lock(mutex_);
    task_ = [order = std::move(order), &work, advance = std::move(advance)] {
      return outcome_of(order, work, advance);
    };
    changed_.notify_all();
  }
  if (!thread_.joinable()) {
    thread_ = std::jthread([this] { run(); });
  }
}

std::optional<Outcome> JobThread::wait(std::chrono::microseconds time) {
  if (!busy_) {
    std::this_thread::sleep_for(time);
    return std::nullopt;
  }
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, time, [this] { return outcome_.has_value(); });
  busy_ = !outcome_;
  return std::exchange(outcome_, std::nullopt);
}

void JobThread::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return task_ || ended_; });
    if (!task_) {
      return;
    }
    const std::function<Outcome()> task = std::exchange(task_, nullptr);
    lock.unlock();
    Outcome outcome = task();
    lock.lock();
    outcome_ = std::move(outcome);
    changed_.notify_all();
  }
}

std::chrono::microseconds Patience::next() const {
  const auto waited = std::chrono::steady_clock::now() - since_;
  return std::clamp(std::chrono::duration_cast<std::chrono::microseconds>(waited / 10),
                    kShortestSleep, kLongestSleep);
}

bool Occasion::due() {
  const auto now = std::chrono::steady_clock::now();
  if (now - last_ < kBetweenOccasions) {
    return false;
  }
  last_ = now;
  return true;
}

}  // namespace kelpie::jobs
