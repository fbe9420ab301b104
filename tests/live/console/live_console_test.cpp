// SPDX-License-Identifier: Apache-2.0
#include "console/live_console.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <thread>

namespace kelpie::live_console_test {
namespace {

// The standard error stream as a pipe that holds 4 kB and that nobody reads.
class StoppedStream {
 public:
  StoppedStream() : before_(::dup(STDERR_FILENO)) {
    EXPECT_EQ(::pipe(ends_.data()), 0);
    ::fcntl(ends_[1], F_SETPIPE_SZ, 4096);
    ::dup2(ends_[1], STDERR_FILENO);
    ::close(ends_[1]);
  }
  ~StoppedStream() { ::close(before_); }
  StoppedStream(const StoppedStream&) = delete;
  StoppedStream(StoppedStream&&) = delete;
  StoppedStream& operator=(const StoppedStream&) = delete;
  StoppedStream& operator=(StoppedStream&&) = delete;

  // What was written; `end` ends writing.
  template <typename End>
  std::string read(End end) {
    std::string text;
    std::thread reader([&] {
      std::array<char, 4096> bytes{};
      for (ssize_t count = 1; count > 0;) {
        count = ::read(ends_[0], bytes.data(), bytes.size());
        text.append(bytes.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
      }
    });
    end();
    ::dup2(before_, STDERR_FILENO);  // the last end of the pipe to write to
    reader.join();
    ::close(ends_[0]);
    return text;
  }

 private:
  int before_;
  std::array<int, 2> ends_{};
};

TEST(LiveConsole, AStreamThatTakesNothingStopsNobody) {
  StoppedStream stream;
  auto console = std::make_unique<cli::LiveConsole>(60.0);
  constexpr std::size_t kMost = cli::LiveConsole::kMostWaiting;
  for (std::size_t k = 0; k < 3 * kMost; ++k) {
    console->event("event " + std::to_string(k));
  }
  const std::string text = stream.read([&] { console.reset(); });
  EXPECT_EQ(text.find("kelpie: event 0\nkelpie: event 1\n"), 0U);
  EXPECT_NE(text.find("kelpie: event " + std::to_string(kMost / 2) + "\n"), std::string::npos);
  EXPECT_EQ(text.find("event " + std::to_string(3 * kMost - 1) + "\n"), std::string::npos);
}

}  // namespace
}  // namespace kelpie::live_console_test
