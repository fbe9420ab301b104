// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "core/text.hpp"

namespace kelpie::align_test {
namespace {

using testing::content_of;
using testing::kelpie;
using testing::Outcome;

// little_log, with commands logged five rows (0.5 s) late; or which a rotor follows in `lag_s`.
std::string late_log(std::size_t rows, bool with_time = true, double lag_s = 0.0) {
  RandomStream random(1, "log");
  double rotor = 0.0;
  std::string text = with_time ? "t,u,n,udot\n" : "u,n,udot\n";
  double u = 0.0;
  double phase = 0.0;
  std::vector<double> commands(5, 0.0);
  for (std::size_t i = 0; i < rows; ++i) {
    phase += random.uniform(0.01, 0.2);
    const double n = 10.0 * std::sin(phase);
    commands.push_back(n);
    rotor = lag_s > 0.0 ? n + (rotor - n) * std::exp(-0.1 / lag_s) : n;
    const double acceleration = 0.01 * rotor * std::abs(rotor) - 2.0 * u * std::abs(u) - 0.3 * u;
    text += with_time ? std::to_string(0.1 * static_cast<double>(i)) + "," : "";
    text += std::to_string(u) + "," + std::to_string(lag_s > 0.0 ? n : commands[i]) + "," +
            std::to_string(acceleration) + "\n";
    u += 0.1 * acceleration;
  }
  return text;
}

nlohmann::json json_of(const std::filesystem::path& file) {
  return nlohmann::json::parse(content_of(file));
}

class Align : public testing::CommandTest {
 protected:
  void SetUp() override { write("log.csv", late_log(2400)); }

  Outcome learn(const std::string& options, const std::string& out = "out") {
    return run("learn log.csv --inputs u,n --targets udot --out " + out + " " + options);
  }

