// SPDX-License-Identifier: Apache-2.0
#include "live/receiver.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "live/pose_mission.hpp"
#include "support.hpp"

namespace kelpie::receiver_test {
namespace {

using testing::kSecond;
using testing::Recorded;

constexpr std::int64_t kBegin = 1'700'000'000 * kSecond;

live::Configuration configuration_of(const std::string& text) {
  const testing::TemporaryFolder folder;
  testing::write_text(folder / "x.toml", text);
  return live::read_configuration(folder / "x.toml", {});
}

// As a command that has ceased, an angle of the pose is no longer known after log.gap.
TEST(Receiver, AnAngleOfAPoseThatHasCeasedIsSilent) {
  std::string text = testing::pose_config("window = 3\ngap = 1");
  const std::string inputs = "\"u\", \"v\", \"r\", \"n\", \"m\"";
  text.replace(text.find(inputs), inputs.size(), "\"psi\", \"n\"");
  const live::Configuration configuration = configuration_of(text);
  live::Receiver receiver(configuration, kBegin);
  std::array<double, 2> x{};
  const auto is_known = [&] {
    return receiver.inputs_at(receiver.now_s(), std::array{0.0, 0.0}, x);
  };
  const testing::PoseLog log(8.0);
  for (const Recorded& message : testing::pose_mission(log, kBegin, 0.0)) {
    const bool has_poses = message.receive_ns < kBegin + 4 * kSecond;
    if (message.topic != 0 || has_poses) {
      receiver.receive(testing::pose_topics(), testing::message_of(message));
    }
    if (message.topic != 0 && has_poses) {
      ASSERT_TRUE(is_known());
    }
  }
  EXPECT_GT(receiver.now_s(), 7.0);
  EXPECT_FALSE(is_known());
}

}  // namespace
}  // namespace kelpie::receiver_test
