// SPDX-License-Identifier: Apache-2.0
// `kelpie live` as its users run it, with a vehicle of another vendor's DDS.

#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "cli/command.hpp"
#include "cli/running.hpp"
#include "dds/loopback.hpp"
#include "live/mission.hpp"
#include "support.hpp"

#ifdef KELPIE_PEER_FAST

namespace kelpie::ros_live_test {
namespace {

namespace fs = std::filesystem;
using testing::Outcome;
using testing::Peer;
using testing::Running;

constexpr const char* kOdometry = "nav_msgs/msg/Odometry";

std::string dds_table(const std::string& more = "") {
  return "[live.dds]\ndomain = " + std::to_string(testing::own_domain()) + "\nloopback = true\n" +
         more + "\n";
}

std::string config(const std::string& more = "") {
  return "buffer = 60\nanchors = 20\n[log]\ninputs = [\"u\", \"v\", \"r\", \"x\", \"y\", \"n\"]\n"
         "targets = [\"udot\", \"vdot\", \"rdot\"]\nrate = 10\nclock = \"header\"\n[log.states]\n"
         "u = \"/odom:twist.twist.linear.x\"\nv = \"/odom:twist.twist.linear.y\"\n"
         "r = \"/odom:twist.twist.angular.z\"\n[log.commands]\nx = \"/thrust:wrench.force.x\"\n"
         "y = \"/thrust:wrench.force.y\"\nn = \"/thrust:wrench.torque.z\"\n[log.derived]\n"
         "udot = \"d(u)\"\nvdot = \"d(v)\"\nrdot = \"d(r)\"\n"
         "[live]\nout = \"out\"\nalign = \"none\"\n" +
         dds_table(more);
}

class LiveTopics : public ::testing::Test {
 protected:
  LiveTopics() { testing::write_text(folder_ / "x.toml", config()); }

  static void publish_motion(Peer& peer) {
    peer.order(std::string("publish /odom ") + kOdometry + " best_effort");
    peer.order("publish /thrust geometry_msgs/msg/WrenchStamped reliable");
  }
  // Has the peer do it again and again until kelpie says this: before they know each other, nothing
  // comes of it.
  static bool repeat_until(Peer& peer, const std::string& order, Running& running,
                           const std::string& text) {
    for (int times = 0; times < 100; ++times) {
      peer.order(order);
      bool has_looked = false;
      running.wait_until([&] { return std::exchange(has_looked, true); });
      if (running.terminal_text().find(text) != std::string::npos) {
        return true;
      }
    }
    return running.wait_for_text(text);
  }
  static bool drive_until(Peer& peer, Running& running, const std::string& text) {
    return repeat_until(peer, "mission 200 1000", running, text);
  }
  // A count of the diagnostics; -1: there is no such count.
  static int count_of(const std::string& diagnostics, const std::string& name) {
    const std::size_t at = diagnostics.find(", " + name + "=");
    return at == std::string::npos ? -1 : std::stoi(diagnostics.substr(at + name.size() + 3));
  }
  // Diagnostics in which every row has its place, but for the last, whose derivatives would take
  // later messages: a busy machine loses messages and rows, and counts them.
  static std::string whole_diagnostics(Peer& peer) {
    for (int times = 0;; ++times) {
      std::string diagnostics = peer.answer("diagnostics");
      int placed = 0;
      for (const char* const name :
           {"samples learned", "rows incomplete", "rows lost", "rows waiting"}) {
        placed += count_of(diagnostics, name);
      }
      const int rows = count_of(diagnostics, "rows");
      const bool is_whole = placed > 0 && placed <= rows && rows <= placed + 3;
      if (is_whole || times == 20) {
        EXPECT_TRUE(is_whole) << diagnostics;
        return diagnostics;
      }
    }
  }
  Outcome run(const std::string& arguments) const {
    return testing::kelpie(folder_.path(), arguments);
  }

