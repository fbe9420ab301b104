// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>

#include "live/output.hpp"

namespace kelpie::cli {

/// What happens, a line each, on the standard error stream; and how things are: on a terminal a
/// line that is written again every second, elsewhere (a journal) one every so many seconds.
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

/// The same in one line.
std::string status_text(const live::Health& health);

/// What is known at the end, or whenever somebody wants all of it: a line per signal and per axis.
std::string final_table(const live::Health& health);

}  // namespace kelpie::cli
