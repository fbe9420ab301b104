// SPDX-License-Identifier: Apache-2.0
#include "cli/progress.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <utility>

#include "cli/output.hpp"

namespace kelpie::cli {
namespace {

constexpr std::chrono::milliseconds kBetweenDraws{100};
constexpr std::size_t kWidth = 30;

}  // namespace

ProgressBar::ProgressBar(std::string what)
    : what_(std::move(what)),
      terminal_(isatty(::fileno(streams().err)) == 1),
      start_(std::chrono::steady_clock::now()) {}

ProgressBar::~ProgressBar() {
  if (terminal_) {
    fmt::print(streams().err, "\r\033[K");
  }
}

void ProgressBar::at(double share) {
  if (!terminal_) {
    return;
  }
  const auto now = std::chrono::steady_clock::now();
  if (now - drawn_ < kBetweenDraws) {
    return;
  }
  drawn_ = now;
  const double elapsed_s = std::chrono::duration<double>(now - start_).count();
  const auto full = static_cast<std::size_t>(share * static_cast<double>(kWidth));
  fmt::print(streams().err, "\r\033[K{} [{:#>{}}{:.>{}}] {:3.0f} %  {:.0f} s left", what_, "", full,
             "", kWidth - full, 100.0 * share,
             share > 0.0 ? elapsed_s * (1.0 - share) / share : 0.0);
}

}  // namespace kelpie::cli
