// SPDX-License-Identifier: Apache-2.0
// Runs that are stopped, killed and gone on with. KELPIE_KILLS says how often to kill (default 5):
// KELPIE_KILLS=1000 build/release/test_cli --gtest_filter=Checkpoint.*Killed*
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "cli/command.hpp"
#include "cli/damaged_checkpoint.hpp"
#include "cli/running.hpp"
#include "format/checkpoint_file.hpp"
#include "kelpie/core/random.hpp"
#include "support.hpp"

namespace kelpie::checkpoint_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using testing::content_of;
using testing::kelpie;
using testing::little_log;
using testing::Outcome;
using testing::Running;
using testing::write_text;

class Checkpoint : public testing::CommandTest {
 protected:
  Outcome learn(const std::string& arguments) {
    return run("learn log.csv --set buffer=60 --set anchors=20 " + arguments);
  }

  void expect_refused(const std::string& arguments, const std::string& message) {
    testing::expect_refused(learn(arguments), message);
  }

  // The result without times.
  Json result_in(const std::string& name) const {
    Json result = Json::parse(content_of(folder_ / name / "result.json"));
    for (Json& axis : result["axes"]) {
      axis.erase("update_us");
    }
    return result;
  }

  void expect_same_results(const std::string& a, const std::string& b) const {
    EXPECT_EQ(result_in(a), result_in(b));
    EXPECT_EQ(content_of(folder_ / a / "model.json"), content_of(folder_ / b / "model.json"));
  }
};

TEST_F(Checkpoint, OffUnlessAskedFor) {
  write("log.csv", little_log(2400));
  testing::succeeded(learn("--out out"));
  EXPECT_FALSE(fs::exists(folder_ / "out" / format::kCheckpointName));
}

TEST_F(Checkpoint, ARunGoneOnWithEndsAsInOneGo) {
  write("log.csv", little_log(2400));
  testing::succeeded(learn("--out whole"));
  testing::succeeded(learn("--out out --checkpoint-every 700"));
  expect_same_results("out", "whole");  // checkpoints change nothing
  // As if it had been killed between the last but one checkpoint and the last.
  fs::rename(folder_ / "out" / format::kPreviousCheckpointName,
             folder_ / "out" / format::kCheckpointName);
  fs::remove(folder_ / "out" / "result.json");
  write_text(folder_ / "out" / "checkpoint.kelpie.123-0.tmp", "left behind");
  const Outcome outcome = testing::succeeded(learn("--out out --resume"));
  EXPECT_EQ(outcome.err, "");
  expect_same_results("out", "whole");
  EXPECT_FALSE(exists("out/checkpoint.kelpie.123-0.tmp"));
}

TEST_F(Checkpoint, WithoutOneItStartsFromTheBeginningAndSaysSo) {
  write("log.csv", little_log(2400));
  const Outcome outcome = learn("--out out --resume");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.err, "kelpie: out holds no checkpoint; starting from the first sample\n");
}

TEST_F(Checkpoint, ADamagedOneIsPassedOverAndBothRefused) {
  write("log.csv", little_log(2400));
  testing::succeeded(learn("--out whole --checkpoint-every 700"));
  const fs::path newest = folder_ / "whole" / format::kCheckpointName;
  const std::string bytes = content_of(newest);
  write_text(newest, bytes.substr(0, bytes.size() / 2));
  const Json before = result_in("whole");
  const Outcome outcome = learn("--out whole --resume");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.err,
            "kelpie: whole/checkpoint.kelpie: is cut short; resuming from "
            "whole/checkpoint.previous.kelpie\n");
  EXPECT_EQ(result_in("whole"), before);
  write_text(folder_ / "whole" / format::kPreviousCheckpointName, "");
  expect_refused("--out whole --resume", "checkpoint.previous.kelpie: is empty");
}

TEST_F(Checkpoint, ADamagedStateIsRefusedByTheNameOfItsFile) {
  write("log.csv", little_log(300));
  testing::succeeded(learn("--out out --checkpoint-every 700"));
  testing::succeeded(learn("--out from --checkpoint-every 700"));
  testing::expect_refused_by_name(folder_.path(), "out/checkpoint.kelpie",
                                  [&] { return learn("--out out --resume"); });
  testing::expect_refused_by_name(folder_.path(), "from/checkpoint.kelpie", [&] {
    return run("learn log.csv --from from/checkpoint.kelpie --out next");
  });
}

