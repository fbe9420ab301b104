// SPDX-License-Identifier: Apache-2.0
#include "bag/ros1_reader.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>

#include "bag/bags.hpp"
#include "bag/hash.hpp"
#include "bag/inspect.hpp"
#include "bag/mcap_writer.hpp"
#include "bag/open_bag.hpp"
#include "bag/ros1_bags.hpp"
#include "bag/series.hpp"
#include "support.hpp"

namespace kelpie::ros1_reader_test {
namespace {

using bag::ReadMode;
using testing::kRos1Stamped;
using testing::ros1_stamped;
using testing::Ros1Bag;
using testing::small_ros1;

bag::BagReport report_of(const std::string& file, ReadMode mode = ReadMode::strict) {
  const auto bag = bag::read_ros1(testing::as_bytes(file), "x.bag", mode);
  return bag::inspect_bag(*bag, bag::MessageDefinitions());
}

std::string refusal(const std::string& file) {
  return testing::message_of<InputError>([&] { report_of(file); });
}

std::vector<bag::Series> series_of(const std::string& file, const std::vector<std::string>& columns,
                                   bag::Clock clock = bag::Clock::receive) {
  const auto bag = bag::read_ros1(testing::as_bytes(file), "x.bag", ReadMode::strict);
  return bag::read_series(*bag, bag::MessageDefinitions(), columns, clock);
}

TEST(Ros1Reader, EveryKindOfChunkGivesTheSameValuesAndTimes) {
  for (const char* const compression : {"none", "bz2", "lz4"}) {
    const std::string file = small_ros1(6, compression).file();
    const std::vector<bag::Series> series = series_of(
        file,
        {"/a:x", "/a:b", "/a:c", "/a:d[1].sec", "/a:d[1].nanosec", "/a:raw[2]", "/a:header.seq"});
    ASSERT_EQ(series.size(), 1U);
    EXPECT_EQ(series[0].values[0], (std::vector<double>{0, 1, 2, 3, 4, 5})) << compression;
    EXPECT_EQ(series[0].times_ns[5], 105'250'000'000);
    const std::vector<double> others{-2, 254, 3, 4, 'c', 7};
    for (std::size_t k = 0; k < others.size(); ++k) {
      EXPECT_EQ(series[0].values[k + 1][3], others[k]) << k;
    }
    EXPECT_EQ(series_of(file, {"/a:x"}, bag::Clock::header)[0].times_ns[5], 95'500'000'000);
    EXPECT_EQ(report_of(file).messages, 7U);
  }
}

TEST(Ros1Reader, TypesNobodyDefinesAreBuiltInAsRos1HasThem) {
  Ros1Bag bag;
  const std::uint32_t id = bag.connect("/v", "geometry_msgs/TwistStamped", "");
  bag.add(id, 1, 0,
          Ros1Bag::raw(std::uint32_t{1}) + Ros1Bag::raw(std::uint32_t{5}) +
              Ros1Bag::raw(std::uint32_t{0}) + Ros1Bag::text("") + Ros1Bag::raw(1.5) +
              std::string(40, '\0'))
      .chunk();
  const auto series = series_of(bag.file(), {"/v:twist.linear.x"}, bag::Clock::header);
  EXPECT_EQ(series[0].values[0], std::vector<double>{1.5});
  EXPECT_EQ(series[0].times_ns, std::vector<std::int64_t>{5'000'000'000});
}

TEST(Ros1Reader, ACopyAsMcapKeepsEverythingAndIsReadBack) {
  const std::string file = small_ros1(6, "lz4").file();
  const auto bag = bag::read_ros1(testing::as_bytes(file), "x.bag", ReadMode::strict);
  const std::string copy = bag::copy_to_mcap(*bag, bag::MessageDefinitions()).content;
  EXPECT_EQ(copy.substr(17, 8), Ros1Bag::text("ros1"));  // the profile
  EXPECT_NE(copy.find("ros1msg"), std::string::npos);
  const auto back = bag::read_mcap(testing::as_bytes(copy), "x.mcap", ReadMode::strict);
  const auto again = bag::read_ros1(testing::as_bytes(file), "x.bag", ReadMode::strict);
  EXPECT_EQ(testing::hashes_of(*back), testing::hashes_of(*again));
  ASSERT_EQ(back->topics().size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(back->topics()[k].definition, again->topics()[k].definition);
    EXPECT_EQ(back->topics()[k].type, again->topics()[k].type);
    EXPECT_EQ(back->topics()[k].is_latched, k == 1);
  }
}

TEST(Ros1Reader, ATopicOfTwoDefinitionsIsRefused) {
  Ros1Bag bag;
  bag.connect("/a", "x_msgs/A", "float64 x\n", "1");
  const std::uint32_t other = bag.connect("/a", "x_msgs/A", "float32 x\n", "2");
  bag.add(other, 1, 0, Ros1Bag::raw(1.0F)).chunk();
  EXPECT_NE(refusal(bag.file()).find("/a has messages by two definitions of x_msgs/A"),
            std::string::npos);
}

TEST(Ros1Reader, AHostileDefinitionIsSaidToBeOne) {
  for (const auto& [definition, data, words] : std::vector<std::array<std::string, 3>>{
           {"x_msgs/A a\n", "", "holds itself"},
           {"Nothing[4000000000] n\nE[] e\n====\nMSG: x_msgs/Nothing\n\n====\nMSG: x_msgs/E\n\n",
            Ros1Bag::raw(UINT32_MAX), ""},
           {"float64[1000000000] x\n", std::string(8, '\0'), "too short"},
           {"string[] s\n", Ros1Bag::raw(UINT32_MAX), "too short"},
       }) {
    Ros1Bag bag;
    bag.add(bag.connect("/a", "x_msgs/A", definition), 1, 0, data).chunk();
    const auto report = report_of(bag.file(), ReadMode::recover);
    const std::string said =
        report.topics[0].not_decoded + (report.losses.empty() ? "" : report.losses[0]);
    EXPECT_TRUE(words.empty() ? said.empty() : said.find(words) != std::string::npos) << said;
  }
}

TEST(Ros1Reader, WhatIsNoneOrNotReadIsNamed) {
  const std::string good = small_ros1(4).file();
  EXPECT_NE(refusal("#ROSBAG V1.2\n").find("another version"), std::string::npos);
  EXPECT_NE(refusal("#ROSBAG V2.0\n").find("offset 13: is cut off"), std::string::npos);
  EXPECT_NE(refusal(small_ros1(4).file(true, {{"encryptor", "rosbag/AesCbcEncryptor"}}))
                .find("encrypted by rosbag/AesCbcEncryptor"),
            std::string::npos);
  std::string swapped = good;
  std::reverse(swapped.begin() + 13, swapped.begin() + 17);
  EXPECT_NE(refusal(swapped).find("another byte order"), std::string::npos);
  EXPECT_NE(refusal(small_ros1(4).file(false)).find("never closed"), std::string::npos);
  EXPECT_EQ(report_of(small_ros1(4).file(false), ReadMode::recover).messages, 5U);
}

// A recorder states what a chunk has when the chunk is full: until then its messages follow a chunk
// of no bytes.
TEST(Ros1Reader, OfABagThatWasNeverClosedTheLastChunkIsReadToo) {
  const Ros1Bag bag = small_ros1(5);
  const std::string begun =
      Ros1Bag::record(5, {{"compression", "none"}, {"size", Ros1Bag::raw(std::uint32_t{0})}}, "");
  const auto report = report_of(bag.file(false) + begun + bag.open_chunk(), ReadMode::recover);
  EXPECT_EQ(report.messages, 6U);
  EXPECT_EQ(report.loss_count, 1U);
}

TEST(Ros1Reader, AFileCutOffAnywhereIsNamedAndReadUpToThere) {
  for (const char* const compression : {"none", "lz4"}) {
    const std::string good = small_ros1(4, compression).file();
    std::size_t before = 0;
    for (std::size_t size = 14; size < good.size(); ++size) {
      const std::string file = good.substr(0, size);
      EXPECT_NE(refusal(file).find("x.bag: offset "), std::string::npos) << size;
      const auto report = report_of(file, ReadMode::recover);
      EXPECT_GE(report.messages, before) << size;
      EXPECT_GE(report.loss_count, 1U) << size;
      before = report.messages;
    }
    EXPECT_EQ(before, 5U);
  }
}

TEST(Ros1Reader, AfterADamagedRecordTheNextOneIsRead) {
  const std::string good = small_ros1(8).file();
  for (std::size_t at = good.find("op=\5"); at != std::string::npos;
       at = good.find("op=\5", at + 1)) {
    std::string file = good;
    file[at + 1] ^= '\x15';  // no field op: its messages are met one by one
    EXPECT_FALSE(refusal(file).empty());
    const auto report = report_of(file, ReadMode::recover);
    EXPECT_EQ(report.messages, 9U) << at;
  }
  std::string file = good;
  file[good.find("op=\2")] ^= '\x15';
  EXPECT_EQ(report_of(file, ReadMode::recover).messages, 8U);
}

TEST(Ros1Reader, ADamagedChunkIsPassedOver) {
  for (const char* const compression : {"bz2", "lz4"}) {
    std::string file = small_ros1(6, compression).file();
    file[file.find("size=") + 60] ^= '\x55';
    EXPECT_NE(refusal(file).find("chunk"), std::string::npos);
    const auto report = report_of(file, ReadMode::recover);
    EXPECT_LT(report.messages, 7U);
    EXPECT_GE(report.loss_count, 1U);
  }
}

TEST(Ros1Reader, AChunkThatUnpacksToTooMuchIsRefused) {
  std::string file = small_ros1(2, "lz4").file();
  const std::size_t size = file.find("size=") + 5;
  file.replace(size, 4, Ros1Bag::raw(std::uint32_t{4'000'000'000}));
  EXPECT_NE(refusal(file).find("cannot come of"), std::string::npos);
}

TEST(Ros1Reader, AnyBytesEndInMessagesOrAnInputError) {
  std::mt19937 random(19);
  for (const char* const compression : {"none", "bz2", "lz4"}) {
    const std::string good = small_ros1(8, compression).file();
    for (int round = 0; round < 1'000; ++round) {
      std::string file = good;
      for (int k = 0; k < 5; ++k) {
        file[13 + random() % (file.size() - 13)] = static_cast<char>(random() % 256);
      }
      try {
        report_of(file, ReadMode::recover);
      } catch (const InputError&) {  // encrypted, by chance
        continue;
      }
    }
  }
}

// Of Debian's python3-rosbag 1.15.15, and so of @foxglove/rosbag 0.4.1: messages, and hashes of all
// values and times.
using Expected = std::map<std::string, testing::TopicHash>;

void expect_values(const std::string& name, const Expected& expected) {
  const std::filesystem::path file = testing::data_file("logs/" + name);
  if (file.empty()) {
    GTEST_SKIP() << "the log isn't there";
  }
  const Expected found = testing::hashes_of(*bag::open_bag(file));
  EXPECT_EQ(found.size(), expected.size());
  for (const auto& [topic, values] : expected) {
    ASSERT_TRUE(found.contains(topic)) << topic;
    EXPECT_TRUE(found.at(topic) == values)
        << topic << " " << found.at(topic).messages << " " << found.at(topic).values << " "
        << found.at(topic).times;
  }
}

TEST(Ros1Reader, EveryValueOfRealBagsIsWhatAnotherImplementationReads) {
  for (const char* const name :
       {"ros1_example.bag", "ros1_example_bz2.bag", "ros1_example_lz4.bag"}) {
    expect_values(name, {
                            {"/rosout", {10, 4220662810U, 1778763036U}},
                            {"/tf", {2688, 48968898U, 664508938U}},
                            {"/tf_static", {1, 2440253711U, 3232589944U}},
                            {"/turtle1/cmd_vel", {357, 2416092997U, 54792726U}},
                            {"/turtle1/color_sensor", {1351, 4106509510U, 2955360746U}},
                            {"/turtle1/pose", {1344, 2354040152U, 4272282488U}},
                            {"/turtle2/cmd_vel", {208, 2893865901U, 284799732U}},
                            {"/turtle2/color_sensor", {1344, 4272681048U, 706677069U}},
                            {"/turtle2/pose", {1344, 3638029636U, 2332486928U}},
                        });
  }
  expect_values("ros1_usv_sim.bag", {
                                        {"e_heading", {2041, 2751485666U, 3685633248U}},
                                        {"e_speed", {2041, 2229518400U, 3352004969U}},
                                        {"position", {2041, 2851938160U, 1475460930U}},
                                        {"r_heading", {2041, 1975974014U, 2209775373U}},
                                        {"r_speed", {2041, 1275272366U, 388303342U}},
                                        {"u_heading", {2041, 2934002705U, 1923260945U}},
                                        {"u_speed", {2041, 3230506548U, 1943563553U}},
                                        {"y_heading", {2041, 1567768288U, 2094692997U}},
                                        {"y_speed", {2041, 1814734134U, 1511505031U}},
                                    });
}

}  // namespace
}  // namespace kelpie::ros1_reader_test