  double r2(const std::string& out) {
    return json_of(folder_ / out / "result.json")["axes"][0]["r2"]["final"];
  }
};

TEST_F(Align, FindsTheShiftSavesItAndSaysSo) {
  const Outcome outcome = testing::succeeded(learn("--time t --verbose"));
  EXPECT_NE(outcome.out.find("commands are taken 0.5 s (5 rows) later: this explains"),
            std::string::npos)
      << outcome.out;
  const nlohmann::json model = json_of(folder_ / "out/model.json");
  EXPECT_EQ(model["alignment"]["rows"], 5);
  EXPECT_NEAR(model["alignment"]["shift_s"], 0.5, 1e-9);
  EXPECT_EQ(model["alignment"]["commands"], nlohmann::json::array({"n"}));
  EXPECT_EQ(json_of(folder_ / "out/result.json")["alignment"]["rows"], 5);
  EXPECT_NE(content("out/report.html").find("0.5 s (5 rows) later"), std::string::npos);
  testing::succeeded(learn("--time t --align none", "none"));
  EXPECT_TRUE(json_of(folder_ / "none/model.json")["alignment"].is_null());
  EXPECT_GT(r2("out"), r2("none") + 0.01);
  testing::succeeded(learn("--time t --align 0.5", "given"));
  EXPECT_EQ(r2("given"), r2("out"));
}

TEST_F(Align, FindsTheLagOfARotorAndCarriesItWhereTheModelGoes) {
  write("log.csv", late_log(2400, true, 0.8));
  const Outcome outcome = testing::succeeded(learn("--time t --split tail"));
  const nlohmann::json model = json_of(folder_ / "out/model.json");
  ASSERT_EQ(model["alignment"]["actuators"].size(), 1) << outcome.out;
  const nlohmann::json& actuator = model["alignment"]["actuators"][0];
  EXPECT_EQ(actuator["command"], "n");
  EXPECT_NEAR(actuator["lag_s"], 0.8, 0.15);
  EXPECT_EQ(model["alignment"]["shift_s"], 0.0);
  const std::string told = "follows its command in ";
  EXPECT_NE(outcome.out.find(told), std::string::npos) << outcome.out;
  EXPECT_NE(content("out/report.html").find(told), std::string::npos);
  EXPECT_NE(content("out/report.html").find(">Actuators<"), std::string::npos);
  const nlohmann::json result = json_of(folder_ / "out/result.json");
  EXPECT_EQ(result["alignment"]["actuators"], model["alignment"]["actuators"]);
  testing::succeeded(learn("--time t --split tail --align none", "none"));
  EXPECT_GT(r2("out"), r2("none") + 0.003);
  EXPECT_EQ(content("none/report.html").find(">Actuators<"), std::string::npos);

  const Outcome predicted =
      testing::succeeded(run("predict --model out/model.json log.csv --out p.csv"));
  EXPECT_NE(predicted.out.find(told), std::string::npos) << predicted.out;
  const std::size_t at = predicted.out.find("R² ");
  ASSERT_NE(at, std::string::npos) << predicted.out;
  EXPECT_NEAR(std::stod(predicted.out.substr(at + 4)), r2("out"), 2e-3);
  testing::succeeded(learn("--time t --from out/model.json", "on"));
  EXPECT_EQ(json_of(folder_ / "on/model.json")["alignment"], model["alignment"]);
}

TEST_F(Align, ActuatorsNeedTheTimeOfALogToPredict) {
  write("log.csv", late_log(2400, true, 0.8));
  testing::succeeded(learn("--time t"));
  write("untimed.csv", late_log(100, false, 0.8));
  const std::string predict = "predict --model out/model.json untimed.csv --out p.csv";
  testing::expect_refused(run(predict),
                          "untimed.csv: has no column of time, and the model's "
                          "actuators take time; name one with --time, or give the "
                          "rows per second with --rate");
  testing::succeeded(run(predict + " --rate 10"));
}

// The same commands as pulses of a servo: an actuator that is known gives the same model.
TEST_F(Align, WhatIsKnownOfActuatorsIsTakenAndKept) {
  std::istringstream lines(late_log(1200));
  std::string text;
  std::string line;
  for (std::getline(lines, line); !line.empty(); std::getline(lines, line)) {
    const std::vector<std::string> cells = split_text(line, ',');
    text += cells[0] + "," + cells[1] + "," +
            (text.empty() ? cells[2] : std::to_string(1500.0 + std::stod(cells[2]))) + "," +
            cells[3] + "\n";
  }
  write("pulses.csv", text);
  write("log.csv", late_log(1200));
  write("n.toml", "[log.actuators]\nn = {neutral = 1500}\n");
  for (const std::string align : {"none", "0.5", "auto"}) {
    const std::string columns = " --time t --inputs u,n --targets udot --align " + align;
    testing::succeeded(run("learn log.csv --out plain" + columns));
    testing::succeeded(run("learn pulses.csv --config n.toml --out known" + columns));
    EXPECT_NEAR(r2("known"), r2("plain"), 1e-4) << align;
    const nlohmann::json alignment = json_of(folder_ / "known/model.json")["alignment"];
    EXPECT_EQ(alignment["actuators"][0]["neutral"], 1500.0) << align;
    EXPECT_EQ(alignment["rows"], align == "none" ? 0 : 5) << align;
  }
  write("n.toml", "[log.actuators]\nm = {neutral = 1500}\n");
  testing::expect_refused(
      run("learn pulses.csv --config n.toml --time t --inputs u,n --targets udot"),
      "m: is to have an actuator, but isn't known to be a command");
}

// A quarter of the rows, the last, is never shown in learning.
TEST_F(Align, PredictShiftsItsLogAsLearnDid) {
  testing::succeeded(learn("--time t --split tail"));
  const auto tail_r2 = [&](const std::string& options) {
    const Outcome outcome = run("predict --model out/model.json tail.csv --out p.csv " + options);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("commands are taken 0.5 s"), std::string::npos) << outcome.out;
    const std::size_t at = outcome.out.find("R² ");
    return at == std::string::npos ? 0.0 : std::stod(outcome.out.substr(at + 4));
  };
  const auto write_tail = [&](bool with_time) {
    const std::string text = late_log(2400, with_time);
    std::size_t line = 0;
    std::string tail;
    for (std::size_t at = 0; at < text.size(); ++line) {
      const std::size_t end = text.find('\n', at) + 1;
      tail += line == 0 || line > 1920 ? text.substr(at, end - at) : "";
      at = end;
    }
    write("tail.csv", tail);
  };
  write_tail(true);
  EXPECT_NEAR(tail_r2(""), r2("out"), 2e-3);
  write_tail(false);
  EXPECT_NEAR(tail_r2(""), r2("out"), 2e-3);  // as fast as when it learned
  EXPECT_NEAR(tail_r2("--rate 10"), r2("out"), 2e-3);
  EXPECT_LT(tail_r2("--rate 20"), r2("out") - 0.01);  // ten rows are the wrong ones here
  EXPECT_EQ(run("predict --model out/model.json tail.csv --rate -4").exit_code, 2);
  EXPECT_EQ(run("predict --model out/model.json tail.csv --time x").exit_code, 2);
}

TEST_F(Align, RolloutSaysAndDoesTheSame) {
  testing::succeeded(learn("--time t --set states=u"));
  const Outcome outcome =
      testing::succeeded(run("rollout log.csv --time t --model out/model.json --horizons 1,5"));
  EXPECT_NE(outcome.out.find("commands are taken 0.5 s (5 rows) later"), std::string::npos);
  const nlohmann::json aligned = json_of(folder_ / "out/rollout/result.json");
  nlohmann::json model = json_of(folder_ / "out/model.json");
  model["alignment"] = nullptr;
  write("unaligned.json", model.dump());
  ASSERT_EQ(run("rollout log.csv --time t --model unaligned.json --horizons 1,5 "
                "--out raw")
                .exit_code,
            0);
  EXPECT_NE(json_of(folder_ / "raw/result.json"), aligned);
}

TEST_F(Align, RefusesWhatIsNoShift) {
  for (const char* const wish : {"soon", "nan", "11", "''"}) {
    testing::expect_refused(learn(std::string("--time t --align ") + wish), "--align");
  }
}

TEST_F(Align, ARunGoesOnOnlyWithTheSameWish) {
  testing::succeeded(learn("--time t --checkpoint-every 500"));
  testing::expect_refused(learn("--time t --checkpoint-every 500 --resume --align none"),
                          "align: is 'auto' there, 'none' in this run");
  EXPECT_EQ(learn("--time t --checkpoint-every 500 --resume").exit_code, 0);
}

}  // namespace
}  // namespace kelpie::align_test
