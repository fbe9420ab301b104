// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "cli/command.hpp"
#include "kelpie/core/random.hpp"
#include "support.hpp"

namespace kelpie::health_test {
namespace {

using testing::succeeded;

class Health : public testing::CommandTest {
 protected:
  // A dive of the simulated Dagon, with a factor on its drag.
  void dive(const std::string& name, int seed, double drag) const {
    const std::string factor = std::to_string(drag);
    std::string all = factor;
    for (int axis = 1; axis < 6; ++axis) {
      all += ", " + factor;
    }
    write("scenario.toml", "vehicle = \"" KELPIE_SOURCE_DIR "/vehicles/dagon.toml\"\nseed = " +
                               std::to_string(seed) +
                               "\nrate_hz = 4.0\nnoise = \"as_recorded\"\n[[configurations]]\n"
                               "name = \"it\"\ndamping_factor = [" +
                               all + "]\n[[phases]]\nconfiguration = \"it\"\nduration_s = 300.0\n");
    succeeded(run("simulate scenario.toml --out " + name));
  }

  static const nlohmann::json& change(const nlohmann::json& card, const std::string& quantity,
                                      const std::string& baseline = "deployment") {
    for (const nlohmann::json& one : card["changes"]) {
      if (one["quantity"] == quantity && one["baseline"] == baseline) {
        return one;
      }
    }
    throw std::runtime_error("no " + quantity);
  }
};

// One vehicle that fouls from the fifth dive on, one that does not.
TEST_F(Health, TellsWhichVehicleOfAFleetFoulsSinceWhenAndHowFast) {
  for (int i = 1; i <= 9; ++i) {
    const std::string date = "2026-03-0" + std::to_string(i) + ".csv";
    dive("a_" + date, i, 1.0 + 0.03 * std::max(0, i - 4));
    dive("b_" + date, 20 + i, 1.0);
  }
  const testing::Outcome outcome = succeeded(
      run("health '{vehicle}_{mission}.csv' --align none --since cleaning=2026-03-05 --out out"));
  EXPECT_NE(outcome.out.find("surge drag +1"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("March 2026, "), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("no significant change"), std::string::npos) << outcome.out;
  const nlohmann::json cards = parsed("out/health.json")["vehicles"];
  ASSERT_EQ(cards.size(), 2U);
  const nlohmann::json& drag = change(cards[0], "surge drag");
  EXPECT_EQ(drag["kind"], "drift") << drag;
  EXPECT_NEAR(drag["change"]["value"].get<double>() / drag["before"]["value"].get<double>(), 0.15,
              0.2 * 0.15);  // the allowance of kTuning.discrepancy
  EXPECT_NEAR(drag["rate_per_day"]["value"].get<double>(), 0.03, 0.2 * 0.03 + 0.001);
  EXPECT_LE(drag["change"]["interval90"][0], drag["change"]["value"]);
  EXPECT_EQ(change(cards[0], "surge drag", "cleaning")["kind"], "drift");
  for (const char* const thruster : {"th1 gain", "th2 gain", "th3 gain"}) {
    EXPECT_EQ(change(cards[0], thruster)["kind"], "constant") << thruster;
  }
  for (const nlohmann::json& one : cards[1]["changes"]) {
    EXPECT_TRUE(one["kind"] == "constant" || one["kind"] == "unknown") << one;
  }
  EXPECT_NE(content("out/health.html").find("1 of 2 vehicles changed"), std::string::npos);
}

TEST_F(Health, RefusesWhatIsNoDateNoLogAndNoColumn) {
  dive("dive.csv", 1, 1.0);
  expect_nothing_written("health dive.csv --since cleaning", "NAME=DATE");
  expect_nothing_written("health dive.csv --since cleaning=yesterday", "is no date");
  expect_nothing_written("health dive.csv --since cleaning=2026-03-03", "--dates");
  expect_nothing_written("health dive.csv --dates 2026-03-03,2026-03-04", "2 dates for 1 logs");
  expect_nothing_written("health 'no*.csv'", "matches no file");
  expect_nothing_written("health dive.csv --volts nothing", "nothing");
  expect_nothing_written("health dive.csv --glider pitch=p", "needs pitch, ballast and depth");
  expect_nothing_written("health dive.csv --glider wing=p", "is no NAME=COLUMN");
}

TEST_F(Health, FewLogsAreNoSignOfHealth) {
  dive("dive.csv", 1, 1.0);
  const testing::Outcome outcome = succeeded(run("health dive.csv --align none --out out"));
  EXPECT_NE(outcome.out.find(": 1 episode, "), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("too few episodes to tell a change"), std::string::npos);
  EXPECT_NE(content("out/health.html").find("Too few episodes to tell a change."),
            std::string::npos);
}

TEST_F(Health, ChecksEveryLogAndNotTheFirstAlone) {
  dive("a.csv", 1, 1.0);
  dive("b.csv", 2, 1.0);
  const std::string text = content("b.csv");
  std::string stamps = text.substr(0, text.find('\n') + 1);
  std::size_t row = 0;
  for (std::size_t at = stamps.size(); at < text.size(); ++row) {  // two rows for every stamp
    const std::size_t end = text.find('\n', at) + 1;
    const std::size_t comma = text.find(',', at);
    stamps += fmt::format("{}", 0.5 * static_cast<double>(row / 2));
    stamps += text.substr(comma, end - comma);
    at = end;
  }
  write("b.csv", stamps);
  expect_nothing_written("health a.csv b.csv --align none",
                         "have the time stamp of the row before");
  succeeded(run("health a.csv b.csv --align none --accept implausible --out out"));
}

// The log without the columns behind the thrusters' speeds.
std::string without_accelerations(const std::string& text) {
  std::string kept;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t comma = at;
    for (int column = 0; column < 8; ++column) {  // t,conf,u,v,r,th1,th2,th3
      comma = text.find(',', comma + 1);
    }
    kept += text.substr(at, comma - at) + "\n";
    at = text.find('\n', at) + 1;
  }
  return kept;
}

TEST_F(Health, LogsWithoutAccelerationsAreReadAsTheFirst) {
  for (const char* const name : {"a.csv", "b.csv"}) {
    dive(name, name[0], 1.0);
    write(name, without_accelerations(content(name)));
  }
  const testing::Outcome outcome = succeeded(run("health a.csv b.csv --align none --out out"));
  EXPECT_NE(outcome.out.find(": 2 episodes, "), std::string::npos) << outcome.out;
}

// A glider that goes down and up, a row every 5 s.
std::string glides() {
  RandomStream random(1, "glider");
  std::string text = "time,p,b,d,w\n";
  double t = 0.0;
  double depth = 0.0;
  for (int part = 0; part < 24; ++part) {
    const double up = part % 2 == 0 ? -1.0 : 1.0;
    const double pitch = up * (0.35 + 0.03 * (part / 2 % 4));
    const double ballast = up * (200.0 + 20.0 * (part / 2 % 3));
    do {
      const double speed =
          0.3 * std::sqrt(std::abs(ballast) / 200.0 * std::abs(std::sin(pitch)) / 0.35);
      const double sinking = -speed * std::sin(pitch) + 0.003 * random.normal();
      text += fmt::format("{},{},{},{},{}\n", t, pitch + 0.005 * random.normal(), ballast, depth,
                          sinking);
      t += 5.0;
      depth += 5.0 * sinking;
    } while (up < 0.0 ? depth < 100.0 : depth > 1.0);
  }
  return text;
}

// The same log with other times.
std::string shifted(const std::string& text, double scale, double offset_s) {
  std::size_t at = text.find('\n') + 1;
  std::string moved = text.substr(0, at);
  while (at < text.size()) {
    const std::size_t end = text.find('\n', at) + 1;
    const std::size_t comma = text.find(',', at);
    moved += fmt::format("{}", scale * std::stod(text.substr(at, comma - at)) + offset_s);
    moved += text.substr(comma, end - comma);
    at = end;
  }
  return moved;
}

const std::string kGlider = " --glider pitch=p,ballast=b,depth=d,sinking=w";

TEST_F(Health, TwoLogsOfOneNameLoseNoGlides) {
  for (const char* const folder : {"a", "b"}) {
    std::filesystem::create_directory(folder_ / folder);
    write(std::string(folder) + "/dive.csv", glides());
  }
  const std::string how = " --glider pitch=p,ballast=b,depth=d,sinking=w --glide-csv";
  expect_nothing_written("health a/dive.csv b/dive.csv" + how, "to one file, dive_glide.csv");
  succeeded(run("health '{vehicle}/{mission}.csv' --out out" + how));
  EXPECT_TRUE(exists("out/a_dive_glide.csv"));
  EXPECT_TRUE(exists("out/b_dive_glide.csv"));
}

// A log that is too short for a factor says so in place of a number.
TEST_F(Health, OneDiveIsATableWithoutAVerdict) {
  dive("dive.csv", 1, 1.0);
  succeeded(run("health dive.csv --align none --out out"));
  const nlohmann::json card = parsed("out/health.json")["vehicles"][0];
  EXPECT_EQ(card["changes"][0]["kind"], "unknown");
  EXPECT_NEAR(card["episodes"][0]["estimates"]["surge drag"]["value"].get<double>(), 1.0, 0.05);
}

TEST_F(Health, SaysWhatChangedBetweenTwoMissionsOfAGlider) {
  const std::filesystem::path first = testing::data_file("vehicles/sea035_10.csv");
  const std::filesystem::path second = testing::data_file("vehicles/sea035_12.csv");
  if (first.empty() || second.empty()) {
    GTEST_SKIP() << "the glider's logs are not here";
  }
  succeeded(run("health " + first.string() + " " + second.string() +
                " --glider pitch=pitch,ballast=ballast,depth=depth,sinking=w,mass=lin --glide-csv "
                "--out out"));
  const nlohmann::json card = parsed("out/health.json")["vehicles"][0];
  const nlohmann::json& buoyancy = change(card, "net buoyancy at ballast 0");
  EXPECT_NE(buoyancy["kind"], "constant") << buoyancy;
  EXPECT_GT(buoyancy["change"]["interval90"][0].get<double>(), 50.0) << buoyancy;
  const std::string learned = "learn out/sea035_12_glide.csv --time time --targets w --inputs ";
  const std::string how = " --split column:second_half --align none --out learned";
  const auto r2 = [&](const std::string& inputs) {
    succeeded(run(learned + inputs + how));
    return parsed("learned/result.json")["axes"][0]["r2"]["final"].get<double>();
  };
  EXPECT_GT(r2("pitch,ballast,depth,lin,glide_sinking"), 0.98);
}

// A vehicle whose clock is wrong.
TEST_F(Health, GivenDatesGoBeforeStamps) {
  const std::string text = glides();
  for (const char* const name : {"a.csv", "b.csv"}) {
    write(name, shifted(text, 1.0, 1'546'300'800.0));  // 2019-01-01
  }
  succeeded(run("health a.csv b.csv --dates 2026-03-01,2026-03-02 --out out" + kGlider));
  const nlohmann::json episodes = parsed("out/health.json")["vehicles"][0]["episodes"];
  ASSERT_GE(episodes.size(), 2U);
  EXPECT_NEAR(episodes.front()["day"].get<double>(), 20513.5, 0.5);  // 2026-03-01
  EXPECT_NEAR(episodes.back()["day"].get<double>(), 20514.5, 0.5);
}

TEST_F(Health, AGlidersTimeIsConverted) {
  write("dive.csv", glides());
  succeeded(run("health dive.csv --out s" + kGlider));
  write("dive.csv", shifted(glides(), 1e3, 0.0));
  succeeded(run("health dive.csv --units time=ms --glide-csv --out ms" + kGlider));
  EXPECT_EQ(parsed("ms/health.json"), parsed("s/health.json"));
  EXPECT_EQ(content("ms/dive_glide.csv").find("ms"), std::string::npos);
  expect_nothing_written("health dive.csv --inputs p" + kGlider,
                         "--inputs, --targets: say nothing");
}

}  // namespace
}  // namespace kelpie::health_test
