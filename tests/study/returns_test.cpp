// SPDX-License-Identifier: Apache-2.0
// The simulated vehicle that changes and returns (scenarios/returns.toml, A→B→A→C→B): how good the
// model is some samples after a hidden switch. Prints the table of docs/memory.md.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "kelpie/data/dataset.hpp"
#include "kelpie/data/split.hpp"
#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/study/metrics.hpp"
#include "kelpie/study/simulated_log.hpp"
#include "kelpie/vehicle/scenario_file.hpp"

namespace kelpie::returns_test {
namespace {

constexpr std::array<std::size_t, 4> kAfter{0, 25, 50, 200};  // samples after a switch

// R² around one switch to a configuration.
struct Arrival {
  int configuration = 0;
  double level = 0.0;  ///< when it was last left; 0: it is met for the first time
  std::array<double, kAfter.size()> r2{};
  std::vector<std::int64_t> recalled;
};

class Journey {
 public:
  Journey(const Dataset& data, const Split& split, std::size_t axis, DynamicsModel& model)
      : data_(data), split_(split), axis_(axis), learner_(model.axis(axis)) {}

  std::vector<Arrival> run() {
    std::vector<Arrival> arrivals;
    std::map<int, double> levels;
    std::size_t since = 0;
    int running = data_.configurations[split_.training.front()];
    for (const std::size_t row : split_.training) {
      const int configuration = data_.configurations[row];
      if (configuration != running) {
        levels[running] = r2(running);
        arrivals.push_back({.configuration = configuration, .level = levels[configuration]});
        running = configuration;
        since = 0;
      }
      for (std::size_t k = 0; k < kAfter.size() && !arrivals.empty(); ++k) {
        if (since == kAfter[k]) {
          arrivals.back().r2[k] = r2(running);
        }
      }
      const Decision decision =
          learner_.update(data_.input(row), data_.target(row)[axis_], data_.times_s[row]);
      if (decision.recalled > 0 && !arrivals.empty()) {
        arrivals.back().recalled.push_back(decision.recalled);
      }
      ++since;
    }
    return arrivals;
  }

 private:
  double r2(int configuration) const {
    std::vector<double> truth;
    std::vector<double> predicted;
    for (const std::size_t row : split_.held_out) {
      if (data_.configurations[row] == configuration) {
        truth.push_back(data_.target(row)[axis_]);
        predicted.push_back(learner_.predict(data_.input(row)));
      }
    }
    return r_squared(truth, predicted);
  }

  const Dataset& data_;
  const Split& split_;
  std::size_t axis_;
  OnlineRegressor& learner_;
};

TEST(Returns, AKnownVehicleIsKnownAgainInFiftySamples) {
  const Scenario scenario =
      read_scenario(std::filesystem::path(KELPIE_SOURCE_DIR) / "scenarios" / "returns.toml");
  const Table table = log_table(simulate(scenario), "simulated");
  const Dataset data = make_dataset(table, guess_roles(table, {}));
  const Split split = make_split(data, {.kind = SplitKind::random});
  DynamicsModel model(data.input_names, data.target_names,
                      ModelSettings::from_preset("default", 3));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const bool sway = axis == 1;  // it feels the load little: docs/memory.md
    for (const Arrival& arrival : Journey(data, split, axis, model).run()) {
      fmt::print("{:5} to {}: level {:.4f}, then {:.4f} {:.4f} {:.4f} {:.4f}; recalled {}\n",
                 data.target_names[axis], arrival.configuration, arrival.level, arrival.r2[0],
                 arrival.r2[1], arrival.r2[2], arrival.r2[3],
                 arrival.recalled.empty() ? 0 : arrival.recalled.front());
      const bool known = arrival.level > 0.0;
      EXPECT_TRUE(known || arrival.recalled.empty()) << "a new vehicle was taken for a known one";
      EXPECT_TRUE(!known || sway || arrival.r2[2] >= arrival.level - 0.02);
    }
  }
}

// Bio-fouling comes on slowly.
TEST(Returns, GradualDriftRecallsNothing) {
  const Scenario scenario =
      read_scenario(std::filesystem::path(KELPIE_SOURCE_DIR) / "scenarios" / "biofouling.toml");
  const Table table = log_table(simulate(scenario), "simulated");
  const Dataset data = make_dataset(table, guess_roles(table, {}));
  DynamicsModel model(data.input_names, data.target_names,
                      ModelSettings::from_preset("default", 3));
  for (std::size_t row = 0; row < data.rows(); ++row) {
    model.update(data.input(row), data.target(row), data.times_s[row]);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(model.axis(axis).status().tally.recalls, 0) << data.target_names[axis];
  }
}

}  // namespace
}  // namespace kelpie::returns_test
