// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "learner/committee.hpp"
#include "learner/learner_state.hpp"
#include "learner/streams.hpp"

namespace kelpie::states_test {
namespace {

using testing::Sample;
using testing::settings_for_plants;
using testing::wandering_stream;
using Comparison = LearnerState::Comparison;
using Task = AdaptiveSvr::SliceTask;
using Past = PastModels::State;

/// A row of the table of modes in docs/reference/architecture.md.
struct Mode {
  std::string name;
  Comparison comparison;
  Task task;
  std::set<Past> past_models;
  std::set<bool> relearning;
};

const std::set<Past> kAny{Past::settling, Past::watching, Past::on_trial};
const std::set<bool> kPossible{false, true};
const std::vector<Mode> kModes{
    {"watch", Comparison::none, Task::none, kAny, kPossible},
    {"challenge", Comparison::challenger, Task::none, kAny, kPossible},
    {"probation", Comparison::probation, Task::none, kAny, kPossible},
    {"recall", Comparison::none, Task::recall, {Past::on_trial}, kPossible},
    {"rescale", Comparison::none, Task::rescale, kAny, {false}},
    {"catch up", Comparison::none, Task::catch_up, kAny, {false}},
    {"follow", Comparison::none, Task::follow, kAny, kPossible},
};

/// The table of events there.
const std::set<std::pair<std::string, std::string>> kEvents{
    {"watch", "challenge"},   {"challenge", "probation"}, {"challenge", "watch"},
    {"probation", "watch"},   {"watch", "recall"},        {"challenge", "recall"},
    {"probation", "recall"},  {"recall", "probation"},    {"watch", "rescale"},
    {"challenge", "rescale"}, {"probation", "rescale"},   {"rescale", "catch up"},
    {"catch up", "follow"},   {"follow", "watch"},
};

const SampleMap kOther = [](std::span<double> x, double& y) {
  for (double& value : x) {
    value *= 0.9;
  }
  y = 0.8 * y + 0.05;
};

/// A committee on a voyage, each of whose states has to be a row of the table.
class Voyage {
 public:
  Voyage() : committee_(2, 0, settings_for_plants(), {}) { inspect(); }

  /// Samples of one of the vehicles, from where the last ones ended.
  void drive(int plant, std::size_t samples) {
    for (Sample& sample : wandering_stream(seed_++, samples, 0.02, plant, time_s_)) {
      if (scaling_) {
        const RescaleStatus status = committee_.rescale(kOther);
        switched_ = switched_ || status == RescaleStatus::switched;
        scaling_ = status != RescaleStatus::done;
        inspect();
      }
      if (switched_) {
        kOther(sample.z, sample.y);
      }
      const Decision decision = committee_.update(sample.z, sample.y, sample.t);
      changes_ += decision.changed ? 1 : 0;
      recalls_ += decision.recalled > 0 ? 1 : 0;
      withdrawn_ += decision.withdrawn ? 1 : 0;
      time_s_ = sample.t + 0.25;
      inspect();
    }
  }

  /// Another axis reports the return of a past model.
  void alert() {
    committee_.alert(time_s_, false);
    inspect();
  }

  void start_rescale() { scaling_ = true; }

  LearnerState state() const { return state_of(committee_); }
  bool rescaled() const { return switched_ && !scaling_; }
  int changes() const { return changes_; }
  int recalls() const { return recalls_; }
  int withdrawn() const { return withdrawn_; }
  const std::set<std::string>& modes() const { return modes_; }
  const std::set<std::pair<std::string, std::string>>& events() const { return events_; }
  const std::set<Past>& past_models() const { return past_models_; }
  const std::set<bool>& relearning() const { return relearning_; }

 private:
  void inspect() {
    const LearnerState state = state_of(committee_);
    const auto row = std::ranges::find_if(kModes, [&](const Mode& mode) {
      return mode.comparison == state.comparison && mode.task == state.task &&
             mode.past_models.contains(state.past_models) &&
             mode.relearning.contains(state.relearning);
    });
    ASSERT_NE(row, kModes.end()) << "at " << time_s_ << " s: comparison "
                                 << static_cast<int>(state.comparison) << ", task "
                                 << static_cast<int>(state.task) << ", past models "
                                 << static_cast<int>(state.past_models) << ", relearning "
                                 << state.relearning;
    if (!mode_.empty() && mode_ != row->name) {
      EXPECT_TRUE(kEvents.contains({mode_, row->name})) << mode_ << " to " << row->name;
      events_.insert({mode_, row->name});
    }
    mode_ = row->name;
    modes_.insert(mode_);
    past_models_.insert(state.past_models);
    relearning_.insert(state.relearning);
  }

  Committee committee_;
  std::uint64_t seed_ = 1;
  double time_s_ = 0.0;
  bool scaling_ = false;
  bool switched_ = false;
  int changes_ = 0;
  int recalls_ = 0;
  int withdrawn_ = 0;
  std::string mode_;
  std::set<std::string> modes_;
  std::set<std::pair<std::string, std::string>> events_;
  std::set<Past> past_models_;
  std::set<bool> relearning_;
};

TEST(States, EveryModeOfTheTableOccursAndNoOther) {
  Voyage voyage;
  voyage.drive(0, 1000);
  EXPECT_EQ(voyage.state(), (LearnerState{.past_models = Past::watching}));

  voyage.drive(1, 300);  // an unknown vehicle
  EXPECT_EQ(voyage.changes(), 1);
  voyage.drive(1, 900);
  EXPECT_EQ(voyage.state(), (LearnerState{.past_models = Past::watching}));

  voyage.drive(0, 300);  // the first vehicle returns
  EXPECT_EQ(voyage.recalls(), 1);

  voyage.drive(0, 700);
  voyage.start_rescale();
  voyage.drive(0, 300);
  EXPECT_TRUE(voyage.rescaled());

  voyage.drive(2, 300);  // a third vehicle, by a false alert taken for a known one
  EXPECT_EQ(voyage.changes(), 3);
  voyage.alert();
  voyage.drive(0, 40);
  EXPECT_EQ(voyage.recalls(), 2);
  voyage.drive(2, 300);
  EXPECT_EQ(voyage.withdrawn(), 1);

  for (const Mode& mode : kModes) {
    EXPECT_TRUE(voyage.modes().contains(mode.name)) << mode.name;
  }
  EXPECT_EQ(voyage.past_models(), kAny);
  EXPECT_EQ(voyage.relearning(), kPossible);
}

}  // namespace
}  // namespace kelpie::states_test
