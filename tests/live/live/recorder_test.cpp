// SPDX-License-Identifier: Apache-2.0
#include "live/recorder.hpp"

#include <gtest/gtest.h>

#include "bag/reader.hpp"
#include "live/mission.hpp"
#include "support.hpp"

namespace kelpie::recorder_test {
namespace {

using testing::little_mission;
using testing::Recorded;
using testing::TemporaryFolder;

TEST(Recorder, WhatItWritesIsABagOfAllThatCame) {
  const TemporaryFolder folder;
  const std::vector<Recorded> messages = little_mission(30.0);
  for (int i = 0; i < 2; ++i) {
    live::Recorder recorder(folder / "rec", {});
    for (const Recorded& message : messages) {
      recorder.write(testing::mission_topics(), testing::message_of(message));
    }
    recorder.finish();
    EXPECT_EQ(recorder.error(), "");
  }
  const std::string whole = testing::read_text(folder / "rec" / "live_0001.mcap");
  EXPECT_EQ(testing::read_text(folder / "rec" / "live_0002.mcap"), whole);
  const testing::Content content = testing::read_all(whole);
  ASSERT_EQ(content.messages.size(), messages.size());
  for (std::size_t i = 0; i < messages.size(); ++i) {
    ASSERT_EQ(content.messages[i].data, messages[i].data);
    ASSERT_EQ(content.messages[i].receive_ns, messages[i].receive_ns);
  }
}

TEST(Recorder, AFileWithoutItsEndIsReadAsFarAsItGoes) {
  bag::McapWriter writer({.compression = "zstd", .chunk_bytes = 4000});
  for (const bag::Topic& topic : testing::mission_topics()) {
    writer.add_topic(topic);
  }
  const std::vector<Recorded> messages = little_mission(30.0);
  std::string taken;
  for (const Recorded& message : messages) {
    writer.write(testing::message_of(message));
    taken += writer.take();
  }
  taken += writer.take(true);
  EXPECT_EQ(testing::read_all(taken, bag::ReadMode::recover).messages.size(), messages.size());
  taken += writer.finish();
  EXPECT_EQ(testing::read_all(taken).messages.size(), messages.size());  // every CRC is checked
}

}  // namespace
}  // namespace kelpie::recorder_test
