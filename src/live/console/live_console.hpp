// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <string>
#include <thread>

#include "live/output.hpp"

namespace kelpie::cli {

/// Events and status on the standard error stream: a line per event; the status in a terminal's
/// last line every second, elsewhere (a journal) a line every `status_s` seconds. A thread writes:
/// a stream that takes nothing (Ctrl-S) stops no caller. Lines beyond kMostWaiting are dropped and
/// counted.
class LiveConsole final : public live::Output {
 public:
  static constexpr std::size_t kMostWaiting = 1'000;  ///< lines

  explicit LiveConsole(double status_s);
  ~LiveConsole() override;  ///< Waits until all is written.
  LiveConsole(const LiveConsole&) = delete;
  LiveConsole& operator=(const LiveConsole&) = delete;

  void event(const std::string& line) override;
  void health(const live::Health& health) override;

 private:
  struct Line {
    std::string text;
    bool is_event = true;
  };

  void add(Line line);
  void write();
  void write(const Line& line) const;

  std::chrono::duration<double> every_;
  bool terminal_;
  std::chrono::steady_clock::time_point shown_;
  std::mutex mutex_;
  std::condition_variable added_;
  std::deque<Line> waiting_;
  std::size_t dropped_ = 0;
  bool ends_ = false;
  std::thread writer_;  // the last: it uses the others
};

/// Status in one line.
std::string status_text(const live::Health& health);

/// Summary of a run: signals, counts and axes.
std::string final_table(const live::Health& health);

}  // namespace kelpie::cli
