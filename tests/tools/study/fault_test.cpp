// SPDX-License-Identifier: Apache-2.0
// The outlier node judged on faults put into the targets of training rows: the rows it is judged on
// are clean. The learner alone. MeasuredFaults prints the table of docs/measured/reproduction.md.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "kelpie/core/random.hpp"
#include "kelpie/motion/term_set.hpp"
#include "kelpie/svr/online_svr.hpp"
#include "log/dataset.hpp"
#include "model/first_scale.hpp"
#include "simulator/scenario_file.hpp"
#include "simulator/simulation.hpp"
#include "study/metrics.hpp"
#include "study/simulated_log.hpp"
#include "study/split.hpp"
#include "study/training_scales.hpp"
#include "support.hpp"
#include "svr/sample_collector.hpp"

namespace kelpie::fault_test {
namespace {

constexpr double kShare = 0.02;

constexpr std::size_t kGrace = 200;  // samples within which a spike should be out of the buffer

struct Faulty {
  double r2 = 0.0;        // on clean rows
  double gone = 0.0;      // share of faults out of the buffer in time
  double rejected = 0.0;  // samples rejected as outliers, of all shown
};

enum class Fault : std::uint8_t { none, spikes, bursts, wrong_sign, stuck };

// Puts faults into about a share of one axis' targets: single spikes of ± 5 standard deviations,
// bursts of ten at + 5, targets with the wrong sign, values that stay for 20 samples.
class FaultMaker {
 public:
  FaultMaker(Fault kind, double share, double sigma) : kind_(kind), share_(share), sigma_(sigma) {}

  double operator()(double y) {
    const double drawn = random_.uniform(0.0, 1.0);
    if (kind_ == Fault::spikes && drawn < share_) {
      return y + (random_.uniform(0.0, 1.0) < 0.5 ? 5.0 : -5.0) * sigma_;
    }
    if (kind_ == Fault::wrong_sign && drawn < share_) {
      return -y;
    }
    const int length = kind_ == Fault::bursts ? 10 : 20;
    if (left_ == 0 && drawn < share_ / length) {
      left_ = length;
      first_ = y;
    }
    if ((kind_ == Fault::bursts || kind_ == Fault::stuck) && left_ > 0) {
      --left_;
      return kind_ == Fault::bursts ? y + 5.0 * sigma_ : first_;
    }
    return y;
  }

 private:
  Fault kind_;
  double share_;
  double sigma_;
  RandomStream random_{11, "faults"};
  int left_ = 0;
  double first_ = 0.0;
};

// Faults of more than two standard deviations are looked for in the buffer.
Faulty with_faults(const log::Dataset& data, const study::Split& split, std::size_t axis,
                   Fault kind) {
  const std::size_t targets = data.target_names.size();
  ModelSettings settings = ModelSettings::from_preset("default", targets);
  settings.assign("learner", "svr");  // whose buffer the faults are to leave
  settings.assign("terms", "fossen");
  settings.assign("warmup", "200");
  const TermSet terms = TermSet::from(settings.shared.terms, data.input_names, targets);
  FirstScale scale(data.input_names.size(), settings.shared, terms, {});
  OnlineSvr learner(data.input_names.size(), settings.axes[axis], terms.size());
  const double sigma =
      study::training_scales(data, split.training, SharedSettings{})[axis].target.scale;
  FaultMaker fault(kind, kShare, sigma);
  std::deque<std::pair<std::size_t, double>> waiting;  // when to look, and for which time stamp
  Faulty result;
  std::size_t shown = 0;
  std::size_t looked = 0;
  std::size_t gone = 0;
  for (const std::size_t row : split.training) {
    const double truth = data.target(row)[axis];
    const double y = ++shown > 300 ? fault(truth) : truth;
    if (std::abs(y - truth) > 2.0 * sigma) {
      waiting.emplace_back(shown + kGrace, data.times_s[row]);
    }
    scale.update(learner, data.input(row), y, data.times_s[row]);
    for (; !waiting.empty() && waiting.front().first <= shown; waiting.pop_front()) {
      const SampleCollector& samples = learner.buffer();
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
    predicted.push_back(scale.predict(learner, data.input(row)));
  }
  const Tally tally = learner.status().tally;
  result.r2 = study::r_squared(truth, predicted);
  result.gone = looked > 0 ? static_cast<double>(gone) / static_cast<double>(looked) : 1.0;
  result.rejected = static_cast<double>(tally.outliers) / static_cast<double>(shown);
  return result;
}

constexpr std::array kFaults{std::pair{Fault::spikes, "spikes"}, std::pair{Fault::bursts, "bursts"},
                             std::pair{Fault::wrong_sign, "wrong sign"},
                             std::pair{Fault::stuck, "stuck"}};

// The first `kinds` of the faults.
void expect_robust(const log::Dataset& data, std::size_t kinds) {
  const study::Split split = study::make_split(data, {});
  for (std::size_t axis = 0; axis < data.target_names.size(); ++axis) {
    const Faulty clean = with_faults(data, split, axis, Fault::none);
    fmt::print("{}: clean R² {:.3f}, {:.2f} % rejected", data.target_names[axis], clean.r2,
               100.0 * clean.rejected);
    EXPECT_LE(clean.rejected, 0.01);
    for (const auto& [kind, name] : std::span(kFaults).first(kinds)) {
      const Faulty faulty = with_faults(data, split, axis, kind);
      fmt::print("; {}: R² {:.3f}, {:.1f} % gone", name, faulty.r2, 100.0 * faulty.gone);
      EXPECT_GE(faulty.r2, clean.r2 - (kind == Fault::stuck ? 0.05 : 0.02)) << name;
      EXPECT_TRUE(kind != Fault::spikes || faulty.gone >= 0.95) << faulty.gone;
    }
    fmt::print("\n");
  }
}

log::Dataset simulated(double duration_s) {
  simulator::Scenario scenario = simulator::read_scenario(std::filesystem::path(KELPIE_SOURCE_DIR) /
                                                          "scenarios" / "paper.toml");
  scenario.phases.resize(1);
  scenario.phases.front().duration_s = duration_s;
  const log::Table table = study::log_table(simulator::simulate(scenario), "simulated");
  return log::make_dataset(table, log::guess_roles(table, {}));
}

TEST(Faults, SpikesLeaveTheBufferAndDoLittleHarm) {
  expect_robust(simulated(3000.0), 1);
}

TEST(MeasuredFaults, LeaveTheBufferAndDoLittleHarmInSimulation) {
  expect_robust(simulated(5000.0), kFaults.size());
}

TEST(MeasuredFaults, LeaveTheBufferAndDoLittleHarmOnTheRealLog) {
  const auto file = testing::data_file("dagon_config1.csv");
  if (file.empty()) {
    GTEST_SKIP() << "the log of AUV Dagon is not here";
  }
  const log::Table table = log::read_csv(file);
  expect_robust(log::make_dataset(table, log::guess_roles(table, {.rate_hz = 4.0})),
                kFaults.size());
}

}  // namespace
}  // namespace kelpie::fault_test
