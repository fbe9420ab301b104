// SPDX-License-Identifier: Apache-2.0
// A stream that is gone on with finds what it would have found in one go.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "kelpie/core/error.hpp"
#include "kelpie/model/dynamics_model.hpp"
#include "study/result_fields.hpp"
#include "study/small_log.hpp"
#include "study/split.hpp"
#include "study/stream.hpp"
#include "support.hpp"

namespace kelpie::resume_test {
namespace {

// Two configurations, the second of which does something else.
log::Dataset switched_log() {
  log::Dataset data = testing::small_log(900, 2);
  for (std::size_t row = 450; row < 900; ++row) {
    data.configurations[row] = 1;
    data.targets[2 * row] *= -1.0;
  }
  return data;
}

struct Saved {
  std::string model;
  std::string stream;
};

class ResumeStream : public ::testing::Test {
 protected:
  DynamicsModel fresh() const {
    return {data_.input_names, data_.target_names, testing::small_settings(2, "60")};
  }

  study::StreamResult run(DynamicsModel& model, study::StreamOptions options) {
    options.save = [&](std::size_t shown, const std::string& stream) {
      saved_[shown] = {model.save(), stream};
    };
    return study::run_stream(data_, split_, model, options);
  }

  study::StreamResult go_on(const Saved& from) {
    DynamicsModel model = DynamicsModel::resume(fresh(), from.model);
    return run(model, {.validate_every = 70, .also_at = {33, 500}, .resume = from.stream});
  }

  log::Dataset data_ = switched_log();
  study::Split split_ =
      study::make_split(data_, {.kind = study::SplitKind::blocks, .block_rows = 40});
  std::map<std::size_t, Saved> saved_;
};

bool same(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

// All but the times of updates.
void expect_same(const study::StreamResult& a, const study::StreamResult& b) {
  EXPECT_EQ(a.samples_shown, b.samples_shown);
  EXPECT_EQ(a.interrupted, b.interrupted);
  ASSERT_EQ(a.axes.size(), b.axes.size());
  for (std::size_t i = 0; i < a.axes.size(); ++i) {
    const study::AxisResult& x = a.axes[i];
    const study::AxisResult& y = b.axes[i];
    ASSERT_EQ(x.validation.size(), y.validation.size());
    for (std::size_t k = 0; k < x.validation.size(); ++k) {
      EXPECT_EQ(x.validation[k].samples, y.validation[k].samples);
      EXPECT_EQ(x.validation[k].time_s, y.validation[k].time_s);
      EXPECT_TRUE(same(x.validation[k].r2, y.validation[k].r2)) << k;
      EXPECT_EQ(x.validation[k].configuration, y.validation[k].configuration);
      EXPECT_EQ(x.validation[k].status.tally.accepted, y.validation[k].status.tally.accepted);
      EXPECT_EQ(x.validation[k].coefficients, y.validation[k].coefficients);
      EXPECT_TRUE(std::ranges::equal(x.validation[k].errors, y.validation[k].errors, same));
    }
    ASSERT_EQ(x.stages.size(), y.stages.size());
    for (std::size_t k = 0; k < x.stages.size(); ++k) {
      EXPECT_EQ(x.stages[k].samples, y.stages[k].samples);
      EXPECT_EQ(x.stages[k].predicted, y.stages[k].predicted);
      EXPECT_EQ(x.stages[k].truth, y.stages[k].truth);
    }
    EXPECT_EQ(x.changes.size(), y.changes.size());
    ASSERT_EQ(x.outliers.size(), y.outliers.size());
    for (std::size_t k = 0; k < x.outliers.size(); ++k) {
      EXPECT_EQ(x.outliers[k].samples, y.outliers[k].samples);
      EXPECT_EQ(x.outliers[k].target, y.outliers[k].target);
    }
    EXPECT_EQ(x.update_us.size(), y.update_us.size());
    EXPECT_EQ(x.held_out_predicted, y.held_out_predicted);
    EXPECT_TRUE(same(x.prequential_r2, y.prequential_r2));
    EXPECT_EQ(x.corrected.predicted, y.corrected.predicted);
    EXPECT_EQ(x.corrected_coverage.samples, y.corrected_coverage.samples);
    EXPECT_TRUE(same(x.r2_mean, y.r2_mean));
    EXPECT_EQ(x.status.tally.forgotten, y.status.tally.forgotten);
  }
}

TEST_F(ResumeStream, FromAnywhereTheResultIsThatOfOneGo) {
  DynamicsModel model = fresh();
  const study::StreamResult whole =
      run(model, {.validate_every = 70, .also_at = {33, 500}, .save_every = 45});
  const std::map<std::size_t, Saved> saved = saved_;
  EXPECT_EQ(saved.size(), (split_.training.size() + 44) / 45);
  EXPECT_EQ(saved.rbegin()->first, split_.training.size());
  for (const auto& [shown, state] : saved) {
    if (shown % 2 == 1 || shown == split_.training.size()) {
      SCOPED_TRACE(shown);
      expect_same(go_on(state), whole);
    }
  }
}

// Where a stream was stopped it judged once more; going on forgets that.
TEST_F(ResumeStream, AfterAStopTheResultIsThatOfOneGo) {
  DynamicsModel model = fresh();
  const study::StreamResult whole = run(model, {.validate_every = 70, .also_at = {33, 500}});
  EXPECT_TRUE(saved_.empty());
  DynamicsModel stopped = fresh();
  const study::StreamResult part =
      run(stopped, {.validate_every = 70,
                    .also_at = {33, 500},
                    .keep_going = [](std::size_t shown) { return shown < 333; },
                    .save_every = 1'000'000});
  EXPECT_TRUE(part.interrupted);
  ASSERT_EQ(saved_.size(), 1U);
  expect_same(go_on(saved_.at(333)), whole);
}

TEST_F(ResumeStream, AStateThatDoesNotFitIsRefused) {
  DynamicsModel model = fresh();
  run(model, {.save_every = 200, .save = {}});
  const Saved saved = saved_.at(400);
  for (std::size_t size = 1; size < saved.stream.size(); size += 97) {
    EXPECT_THROW(go_on({saved.model, saved.stream.substr(0, size)}), InputError) << size;
  }
  EXPECT_THROW(go_on({saved.model, saved.stream + "x"}), InputError);
  std::string older = saved.stream;
  older.replace(older.find(study::kStreamVersion), 1, "0");
  EXPECT_EQ(testing::message_of<InputError>([&] {
              go_on({saved.model, older});
            }),
            "stream version: is '0' in what was saved, '1' here");
  split_.training.resize(300);
  EXPECT_THROW(go_on(saved), InputError);
}

}  // namespace
}  // namespace kelpie::resume_test