TEST_F(Checkpoint, AnotherRunIsRefusedByName) {
  write("log.csv", little_log(2400));
  testing::succeeded(learn("--out out --checkpoint-every 700"));
  const std::string file = "out/checkpoint.kelpie: ";
  expect_refused("--out out --resume --set gamma=0.3", file + "gamma: is '0.1' there, '0.3'");
  expect_refused("--out out --resume --split tail", file + "split: is 'blocks of 400 rows");
  expect_refused("--out out --resume --scales train",
                 "--scales: 'learner = posterior' takes no scale");
  expect_refused("--out out --resume --validate-every 9", file + "validate_every: is '0' there");
  expect_refused("--out out --resume --inputs u", file + "inputs: is 'u, n' there, 'u'");
  write("log.csv", little_log(2500));
  expect_refused("--out out --resume", file + "log.rows: is '2400' there, '2500'");
}

// Ctrl-C leaves a checkpoint of where it was.
TEST_F(Checkpoint, AStoppedRunGoesOnWhereItStopped) {
  write("log.csv", little_log(8000));
  const std::string settings = "--set epsilon=0.001 --set gamma=2 --set buffer=150 ";
  Running learning(folder_.path(),
                   {"learn", "log.csv", "--set", "epsilon=0.001", "--set", "gamma=2", "--set",
                    "buffer=150", "--checkpoint-every", "1000000", "--out", "out"});
  ASSERT_TRUE(learning.wait_for_text("[#")) << learning.terminal_text();  // a thirtieth is done
  learning.press_ctrl_c();
  ASSERT_EQ(learning.exit_code(), 0) << learning.terminal_text();
  const bool stopped = result_in("out")["interrupted"].get<bool>();
  ASSERT_TRUE(stopped);
  EXPECT_TRUE(fs::exists(folder_ / "out" / format::kCheckpointName));
  ASSERT_EQ(run("learn log.csv " + settings + "--out out --resume").exit_code, 0);
  testing::succeeded(run("learn log.csv " + settings + "--out whole"));
  expect_same_results("out", "whole");
}

// 0 where there is none.
std::size_t samples_in(const std::optional<format::FoundCheckpoint>& found) {
  return found ? Json::parse(found->checkpoint.header)["samples_shown"].get<std::size_t>() : 0;
}

TEST_F(Checkpoint, KilledAtRandomMomentsItLosesNothingButTheLastSamples) {
  const std::string scenario = KELPIE_SOURCE_DIR "/scenarios/small.toml";
  testing::succeeded(run("simulate '" + scenario + "' --out log.csv"));
  const auto start = std::chrono::steady_clock::now();
  testing::succeeded(learn("--out whole --checkpoint-every 40"));
  const std::chrono::duration<double, std::micro> once = std::chrono::steady_clock::now() - start;
  const std::vector<std::string> arguments{"learn",     "log.csv", "--set",
                                           "buffer=60", "--set",   "anchors=20",
                                           "--out",     "out",     "--checkpoint-every",
                                           "40",        "--resume"};
  const char* const asked = std::getenv("KELPIE_KILLS");      // NOLINT: no thread writes it
  const int kills = asked == nullptr ? 5 : std::atoi(asked);  // NOLINT: a number or none
  RandomStream random(1, "kills");
  std::size_t shown = 0;
  int ended = 0;
  for (int killed = 0; killed < kills;) {
    Running learning(folder_.path(), arguments);
    if (killed % 2 == 0) {  // once it has got on, or it never would on a busy machine
      learning.wait_until(
          [&] { return samples_in(format::find_checkpoint(folder_ / "out")) > shown; });
    }
    std::this_thread::sleep_for(
        std::chrono::microseconds(std::lround(random.uniform(0.0, 0.3 * once.count()))));
    const int code = learning.kill();
    if (code == 0) {
      expect_same_results("out", "whole");
      fs::remove_all(folder_ / "out");
      shown = 0;
      ++ended;
      continue;
    }
    ASSERT_EQ(code, -SIGKILL) << learning.terminal_text();
    ++killed;
    const std::optional<format::FoundCheckpoint> found = format::find_checkpoint(folder_ / "out");
    ASSERT_EQ(found ? found->passed_over : "", "") << killed;
    ASSERT_GE(samples_in(found), shown) << killed;
    shown = samples_in(found);
  }
  EXPECT_GT(shown, 0U);
  testing::succeeded(learn("--out out --checkpoint-every 40 --resume"));
  expect_same_results("out", "whole");
  RecordProperty("runs_to_the_end", ended);
}

}  // namespace
}  // namespace kelpie::checkpoint_test