  testing::TemporaryFolder folder_;
};

TEST_F(LiveTopics, AVehicleOfAnotherVendorIsLearnedAndHearsItsPredictions) {
  Peer peer(KELPIE_PEER_FAST);
  Running running(folder_.path(), {"live", "--config", "x.toml", "--record", "rec"});
  publish_motion(peer);
  ASSERT_TRUE(drive_until(peer, running, "a model is in service")) << running.terminal_text();
  peer.order("subscribe /kelpie/prediction geometry_msgs/msg/AccelWithCovarianceStamped reliable");
  peer.order("subscribe /diagnostics diagnostic_msgs/msg/DiagnosticArray reliable");
  peer.order("publish /kelpie/command std_msgs/msg/String reliable");
  peer.order("mission 1500 1000");

  peer.say("mission 20 50");
  std::istringstream heard(peer.answer("accel"));
  std::string stamp;
  std::string frame;
  double u = 0.0, v = 0.0, w = -1.0, p = -1.0, q = -1.0, r = 0.0, var_u = 0.0, var_r = 0.0;
  heard >> stamp >> frame >> u >> v >> w >> p >> q >> r >> var_u >> var_r;
  EXPECT_EQ(frame, "base_link");
  testing::Swimming vehicle;
  for (vehicle.step();
       std::to_string(vehicle.sec()) + "." + std::to_string(vehicle.nanosec()) != stamp;) {
    ASSERT_LT(vehicle.sec(), testing::Swimming::kBeginSec + 1000) << stamp;
    vehicle.step();
  }
  EXPECT_NEAR(u, vehicle.acceleration[0], 0.3);
  EXPECT_NEAR(v, vehicle.acceleration[1], 0.3);
  EXPECT_NEAR(r, vehicle.acceleration[2], 0.3);
  EXPECT_EQ(w, 0.0);
  EXPECT_EQ(p, 0.0);
  EXPECT_EQ(q, 0.0);
  EXPECT_GE(var_u, 0.0);  // -1: not known
  EXPECT_GE(var_r, 0.0);
  const auto ask = [&](const std::string& command, const std::string& answer) {
    peer.order("text " + command);
    EXPECT_TRUE(running.wait_for_text(answer)) << running.terminal_text();
  };
  ask("freeze", "learning is frozen");
  ask("resume", "learning goes on");
  ask("save", "saved, after");
  ask("sing", "/kelpie/command: 'sing' must be save, freeze, resume or reset");

  const std::string diagnostics = whole_diagnostics(peer);
  EXPECT_NE(diagnostics.find("kelpie: learning"), std::string::npos) << diagnostics;
  const int lost = count_of(diagnostics, "messages lost") + count_of(diagnostics, "rows lost");
  running.send(SIGTERM);
  ASSERT_EQ(running.exit_code(), 0) << running.terminal_text();
  EXPECT_TRUE(fs::exists(folder_ / "out/model.json"));
  EXPECT_TRUE(lost == 0 || running.terminal_text().find("lost") != std::string::npos)
      << running.terminal_text();
}

TEST_F(LiveTopics, WhatItRecordsIsLearnedToTheSameModel) {
  Peer peer(KELPIE_PEER_FAST);
  Running running(folder_.path(), {"live", "--config", "x.toml", "--record", "rec"});
  publish_motion(peer);
  ASSERT_TRUE(drive_until(peer, running, "a model is in service")) << running.terminal_text();
  peer.order("mission 1000 1000");
  running.send(SIGTERM);
  ASSERT_EQ(running.exit_code(), 0) << running.terminal_text();
  const Outcome learned =
      run("learn rec/live_0001.mcap --config x.toml --split none --align none --out of_learn");
  ASSERT_EQ(learned.exit_code, 0) << learned.err;
  const std::string model = testing::content_of(folder_ / "out/model.json");
  EXPECT_FALSE(model.empty());
  EXPECT_EQ(model, testing::content_of(folder_ / "of_learn/model.json"));
}

TEST_F(LiveTopics, APublisherMayGoAndComeBackWithAnotherTypeAndFlood) {
  Running running(folder_.path(), {"live", "--config", "x.toml"});
  ASSERT_TRUE(running.wait_for_text("/odom: no publisher yet")) << running.terminal_text();
  {
    Peer first(KELPIE_PEER_FAST);
    publish_motion(first);
    ASSERT_TRUE(drive_until(first, running, "a model is in service")) << running.terminal_text();
  }
  ASSERT_TRUE(running.wait_for_text("/odom: no publisher any more")) << running.terminal_text();
  {
    Peer wrong(KELPIE_PEER_FAST);
    wrong.order("publish /odom geometry_msgs/msg/TwistStamped reliable");
    ASSERT_TRUE(running.wait_for_text("/odom cannot be used")) << running.terminal_text();
    EXPECT_NE(running.terminal_text().find("did you mean 'twist.linear.x'"), std::string::npos)
        << running.terminal_text();
  }
  Peer peer(KELPIE_PEER_FAST);
  publish_motion(peer);
  // Its days begin like that of the first one; how many pass before they know each other is open.
  ASSERT_TRUE(repeat_until(peer, "day 200 1000", running, "a clock was set back"))
      << running.terminal_text();
  Peer rogue(KELPIE_PEER_FAST);
  rogue.order(std::string("publish /odom ") + kOdometry + " reliable");
  ASSERT_TRUE(repeat_until(rogue, "stream 1000000 5000 60", running,
                           "/odom has messages that aren't of its type"))
      << running.terminal_text();
  peer.order("mission 200 1000");
  running.send(SIGTERM);
  EXPECT_EQ(running.exit_code(), 0) << running.terminal_text();
  EXPECT_TRUE(fs::exists(folder_ / "out/model.json"));
}

TEST_F(LiveTopics, ThousandsOfTopicsOfOthersAreNoHindrance) {
  Peer others(KELPIE_PEER_CYCLONE);
  for (int k = 0; k < 5'000; ++k) {
    others.order("publish /other/topic_" + std::to_string(k) + " std_msgs/msg/String reliable");
  }
  others.order(std::string("publish /odon ") + kOdometry + " reliable");
  Running running(folder_.path(), {"live", "--config", "x.toml"});
  ASSERT_TRUE(running.wait_for_text("/odom: no publisher yet (did you mean '/odon'?)"))
      << running.terminal_text();
  Peer peer(KELPIE_PEER_FAST);
  publish_motion(peer);
  ASSERT_TRUE(drive_until(peer, running, "a model is in service")) << running.terminal_text();
  running.send(SIGTERM);
  EXPECT_EQ(running.exit_code(), 0) << running.terminal_text();
}

TEST_F(LiveTopics, AFloodOfCommandsIsJoinedLongOnesAreRefusedAndTheEndIsPrompt) {
  Peer peer(KELPIE_PEER_FAST);
  Running running(folder_.path(), {"live", "--config", "x.toml"});
  publish_motion(peer);
  ASSERT_TRUE(drive_until(peer, running, "a model is in service")) << running.terminal_text();
  peer.order("publish /kelpie/command std_msgs/msg/String reliable");
  ASSERT_TRUE(repeat_until(peer, "text save", running, "saved, after"));
  peer.order("stream 1000 100 900000");
  EXPECT_TRUE(running.wait_for_text("/kelpie/command: a command of more than 256 bytes"))
      << running.terminal_text();
  for (int k = 0; k < 3'000; ++k) {
    peer.order("text save");
  }
  peer.order("text freeze");
  EXPECT_TRUE(running.wait_for_text("learning is frozen")) << running.terminal_text();
  running.send(SIGTERM);
  EXPECT_EQ(running.exit_code(), 0) << running.terminal_text();
  std::size_t saved = 0;
  const std::string said = running.terminal_text();
  for (std::size_t at = said.find("saved, after"); at != std::string::npos;
       at = said.find("saved, after", at + 1)) {
    ++saved;
  }
  EXPECT_LT(saved, 300U);
}

TEST_F(LiveTopics, ATopicsNameThatIsNoneIsRefusedWithItsLine) {
  const std::string whole = config();
  for (const std::string name : {"/odom/", "/a//b", "/é", "/1a", "/", "/a b"}) {
    for (const auto& [column, place] :
         {std::pair{"/odom:twist.twist.linear.x", "x.toml:9: log.states.u: "},
          std::pair{"/thrust:wrench.torque.z", "x.toml:15: log.commands.n: "}}) {
      std::string text = whole;
      const std::string field = std::string(column).substr(std::string(column).find(':'));
      text.replace(text.find(column), std::string(column).size(), name + field);
      testing::write_text(folder_ / "x.toml", text);
      const Outcome refused = run("live --config x.toml");
      EXPECT_EQ(refused.exit_code, 2) << refused.err;
      EXPECT_NE(refused.err.find(place + name + ": is no name of a topic"), std::string::npos)
          << refused.err;
    }
  }
}

TEST_F(LiveTopics, ARecordingsTopicWhoseNameIsNoneIsLeftOutAndSaid) {
  std::vector<bag::Topic> topics = testing::mission_topics();
  topics[0].name = "/odom/";
  testing::write_text(folder_ / "mission.mcap",
                      testing::mcap_of(topics, testing::little_mission(1.0)));
  testing::write_text(folder_ / "x.toml", config());
  const Outcome played = run("play mission.mcap --config x.toml --speed max");
  EXPECT_EQ(played.exit_code, 0) << played.err;
  EXPECT_NE(played.err.find("/odom/: /odom/: is no name of a topic"), std::string::npos)
      << played.err;
}

TEST_F(LiveTopics, ARecordingWithNothingToPlayIsRefused) {
  std::vector<bag::Topic> topics = testing::mission_topics();
  for (std::size_t k = 0; k < topics.size(); ++k) {
    topics[k].name = "/no name/" + std::to_string(k);
  }
  testing::write_text(folder_ / "mission.mcap",
                      testing::mcap_of(topics, testing::little_mission(1.0)));
  testing::write_text(folder_ / "x.toml", config());
  const Outcome played = run("play mission.mcap --config x.toml --speed max");
  EXPECT_EQ(played.exit_code, 2) << played.out;
  EXPECT_NE(played.err.find("has no message that can be published"), std::string::npos)
      << played.err;
}

TEST_F(LiveTopics, AQualityThatDoesNotMatchIsSaid) {
  testing::write_text(folder_ / "x.toml", config("reliable = true"));
  Peer peer(KELPIE_PEER_FAST);
  publish_motion(peer);
  Running running(folder_.path(), {"live", "--config", "x.toml"});
  EXPECT_TRUE(running.wait_for_text(
      "/odom: a publisher offers best effort, while reliable is asked for here (reliability)"))
      << running.terminal_text();
}

TEST_F(LiveTopics, ACheckTellsWhatIsThere) {
  Peer peer(KELPIE_PEER_FAST);
  publish_motion(peer);
  const Outcome well = run("live --config x.toml --check");
  EXPECT_EQ(well.exit_code, 0) << well.err;
  EXPECT_NE(well.out.find("topics of ROS 2 in DDS domain"), std::string::npos) << well.out;
  EXPECT_NE(well.out.find("/odom: nav_msgs/msg/Odometry"), std::string::npos) << well.out;
  EXPECT_FALSE(fs::exists(folder_ / "out"));

  std::string text = config();
  text.replace(text.find("twist.twist.linear.x"), 20, "twist.twist.linear.q");
  testing::write_text(folder_ / "x.toml", text);
  const Outcome ill = run("live --config x.toml --check");
  EXPECT_EQ(ill.exit_code, 2);
  EXPECT_NE(
      ill.err.find("x.toml:9: log.states.u: /odom cannot be used: /odom:twist.twist.linear.q"),
      std::string::npos)
      << ill.err;
  EXPECT_NE(ill.err.find("did you mean 'twist.twist.linear.x'"), std::string::npos) << ill.err;

  testing::write_text(folder_ / "x.toml", config("interface = \"lo\""));
  const Outcome none = run("live --config x.toml");
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_NE(none.err.find("live.dds.interface: says nothing"), std::string::npos) << none.err;
}

TEST_F(LiveTopics, ARecordingIsPlayedInPlaceOfTheVehicle) {
  testing::write_text(folder_ / "mission.mcap",
                      testing::mcap_of(testing::mission_topics(), testing::little_mission(60.0)));
  testing::write_text(folder_ / "x.toml",
                      testing::mission_config("clock = \"header\"", "align = \"none\"\n") +
                          dds_table("remap = [\"/odom:=/dvl/odom\"]"));
  Running running(folder_.path(), {"live", "--config", "x.toml", "--out", "out"});
  const Outcome played = run("play mission.mcap --config x.toml --speed 20");
  EXPECT_EQ(played.exit_code, 0) << played.err;
  EXPECT_NE(played.out.find("messages published"), std::string::npos) << played.out;
  ASSERT_TRUE(running.wait_for_text("a model is in service")) << running.terminal_text();
  running.send(SIGTERM);
  EXPECT_EQ(running.exit_code(), 0);
}

}  // namespace
}  // namespace kelpie::ros_live_test

#endif
