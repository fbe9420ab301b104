// SPDX-License-Identifier: Apache-2.0
#include "bag/tlog_reader.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

#include "bag/bags.hpp"
#include "bag/byte_reader.hpp"
#include "bag/decoding.hpp"
#include "bag/hash.hpp"
#include "bag/inspect.hpp"
#include "bag/open_bag.hpp"
#include "bag/series.hpp"
#include "bag/tlogs.hpp"
#include "mavlink/frames.hpp"
#include "support.hpp"

namespace kelpie::tlog_reader_test {
namespace {

using bag::ReadMode;
using testing::kTlogBeginUs;
using testing::small_tlog;
using testing::Tlog;

std::vector<bag::Series> series_of(Tlog& log, const std::vector<std::string>& columns,
                                   bag::Clock clock = bag::Clock::receive,
                                   ReadMode mode = ReadMode::strict) {
  const auto bag = bag::read_tlog(log.bytes(), "x.tlog", mode);
  return bag::read_series(*bag, bag::MessageDefinitions(), columns, clock);
}

std::string refusal(const std::vector<std::byte>& bytes) {
  return testing::message_of<InputError>([&] {
    const auto bag = bag::read_tlog(bytes, "x.tlog", ReadMode::strict);
    bag::inspect_bag(*bag, bag::MessageDefinitions());
  });
}

TEST(TlogReader, FieldsHaveTheTimesOfTheirStampsOrOfTheSender) {
  Tlog log = small_tlog(100);
  for (const auto& [clock, begin_ns] :
       {std::pair(bag::Clock::receive, std::int64_t{kTlogBeginUs} * 1'000 + 3'000'000),
        std::pair(bag::Clock::header, std::int64_t{10'000'000'000})}) {
    const std::vector<bag::Series> series = series_of(log, {"ATTITUDE:roll"}, clock);
    ASSERT_EQ(series.size(), 1U);
    ASSERT_EQ(series[0].times_ns.size(), 100U);
    for (std::size_t k = 0; k < 100; ++k) {
      EXPECT_EQ(series[0].times_ns[k], begin_ns + 20'000'000 * static_cast<std::int64_t>(k));
      EXPECT_EQ(series[0].values[0][k],
                static_cast<double>(static_cast<float>(0.01 * static_cast<double>(k))));
    }
  }
}

TEST(TlogReader, ACounterOfMicrosecondsThatBeginsAnewIsCountedOn) {
  mavlink::FrameWriter writer(1, 1);
  Tlog log;
  log.add(kTlogBeginUs, testing::heartbeat_of_vehicle(writer));
  // The third comes late, from before the counter's new beginning.
  for (const std::uint64_t time : {4'294'960'000U, 1'000U, 4'294'966'000U, 21'000U}) {
    writer.begin("SERVO_OUTPUT_RAW").set("time_usec", static_cast<double>(time));
    log.add(kTlogBeginUs, writer.finish());
  }
  const std::vector<bag::Series> series =
      series_of(log, {"SERVO_OUTPUT_RAW:servo1_raw"}, bag::Clock::header);
  EXPECT_EQ(series[0].times_ns, (std::vector<std::int64_t>{4'294'960'000'000, 4'294'966'000'000,
                                                           4'294'968'296'000, 4'294'988'296'000}));
}

// A vehicle is up for two hours when recording begins: its pulses have the time of its attitude.
TEST(TlogReader, ACounterOfMicrosecondsThatHasBegunAnewHasTheTimeOfItsSender) {
  constexpr double kUpS = 7'200.0;
  constexpr double kWrap = 4'294'967'296.0;
  for (const std::uint8_t component : {std::uint8_t{1}, std::uint8_t{2}}) {
    mavlink::FrameWriter writer(1, component);
    mavlink::FrameWriter vehicle(1, 1);
    Tlog log;
    log.add(kTlogBeginUs, testing::heartbeat_of_vehicle(vehicle));
    for (int k = 0; k < 20; ++k) {
      const double t = kUpS + 0.1 * k;
      const std::uint64_t received_us = kTlogBeginUs + 100'000U * static_cast<std::uint64_t>(k);
      writer.begin("SERVO_OUTPUT_RAW").set("time_usec", std::fmod(std::round(1e6 * t), kWrap));
      log.add(received_us, writer.finish());
      writer.begin("ATTITUDE").set("time_boot_ms", std::round(1e3 * t)).set("roll", 0.1 * k);
      log.add(received_us, writer.finish());
    }
    const std::string sender = component == 1 ? "" : "/mavlink/1/2/";
    const std::vector<bag::Series> series =
        series_of(log, {sender + "SERVO_OUTPUT_RAW:servo1_raw", sender + "ATTITUDE:roll"},
                  bag::Clock::header);
    ASSERT_EQ(series[0].times_ns.size(), 19U);  // the first comes before any time
    ASSERT_EQ(series[1].times_ns.size(), 20U);
    for (std::size_t k = 0; k < 19; ++k) {
      EXPECT_EQ(series[0].times_ns[k], series[1].times_ns[k + 1]);
    }
  }
}

// While the vehicle is up for long, silent, and booted: all messages have the time since the boot,
// less the overflows before the first message.
TEST(TlogReader, CountersThatEndGoOnAndBeginAnewWithTheirSender) {
  constexpr double kUs_s = 4'294.967296;  // 32 bits of µs
  constexpr double kMs_s = 1e3 * kUs_s;
  constexpr double kDay_s = 86'400.0;
  const double days13 = kUs_s * std::ceil(13.0 * kDay_s / kUs_s);
  struct Stretch {
    double received_s;
    double up_s;  ///< received 2 s long
  };
  const std::vector<std::pair<std::string, std::vector<Stretch>>> cases{
      {"µs end after 13 days", {{0, days13 - 1}}},
      {"µs end in a silence", {{0, days13 - 1'800}, {3'600, days13 + 1'800}}},
      {"ms end", {{0, kMs_s - 1}}},
      {"ms end in a silence", {{0, kMs_s - 1'800}, {3'600, kMs_s + 1'800}}},
      {"a boot", {{0, 5 * kDay_s}, {60, 10}}},
      {"a boot unheard for hours", {{0, 5 * kDay_s}, {9'000, 8'000}}},
      {"a boot after the end of µs", {{0, days13 - 1}, {60, 10}}},
      {"a boot after the end of ms", {{0, kMs_s - 1}, {3'600, kMs_s + 3'599}, {3'660, 10}}},
  };
  for (const auto& [name, stretches] : cases) {
    mavlink::FrameWriter writer(1, 1);
    Tlog log;
    log.add(kTlogBeginUs, testing::heartbeat_of_vehicle(writer));
    std::vector<std::int64_t> times_ns;
    for (const auto& [received_s, up_s] : stretches) {
      for (int k = 0; k < 20; ++k) {
        const auto us = std::llround(1e6 * up_s) / 1'000 * 1'000 + 100'000 * k;
        const auto received_us = kTlogBeginUs + std::llround(1e6 * received_s) + 100'000 * k;
        const auto add = [&](const char* message, const char* field, std::int64_t count) {
          constexpr std::int64_t kWrap = std::int64_t{1} << 32;
          writer.begin(message).set(field, static_cast<double>(count % kWrap));
          log.add(received_us, writer.finish());
        };
        add("ATTITUDE", "time_boot_ms", us / 1'000);
        add("SERVO_OUTPUT_RAW", "time_usec", us);
        if (received_s > 0) {
          add("LOCAL_POSITION_NED", "time_boot_ms", us / 1'000);  // begins late
        }
        times_ns.push_back(1'000 * us);
      }
    }
    std::ranges::sort(times_ns);
    const std::vector<bag::Series> series =
        series_of(log, {"ATTITUDE:roll", "SERVO_OUTPUT_RAW:servo1_raw"}, bag::Clock::header);
    EXPECT_EQ(series[0].times_ns, times_ns) << name;
    EXPECT_EQ(series[1].times_ns, times_ns) << name;
    if (stretches.size() > 1) {
      const bag::Series late =
          series_of(log, {"LOCAL_POSITION_NED:vx", "ATTITUDE:roll"}, bag::Clock::header)[0];
      for (const std::int64_t time_ns : late.times_ns) {
        EXPECT_TRUE(std::ranges::binary_search(times_ns, time_ns)) << name << " " << time_ns;
      }
    }
  }
}

TEST(TlogReader, ACounterOfMicrosecondsDoesNotWaitForeverForItsSender) {
  mavlink::FrameWriter writer(1, 1);
  Tlog log;
  log.add(kTlogBeginUs, testing::heartbeat_of_vehicle(writer));
  for (std::uint64_t k = 0; k < 10; ++k) {
    writer.begin("SERVO_OUTPUT_RAW").set("time_usec", 1e6 * static_cast<double>(k));
    log.add(kTlogBeginUs + 1'000'000 * k, writer.finish());
  }
  writer.begin("ATTITUDE").set("time_boot_ms", 9'000);
  log.add(kTlogBeginUs + 9'000'000, writer.finish());
  EXPECT_EQ(series_of(log, {"SERVO_OUTPUT_RAW:servo1_raw", "ATTITUDE:roll"}, bag::Clock::header)[0]
                .times_ns.front(),
            std::int64_t{6'000'000'000});
}

TEST(TlogReader, ZerosLeftOutArraysAndExtensionsAreRead) {
  mavlink::FrameWriter writer(1, 1);
  Tlog log;
  log.add(kTlogBeginUs, testing::heartbeat_of_vehicle(writer));
  writer.begin("ACTUATOR_OUTPUT_STATUS").set("time_usec", 7).set("actuator", 0.25, 2);
  log.add(kTlogBeginUs, writer.finish());
  writer.begin("ODOMETRY").set("time_usec", 7).set("quality", -1).set("vx", 1.5);
  log.add(kTlogBeginUs, writer.finish());
  const std::vector<bag::Series> series =
      series_of(log, {"ACTUATOR_OUTPUT_STATUS:actuator[2]", "ACTUATOR_OUTPUT_STATUS:actuator[31]",
                      "ODOMETRY:quality", "ODOMETRY:vx", "ODOMETRY:vz"});
  EXPECT_EQ(series[0].values, (std::vector<std::vector<double>>{{0.25}, {0.0}}));
  EXPECT_EQ(series[1].values, (std::vector<std::vector<double>>{{-1.0}, {1.5}, {0.0}}));
}

// The one autopilot's messages have short names; of several, nobody's have.
TEST(TlogReader, SystemsAreToldApart) {
  mavlink::FrameWriter vehicle(3, 1);
  mavlink::FrameWriter computer(3, 191);
  mavlink::FrameWriter station(255, 190);
  Tlog log;
  log.add(kTlogBeginUs, computer.begin("ATTITUDE").set("roll", 0.5).finish());
  log.add(kTlogBeginUs, vehicle.begin("ATTITUDE").set("roll", 0.25).finish());
  station.begin("HEARTBEAT").set("type", 6).set("autopilot", 8);
  log.add(kTlogBeginUs, station.finish());
  log.add(kTlogBeginUs, testing::heartbeat_of_vehicle(vehicle));
  const std::vector<bag::Series> one =
      series_of(log, {"ATTITUDE:roll", "/mavlink/3/191/ATTITUDE:roll"});
  EXPECT_EQ(one[0].values[0], std::vector<double>{0.25});
  EXPECT_EQ(one[1].values[0], std::vector<double>{0.5});
  mavlink::FrameWriter other(4, 1);
  log.add(kTlogBeginUs, testing::heartbeat_of_vehicle(other));
  const std::vector<bag::Series> several = series_of(log, {"/mavlink/3/1/ATTITUDE:roll"});
  EXPECT_EQ(several[0].values[0], std::vector<double>{0.25});
  EXPECT_THROW(series_of(log, {"ATTITUDE:roll"}), InputError);
}

TEST(TlogReader, UnknownMessagesAreCountedAsTopicsThatCannotBeDecoded) {
  Tlog log = small_tlog(3);
  for (int k = 0; k < 2; ++k) {
    log.add(kTlogBeginUs, testing::other_frame(29'999, 7));
    log.add(kTlogBeginUs, testing::other_frame(31, 40));  // another definition of a known one
  }
  const auto bag = bag::read_tlog(log.bytes(), "x.tlog", ReadMode::strict);
  const bag::BagReport report = bag::inspect_bag(*bag, bag::MessageDefinitions());
  ASSERT_EQ(report.topics.size(), 4U);
  EXPECT_EQ(report.topics[0].name, "/mavlink/1/1/29999");
  EXPECT_EQ(report.topics[1].name, "/mavlink/1/1/31");
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(report.topics[k].messages, 2U);
    EXPECT_NE(report.topics[k].not_decoded.find("is an unknown MAVLink message"),
              std::string::npos);
  }
  EXPECT_EQ(report.topics[2].messages, 3U);
}

TEST(TlogReader, IsRecognisedByItsContent) {
  const testing::TemporaryFolder folder;
  testing::write_text(folder / "a.bin", small_tlog(3).text());
  EXPECT_TRUE(bag::is_bag(folder / "a.bin"));
  EXPECT_EQ(bag::inspect_bag(*bag::open_bag(folder / "a.bin"), bag::MessageDefinitions()).messages,
            4U);
  testing::write_text(folder / "b.tlog", "t,u,v\n1,2,3\n");
  EXPECT_FALSE(bag::is_bag(folder / "b.tlog"));
  const std::vector<std::byte> raw(200, std::byte{0xFD});
  EXPECT_FALSE(bag::begins_as_tlog(bag::text_of(raw)));
}

TEST(TlogReader, DamageIsNamedWithItsOffsetAndRecoverReadsTheRest) {
  const Tlog good = small_tlog(20);
  for (const std::size_t within : {1U, 8U, 9U, 12U, 20U}) {  // stamp, magic, length, head, payload
    Tlog log = good;
    const std::size_t offset = log.offsets()[5];
    log.bytes()[offset + within] ^= std::byte{0x55};
    EXPECT_NE(refusal(log.bytes()).find("x.tlog: offset " + std::to_string(offset)),
              std::string::npos)
        << within << " " << refusal(log.bytes());
    const auto bag = bag::read_tlog(log.bytes(), "x.tlog", ReadMode::recover);
    const bag::BagReport report = bag::inspect_bag(*bag, bag::MessageDefinitions());
    EXPECT_EQ(report.messages, 20U) << within;
    EXPECT_EQ(report.loss_count + report.passed_over.size(), 1U) << within;
  }
}

TEST(TlogReader, AWrongChecksumCostsItsFrameAloneAndIsCounted) {
  Tlog log = small_tlog(20);
  for (const std::size_t frame : {5U, 6U, 9U}) {
    log.bytes()[log.offsets()[frame] + 20] ^= std::byte{0x55};
  }
  const auto bag = bag::read_tlog(log.bytes(), "x.tlog", ReadMode::usual);
  const bag::BagReport report = bag::inspect_bag(*bag, bag::MessageDefinitions());
  EXPECT_EQ(report.messages, 18U);
  EXPECT_EQ(report.loss_count, 0U);
  EXPECT_EQ(report.passed_over, (std::map<std::string, std::size_t>{{"ATTITUDE", 3}}));
  EXPECT_EQ(bag->losses_text(),
            "passed over: 3 messages with a wrong checksum, 3 of ATTITUDE (--strict refuses)\n");
  EXPECT_NE(refusal(log.bytes()).find("checksum of message 30"), std::string::npos);
  log.bytes().resize(log.bytes().size() - 1);  // other damage is refused as ever
  EXPECT_THROW(bag::inspect_bag(*bag::read_tlog(log.bytes(), "x.tlog", ReadMode::usual),
                                bag::MessageDefinitions()),
               InputError);
}

// Nobody knows how many messages lay behind it.
TEST(TlogReader, AWrongChecksumWithoutAFrameBehindItIsDamage) {
  Tlog log = small_tlog(20);
  const std::size_t offset = log.offsets()[5];
  log.bytes()[offset + 9] = std::byte{200};  // bytes of its payload
  EXPECT_NE(testing::message_of<InputError>([&] {
              bag::inspect_bag(*bag::read_tlog(log.bytes(), "x.tlog", ReadMode::usual),
                               bag::MessageDefinitions());
            }).find("offset " + std::to_string(offset)),
            std::string::npos);
  const auto bag = bag::read_tlog(log.bytes(), "x.tlog", ReadMode::recover);
  const bag::BagReport report = bag::inspect_bag(*bag, bag::MessageDefinitions());
  EXPECT_EQ(report.loss_count, 1U);
  EXPECT_EQ(report.messages, 20U);
}

TEST(TlogReader, AFileCutOffAnywhereIsNamedAndReadUpToThere) {
  const Tlog good = small_tlog(3);
  const std::size_t first = good.offsets()[1];
  for (std::size_t size = first + 1; size < good.offsets()[3]; ++size) {
    Tlog log = good;
    log.bytes().resize(size);
    const bool is_whole = size == good.offsets()[2];
    EXPECT_EQ(refusal(log.bytes()).empty(), is_whole) << size;
    const auto bag = bag::read_tlog(log.bytes(), "x.tlog", ReadMode::recover);
    const bag::BagReport report = bag::inspect_bag(*bag, bag::MessageDefinitions());
    EXPECT_EQ(report.messages, size >= good.offsets()[2] ? 2U : 1U) << size;
    EXPECT_EQ(report.loss_count, is_whole ? 0U : 1U) << size;
  }
}

TEST(TlogReader, AnyBytesEndInMessagesOrAnInputError) {
  std::mt19937 random(19);
  const Tlog good = small_tlog(10);
  for (int round = 0; round < 3'000; ++round) {
    Tlog log = good;
    for (int k = 0; k < 6; ++k) {
      log.bytes()[random() % log.bytes().size()] = static_cast<std::byte>(random() % 256);
    }
    const auto bag = bag::read_tlog(log.bytes(), "x.tlog", ReadMode::recover);
    EXPECT_GT(bag::inspect_bag(*bag, bag::MessageDefinitions()).messages, 0U);
  }
}

TEST(TlogReader, ATimeThatCannotBeIsLost) {
  mavlink::FrameWriter writer(1, 1);
  Tlog log;
  log.add(kTlogBeginUs, testing::heartbeat_of_vehicle(writer));
  writer.begin("ODOMETRY").set("time_usec", 1.8e19).set("vx", 1.0);
  log.add(kTlogBeginUs, writer.finish());
  writer.begin("ODOMETRY").set("time_usec", 5.0).set("vx", 2.0);
  log.add(kTlogBeginUs, writer.finish());
  const std::vector<bag::Series> series =
      series_of(log, {"ODOMETRY:vx"}, bag::Clock::header, ReadMode::recover);
  EXPECT_EQ(series[0].values[0], std::vector<double>{2.0});
  EXPECT_THROW(series_of(log, {"ODOMETRY:vx"}, bag::Clock::header), InputError);
}

// Of `node scripts/mavlink_peer.mjs read ardusub_small.tlog`: messages, and a hash of all values.
TEST(TlogReader, EveryValueOfARealLogIsWhatAnotherImplementationReads) {
  const std::filesystem::path file = testing::data_file("logs/ardusub_small.tlog");
  if (file.empty()) {
    GTEST_SKIP() << "the log isn't there";
  }
  const std::map<std::string, std::pair<int, std::uint32_t>> expected{
      {"HEARTBEAT", {1056, 3355401250U}},
      {"SYS_STATUS", {528, 3072509359U}},
      {"SYSTEM_TIME", {794, 27549645U}},
      {"PARAM_REQUEST_LIST", {1, 97136504U}},
      {"PARAM_VALUE", {888, 2402961772U}},
      {"GPS_RAW_INT", {528, 3165559596U}},
      {"RAW_IMU", {528, 3856695729U}},
      {"SCALED_PRESSURE", {528, 3764008000U}},
      {"ATTITUDE", {5245, 1176745006U}},
      {"LOCAL_POSITION_NED", {792, 1824053786U}},
      {"GLOBAL_POSITION_INT", {792, 3522616125U}},
      {"SERVO_OUTPUT_RAW", {528, 975895634U}},
      {"MISSION_CURRENT", {528, 292787141U}},
      {"MISSION_REQUEST_LIST", {2, 3446450008U}},
      {"MISSION_COUNT", {2, 3031849976U}},
      {"MISSION_ACK", {2, 811562040U}},
      {"GPS_GLOBAL_ORIGIN", {1, 3327890775U}},
      {"NAV_CONTROLLER_OUTPUT", {528, 1662864121U}},
      {"RC_CHANNELS", {528, 3049371982U}},
      {"REQUEST_DATA_STREAM", {35, 1215864287U}},
      {"MANUAL_CONTROL", {1450, 3726508165U}},
      {"VFR_HUD", {3060, 706322698U}},
      {"COMMAND_LONG", {9, 1605430542U}},
      {"COMMAND_ACK", {9, 1537468075U}},
      {"TIMESYNC", {27, 3872058415U}},
      {"SCALED_IMU2", {528, 4013945106U}},
      {"POWER_STATUS", {528, 30683589U}},
      {"SCALED_PRESSURE2", {635, 2107832834U}},
      {"BATTERY_STATUS", {792, 1422603893U}},
      {"AUTOPILOT_VERSION", {2, 4243750453U}},
      {"SENSOR_OFFSETS", {48, 1485629278U}},
      {"MEMINFO", {528, 1418751461U}},
      {"MOUNT_STATUS", {792, 523716549U}},
      {"AHRS", {792, 3629992232U}},
      {"HWSTATUS", {792, 948823365U}},
      {"AHRS2", {5245, 3925100989U}},
      {"EKF_STATUS_REPORT", {792, 321748516U}},
      {"GPS_INPUT", {1011, 1186758861U}},
      {"VIBRATION", {792, 2420579029U}},
      {"HOME_POSITION", {1, 2432181975U}},
      {"NAMED_VALUE_FLOAT", {4224, 3611977236U}},
      {"STATUSTEXT", {4, 3332726597U}},
      {"STORAGE_INFORMATION", {1, 2257160480U}},
      {"VIDEO_STREAM_STATUS", {1, 2497979136U}},
      {"PARAM_EXT_REQUEST_LIST", {1, 1546661641U}},
      {"PARAM_EXT_VALUE", {14, 1332538306U}},
  };
  const auto bag = bag::open_bag(file);
  const auto is_known = [](const bag::Topic& topic) { return !topic.type.starts_with("message "); };
  int unknown = 0;
  std::vector<bag::Decoder> decoders;
  std::map<std::string, std::pair<int, testing::Hash>> found;
  for (bag::Message message; bag->next(message);) {
    for (std::size_t k = decoders.size(); k < bag->topics().size(); ++k) {
      const bag::Topic& topic = bag->topics()[k];
      decoders.push_back(is_known(topic) ? bag::Decoder(topic, bag::MessageDefinitions())
                                         : bag::Decoder());
    }
    if (!is_known(bag->topics()[message.topic])) {
      ++unknown;
      continue;
    }
    auto& [count, hash] = found[bag->topics()[message.topic].type];
    ++count;
    decoders[message.topic].visit(message.data, hash);
  }
  EXPECT_EQ(unknown, 4);  // a camera's, which the other one leaves out as well
  EXPECT_EQ(found.size(), expected.size());
  for (const auto& [type, values] : expected) {
    EXPECT_EQ(found[type].first, values.first) << type;
    EXPECT_EQ(found[type].second.state, values.second) << type;
  }
}

// Of `node scripts/mavlink_peer.mjs count blueos_badcrc.tlog`. BlueOS has damaged DISTANCE_SENSORs
// (its issue 1740).
TEST(TlogReader, ARealLogOfBlueOsHasTheMessagesThatAnotherImplementationCounts) {
  const std::filesystem::path file = testing::data_file("logs/blueos_badcrc.tlog");
  if (file.empty()) {
    GTEST_SKIP() << "the log isn't there";
  }
  const std::map<std::string, std::size_t> expected{
      {"ATTITUDE", 6210},
      {"VFR_HUD", 3117},
      {"AHRS2", 6210},
      {"HEARTBEAT", 1257},
      {"POWER_STATUS", 627},
      {"MEMINFO", 627},
      {"NAV_CONTROLLER_OUTPUT", 627},
      {"MISSION_CURRENT", 627},
      {"SERVO_OUTPUT_RAW", 627},
      {"RC_CHANNELS", 627},
      {"RAW_IMU", 627},
      {"SCALED_IMU2", 627},
      {"SCALED_PRESSURE", 627},
      {"SCALED_PRESSURE2", 627},
      {"GPS_RAW_INT", 627},
      {"NAMED_VALUE_FLOAT", 5016},
      {"COMMAND_LONG", 9},
      {"COMMAND_ACK", 13},
      {"AUTOPILOT_VERSION", 2},
      {"GLOBAL_POSITION_INT", 938},
      {"SYS_STATUS", 898},
      {"SYSTEM_TIME", 940},
      {"AHRS", 938},
      {"HWSTATUS", 938},
      {"MOUNT_STATUS", 938},
      {"EKF_STATUS_REPORT", 938},
      {"VIBRATION", 938},
      {"BATTERY_STATUS", 938},
      {"DISTANCE_SENSOR", 919},
      {"REQUEST_DATA_STREAM", 35},
      {"MANUAL_CONTROL", 7463},
      {"PARAM_REQUEST_LIST", 1},
      {"PARAM_EXT_REQUEST_LIST", 1},
      {"PARAM_EXT_VALUE", 14},
      {"PARAM_VALUE", 4443},
      {"STATUSTEXT", 28},
      {"SENSOR_OFFSETS", 57},
      {"MISSION_REQUEST_LIST", 2},
      {"MISSION_COUNT", 2},
      {"MISSION_ACK", 2},
      {"STORAGE_INFORMATION", 1},
      {"VIDEO_STREAM_STATUS", 1},
      {"TIMESYNC", 31},
      {"PARAM_SET", 1},
  };
  const bag::BagReport report = bag::inspect_bag(*bag::open_bag(file), bag::MessageDefinitions());
  std::map<std::string, std::size_t> found;
  std::size_t unknown = 0;
  for (const bag::TopicReport& topic : report.topics) {
    (topic.not_decoded.empty() ? found[topic.type] : unknown) += topic.messages;
  }
  EXPECT_EQ(found, expected);
  EXPECT_EQ(report.passed_over.at("/mavlink/1/194/DISTANCE_SENSOR"), 1949U);
  std::size_t passed_over = 0;
  for (const auto& [topic, count] : report.passed_over) {
    passed_over += count;
  }
  EXPECT_EQ(unknown + passed_over, 1967U);
  EXPECT_THROW(bag::inspect_bag(*bag::open_bag(file, ReadMode::strict), bag::MessageDefinitions()),
               InputError);
}

}  // namespace
}  // namespace kelpie::tlog_reader_test
