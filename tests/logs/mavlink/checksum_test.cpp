// SPDX-License-Identifier: Apache-2.0
#include "mavlink/checksum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <random>
#include <span>
#include <vector>

namespace kelpie::checksum_test {
namespace {

// A search for frames in rubbish asks for the checksum of a stretch at nearly every byte.
TEST(RunningChecksum, IsTheChecksumOfEveryStretch) {
  std::mt19937 random(3);
  std::vector<std::byte> bytes;
  mavlink::RunningChecksum running;
  for (int round = 0; round < 2'000; ++round) {
    std::vector<std::byte> more(random() % 300);
    std::ranges::generate(more, [&] { return static_cast<std::byte>(random()); });
    running.add(more);
    bytes.insert(bytes.end(), more.begin(), more.end());
    const std::size_t first = random() % (bytes.size() + 1);
    const std::size_t size =
        random() % (std::min(bytes.size() - first, mavlink::RunningChecksum::kMostBytes) + 1);
    ASSERT_EQ(running.of(first, size), mavlink::checksum(std::span(bytes).subspan(first, size)))
        << first << " " << size;
    const std::size_t gone = random() % (bytes.size() + 1);
    running.drop(gone);
    bytes.erase(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(gone));
  }
}

}  // namespace
}  // namespace kelpie::checksum_test
