// SPDX-License-Identifier: Apache-2.0
#include "bag/ulog_reader.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "bag/bags.hpp"
#include "bag/hash.hpp"
#include "bag/inspect.hpp"
#include "bag/open_bag.hpp"
#include "bag/packed_bytes.hpp"
#include "bag/read_bytes.hpp"
#include "bag/series.hpp"
#include "bag/ulog_messages.hpp"
#include "kelpie/core/error.hpp"
#include "support.hpp"

namespace kelpie::ulog_reader_test {
namespace {

using bag::ReadMode;
using testing::PackedBytes;

PackedBytes record(char type, const PackedBytes& content) {
  return PackedBytes().add(static_cast<std::uint16_t>(content.size())).add(type).add(content);
}

PackedBytes file_head(std::uint8_t version = 1) {
  return PackedBytes().add("ULog\x01\x12\x35").add(version).add(std::uint64_t{1'000});
}

PackedBytes flags(std::uint64_t incompatible, std::uint64_t appended = 0) {
  return record('B', PackedBytes()
                         .add(std::uint64_t{0})
                         .add(incompatible)
                         .add(appended)
                         .add(std::uint64_t{0})
                         .add(std::uint64_t{0}));
}

PackedBytes format(std::string_view text) {
  return record('F', PackedBytes().add(text));
}

PackedBytes subscribe(std::uint8_t instance, std::uint16_t id, std::string_view name) {
  return record('A', PackedBytes().add(instance).add(id).add(name));
}

PackedBytes data(std::uint16_t id, const PackedBytes& content) {
  return record('D', PackedBytes().add(id).add(content));
}

PackedBytes sync() {
  return record('S', PackedBytes().add("\x2F\x73\x13\x20\x25\x0C\xBB\x12"));
}

PackedBytes accel(std::uint64_t time_us, float x) {
  return PackedBytes().add(time_us).add(x).add(std::uint8_t{1});
}

PackedBytes definitions() {
  PackedBytes log = file_head();
  log.add(flags(0));
  log.add(format("sensor_accel:uint64_t timestamp;float x;bool good;uint8_t[3] _padding0;"));
  log.add(format("esc:uint8_t state;uint8_t[3] _padding0;float rpm;"));
  log.add(format("esc_status:uint64_t timestamp;char[4] name;esc[2] esc;int16_t[3] n;"));
  log.add(record('I', PackedBytes().add(std::uint8_t{13}).add("char[3] sys").add("PX4")));
  log.add(record('P', PackedBytes().add(std::uint8_t{7}).add("float P").add(1.0F)));
  log.add(subscribe(0, 0, "sensor_accel")).add(subscribe(1, 1, "sensor_accel"));
  return log.add(subscribe(0, 7, "esc_status"));
}

PackedBytes small_log(std::uint64_t count) {
  PackedBytes log = definitions();
  for (std::uint64_t k = 0; k < count; ++k) {
    const std::uint64_t time_us = 2'000'000 + 10'000 * k;
    log.add(data(0, accel(time_us, 0.5F * static_cast<float>(k))));
    log.add(data(1, accel(time_us + 5, -1.0F)));
    if (k % 4 == 3) {
      log.add(sync());
    }
  }
  return log;
}

const testing::BytesReader reader(bag::read_ulog, "x.ulg");

TEST(UlogReader, InstancesAreTopicsAndTimestampsTimes) {
  const std::vector<bag::Series> series =
      reader.series_of(small_log(3), {"sensor_accel:x", "sensor_accel:good", "sensor_accel[1]:x"});
  ASSERT_EQ(series.size(), 2U);
  EXPECT_EQ(series[0].times_ns,
            (std::vector<std::int64_t>{2'000'000'000, 2'010'000'000, 2'020'000'000}));
  EXPECT_EQ(series[0].values, (std::vector<std::vector<double>>{{0.0, 0.5, 1.0}, {1.0, 1.0, 1.0}}));
  EXPECT_EQ(series[1].times_ns[0], 2'000'005'000);
  EXPECT_EQ(series[1].values[0], (std::vector<double>{-1.0, -1.0, -1.0}));
}

// A subscription of a few bytes names a format that may be long.
TEST(UlogReader, TooManySubscriptionsToALongFormatAreRefused) {
  std::string fields = "long:uint64_t timestamp;";
  for (int k = 0; k < 4'000; ++k) {
    fields += "float x" + std::to_string(k) + ";";
  }
  PackedBytes log = file_head();
  log.add(flags(0)).add(format(fields));
  for (int k = 0; k < 200; ++k) {
    log.add(subscribe(0, 0, "long"));
  }
  const std::string message = reader.refusal(log.bytes());
  EXPECT_NE(message.find("defines its topics by more than 64 MB"), std::string::npos) << message;
}

TEST(UlogReader, NestedTypesArraysTextsAndPaddingAreRead) {
  PackedBytes log = definitions();
  PackedBytes status = PackedBytes().add(std::uint64_t{5}).add("ab", 4);
  for (const float rpm : {100.0F, 200.0F}) {
    status.add(std::uint8_t{3}).add("\xEE\xEE\xEE").add(rpm);
  }
  log.add(data(7, status.add(std::int16_t{1}).add(std::int16_t{-2}).add(std::int16_t{3})));
  const std::vector<bag::Series> series =
      reader.series_of(log, {"esc_status:esc[0].rpm", "esc_status:esc[1].rpm",
                             "esc_status:esc[1].state", "esc_status:n[1]"});
  EXPECT_EQ(series[0].values, (std::vector<std::vector<double>>{{100.0}, {200.0}, {3.0}, {-2.0}}));
}

// Loggers leave out padding at the end; some don't.
TEST(UlogReader, PaddingAtTheEndMayBeThere) {
  PackedBytes log = definitions();
  log.add(data(0, accel(1, 2.0F).add("\xEE\xEE\xEE"))).add(data(0, accel(2, 3.0F)));
  EXPECT_EQ(reader.series_of(log, {"sensor_accel:x"})[0].values[0],
            (std::vector<double>{2.0, 3.0}));
}

TEST(UlogReader, AGpsTellsTheDate) {
  PackedBytes log = small_log(2);
  log.add(format("vehicle_gps_position:uint64_t timestamp;uint64_t time_utc_usec;"));
  log.add(subscribe(0, 9, "vehicle_gps_position"));
  log.add(data(9, PackedBytes().add(std::uint64_t{2'500'000}).add(std::uint64_t{0})));
  log.add(data(
      9, PackedBytes().add(std::uint64_t{3'000'000}).add(std::uint64_t{1'683'072'000'000'000})));
  EXPECT_EQ(reader.series_of(log, {"sensor_accel:x"})[0].times_ns[0],
            (1'683'072'000LL - 1) * 1'000'000'000);
  EXPECT_EQ(reader.series_of(log, {"sensor_accel:x"}, bag::Clock::header)[0].times_ns[0],
            2'000'000'000);
}

TEST(UlogReader, DropoutsAreCounted) {
  PackedBytes log = small_log(2);
  log.add(record('O', PackedBytes().add(std::uint16_t{37})));
  log.add(data(0, accel(2'100'000, 0.0F)));
  const bag::BagReport report = reader.report_of(log.bytes(), ReadMode::strict);
  ASSERT_EQ(report.topics.size(), 4U);
  EXPECT_EQ(report.topics[0].name, "dropout");
  EXPECT_EQ(report.topics[0].fields[0].path, "duration_ms");
  EXPECT_EQ(report.topics[0].fields[0].high, 37.0);
  EXPECT_EQ(reader.series_of(log, {"dropout:duration_ms"})[0].times_ns[0], 2'010'005'000);
}

// A crash leaves a message cut off before what was appended afterwards.
TEST(UlogReader, AppendedDataIsRead) {
  const PackedBytes begin = small_log(3);
  const PackedBytes cut = data(0, accel(3'000'000, 0.0F));
  for (const std::size_t left : {std::size_t{1}, std::size_t{2}, std::size_t{9}, cut.size()}) {
    PackedBytes log = begin;
    log.bytes().insert(log.bytes().end(), cut.bytes().begin(),
                       cut.bytes().begin() + static_cast<std::ptrdiff_t>(left));
    const std::uint64_t appended = log.size();
    const PackedBytes head = file_head().add(flags(1, appended));
    std::copy(head.bytes().begin(), head.bytes().end(), log.bytes().begin());
    log.add(data(0, accel(4'000'000, 9.0F)));
    const bag::BagReport report = reader.report_of(log.bytes(), ReadMode::strict);
    EXPECT_EQ(report.messages, left == cut.size() ? 8U : 7U) << left;
    ASSERT_EQ(report.topics[1].name, "sensor_accel");
    EXPECT_EQ(report.topics[1].fields[1].high, 9.0);
  }
}

TEST(UlogReader, TheFirstVersionHasNoFlags) {
  PackedBytes log = file_head(0);
  log.add(format("a:uint64_t timestamp;int8_t[2] v;")).add(subscribe(0, 3, "a"));
  log.add(data(3, PackedBytes().add(std::uint64_t{7}).add("\xFF\x02")));
  EXPECT_EQ(reader.series_of(log, {"a:v[0]"})[0].values[0], std::vector<double>{-1.0});
}

TEST(UlogReader, IsRecognisedByItsContent) {
  reader.expect_recognised(small_log(3), 6);
  const testing::TemporaryFolder folder;
  testing::write_text(folder / "b.ulge", "ULogEnc\x01 and so on");
  EXPECT_NE(testing::message_of<InputError>([&] {
              bag::open_bag(folder / "b.ulge");
            }).find("is an encrypted ULog file"),
            std::string::npos);
}

TEST(UlogReader, WhatItCannotKnowIsRefused) {
  PackedBytes old = small_log(1);
  old.bytes()[7] = std::byte{2};
  EXPECT_NE(reader.refusal(old.bytes()).find("offset 7: is ULog of version 2"), std::string::npos);
  PackedBytes flagged = file_head();
  EXPECT_NE(reader.refusal(flagged.add(flags(2)).bytes()).find("flags 0x2"), std::string::npos);
}

TEST(UlogReader, ACopyAsMcapReadsTheSame) {
  reader.expect_same_as_mcap(small_log(5));
}

TEST(UlogReader, DamageIsNamedWithItsOffsetAndRecoverReadsTheRest) {
  const std::size_t step = data(0, accel(0, 0.0F)).size();
  const std::size_t offset = definitions().size() + 2 * step;
  reader.expect_damage_costs_one(small_log(8), offset, {0, 1, 2, 3, 4}, 15);
}

// One loss, not one for each byte that looks like a definition of 64 kB.
TEST(UlogReader, GarbageThatLooksLikeDefinitionsIsReadOnce) {
  using namespace std::string_view_literals;
  for (const std::string_view garbage : {"\xff\xff"
                                         "F"sv,
                                         "\xff\xff"
                                         "A"sv,
                                         "F"sv, "A"sv, "\0A"sv}) {
    PackedBytes log = small_log(8);
    for (int k = 0; k < 100'000; ++k) {
      log.add(garbage);
    }
    log.add(sync()).add(data(0, accel(3'000'000, 1.0F)));
    const bag::BagReport report = reader.report_of(log.bytes());
    EXPECT_EQ(report.messages, 17U) << garbage;
    EXPECT_EQ(report.loss_count, 1U) << garbage;
  }
}

TEST(UlogReader, AFileCutOffAnywhereIsNamedAndReadUpToThere) {
  const PackedBytes good = small_log(2);
  const std::size_t head = definitions().size();
  const std::size_t step = data(0, accel(0, 0.0F)).size();
  for (std::size_t size = 1; size < good.size(); ++size) {
    const std::vector<std::byte> bytes(good.bytes().begin(),
                                       good.bytes().begin() + static_cast<std::ptrdiff_t>(size));
    const bag::BagReport report = reader.report_of(bytes);
    EXPECT_EQ(report.messages, size < head ? 0 : (size - head) / step) << size;
    EXPECT_EQ(reader.refusal(bytes).empty(), report.loss_count == 0) << size;
    if (size > head && (size - head) % step != 0) {
      const std::size_t last = head + (size - head) / step * step;
      EXPECT_NE(reader.refusal(bytes).find("offset " + std::to_string(last)), std::string::npos)
          << size;
    }
  }
}

TEST(UlogReader, SubscriptionsAndFormatsThatCannotBeAreNamed) {
  const PackedBytes good = definitions();
  const std::string offset = "offset " + std::to_string(good.size());
  for (const PackedBytes& more :
       {data(5, accel(0, 0.0F)), data(0, PackedBytes().add(std::uint64_t{0})),
        data(0, accel(std::uint64_t{1} << 63U, 0.0F)), record('D', PackedBytes().add("x")),
        format("no colon"), format("bad\xFF:float x;"), format("esc:float other;"),
        subscribe(0, 8, "bad\x01name"), PackedBytes().add(std::uint16_t{0}).add('#'),
        PackedBytes().add(std::uint16_t{60'000}).add('D')}) {
    const std::string message = reader.refusal(PackedBytes(good).add(more).bytes());
    EXPECT_NE(message.find(offset), std::string::npos) << message;
  }
  for (const PackedBytes& more : {record('A', PackedBytes().add("x")), record('B', {})}) {
    const std::string message = reader.refusal(PackedBytes(good).add(more).bytes());
    EXPECT_NE(message.find("is cut off"), std::string::npos) << message;
  }
}

TEST(UlogReader, HostileFormatsCannotBeDecodedAndDoNoHarm) {
  for (const std::string_view fields :
       {"uint64_t timestamp;loop next;", "void x;", "float[0] x;", "float[70000] x;",
        "float[-1] x;", "float[2 x;", "float", "float x y;", "", ";", "missing m;",
        "loop[60000] a;", "wide[255] a;", "double[65535] a;"}) {
    PackedBytes log = file_head();
    log.add(format("loop:" + std::string(fields))).add(format("wide:double[255] x;"));
    log.add(subscribe(0, 0, "loop")).add(data(0, accel(1, 1.0F)));
    const bag::BagReport report = reader.report_of(log.bytes(), ReadMode::strict);
    ASSERT_EQ(report.topics.size(), 1U) << fields;
    EXPECT_FALSE(report.topics[0].not_decoded.empty()) << fields;
    EXPECT_EQ(report.messages, 1U) << fields;
  }
  // Each holds the next one twice.
  PackedBytes log = file_head();
  for (char name = 'a'; name < 'z'; ++name) {
    const std::string held(1, static_cast<char>(name + 1));
    log.add(format(std::string(1, name) + ":" + held + " p;" + held + " q;"));
  }
  log.add(format("z:bool x;")).add(subscribe(0, 0, "a")).add(data(0, accel(1, 1.0F)));
  EXPECT_FALSE(reader.report_of(log.bytes()).topics[0].not_decoded.empty());
}

TEST(UlogReader, FormatsWithinFormatsWithoutEndAreLeftOut) {
  constexpr int kFormats = 200'000;
  bag::UlogFormats formats;
  for (int k = 0; k < kFormats; ++k) {
    formats["t" + std::to_string(k)] = "uint64_t timestamp;t" + std::to_string(k + 1) + " next;";
  }
  const std::string definition = bag::ulog_definition("t0", formats);
  EXPECT_NE(definition.find("t32:"), std::string::npos);
  EXPECT_LT(definition.size(), 10'000U);
  const bag::MessageDefinitions none;
  const auto refusal = [&](const std::string& text) {
    return testing::message_of<InputError>([&] {
      bag::ulog_type_of({.name = "t", .type = "t0", .encoding = "ulog", .definition = text}, none);
    });
  };
  EXPECT_NE(refusal(definition).find("more than 32 deep"), std::string::npos);
  EXPECT_EQ(refusal("t0:float " + std::string(200, 'a') + ";"), "");
  EXPECT_NE(refusal("t0:float " + std::string(201, 'a') + ";").find("longer than 200 bytes"),
            std::string::npos);
}

TEST(UlogReader, AnyBytesEndInMessagesOrAnInputError) {
  reader.expect_any_bytes_end(small_log(10));
}

// Of `node scripts/ulog_peer.mjs px4_small.ulg`: messages, and the sum of the hashes of all values.
TEST(UlogReader, EveryValueOfARealLogIsWhatAnotherImplementationReads) {
  const std::filesystem::path file = testing::data_file("logs/px4_small.ulg");
  if (file.empty()) {
    GTEST_SKIP() << "the log isn't there";
  }
  const testing::HashSums expected{
      {"actuator_armed", {14, 2892390463U}},
      {"actuator_controls_0", {1812, 3564847080U}},
      {"actuator_controls_1", {1812, 2507587587U}},
      {"actuator_outputs", {65, 3050131085U}},
      {"actuator_outputs[1]", {65, 1003265128U}},
      {"airspeed", {595, 631030752U}},
      {"airspeed_validated", {8, 2251009375U}},
      {"battery_status", {21, 1595296833U}},
      {"battery_status[1]", {21, 4244927851U}},
      {"commander_state", {14, 3678809677U}},
      {"cpuload", {14, 3952184709U}},
      {"differential_pressure", {6, 3371451618U}},
      {"differential_pressure[1]", {6, 3472413997U}},
      {"ekf2_timestamps", {1297, 1955713130U}},
      {"ekf_gps_drift", {28, 1135215801U}},
      {"estimator_innovation_test_ratios", {33, 1134954444U}},
      {"estimator_innovation_variances", {33, 4161996239U}},
      {"estimator_innovations", {33, 1908619378U}},
      {"estimator_sensor_bias", {7, 1711597879U}},
      {"estimator_status", {636, 2818567815U}},
      {"input_rc", {13, 251101573U}},
      {"logger_status", {7, 3881258965U}},
      {"manual_control_setpoint", {33, 3305982614U}},
      {"mission", {1, 3739432209U}},
      {"multirotor_motor_limits", {7, 3313218334U}},
      {"position_setpoint_triplet", {1, 2493555456U}},
      {"px4io_status", {7, 779950688U}},
      {"rate_ctrl_status", {33, 306068397U}},
      {"safety", {8, 637602614U}},
      {"sensor_accel", {6, 2551013021U}},
      {"sensor_accel[1]", {6, 1630743936U}},
      {"sensor_accel[2]", {6, 4291937846U}},
      {"sensor_baro", {6, 37208913U}},
      {"sensor_baro[1]", {6, 1479025081U}},
      {"sensor_combined", {1298, 2588283883U}},
      {"sensor_gyro", {6, 2271225364U}},
      {"sensor_gyro[1]", {6, 3976589842U}},
      {"sensor_gyro[2]", {6, 2866005026U}},
      {"sensor_mag", {6, 2390745967U}},
      {"sensor_mag[1]", {6, 937114588U}},
      {"sensor_preflight", {7, 499032003U}},
      {"sensor_selection", {1, 871333706U}},
      {"system_power", {13, 3919951464U}},
      {"telemetry_status", {8, 1755342371U}},
      {"telemetry_status[1]", {8, 3265796429U}},
      {"test_motor", {1, 3327524741U}},
      {"vehicle_air_data", {120, 3318268487U}},
      {"vehicle_angular_acceleration", {1811, 1090988297U}},
      {"vehicle_angular_velocity", {1812, 2484201553U}},
      {"vehicle_attitude", {1298, 3971427308U}},
      {"vehicle_attitude_setpoint", {65, 2206070341U}},
      {"vehicle_command", {1, 373152047U}},
      {"vehicle_control_mode", {14, 2403430575U}},
      {"vehicle_gps_position", {32, 2910539418U}},
      {"vehicle_imu", {12, 769281708U}},
      {"vehicle_imu[1]", {12, 2983282943U}},
      {"vehicle_imu[2]", {12, 1839957705U}},
      {"vehicle_imu_status", {6, 2561521079U}},
      {"vehicle_imu_status[1]", {7, 750122946U}},
      {"vehicle_imu_status[2]", {6, 4132428405U}},
      {"vehicle_land_detected", {11, 1675527220U}},
      {"vehicle_local_position", {636, 3990454553U}},
      {"vehicle_magnetometer", {319, 2420626168U}},
      {"vehicle_rates_setpoint", {319, 3779795810U}},
      {"vehicle_status", {14, 3991765408U}},
      {"vehicle_status_flags", {14, 1037439817U}},
      {"vtol_vehicle_status", {33, 2086480050U}},
      {"wind_estimate", {8, 1265292994U}},
      {"wind_estimate[1]", {8, 1265292994U}},
      {"yaw_estimator_status", {8, 3911970022U}},
  };
  const auto bag = bag::open_bag(file);
  testing::HashSums found = testing::hash_sums_of(*bag);
  found.erase("dropout");
  EXPECT_EQ(found, expected);
}

}  // namespace
}  // namespace kelpie::ulog_reader_test
