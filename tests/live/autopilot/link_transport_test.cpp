// SPDX-License-Identifier: Apache-2.0
#include "autopilot/link_transport.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <random>
#include <thread>

#include "autopilot/rov.hpp"
#include "autopilot/signing.hpp"
#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "live/engine.hpp"
#include "live/receiver.hpp"
#include "mavlink/frames.hpp"
#include "support.hpp"

namespace kelpie::link_transport_test {
namespace {

using testing::Bytes;
using testing::Rov;
using testing::rov_config;
using testing::TemporaryFolder;
using Got = live::Transport::Got;
using std::chrono::milliseconds;

// Of one value, by anybody.
Bytes odometry(mavlink::FrameWriter& writer, double vx) {
  const auto frame = writer.begin("ODOMETRY").set("vx", vx).set("q", 1.0).finish();
  return {frame.begin(), frame.end()};
}

// Both ends of a line in one thread: what is written to it is heard by the vehicle at once.
class VehicleLine final : public autopilot::ByteLine {
 public:
  explicit VehicleLine(Rov& rov) : rov_(rov) {}

  std::span<const std::byte> read(milliseconds most) override {
    if (waiting.empty()) {
      std::this_thread::sleep_for(most);
      return {};
    }
    source_ = waiting.front().first;
    bytes_.clear();
    while (!waiting.empty() && waiting.front().first == source_) {
      const Bytes& bytes = waiting.front().second;
      bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
      waiting.pop_front();
    }
    return bytes_;
  }
  autopilot::Address source() const override { return address(source_); }
  void write(std::span<const std::byte> bytes) override {
    rov_.hear(bytes, [&](auto answer) { add(answer); });
  }

  // From the vehicle, or from others with a port of their own.
  void add(std::span<const std::byte> bytes, std::uint16_t port = 1) {
    waiting.emplace_back(port, Bytes(bytes.begin(), bytes.end()));
  }
  std::deque<std::pair<std::uint16_t, Bytes>> waiting;

  static autopilot::Address address(std::uint16_t port) {
    autopilot::Address address{.bytes = sizeof(sockaddr_in)};
    auto& internet = reinterpret_cast<sockaddr_in&>(address.storage);
    internet.sin_family = AF_INET;
    internet.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    internet.sin_port = htons(port);
    return address;
  }

 private:
  Rov& rov_;
  std::uint16_t source_ = 1;
  Bytes bytes_;
};

class Link : public ::testing::Test {
 protected:
  void open(const std::string& mavlink = "", const std::string& log = "",
            const std::string& velocity = "ODOMETRY:vx") {
    std::string text = rov_config(mavlink, "", log);
    text.replace(text.find("ODOMETRY:vx"), std::string("ODOMETRY:vx").size(), velocity);
    testing::write_text(folder_ / "x.toml", text);
    configuration_ = live::read_configuration(folder_ / "x.toml", {});
    auto line = std::make_unique<VehicleLine>(rov_);
    line_ = line.get();
    link_ = std::make_unique<autopilot::LinkTransport>(
        configuration_, autopilot::read_link_settings(*configuration_.live.mavlink),
        std::move(line));
  }

  // The vehicle's time goes by; how many messages of each topic came.
  std::map<std::string, int> pass(double seconds) {
    rov_.go(seconds, [&](auto bytes) { line_->add(bytes); });
    return take();
  }
  std::map<std::string, int> take() {
    std::map<std::string, int> messages;
    for (bag::Message message;;) {
      if (link_->next(message, milliseconds(2)) == Got::message) {
        ++messages[link_->topics()[message.topic].name];
      } else if (line_->waiting.empty()) {  // a slow machine needs all the time before it reads
        return messages;
      }
    }
  }

