// SPDX-License-Identifier: Apache-2.0
#include "kelpie/model/online_model.hpp"
#include "model/axis_list.hpp"

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <utility>
#include <vector>

namespace kelpie::online_model_test {
namespace {

struct Alert {
  double since_s = 0.0;
  bool another = false;
  friend bool operator==(const Alert&, const Alert&) = default;
};

// Says of every sample what it was told to say, and remembers the sample and the alerts.
class Scripted final : public OnlineRegressor {
 public:
  explicit Scripted(Decision said) : said_(said) {}

  Decision update(std::span<const double> x, double y, double t) override {
    learned_ = {x[0], y, t};
    alerts_.clear();
    return said_;
  }
  void alert(double since_s, bool another) override { alerts_.push_back({since_s, another}); }
  double predict(std::span<const double> /*x*/) const override { return 0.0; }
  Status status() const override { return {}; }

  const std::array<double, 3>& learned() const { return learned_; }
  const std::vector<Alert>& alerts() const { return alerts_; }

 private:
  Decision said_;
  std::array<double, 3> learned_{};
  std::vector<Alert> alerts_;
};

AxisList list_of(const std::vector<Decision>& decisions) {
  std::vector<std::unique_ptr<OnlineRegressor>> axes;
  axes.reserve(decisions.size());
  for (const Decision& decision : decisions) {
    axes.push_back(std::make_unique<Scripted>(decision));
  }
  return AxisList(std::move(axes));
}

const Scripted& scripted(const OnlineModel& model, std::size_t axis) {
  return dynamic_cast<const Scripted&>(model.axis(axis));
}

TEST(OnlineModel, EveryAxisLearnsItsOwnTargetInTurn) {
  AxisList model = list_of({{.similarity = 0.25}, {.similarity = 0.5}});
  std::vector<std::size_t> done;
  model.update(std::array{7.0}, std::array{1.0, 2.0}, 3.0, [&](std::size_t axis) {
    EXPECT_EQ(model.decisions()[axis].similarity, 0.25 * static_cast<double>(axis + 1));
    done.push_back(axis);
  });
  EXPECT_EQ(done, (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(scripted(model, 0).learned(), (std::array{7.0, 1.0, 3.0}));
  EXPECT_EQ(scripted(model, 1).learned(), (std::array{7.0, 2.0, 3.0}));
}

// Who has found a change itself needs no telling; the others hear of every change that was found,
// of a return as soon as it is found and not again when it is done.
TEST(OnlineModel, AxesThatFindAChangeTellTheOthers) {
  AxisList model = list_of({{.changed = true, .changed_since = 40.0},
                            {},
                            {.changed_since = 50.0, .returning = true},
                            {},
                            {.changed = true, .changed_since = 55.0, .recalled = 3}});
  model.update(std::array{0.0}, std::array{0.0, 0.0, 0.0, 0.0, 0.0}, 60.0);
  EXPECT_TRUE(scripted(model, 0).alerts().empty());
  EXPECT_TRUE(scripted(model, 2).alerts().empty());
  const std::vector<Alert> both{{40.0, true}, {50.0, false}};
  EXPECT_EQ(scripted(model, 1).alerts(), both);
  EXPECT_EQ(scripted(model, 3).alerts(), both);
}

}  // namespace
}  // namespace kelpie::online_model_test
