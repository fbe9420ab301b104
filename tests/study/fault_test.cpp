// SPDX-License-Identifier: Apache-2.0
// The outlier node judged on faults put into the targets of training rows: the rows it is judged on
// are clean. Default preset. Prints what it measures.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <deque>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "kelpie/core/random.hpp"
#include "kelpie/data/csv.hpp"
#include "kelpie/data/dataset.hpp"
#include "kelpie/data/split.hpp"
#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/study/metrics.hpp"
#include "kelpie/study/simulated_log.hpp"
#include "kelpie/study/training_scales.hpp"
#include "kelpie/vehicle/scenario_file.hpp"
#include "kelpie/vehicle/simulation.hpp"
#include "support.hpp"

namespace kelpie {
namespace {

constexpr std::size_t kGrace = 200;  // samples within which a spike should be out of the buffer

struct Faulty {
  double r2 = 0.0;        // on clean rows
  double gone = 0.0;      // share of faults out of the buffer in time
  double rejected = 0.0;  // samples rejected as outliers, of all shown
  std::int64_t changes = 0;
};

// Spikes of ± 5 standard deviations of the target on a share of the samples of one axis.
Faulty with_spikes(const Dataset& data, const Split& split, std::size_t axis, double share) {
  DynamicsModel model(data.input_names, data.target_names,
                      ModelSettings::from_preset("default", data.target_names.size()));
  const double sigma = training_scales(data, split.training, SharedSettings{})[axis].target.scale;
  RandomStream random(11, "faults");
  std::deque<std::pair<std::size_t, double>> waiting;  // when to look, and for which time stamp
  Faulty result;
  std::size_t shown = 0;
  std::size_t looked = 0;
  std::size_t gone = 0;
  OnlineRegressor& learner = model.axis(axis);
  const auto& buffer = std::as_const(model).axis(axis).learner();
  for (const std::size_t row : split.training) {
    double y = data.target(row)[axis];
    if (++shown > 300 && random.uniform(0.0, 1.0) < share) {
      y += random.uniform(0.0, 1.0) < 0.5 ? 5.0 * sigma : -5.0 * sigma;
      waiting.emplace_back(shown + kGrace, data.times_s[row]);
    }
    learner.update(data.input(row), y, data.times_s[row]);
    for (; !waiting.empty() && waiting.front().first <= shown; waiting.pop_front()) {
      const SampleCollector& samples = buffer.champion().buffer();
      bool there = false;
      for (std::size_t i = 0; i < samples.size(); ++i) {
        there = there || samples.time(i) == waiting.front().second;
      }
      gone += there ? 0 : 1;
      ++looked;
    }
  }
  std::vector<double> truth;
  std::vector<double> predicted;
  for (const std::size_t row : split.held_out) {
    truth.push_back(data.target(row)[axis]);
    predicted.push_back(learner.predict(data.input(row)));
  }
  const Tally tally = learner.status().tally;
  result.r2 = r_squared(truth, predicted);
  result.gone = looked > 0 ? static_cast<double>(gone) / static_cast<double>(looked) : 1.0;
  result.rejected = static_cast<double>(tally.outliers) / static_cast<double>(shown);
  result.changes = tally.changes;
  return result;
}

void expect_robust(const Dataset& data) {
  const Split split = make_split(data, {});
  for (std::size_t axis = 0; axis < data.target_names.size(); ++axis) {
    const Faulty clean = with_spikes(data, split, axis, 0.0);
    const Faulty spiked = with_spikes(data, split, axis, 0.02);
    fmt::print(
        "{}: clean R² {:.3f}, {:.2f} % rejected; 2 % spikes: R² {:.3f}, {:.1f} % of them gone\n",
        data.target_names[axis], clean.r2, 100.0 * clean.rejected, spiked.r2, 100.0 * spiked.gone);
    EXPECT_LE(clean.rejected, 0.01);
    EXPECT_GE(spiked.gone, 0.95);
    EXPECT_GE(spiked.r2, clean.r2 - 0.02);
    EXPECT_EQ(clean.changes, 0);
    EXPECT_EQ(spiked.changes, 0);
  }
}

TEST(Faults, SpikesLeaveAndDoNoHarmInSimulation) {
  Scenario scenario =
      read_scenario(std::filesystem::path(KELPIE_SOURCE_DIR) / "scenarios" / "paper.toml");
  scenario.phases.resize(1);
  scenario.phases.front().duration_s = 5000.0;
  const Table table = log_table(simulate(scenario), "simulated");
  expect_robust(make_dataset(table, guess_roles(table, {})));
}

TEST(Faults, SpikesLeaveAndDoNoHarmOnTheRealLog) {
  const auto file = testing::data_file("dagon_config1.csv");
  if (file.empty()) {
    GTEST_SKIP() << "the log of AUV Dagon is not here";
  }
  const Table table = read_csv(file);
  expect_robust(make_dataset(table, guess_roles(table, {.rate_hz = 4.0})));
}

}  // namespace
}  // namespace kelpie