  // Of whole rows within 10 s of the vehicle's time.
  std::vector<double> pulses_of_rows(double boots_s = 20.0) {
    live::Receiver receiver(configuration_, std::nullopt);
    std::vector<double> pulses;
    for (int second = 0; second < 10; ++second) {
      if (second == boots_s) {
        rov_.restart();
      }
      rov_.go(1.0, [&](auto bytes) { line_->add(bytes); });
      for (bag::Message message;;) {
        if (link_->next(message, milliseconds(2)) == Got::message) {
          receiver.receive(link_->topics(), message);
        } else if (line_->waiting.empty()) {
          break;
        }
        while (const SampleRow* const row = receiver.next()) {
          if (row->is_whole) {
            pulses.push_back(row->x[1]);
          }
        }
      }
    }
    return pulses;
  }

  TemporaryFolder folder_;
  Rov rov_{7};
  live::Configuration configuration_;
  VehicleLine* line_ = nullptr;
  std::unique_ptr<autopilot::LinkTransport> link_;
};

TEST_F(Link, TheVehicleIsAskedForItsMessagesAtTheRatesWanted) {
  open("rates = {ODOMETRY = 50}");
  EXPECT_EQ(link_->health().faults,
            std::vector<std::string>{"udp:14550: no HEARTBEAT of an autopilot"});
  pass(1.0);
  pass(1.0);
  EXPECT_DOUBLE_EQ(rov_.rates_hz["ODOMETRY"], 50.0);
  EXPECT_DOUBLE_EQ(rov_.rates_hz["SERVO_OUTPUT_RAW"], 20.0);  // twice the rows
  const std::map<std::string, int> messages = pass(2.0);
  EXPECT_NEAR(messages.at("ODOMETRY"), 100, 1);
  EXPECT_NEAR(messages.at("SERVO_OUTPUT_RAW"), 40, 1);
  EXPECT_NEAR(messages.at("HEARTBEAT"), 2, 1);
  EXPECT_GE(rov_.heard["HEARTBEAT"], 1);
  EXPECT_TRUE(link_->health().faults.empty());
}

// The function of the output that [log] names, then the direction of the motor on this output.
TEST_F(Link, TheVehicleIsAskedForTheDirectionsOfItsMotors) {
  rov_.parameters = {{"SERVO1_FUNCTION", 35}, {"MOT_3_DIRECTION", -1}, {"FRAME_CONFIG", 1}};
  open("", "mirror_motors = true");
  std::map<std::string, int> messages = pass(2.0);
  EXPECT_EQ(join_text(rov_.asked_parameters, ","), "SERVO1_FUNCTION,MOT_3_DIRECTION,FRAME_CONFIG");
  for (const auto& [topic, count] : pass(1.0)) {
    messages[topic] += count;
  }
  EXPECT_EQ(messages["PARAM_VALUE"], 3);  // recorded and heard as any message
  EXPECT_EQ(rov_.asked_parameters.size(), 3U);
  EXPECT_TRUE(link_->health().faults.empty());
}

TEST_F(Link, ALearnerMirrorsAReversedMotorOnceItsDirectionIsTold) {
  const auto learned = [&](double direction) {
    rov_ = Rov(7);
    rov_.parameters = {{"SERVO1_FUNCTION", 35}, {"MOT_3_DIRECTION", direction}};
    open("", "mirror_motors = true");
    return pulses_of_rows();
  };
  const std::vector<double> plain = learned(1.0);
  const std::vector<double> mirrored = learned(-1.0);
  ASSERT_GT(plain.size(), 20U);
  const auto [low, high] = std::ranges::minmax(plain);
  const auto [mirrored_low, mirrored_high] = std::ranges::minmax(mirrored);
  EXPECT_NEAR(mirrored_low, 3000.0 - high, 20.0);
  EXPECT_NEAR(mirrored_high, 3000.0 - low, 20.0);
}

// Its pulses count µs with 32 bits, which begin anew after 71.6 minutes, its velocities ms, which
// do so after 49.7 days. A boot costs the rows of some seconds.
TEST_F(Link, AVehicleThatHasBeenUpForHoursOrWeeksIsLearnedAsWell) {
  constexpr double kUs_s = 4'294.967296;
  struct Case {
    double up_s;
    double boots_s;  ///< after so much of 10 s
  };
  for (const std::string velocity : {"ODOMETRY:vx", "LOCAL_POSITION_NED:vx"}) {
    const auto rows_of = [&](const Case& one) {
      rov_ = Rov(7);
      rov_.be_up(one.up_s);
      open("", "", velocity);
      return static_cast<double>(pulses_of_rows(one.boots_s).size());
    };
    const double rows = rows_of({0.0, 20.0});
    ASSERT_GT(rows, 60.0);
    for (const Case& one : {Case{7'200.0, 20.0}, Case{260 * kUs_s - 5.0, 20.0},
                            Case{1'000 * kUs_s - 5.0, 20.0}, Case{1'010 * kUs_s - 5.0, 20.0}}) {
      EXPECT_NEAR(rows_of(one), rows, 5.0) << velocity << " " << one.up_s;
    }
    const double rows_after_boot = rows_of({200.0, 6.0});
    ASSERT_GT(rows_after_boot, 40.0);
    for (const Case& one :
         {Case{7'200.0, 6.0}, Case{260 * kUs_s - 3.0, 6.0}, Case{1'000 * kUs_s - 3.0, 6.0}}) {
      EXPECT_NEAR(rows_of(one), rows_after_boot, 5.0) << velocity << " " << one.up_s;
    }
  }
}

// What an autopilot tells while nobody knows whether it is the vehicle is passed on to nobody.
TEST_F(Link, ParametersToldBeforeTheVehicleIsFoundAreAskedForAgain) {
  rov_.parameters = {{"SERVO1_FUNCTION", 35}, {"MOT_3_DIRECTION", -1}, {"FRAME_CONFIG", 1}};
  rov_.rates_hz = {{"ODOMETRY", 0.0}, {"SERVO_OUTPUT_RAW", 0.0}};
  rov_.refuses_message = "ODOMETRY";
  open("", "mirror_motors = true");
  mavlink::FrameWriter writer(7, 1);
  line_->add(testing::heartbeat_of_vehicle(writer));
  take();
  line_->add(writer.begin("PARAM_VALUE").set("param_id", "FRAME_CONFIG").finish());
  EXPECT_TRUE(take().empty());
  line_->add(odometry(writer, 0.1));
  std::map<std::string, int> messages = take();
  for (int second = 0; second < 2; ++second) {
    for (const auto& [topic, count] : pass(1.0)) {
      messages[topic] += count;
    }
  }
  EXPECT_EQ(messages["PARAM_VALUE"], 3);
  EXPECT_EQ(join_text(rov_.asked_parameters, ","), "SERVO1_FUNCTION,MOT_3_DIRECTION,FRAME_CONFIG");
}

// A sender that has taken the place of a silent one is no rival of its own.
TEST(Senders, WhoTakesAPlaceIsNoRival) {
  autopilot::Senders senders({}, {});
  mavlink::FrameWriter writer(7, 1);
  mavlink::FrameParser parser;
  parser.add(testing::heartbeat_of_vehicle(writer));
  mavlink::Frame frame;
  ASSERT_TRUE(parser.next(frame));
  const autopilot::Senders::Time begin{std::chrono::hours(1)};
  const auto faults_after = [&](double seconds, std::uint16_t port, bool is_heard) {
    const auto now = begin + milliseconds(static_cast<int>(1e3 * seconds));
    EXPECT_EQ(senders.accept(frame, VehicleLine::address(port), true, now), is_heard) << seconds;
    return join_text(senders.faults(now), "\n");
  };
  EXPECT_EQ(faults_after(0.0, 1, true), "");
  EXPECT_NE(faults_after(1.0, 2, false).find("127.0.0.1:2 is refused"), std::string::npos);
  EXPECT_EQ(faults_after(8.0, 2, true), "");
  EXPECT_NE(faults_after(9.0, 3, false).find("127.0.0.1:3 is refused"), std::string::npos);
}

// What the configuration's `velocity` is refused with, where surge comes from this field.
class ToldVelocity : public Link {
 protected:
  std::string refusal(const std::string& how, const std::string& surge) {
    std::string text = rov_config("connection = \"udp:0\"\nvelocity = \"" + how + "\"");
    text.replace(text.find("ODOMETRY:vx"), 11, surge);
    testing::write_text(folder_ / "x.toml", text);
    configuration_ = live::read_configuration(folder_ / "x.toml", {});
    return testing::message_of<InputError>(
        [&] { autopilot::open_link(configuration_, *configuration_.live.mavlink); });
  }
};

TEST_F(ToldVelocity, TheWayOfAVelocityLogTakesAllThreeVelocities) {
  const std::string refused = refusal("VISION_POSITION_DELTA", "/mavlink/7/197/ODOMETRY:vx");
  EXPECT_NE(refused.find("live.mavlink.velocity: VISION_POSITION_DELTA tells the way"),
            std::string::npos)
      << refused;
  EXPECT_EQ(refusal("ODOMETRY", "/mavlink/7/197/ODOMETRY:vx"), "");
}

// A filter would be told its own output, and kelpie would never see the velocity log's outage.
TEST_F(ToldVelocity, TheFiltersOwnVelocityIsNotToldToTheFilter) {
  for (const std::string how : {"ODOMETRY", "VISION_POSITION_DELTA"}) {
    for (const std::string surge :
         {"LOCAL_POSITION_NED:vx", "GLOBAL_POSITION_INT:vx", "ODOMETRY:vx"}) {
      const std::string refused = refusal(how, surge);
      EXPECT_NE(refused.find("x.toml:20: live.mavlink.velocity: "), std::string::npos) << refused;
      EXPECT_NE(refused.find("u is " + surge + ", what this filter makes"), std::string::npos)
          << refused;
      EXPECT_NE(refused.find("VISION_POSITION_DELTA:position_delta[0]/time_delta_usec"),
                std::string::npos)
          << refused;
      EXPECT_EQ(refusal("none", surge), "");
    }
  }
  for (const std::string surge :
       {"/mavlink/255/0/VISION_POSITION_DELTA:position_delta[0]/time_delta_usec",
        "VISION_POSITION_DELTA:position_delta[0]/time_delta_usec"}) {
    EXPECT_EQ(refusal("ODOMETRY", surge), "");
  }
}

TEST_F(Link, OnlyTheVehicleIsAskedAndOthersKeepTheirNames) {
  open("system = 7");
  Rov other(3);
  other.go(2.0, [&](auto bytes) { line_->add(bytes); });
  mavlink::FrameWriter camera(7, 100);
  line_->add(camera.begin("HEARTBEAT").set("type", 30).set("autopilot", 8).finish());
  EXPECT_TRUE(take().empty());  // nobody's names are known yet
  pass(1.2);
  other.go(1.0, [&](auto bytes) { line_->add(bytes); });
  const std::map<std::string, int> messages = pass(1.0);
  EXPECT_NEAR(messages.at("/mavlink/3/1/ODOMETRY"), 4, 1);
  EXPECT_NEAR(messages.at("ODOMETRY"), 20, 1);
  EXPECT_EQ(other.rates_hz["ODOMETRY"], 4.0);
}

TEST_F(Link, WhatIsLostOrDamagedIsCounted) {
  open();
  pass(1.1);
  std::vector<std::vector<std::byte>> frames;
  rov_.go(1.0, [&](auto bytes) { frames.emplace_back(bytes.begin(), bytes.end()); });
  ASSERT_GT(frames.size(), 20U);
  frames[3][12] ^= std::byte{1};
  frames.erase(frames.begin() + 10);
  for (const std::vector<std::byte>& frame : frames) {
    line_->add(frame);
  }
  line_->add(testing::other_frame(29'999, 3));
  take();
  EXPECT_EQ(link_->health().damaged, 1U);
  EXPECT_GE(link_->health().lost, 2U);
  EXPECT_EQ(link_->health().unknown, 1U);
}

TEST_F(Link, BytesThatAreNoFramesAreSaid) {
  open();
  std::mt19937 random(18);
  for (int k = 0; k < 200; ++k) {
    std::vector<std::byte> bytes(50);
    std::ranges::generate(bytes, [&] { return static_cast<std::byte>(random() % 256); });
    line_->add(bytes);
    take();
  }
  EXPECT_NE(link_->health().faults.at(0).find("is the baud rate right?"), std::string::npos);
  pass(1.1);
  pass(1.0);  // and it goes on when frames come
  EXPECT_TRUE(link_->health().faults.empty());
}

TEST_F(Link, AFloodOfSendersFillsNoMemory) {
  open();
  pass(1.1);
  for (int system = 1; system < 256; ++system) {
    for (int component = 1; component < 60; ++component) {
      mavlink::FrameWriter writer(static_cast<std::uint8_t>(system),
                                  static_cast<std::uint8_t>(component));
      line_->add(writer.begin("ATTITUDE").finish());
    }
    take();
  }
  EXPECT_LE(link_->topics().size(), 5'000U);
  EXPECT_NEAR(pass(1.0).at("ODOMETRY"), 20, 1);  // the vehicle is heard all the same
}

std::string faults_of(const autopilot::LinkTransport& link) {
  std::string text;
  for (const std::string& fault : link.health().faults) {
    text += fault + "\n";
  }
  return text;
}

TEST_F(Link, OtherAutopilotsBeforehandDontKeepTheVehicleOut) {
  open();
  for (int round = 0; round < 2; ++round) {
    for (int sender = 0; sender < 2'000; ++sender) {
      mavlink::FrameWriter writer(static_cast<std::uint8_t>(10 + sender / 20),
                                  static_cast<std::uint8_t>(1 + sender % 20));
      line_->add(testing::heartbeat_of_vehicle(writer), 2);
    }
    take();
    pass(1.1);
  }
  EXPECT_NEAR(pass(1.0).at("ODOMETRY"), 20, 1);
  EXPECT_LE(link_->topics().size(), 1'000U);
}

TEST_F(Link, ASecondSenderUnderTheVehiclesNumbersIsRefusedAndSaid) {
  open();
  pass(1.2);
  mavlink::FrameWriter forger(7, 1);
  const std::size_t refused = link_->health().refused;
  for (int k = 0; k < 5; ++k) {
    line_->add(odometry(forger, 1e6), 2);
    line_->add(testing::heartbeat_of_vehicle(forger), 3);
    EXPECT_TRUE(take().empty());
  }
  EXPECT_EQ(link_->health().refused, refused + 10);
  EXPECT_NE(faults_of(*link_).find("two senders are system 7, component 1: 127.0.0.1:1 is heard, "
                                   "127.0.0.1:2 is refused"),
            std::string::npos)
      << faults_of(*link_);
  EXPECT_NEAR(pass(1.0).at("ODOMETRY"), 20, 1);
}

// The begin of a frame, from another sender, would swallow the vehicle's next frames.
TEST_F(Link, ABeginWithoutAnEndCostsOthersNothing) {
  open();
  pass(1.2);
  const Bytes begin{std::byte{0xFD}, std::byte{0xFF}, std::byte{0}};
  int messages = 0;
  for (int k = 0; k < 20; ++k) {
    line_->add(begin, 2);
    messages += pass(0.05)["ODOMETRY"];
  }
  EXPECT_NEAR(messages, 20, 1);
  EXPECT_EQ(link_->health().damaged, 0U);
}

TEST_F(Link, AStatedComponentIsTheVehicle) {
  open("system = 7\ncomponent = 1");
  mavlink::FrameWriter other(7, 2);
  for (int k = 0; k < 5; ++k) {
    line_->add(testing::heartbeat_of_vehicle(other));
    line_->add(odometry(other, 3.0));
  }
  EXPECT_TRUE(take().empty());
  pass(1.2);
  EXPECT_NEAR(pass(1.0).at("ODOMETRY"), 20, 1);
  line_->add(odometry(other, 3.0));
  EXPECT_EQ(take().begin()->first, "/mavlink/7/2/ODOMETRY");
}

TEST_F(Link, WithAKeyOnlySignedMessagesAreHeardAndSent) {
  const std::string digits(64, 'a');
  testing::write_text(folder_ / "vehicle.key", digits + "\n");
  open("key = \"vehicle.key\"");
  pass(1.2);
  EXPECT_TRUE(pass(1.0).empty());
  EXPECT_NE(faults_of(*link_).find("unsigned messages are refused"), std::string::npos);
  autopilot::Signing signing(autopilot::read_signing_key(folder_ / "vehicle.key"));
  rov_ = Rov(7, [&](Bytes& frame) { signing.sign(frame, autopilot::signing_time_now()); });
  pass(1.2);
  EXPECT_NEAR(pass(1.0).at("ODOMETRY"), 20, 1);
  autopilot::Signing wrong(autopilot::SigningKey{});
  mavlink::FrameWriter forger(
      7, 1, [&](Bytes& frame) { wrong.sign(frame, autopilot::signing_time_now()); });
  line_->add(odometry(forger, 1e6));
  EXPECT_TRUE(take().empty());
  EXPECT_NE(faults_of(*link_).find("wrong signature"), std::string::npos);
  EXPECT_TRUE(rov_.all_are_signed);
}

TEST_F(Link, WhatIsNoMessageOrFieldIsNamedBeforeAnythingStarts) {
  const auto refusal = [&](const std::string& field) {
    testing::write_text(folder_ / "x.toml", rov_config("") + "");
    std::string text = rov_config("");
    text.replace(text.find("ODOMETRY:vx"), 11, field);
    testing::write_text(folder_ / "x.toml", text);
    configuration_ = live::read_configuration(folder_ / "x.toml", {});
    return testing::message_of<InputError>(
        [&] { autopilot::LinkTransport(configuration_, {}, std::make_unique<VehicleLine>(rov_)); });
  };
  EXPECT_NE(refusal("ODOMETRI:vx").find("did you mean 'ODOMETRY'"), std::string::npos);
  EXPECT_NE(refusal("ODOMETRY:vxx").find("no field vxx"), std::string::npos);
  EXPECT_NE(refusal("/odom:twist.linear.x").find("is no message of MAVLink"), std::string::npos);
}

// A whole drive, with a start anew of the autopilot within it.
TEST_F(Link, AModelIsLearnedAndPredictionsComeBack) {
  open();
  live::Outputs outputs;
  live::Requests requests;
  outputs.add(*link_->open_output(requests));
  live::Engine engine(configuration_, folder_.path(), *link_, std::nullopt, outputs, requests);
  int rounds = 0;
  engine.run([&] {
    if (line_->waiting.empty()) {
      rov_.go(0.25, [&](auto bytes) { line_->add(bytes); });
      if (++rounds == 240) {
        rov_.restart();
      }
    }
    return rounds < 480 ? live::Engine::Action::proceed : live::Engine::Action::stop;
  });
  const live::Health health = engine.health();
  EXPECT_GT(health.learner.learned, 1'000U);
  EXPECT_EQ(health.clock_restarts, 1U);
  EXPECT_EQ(health.transport.damaged, 0U);
  ASSERT_EQ(health.learner.axes.size(), 1U);
  EXPECT_GT(health.learner.axes[0].r2, 0.9);
  EXPECT_TRUE(rov_.values.contains("udot"));
}

}  // namespace
}  // namespace kelpie::link_transport_test
