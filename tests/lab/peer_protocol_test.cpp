// SPDX-License-Identifier: Apache-2.0
#include "lab/published_protocol.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <string>

#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"
#include "support.hpp"

namespace kelpie::peer_protocol_test {
namespace {

const auto kGoOn = [](std::size_t) { return true; };

// 3,000 rows of each configuration, every fifth held out; the second has another drag.
std::string stream(int first, int second) {
  RandomStream random(1, "peer");
  std::string text = "conf,split,u,v,r,n1,n2,n3,du,dv,dr\n";
  for (int row = 0; row < 6000; ++row) {
    std::array<double, 6> x{};
    for (double& value : x) {
      value = random.normal();
    }
    const int conf = row < 3000 ? first : second;
    const double du = 0.3 * x[3] - (conf == 0 ? 1.0 : 2.0) * x[0];
    text += std::to_string(conf) + (row % 5 == 4 ? ",1" : ",0");
    for (const double value : x) {
      text += "," + std::to_string(value);
    }
    text += "," + std::to_string(du) + ",0,0\n";
  }
  return text;
}

class Peers : public ::testing::Test {
 protected:
  lab::PeerRun run(const std::string& text) {
    std::ofstream(folder_ / "unmodelled.csv") << text;
    return lab::run_peer(folder_ / "unmodelled.csv", lab::rls_contender("rls", 0.999), kGoOn);
  }
  testing::TemporaryFolder folder_;
};

TEST_F(Peers, JudgesAtEveryMarkOnTheConfigurationRunning) {
  const lab::PeerRun result = run(stream(0, 1));
  EXPECT_EQ(result.stream, "unmodelled");
  // Plain physics: learned before the switch, and forgotten at the rate of λ after it.
  EXPECT_GT(result.r2[0], 0.98);
  EXPECT_GT(result.r2[1], 0.98);
  EXPECT_LT(result.r2[2], result.r2[3]);
  EXPECT_LT(result.r2[3], result.r2[4]);
  EXPECT_GT(result.r2[5], 0.95);
}

TEST_F(Peers, RefusesAStreamWithoutASwitchOrWithHoles) {
  const auto message = [&](const std::string& text) {
    return testing::message_of<InputError>([&] { run(text); });
  };
  EXPECT_NE(message(stream(0, 0)).find("conf: has to begin with configuration 0"),
            std::string::npos);
  EXPECT_NE(message(stream(1, 0)).find("conf: has to begin"), std::string::npos);
  std::string holes = stream(0, 1);
  holes.insert(holes.find('\n') + 1, "0,0,nan,0,0,0,0,0,0,0,0\n");
  EXPECT_NE(message(holes).find("NaN"), std::string::npos);
  EXPECT_NE(message("conf,u,v,r,n1,n2,n3,du\n0,1,2,3,4,5,6,7\n0,2,1,4,3,6,5,8\n").find("split"),
            std::string::npos);
}

}  // namespace
}  // namespace kelpie::peer_protocol_test
