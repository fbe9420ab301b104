// SPDX-License-Identifier: Apache-2.0
// What is known of the vehicle beforehand: `kelpie learn --nominal`.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/command.hpp"

namespace kelpie::nominal_cli_test {
namespace {

using Json = nlohmann::json;
using testing::content_of;
using testing::little_log;

constexpr const char* kHeavy = KELPIE_SOURCE_DIR "/vehicles/bluerov2_heavy.toml";
constexpr const char* kOptions = " --align none --set buffer=100 --validate-every 100 --split tail";

class Nominal : public testing::CommandTest {
 protected:
  // A minute of a simulated BlueROV2 Heavy on six axes.
  void drive() {
    write("scenario.toml",
          fmt::format("vehicle = \"{}\"\nseed = 3\nrate_hz = 10.0\nlog = \"six_axes\"\n"
                      "noise = \"raw_dvl\"\n[excitation]\nmode = \"pilot\"\n"
                      "period_s = [1.0, 6.0]\neffort = [50, 50, 40, 6, 6, 4]\ndither = 0.1\n"
                      "[[configurations]]\nname = \"nominal\"\n[[phases]]\n"
                      "configuration = \"nominal\"\nduration_s = 60.0\n",
                      kHeavy));
    testing::succeeded(run("simulate scenario.toml --out heavy.csv"));
  }
  void expect_refused(const std::string& arguments, const std::string& message) {
    testing::expect_refused(run("learn " + arguments), message);
  }
  Json result(const std::string& out) const {
    return Json::parse(content_of(folder_ / out / "result.json"));
  }
  // Mean R² of the axes on held-out rows after 100 samples.
  double early_r2(const std::string& out) const {
    const Json axes = result(out)["axes"];
    double sum = 0.0;
    for (const Json& axis : axes) {
      sum += axis["validation"]["r2"][0].get<double>();
    }
    return sum / static_cast<double>(axes.size());
  }
};

TEST_F(Nominal, AVehicleFileIsWorthMoreThanTheFirstTenSeconds) {
  drive();
  testing::succeeded(run("learn heavy.csv --out without" + std::string(kOptions)));
  testing::succeeded(
      run(fmt::format("learn heavy.csv --nominal {} --out with{}", kHeavy, kOptions)));
  EXPECT_GT(early_r2("with"), 0.4);
  EXPECT_GT(early_r2("with"), early_r2("without") + 0.5);
  EXPECT_EQ(result("with")["nominal"], kHeavy);
  EXPECT_TRUE(result("without")["nominal"].is_null());
  // In axes that point elsewhere the same file is wrong.
  testing::succeeded(run(
      fmt::format("learn heavy.csv --nominal {} --frame FLU --out turned{}", kHeavy, kOptions)));
  EXPECT_GT(early_r2("with"), early_r2("turned") + 0.1);
}

TEST_F(Nominal, EarlierModelsAreAStart) {
  write("log.csv", little_log(1600));
  const std::string options = " --split tail --set buffer=100 --validate-every 60 ";
  testing::succeeded(run("learn log.csv --out before" + options));
  testing::succeeded(run("learn log.csv --out without" + options));
  testing::succeeded(run("learn log.csv --nominal before/model.json --out one" + options));
  testing::succeeded(
      run("learn log.csv --nominal before/model.json --nominal without/model.json --out two" +
          options));
  EXPECT_GT(early_r2("one"), early_r2("without"));
  EXPECT_EQ(early_r2("one"), early_r2("two")) << "the mean of two equal models";
  EXPECT_EQ(result("two")["nominal"], "before/model.json, without/model.json");
}

TEST_F(Nominal, RefusesFilesThatTellNothingOfTheLog) {
  write("log.csv", little_log(600));
  testing::succeeded(run("learn log.csv --split tail --set buffer=50"));
  expect_refused("log.csv --nominal " + std::string(kHeavy),
                 "--nominal: the vehicle's thrusters are m1, m2");
  expect_refused("log.csv --nominal out/learn/model.json --from out/learn/model.json --out next",
                 "--nominal: is the start of a new model");
  expect_refused("log.csv --nominal nothing.json", "nothing.json");
  expect_refused("log.csv --frame NED --nominal " + std::string(kHeavy),
                 "--frame: has to be FLU or FRD");
  write("other.csv", [] {
    std::string text = little_log(600);
    text.replace(text.find("udot"), 4, "vdot").replace(text.find(",u,"), 3, ",v,");
    return text;
  }());
  expect_refused("other.csv --nominal out/learn/model.json --out next",
                 "--nominal: the model has the targets udot; the log has vdot");
}

}  // namespace
}  // namespace kelpie::nominal_cli_test
