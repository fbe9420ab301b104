// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>

#include "live/output.hpp"

namespace kelpie::cli {

/// Events and status on the standard error stream: a line per event; the status in a terminal's
/// last line every second, elsewhere (a journal) a line every `status_s` seconds.
class LiveConsole final : public live::Output {
 public:
  explicit LiveConsole(double status_s);
  ~LiveConsole() override;
  LiveConsole(const LiveConsole&) = delete;
  LiveConsole& operator=(const LiveConsole&) = delete;

  void event(const std::string& line) override;
  void health(const live::Health& health) override;

 private:
  std::chrono::duration<double> every_;
  bool terminal_;
  std::chrono::steady_clock::time_point shown_;
};

/// Status in one line.
std::string status_text(const live::Health& health);

/// Summary of a run: signals, counts and axes.
std::string final_table(const live::Health& health);

}  // namespace kelpie::cli
