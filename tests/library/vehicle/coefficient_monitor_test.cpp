// SPDX-License-Identifier: Apache-2.0
#include "vehicle/coefficient_monitor.hpp"

#include <gtest/gtest.h>

#include <array>

#include "kelpie/core/random.hpp"

namespace kelpie::coefficient_monitor_test {
namespace {

// Blocks of a vehicle of one axis and one thruster.
class Blocks {
 public:
  void show(double seconds, double rate_hz) {
    for (const double end_s = t_ + seconds; t_ < end_s;) {
      NormalEquations block(monitor.terms().size(), 1);
      const double start_s = t_;
      std::vector<double> phi(monitor.terms().size());
      double last_s = t_;
      while (block.rows() < 6.0 || last_s - start_s < 2.25) {
        const std::array x{random_.uniform(-1.0, 1.0), random_.uniform(-1.0, 1.0)};
        monitor.terms().evaluate(x, phi);
        block.add(phi, std::array{x[1] - x[0] + 0.01 * random_.normal()});
        last_s = t_;
        t_ += 1.0 / rate_hz;
      }
      monitor.insert(block, start_s, last_s, start_s);
      while (monitor.step()) {
      }
    }
  }
  void pause(double seconds) { t_ += seconds; }

  CoefficientMonitor monitor{2, std::array{std::size_t{0}}, {0}, {}, {}};

 private:
  RandomStream random_{1, "blocks"};
  double t_ = 0.0;
};

// The reference forgets within an hour, at whatever rate rows came before.
TEST(CoefficientMonitor, AFastStretchDoesNotLengthenTheMemory) {
  Blocks blocks;
  blocks.show(900.0, 50.0);
  blocks.show(7200.0, 4.0);
  EXPECT_LT(blocks.monitor.reference().rows(), 1.1 * 3600.0 * 4.0);
}

TEST(CoefficientMonitor, APauseDoesNotShortenTheMemory) {
  Blocks blocks;
  blocks.show(4000.0, 4.0);
  for (int dive = 0; dive < 20; ++dive) {
    blocks.pause(3600.0);
    blocks.show(300.0, 4.0);
  }
  EXPECT_GT(blocks.monitor.reference().rows(), 0.9 * 3600.0 * 4.0);
}

}  // namespace
}  // namespace kelpie::coefficient_monitor_test
