// SPDX-License-Identifier: Apache-2.0
// Programs in C and Python ask a library of `kelpie export --live` while `kelpie live` learns.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <memory>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "cli/running.hpp"
#include "console/live_command.hpp"
#include "support.hpp"

namespace kelpie::live_block_test {
namespace {

using testing::LiveCommand;
using testing::Outcome;
using testing::Running;
using testing::succeeded;

class LiveBlock : public LiveCommand {
 protected:
  // A model of the first rows, and the library of the export.
  void export_library() {
    write("dive.csv", testing::little_log(2000));
    write("first.csv", testing::little_log(400));
    succeeded(run("learn first.csv --split none --align none --out first"));
    succeeded(run("export first/model.json --live vehicle.so"));
  }

  // How many publications a host has met.
  std::size_t publications(const std::string& host) const {
    const std::string said = content(host);
    std::smatch found;
    EXPECT_TRUE(std::regex_search(said, found, std::regex("publications ([0-9]+), median")))
        << said << content(host + ".err");
    return found.empty() ? 0 : std::stoul(found[1]);
  }

  int shell(const std::string& command) const {
    return std::system(  // NOLINT(concurrency-mt-unsafe): the test's own
        ("cd '" + folder_.path().string() + "' || exit 1; " + command).c_str());
  }
};

// What the library says at the row of a log, of one target.
double said_by(const std::string& library, const std::vector<double>& x) {
  const std::unique_ptr<void, int (*)(void*)> loaded(dlopen(library.c_str(), RTLD_NOW), &dlclose);
  if (!loaded) {
    ADD_FAILURE() << dlerror();  // NOLINT(concurrency-mt-unsafe): one thread
    return std::nan("");
  }
  double y = 0.0;
  using Predict = void (*)(const double*, double*);
  reinterpret_cast<Predict>(  // NOLINT: how dlsym is used
      dlsym(loaded.get(), "kelpie_model_predict"))(x.data(), &y);
  return y;
}

TEST_F(LiveBlock, HostsInCAndPythonFollowTheLearnerToItsLastModel) {
  export_library();
  const std::string examples = KELPIE_SOURCE_DIR "/examples/12_live_host";
  ASSERT_EQ(shell(KELPIE_C_COMPILER " -std=c99 -Wall -Wextra -Werror -O1 " + examples +
                  ".c -o host -ldl"),
            0);
  if (shell("./host >host.out 2>&1; [ $? -ne 126 ]") != 0) {
    GTEST_SKIP() << "this machine runs programs of the build in an emulator alone";
  }
  write("x.toml", "[live]\nalign = \"none\"\nblock = \"vehicle.block\"\n");
  Running live(folder_.path(), {"live", "--replay", "dive.csv", "--speed", "40", "--config",
                                "x.toml", "--out", "out"});
  ASSERT_TRUE(live.wait_for_text("a model is in service")) << live.terminal_text();
  ASSERT_EQ(shell("(./host ./vehicle.so 2 >c 2>c.err) & python3 " + examples +
                  ".py ./vehicle.so 2 >py 2>py.err; wait"),
            0);
  EXPECT_GT(publications("c"), 20U);
  EXPECT_GT(publications("py"), 20U);
  EXPECT_NE(content("c").find("failed 0"), std::string::npos) << content("c");
  ASSERT_EQ(live.exit_code(), 0) << live.terminal_text();
  write("row.csv", "t,u,n,udot\n0,0.3,2,0\n0.1,0.31,2,0\n");
  const Outcome told = succeeded(run("predict row.csv --model out/model.json --out told.csv"));
  std::istringstream lines(content("told.csv"));
  std::string line;
  std::getline(lines, line);
  std::getline(lines, line);
  for (int column = 0; column < 4; ++column) {
    line.erase(0, line.find(',') + 1);  // t, u, n, udot
  }
  const double predicted = std::stod(line);
  EXPECT_NEAR(said_by((folder_ / "vehicle.so").string(), {0.3, 2.0}), predicted, 1e-9) << line;
}

TEST_F(LiveBlock, IsRefusedWhereItIsNotTheModels) {
  export_library();
  const std::string live = "--replay dive.csv --speed max --out refused ";
  expect_refused(live + "--block none.block", "none.block: cannot be opened to be renewed");
  expect_refused(live + "--block dive.csv", "dive.csv: block: is no block of this version");
  expect_refused(live + "--block vehicle.block --inputs u",
                 "vehicle.block: block: belongs to a model with other inputs, targets or terms");
  expect_refused(live + "--block vehicle.block --set buffer=1000",
                 "the settings of the learner allow");
}

}  // namespace
}  // namespace kelpie::live_block_test
