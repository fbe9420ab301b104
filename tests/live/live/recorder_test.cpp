// SPDX-License-Identifier: Apache-2.0
#include "live/recorder.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>
#include <tuple>

#include "bag/autopilot_state.hpp"
#include "bag/mcap_reader.hpp"
#include "bag/reader.hpp"
#include "kelpie/core/random.hpp"
#include "live/mission.hpp"
#include "live/tuning.hpp"
#include "mavlink/frame_parser.hpp"
#include "mavlink/frame_writer.hpp"
#include "plain_user.hpp"
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

// A vehicle tells its parameters once; every file of a recording has all of them.
TEST(Recorder, ANewFileBeginsWithTheParametersAsLastTold) {
  const TemporaryFolder folder;
  const std::vector<bag::Topic> topics{
      {.name = "ATTITUDE", .type = "ATTITUDE", .encoding = "mavlink"},
      {.name = "PARAM_VALUE", .type = "PARAM_VALUE", .encoding = "mavlink"}};
  mavlink::FrameWriter writer(1, 1);
  mavlink::FrameParser parser;
  live::ParameterMessages told;
  std::int64_t time_ns = testing::kSecond;
  const auto message_with = [&](std::size_t topic, std::span<const std::byte> bytes,
                                const std::function<void(const bag::Message&)>& use) {
    parser.add(bytes);
    mavlink::Frame frame;
    ASSERT_TRUE(parser.next(frame));
    time_ns += testing::kSecond;
    use({.topic = topic, .receive_ns = time_ns, .publish_ns = time_ns, .data = frame.payload});
  };
  live::Recorder first(folder / "rec", {});
  first.begin_with(told);
  const auto tell = [&](const char* name, double value) {
    writer.begin("PARAM_VALUE").set("param_id", name).set("param_value", value);
    message_with(1, writer.finish(), [&](const bag::Message& message) {
      first.write(topics, message);
      told.hear(topics, message);
    });
  };
  tell("MOT_1_DIRECTION", 1.0);
  tell("FRAME_CONFIG", 2.0);
  tell("MOT_1_DIRECTION", -1.0);
  first.finish();
  live::Recorder second(folder / "rec", {});
  second.begin_with(told);
  for (int k = 0; k < 2; ++k) {
    message_with(0, writer.begin("ATTITUDE").set("roll", 0.5).finish(),
                 [&](const bag::Message& message) { second.write(topics, message); });
  }
  second.finish();
  const std::string text = testing::read_text(folder / "rec" / "live_0002.mcap");
  const auto bag = bag::read_mcap(std::as_bytes(std::span(text)), "x.mcap", bag::ReadMode::strict);
  bag::AutopilotState state;
  std::vector<std::int64_t> times_ns;
  for (bag::Message message; bag->next(message);) {
    state.hear(bag->topics(), message);
    times_ns.push_back(message.receive_ns);
  }
  EXPECT_EQ(state.parameters(),
            (std::map<std::string, double>{{"FRAME_CONFIG", 2.0}, {"MOT_1_DIRECTION", -1.0}}));
  ASSERT_EQ(times_ns.size(), 4U);
  EXPECT_EQ(times_ns.front(), times_ns[2]);  // of the file's time, not of hours ago
}

// While it lives no file of this process grows beyond its bytes.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) : before_(::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &limit_);
    const rlimit little{.rlim_cur = bytes, .rlim_max = limit_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &little);
  }
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &limit_);
    std::ignore = ::signal(SIGXFSZ, before_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk(FullDisk&&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;
  FullDisk& operator=(FullDisk&&) = delete;

 private:
  rlimit limit_{};
  sighandler_t before_;
};

TEST(Recorder, AFullDiskIsCountedAndWithRoomAgainItGoesOnInAnotherFile) {
  const TemporaryFolder folder;
  live::Recorder recorder(folder / "rec", {});
  bag::Message large = testing::message_of(little_mission(1.0).front());
  RandomStream random(3, "disk");
  std::vector<std::byte> noise(200'000);  // packs to its length
  std::ranges::generate(noise, [&] { return static_cast<std::byte>(random.uniform(0.0, 255.9)); });
  large.data = noise;
  const auto write = [&](int count) {
    for (int i = 0; i < count; ++i) {
      recorder.write(testing::mission_topics(), large);
    }
  };
  write(10);
  EXPECT_EQ(recorder.error(), "");
  {
    const FullDisk full(100'000);
    write(20);
    EXPECT_NE(recorder.error(), "");
    const auto end = std::chrono::steady_clock::now() + 3 * live::kTuning.between_recordings / 2;
    while (std::chrono::steady_clock::now() < end) {  // tried again, in vain
      write(1);
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  }
  const std::size_t lost = recorder.lost();
  EXPECT_GE(lost, 15U);
  while (!recorder.error().empty()) {
    write(1);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  recorder.finish();
  std::size_t recorded = 0;
  for (const auto& file : std::filesystem::directory_iterator(folder / "rec")) {
    recorded +=
        testing::read_all(testing::read_text(file.path()), bag::ReadMode::recover).messages.size();
  }
  EXPECT_GT(recorded, 10U);
  EXPECT_GE(recorder.lost(), lost);
}

// A disk that takes the head of a file, and even a message, and no chunk of a recording.
TEST(Recorder, AFullDiskWithALittleRoomRecordsNothingAndKeepsNoEmptyFiles) {
  const TemporaryFolder folder;
  live::Recorder recorder(folder / "rec", {});
  bag::Message message = testing::message_of(little_mission(1.0).front());
  RandomStream random(3, "disk");
  std::vector<std::byte> noise(30'000);
  message.data = noise;
  const FullDisk full(100'000);
  const auto end = std::chrono::steady_clock::now() + 3 * live::kTuning.between_recordings / 2;
  std::size_t written = 0;
  for (; std::chrono::steady_clock::now() < end; ++written) {
    std::ranges::generate(noise,
                          [&] { return static_cast<std::byte>(random.uniform(0.0, 255.9)); });
    recorder.write(testing::mission_topics(), message);
    if (recorder.lost() > 0) {
      ASSERT_NE(recorder.error(), "") << "after " << written << " messages";
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_GE(recorder.lost() + 40U, written);
  EXPECT_LE(std::distance(std::filesystem::directory_iterator(folder / "rec"), {}), 1);
}

TEST(Recorder, AFolderWithoutPermissionIsAFailureThatNamesTheFile) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "rec");
  const testing::PlainUser user(folder / "rec");
  if (!testing::PlainUser::is_plain()) {
    GTEST_SKIP() << "root may write anywhere";
  }
  for (const auto permissions :
       {std::filesystem::perms::owner_read, std::filesystem::perms::none}) {
    std::filesystem::permissions(folder / "rec", permissions);
    EXPECT_NE(testing::message_of<Failure>([&] {
                live::Recorder(folder / "rec", {});
              }).find("live_0001.mcap: cannot be written: Permission denied"),
              std::string::npos);
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
