// SPDX-License-Identifier: Apache-2.0
#include "bag/child_process.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <stdexcept>
#include <thread>
#include <vector>

namespace kelpie::child_process_test {
namespace {

constexpr bag::ChildLimits kLimits{.bytes = 256'000'000, .seconds = 20};

// Why a child gives fewer bytes than wanted.
std::string end_of(const std::function<void(const bag::ChildProcess::Write&)>& work,
                   const bag::ChildLimits& limits = kLimits) {
  bag::ChildProcess child(work, limits);
  std::array<std::byte, 8> bytes{};
  EXPECT_FALSE(child.read(bytes));
  return child.end();
}

TEST(ChildProcess, ACrashAHangAndAnExceptionHaveTheirEnds) {
  EXPECT_EQ(end_of([](const auto&) { std::raise(SIGSEGV); }),
            "ended by signal 11 (Segmentation fault)");
  EXPECT_EQ(end_of([](const auto&) { ::pause(); }, {.bytes = 256'000'000, .seconds = 1}),
            "takes more than 1 s");
  EXPECT_EQ(end_of([](const auto&) { throw std::runtime_error("damaged"); }), "failed");
  EXPECT_EQ(end_of([](const auto& write) { write(std::array<std::byte, 4>{}); }),
            "ended too early");
}

TEST(ChildProcess, MemoryBeyondTheLimitEndsTheChild) {
  const std::string end = end_of([](const auto& write) {
    std::vector<std::vector<std::byte>> all;
    while (all.size() < 100) {  // 1.6 GB
      all.emplace_back(std::size_t{16'000'000}, std::byte{1});
    }
    write(std::array<std::byte, 8>{});
  });
  EXPECT_TRUE(end == "failed" || end.starts_with("ended by signal")) << end;
}

TEST(ChildProcess, AllocatesBesideThreadsThatDo) {
  std::atomic<bool> ends = false;
  std::vector<std::jthread> threads;
  for (int k = 0; k < 4; ++k) {
    threads.emplace_back([&ends] {
      for (std::size_t size = 1; !ends; size = size * 3 % 100'003) {
        std::vector<std::byte> some(size);
        some.back() = std::byte{1};
      }
    });
  }
  for (int round = 0; round < 50; ++round) {
    bag::ChildProcess child(
        [](const auto& write) {
          std::vector<std::byte> sent;
          while (sent.size() < 10'000) {
            sent.insert(sent.end(), std::size_t{7}, std::byte{5});
          }
          write(sent);
        },
        kLimits);
    std::vector<std::byte> received(10'000);
    EXPECT_TRUE(child.read(received)) << child.end();
  }
  ends = true;
}

}  // namespace
}  // namespace kelpie::child_process_test
