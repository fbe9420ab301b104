// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace {

struct Outcome {
  int code = -1;
  std::string said;
};

class SimulateCommand : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("kelpie_simulate_" +
               std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string content(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(folder_ / name, std::ios::binary).rdbuf();
    return text.str();
  }

  Outcome simulate(const std::string& arguments) const {
    const std::string command = std::string(KELPIE_COMMAND " simulate ") + arguments + " > " +
                                (folder_ / "said").string() + " 2>&1";
    const int status = std::system(command.c_str());  // NOLINT(cert-env33-c,concurrency-mt-unsafe)
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content("said")};
  }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  const std::string small_ = KELPIE_SOURCE_DIR "/scenarios/small.toml";
  std::filesystem::path folder_;
};

TEST_F(SimulateCommand, SameSeedSameBytesOtherSeedOtherBytes) {
  ASSERT_EQ(simulate(small_ + " --out " + path("a.csv")).code, 0);
  ASSERT_EQ(simulate(small_ + " --seed 1 --out " + path("b.csv")).code, 0);
  ASSERT_EQ(simulate(small_ + " --seed 2 --out " + path("c.csv")).code, 0);
  EXPECT_EQ(content("a.csv"), content("b.csv"));
  EXPECT_NE(content("a.csv"), content("c.csv"));
  const std::string header =
      "t,conf,u,v,r,th1,th2,th3,udot,vdot,rdot,udot_true,vdot_true,rdot_true\n";
  EXPECT_EQ(content("a.csv").substr(0, header.size()), header);
}

TEST_F(SimulateCommand, BadInputEndsWithCode2AndItsPlace) {
  std::ofstream(folder_ / "bad.toml") << "rate_hz = 4.0\nrate_hzz = 4.0\n";
  const Outcome outcome = simulate(path("bad.toml") + " --out " + path("a.csv"));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.said.find("bad.toml:2: rate_hzz: unknown key (did you mean 'rate_hz'?)"),
            std::string::npos)
      << outcome.said;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.csv"));
  EXPECT_EQ(simulate(path("nothing.toml") + " --out " + path("a.csv")).code, 2);
  EXPECT_EQ(simulate(small_).code, 2);
  EXPECT_EQ(simulate(small_ + " --seed -1 --out " + path("a.csv")).code, 2);
}

TEST_F(SimulateCommand, ARunawayEndsWithCode1AndNoFile) {
  std::ofstream(folder_ / "runaway.toml")
      << "vehicle = \"" KELPIE_SOURCE_DIR
         "/vehicles/dagon.toml\"\nrate_hz = 1.0\n"
         "[[configurations]]\nname = \"stiff\"\n"
         "damping_factor = [1e6, 1e6, 1e6, 1e6, 1e6, 1e6]\n"
         "[[phases]]\nconfiguration = \"stiff\"\nduration_s = 100.0\n";
  const Outcome outcome = simulate(path("runaway.toml") + " --out " + path("a.csv"));
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(outcome.said.find("left finite numbers at t = "), std::string::npos) << outcome.said;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.csv"));
}

}  // namespace
