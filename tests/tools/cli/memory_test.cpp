// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <future>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "cli/command.hpp"
#include "file/descriptor.hpp"

namespace kelpie::memory_test {
namespace {

using testing::kelpie_process;
using testing::little_log;
using testing::Outcome;

class Memory : public testing::CommandTest {
 protected:
  Memory() { write("log.csv", little_log(2500)); }

  Outcome learn(const std::string& arguments) {
    return run(
        "learn log.csv --set buffer=60 --set anchors=20 "
        "--memory m.json " +
        arguments);
  }

  nlohmann::json the_only_model() const {
    const auto json = parsed("m.json");
    EXPECT_EQ(json["axes"][0]["models"].size(), 1U);
    return json["axes"][0]["models"][0];
  }

  void expect_refused(const std::string& arguments, const std::string& message) {
    testing::expect_refused(run(arguments), message);
  }
};

TEST_F(Memory, IsKeptFromRunToRunListedShownAndForgotten) {
  testing::succeeded(learn(""));
  const Outcome list = run("memory list m.json");
  EXPECT_EQ(list.exit_code, 0) << list.err;
  EXPECT_NE(list.out.find("udot:1"), std::string::npos) << list.out;
  const Outcome show = run("memory show m.json udot:1");
  EXPECT_EQ(show.exit_code, 0) << show.err;
  EXPECT_NE(show.out.find("Recalls"), std::string::npos) << show.out;

  // A second run adds to what is known of the vehicle: it is the same one, so the same model.
  const nlohmann::json first = the_only_model();
  testing::succeeded(learn(""));
  const nlohmann::json second = the_only_model();
  EXPECT_EQ(second["number"], 1);
  EXPECT_GT(first["samples"], 1500);
  EXPECT_NEAR(second["samples"].get<int>(), 2 * first["samples"].get<int>(), 40);

  const Outcome forget = run("memory forget m.json udot:1");
  EXPECT_EQ(forget.exit_code, 0) << forget.err;
  expect_refused("memory show m.json udot:1", "m.json: udot:1: isn't there");
}

TEST_F(Memory, IsOfTheTermsAndOfNoUseToALearnerAlone) {
  testing::succeeded(learn(""));
  EXPECT_NE(run("memory show m.json udot:1").out.find("root mean square"), std::string::npos);
  expect_refused("learn log.csv --set terms=linear --memory m.json", "m.json: terms: are '1; ");
  expect_refused("learn log.csv --set learner=svr --memory m.json", "learner = svr");
}

// As kelpie 1.x wrote them: samples.
TEST_F(Memory, OfVersionOneIsRefusedByASentence) {
  write("m.json", R"({"format": "kelpie-memory", "version": 1, "inputs": ["u", "n"], "units": {},
                      "axes": []})");
  expect_refused("learn log.csv --memory m.json",
                 "m.json: version: 1 holds the samples of past models, as kelpie 1.x wrote them");
}

TEST_F(Memory, ADayLearnedFourTimesTakesOnePlace) {
  for (int day = 0; day < 4; ++day) {
    testing::succeeded(learn(""));
  }
  EXPECT_EQ(the_only_model()["number"], 1);
}

// Both begin without a file, and neither can write one before both have learned. In two folders,
// since what they print goes to one.
TEST_F(Memory, TwoRunsAtOnceLoseNothing) {
  const auto run = [&](const std::string& name) {
    const std::filesystem::path folder = folder_ / name;
    std::filesystem::create_directory(folder);
    return std::async(std::launch::async, [folder] {
      return kelpie_process(folder,
                            "learn ../log.csv --set buffer=60 --set anchors=20 "
                            "--memory ../m.json")
          .exit_code;
    });
  };
  auto lock = std::make_unique<file::FolderLock>(folder_ / "m.json");
  std::future<int> a = run("a");
  std::future<int> b = run("b");
  for (const char* const name : {"a", "b"}) {
    while (!std::filesystem::exists(folder_ / name / "out/learn/model.json")) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }
  lock.reset();
  EXPECT_EQ(a.get(), 0);
  EXPECT_EQ(b.get(), 0);
  const auto json = parsed("m.json");
  ASSERT_EQ(json["axes"][0]["models"].size(), 2U);
  EXPECT_EQ(json["axes"][0]["models"][0]["number"], 1);
  EXPECT_EQ(json["axes"][0]["models"][1]["number"], 2);
}

TEST_F(Memory, BadInputIsRefusedAndNothingLost) {
  expect_refused("memory list m.json", "m.json: cannot be read");
  testing::succeeded(learn(""));
  const std::string before = content("m.json");
  expect_refused("memory show m.json vdot:1", "there are udot:1");
  expect_refused("memory forget m.json udot:9", "there are udot:1");
  expect_refused("learn log.csv --inputs n,u --memory m.json", "m.json: inputs: are 'u, n' there");
  expect_refused("learn log.csv --units u=ft/s --memory m.json --set memory=0",
                 "m.json: udot: holds 1 models; the settings keep 0");
  EXPECT_EQ(content("m.json"), before);
  write("m.json", before.substr(0, before.size() / 2));
  expect_refused("learn log.csv --memory m.json", "m.json: file: is not JSON");
  testing::succeeded(run("learn log.csv --memory none.json --set memory=0"));
  expect_refused("memory list none.json", "the memory holds no models yet");
  expect_refused("memory", "Usage: kelpie memory");
}

}  // namespace
}  // namespace kelpie::memory_test
