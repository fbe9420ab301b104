// SPDX-License-Identifier: Apache-2.0

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <fstream>
#include <thread>

#include "cli/command.hpp"
#include "log/dataset.hpp"
#include "support.hpp"

namespace kelpie::predict_test {
namespace {

using testing::kelpie;
using testing::Outcome;
using testing::write_text;

class Predict : public testing::CommandTest {
 protected:
  void SetUp() override { learn_little_log(); }

  Outcome predict(const std::string& log) {
    return run("predict --model out/model.json " + log + " --out p.csv");
  }
};

TEST_F(Predict, NeedsNeitherTargetsNorTimeAndKeepsEveryRow) {
  write("inputs.csv", "n;u\n1;0.1\nnan;0.2\n3;0.3\n");
  const Outcome outcome = testing::succeeded(predict("inputs.csv"));
  EXPECT_EQ(outcome.out.find("R²"), std::string::npos);
  const std::string written = content("p.csv");
  EXPECT_EQ(written.substr(0, written.find('\n')),
            "n,u,udot_predicted,udot_lower,udot_upper,udot_novelty");
  EXPECT_NE(written.find("\nnan,0.2,nan,nan,nan,nan\n"), std::string::npos) << written;
  const log::Table table = log::read_csv(folder_ / "p.csv");
  EXPECT_LT(table.columns[3][0], table.columns[2][0]);
  EXPECT_GT(table.columns[4][0], table.columns[2][0]);
  EXPECT_GE(table.columns[5][0], 0.0);
  EXPECT_LE(table.columns[5][0], 1.0);
}

TEST_F(Predict, TakesTheModelThatLearnWritesWhereNoneIsNamed) {
  testing::expect_refused(run("predict log.csv"),
                          "out/learn/model.json: there is no such model; `kelpie learn` makes one");
  testing::expect_refused(run("rollout log.csv"), "there is no such model");
  testing::expect_refused(run("export --c model.c"), "there is no such model");
  std::filesystem::create_directory(folder_ / "out/learn");
  std::filesystem::copy(folder_ / "out/model.json", folder_ / "out/learn/model.json");
  testing::succeeded(run("predict log.csv"));
  testing::succeeded(predict("log.csv"));
  EXPECT_EQ(content("predictions.csv"), content("p.csv"));
  testing::succeeded(run("rollout log.csv"));
  testing::succeeded(run("export --c model.c"));
  EXPECT_TRUE(exists("model.c"));
}

TEST_F(Predict, AModelMayBeAPipe) {
  testing::succeeded(predict("log.csv"));
  const std::string from_file = content("p.csv");
  const std::string model = content("out/model.json");
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  {
    const std::jthread writer([&] { std::ofstream(folder_ / "pipe") << model; });
    testing::succeeded(run("predict log.csv --model pipe --out q.csv"));
  }
  EXPECT_EQ(content("q.csv"), from_file);
  const std::jthread writer([&] { std::ofstream(folder_ / "pipe") << model; });
  testing::succeeded(run("learn log.csv --from pipe --out next"));
}

TEST_F(Predict, WordsStayAsTheyWereAndNoInputIsReplaced) {
  write("inputs.csv", "n,u,note\n1,0.1,dive 7\n3,0.3,\n");
  ASSERT_EQ(predict("inputs.csv").exit_code, 0);
  const std::string written = content("p.csv");
  EXPECT_NE(written.find("\n1,0.1,\"dive 7\","), std::string::npos) << written;
  write("p.csv", "n,u\n1,0.1\n");
  for (const std::string log : {"p.csv", "./p.csv"}) {
    testing::expect_refused(predict(log),
                            "p.csv: --out: would overwrite an input; choose another name");
  }
  EXPECT_EQ(content("p.csv"), "n,u\n1,0.1\n");
}

TEST_F(Predict, ATimeWithAWordInItIsRefused) {
  write("inputs.csv", "t,u,n\n0,1,2\n0.1,1,2\n-,1,2\n");
  auto model = parsed("out/model.json");
  model["alignment"] = {{"shift_s", 0.2}, {"rows", 2}, {"commands", {"n"}}};
  write_text(folder_ / "out" / "model.json", model.dump());
  testing::expect_refused(predict("inputs.csv"), "inputs.csv:4: t: '-' is not a number");
}

TEST_F(Predict, TimesInMillisecondsAndTimeStampsAreTimes) {
  auto model = parsed("out/model.json");
  model["alignment"] = {{"shift_s", 0.2}, {"rows", 2}, {"commands", {"n"}}};
  write_text(folder_ / "out" / "model.json", model.dump());
  std::string seconds = "t,u,n\n";
  std::string milliseconds = "t,u,n\n";
  std::string stamps = "when,u,n\n";
  for (int row = 0; row < 9; ++row) {
    const std::string cells = fmt::format(",{},{}\n", 0.1 * row, 0.2 * row);
    seconds += fmt::format("0.{}", row) + cells;
    milliseconds += fmt::format("{}", 100 * row) + cells;
    stamps += fmt::format("2026-05-01 12:00:00.{}", row) + cells;
  }
  write("s.csv", seconds);
  write("ms.csv", milliseconds);
  write("stamps.csv", stamps);
  const auto predictions = [&](const std::string& log) {
    testing::succeeded(predict(log));
    const log::Table table = log::read_csv(folder_ / "p.csv");
    std::vector<double> values = table.columns[table.find("udot_predicted")];
    std::erase_if(values, [](double value) { return !std::isfinite(value); });
    return values;
  };
  const std::vector<double> expected = predictions("s.csv");
  EXPECT_EQ(expected.size(), 9U);
  EXPECT_NE(predictions("ms.csv"), expected);  // as seconds
  EXPECT_EQ(predictions("ms.csv --units t=ms"), expected);
  EXPECT_EQ(predictions("stamps.csv"), expected);
}

TEST_F(Predict, AnotherUnitThanTheLearnedIsTold) {
  const std::string rows = content("log.csv").substr(content("log.csv").find('\n'));
  write("si.csv", "t,u [m/s],n,udot" + rows);
  write("other.csv", "t,u [cm/s],n,udot" + rows);
  testing::succeeded(run("learn si.csv --out out" + testing::kFewSamples));
  for (const std::string command : {"predict", "rollout"}) {
    const std::string model = " --model out/model.json --out p.csv ";
    EXPECT_EQ(testing::succeeded(run(command + " si.csv" + model)).err, "");
    EXPECT_NE(run(command + " other.csv" + model)
                  .err.find("other.csv: WARNING: u is in cm/s, and the model learned m/s; --units "
                            "'u=cm s^-1' converts"),
              std::string::npos);
    EXPECT_EQ(run(command + " other.csv --units 'u=cm s^-1'" + model).err.find("learned m/s"),
              std::string::npos);
    std::filesystem::remove_all(folder_ / "p.csv");
  }
}

TEST_F(Predict, RowsHeldOutAreJudgedApartFromThoseLearned) {
  const Outcome outcome = testing::succeeded(predict("log.csv"));
  const auto result = parsed("out/result.json");
  const std::size_t held_out = result["held_out_rows"];
  EXPECT_NE(outcome.out.find(fmt::format("udot: R² {:.3f} over {} rows held out when it learned\n",
                                         result["axes"][0]["r2"]["final"].get<double>(), held_out)),
            std::string::npos)
      << outcome.out;
  EXPECT_NE(outcome.out.find(fmt::format(" over {} rows that it learned\n", 2400 - held_out)),
            std::string::npos)
      << outcome.out;
  // With another row it isn't known which of them are the same.
  write("longer.csv", content("log.csv") + "240,0.1,2,0.3\n");
  EXPECT_NE(predict("longer.csv").out.find("over 2401 of 2401 rows"), std::string::npos);
  // A gap in what the model doesn't see is none.
  std::string gap = content("log.csv");
  gap.insert(gap.find('\n') + 1, "0,nan,1,0\n");
  write("gap.csv", gap);
  EXPECT_NE(predict("gap.csv").out.find("rows held out when it learned"), std::string::npos);
}

TEST_F(Predict, JacobianAddsTheDerivativesInTheLogsUnits) {
  write("inputs.csv", "u,n\n0.1,5\n0.101,5\n0.1,5.01\nnan,1\n");
  const Outcome outcome =
      testing::succeeded(run("predict --model out/model.json inputs.csv --out p.csv --jacobian"));
  const log::Table table = log::read_csv(folder_ / "p.csv");
  EXPECT_EQ(table.names,
            (std::vector<std::string>{"u", "n", "udot_predicted", "udot_lower", "udot_upper",
                                      "udot_novelty", "d(udot)/d(u)", "d(udot)/d(n)"}));
  const std::vector<double>& y = table.columns[2];
  EXPECT_NEAR(table.columns[6][0], (y[1] - y[0]) / 0.001, 0.02 * std::abs(table.columns[6][0]));
  EXPECT_NEAR(table.columns[7][0], (y[2] - y[0]) / 0.01, 0.02 * std::abs(table.columns[7][0]));
  EXPECT_TRUE(std::isnan(table.columns[7][3]));
  write("twice.csv", "u,n,d(udot)/d(n)\n1,2,3\n");
  const Outcome twice = run("predict --model out/model.json twice.csv --out q.csv --jacobian");
  testing::expect_refused(twice, "d(udot)/d(n): is there already");
}

TEST_F(Predict, RefusesLogsOfAnotherVehicleAndDamagedModels) {
  write("other.csv", "u,m\n1,2\n");
  Outcome outcome = predict("other.csv");
  testing::expect_refused(outcome, "other.csv: n: there is no such column");
  testing::expect_refused(outcome, "; a column of the model in out/model.json");
  EXPECT_FALSE(exists("p.csv"));
  write("twice.csv", "u,n,udot_predicted\n1,2,3\n");
  outcome = predict("twice.csv");
  testing::expect_refused(outcome, "udot_predicted: is there already");
  const std::string model = content("out/model.json");
  write_text(folder_ / "out" / "model.json", model.substr(0, model.size() / 2));
  outcome = predict("log.csv");
  testing::expect_refused(outcome, "model.json: file: is not JSON");
  write_text(folder_ / "out" / "model.json", "\x8BKELPIE\r\n\x1A\n\n");
  testing::expect_refused(predict("log.csv"), "is a checkpoint");
}

}  // namespace
}  // namespace kelpie::predict_test
