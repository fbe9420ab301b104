// SPDX-License-Identifier: Apache-2.0
// The interface for C says what the class says, and fails with a code and a message.
#include "kelpie/kelpie.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "allocation_count.hpp"
#include "kelpie/model/dynamics_model.hpp"

namespace kelpie::c_test {
namespace {

constexpr std::array kInputs{"u", "r", "n1", "n2"};
constexpr std::array kTargets{"udot", "rdot"};
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

using Model = std::unique_ptr<kelpie_model, decltype(&kelpie_free)>;

Model made(const char* settings = "buffer = 60\nterms = u; n1*|n1|\n") {
  kelpie_model* model = nullptr;
  EXPECT_EQ(kelpie_create(kInputs.data(), 4, kTargets.data(), 2, settings, &model), KELPIE_OK)
      << kelpie_last_error();
  return {model, kelpie_free};
}

DynamicsModel the_class() {
  ModelSettings settings = ModelSettings::from_preset("default", 2);
  settings.assign("buffer", "60");
  settings.assign("terms", "u; n1*|n1|");
  return {{kInputs.begin(), kInputs.end()}, {kTargets.begin(), kTargets.end()}, settings};
}

struct Sample {
  std::array<double, 4> x;
  std::array<double, 2> y;
  double t;
};

Sample sample(int i) {
  const double t = 0.1 * i;
  const std::array x{std::sin(0.31 * t), 0.4 * std::sin(0.7 * t), 5.0 * std::sin(0.2 * t + 1.0),
                     5.0 * std::cos(0.53 * t)};
  return {
      x, {0.01 * x[2] * std::abs(x[2]) - 0.4 * x[0], 0.02 * (x[2] - x[3]) - 0.3 * x[1] * x[0]}, t};
}

void learn(kelpie_model* model, int from, int to) {
  for (int i = from; i < to; ++i) {
    const Sample s = sample(i);
    ASSERT_EQ(kelpie_update(model, s.x.data(), 4, s.y.data(), 2, s.t, nullptr), KELPIE_OK);
  }
}

std::string saved(const kelpie_model* model) {
  unsigned char* bytes = nullptr;
  std::size_t size = 0;
  EXPECT_EQ(kelpie_save(model, &bytes, &size), KELPIE_OK);
  std::string copy(bytes, bytes + size);
  kelpie_free_bytes(bytes);
  return copy;
}

kelpie_status load(const std::string& bytes, kelpie_model** model) {
  return kelpie_load(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), model);
}

TEST(InC, ItSaysWhatTheClassSays) {
  const Model in_c = made();
  DynamicsModel model = the_class();
  for (int i = 0; i < 400; ++i) {
    const Sample s = sample(i);
    std::array<kelpie_decision, 2> decisions;
    ASSERT_EQ(kelpie_update(in_c.get(), s.x.data(), 4, s.y.data(), 2, s.t, decisions.data()),
              KELPIE_OK);
    model.update(s.x, s.y, s.t);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      ASSERT_EQ(decisions[axis].predicted, model.decisions()[axis].prediction.value) << i;
      ASSERT_EQ(decisions[axis].verdict, static_cast<int>(model.decisions()[axis].verdict)) << i;
      ASSERT_EQ(decisions[axis].lower, model.decisions()[axis].prediction.lower) << i;
    }
    ASSERT_EQ(kelpie_ready(in_c.get()) == 1, model.ready());
  }
  const Sample s = sample(1000);
  std::array<double, 2> y{};
  std::array<double, 2> expected{};
  std::array<double, 8> jacobian{};
  std::array<double, 8> slopes{};
  ASSERT_EQ(kelpie_predict(in_c.get(), s.x.data(), 4, y.data(), 2), KELPIE_OK);
  model.predict(s.x, expected);
  EXPECT_EQ(y, expected);
  ASSERT_EQ(kelpie_predict_with_jacobian(in_c.get(), s.x.data(), 4, y.data(), 2, jacobian.data()),
            KELPIE_OK);
  model.predict_with_jacobian(s.x, expected, slopes);
  EXPECT_EQ(jacobian, slopes);
  std::array<kelpie_prediction, 2> assessed{};
  std::array<Prediction, 2> predictions;
  ASSERT_EQ(kelpie_assess(in_c.get(), s.x.data(), 4, assessed.data(), 2, 0.3), KELPIE_OK);
  model.predict(s.x, predictions, 0.3);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    EXPECT_EQ(assessed[axis].value, predictions[axis].value);
    EXPECT_EQ(assessed[axis].lower, predictions[axis].lower);
    EXPECT_EQ(assessed[axis].upper, predictions[axis].upper);
    EXPECT_EQ(assessed[axis].novelty, predictions[axis].novelty);
    EXPECT_EQ(assessed[axis].disturbance, predictions[axis].disturbance);
    EXPECT_EQ(assessed[axis].corrected_lower, predictions[axis].corrected_lower);
    EXPECT_EQ(assessed[axis].corrected_upper, predictions[axis].corrected_upper);
  }
}

TEST(InC, ALoadedModelGoesOnAsIfItHadNeverStopped) {
  const Model never_stopped = made();
  learn(never_stopped.get(), 0, 300);
  const std::string bytes = saved(never_stopped.get());
  kelpie_model* loaded = nullptr;
  ASSERT_EQ(load(bytes, &loaded), KELPIE_OK) << kelpie_last_error();
  const Model resumed(loaded, kelpie_free);
  EXPECT_EQ(kelpie_input_count(loaded), 4U);
  EXPECT_STREQ(kelpie_input_name(loaded, 3), "n2");
  EXPECT_EQ(kelpie_target_count(loaded), 2U);
  EXPECT_STREQ(kelpie_target_name(loaded, 1), "rdot");
  EXPECT_EQ(kelpie_target_name(loaded, 2), nullptr);
  learn(never_stopped.get(), 300, 400);
  learn(loaded, 300, 400);
  EXPECT_EQ(saved(loaded), saved(never_stopped.get()));
}

TEST(InC, BytesThatArentWholeAreRefused) {
  const Model model = made();
  learn(model.get(), 0, 120);
  const std::string bytes = saved(model.get());
  kelpie_model* loaded = nullptr;
  for (std::size_t size = 0; size < bytes.size(); size = size < 800 ? size + 1 : 2 * size) {
    ASSERT_EQ(load(bytes.substr(0, size), &loaded), KELPIE_BAD_INPUT) << size;
  }
  EXPECT_EQ(load(bytes + "x", &loaded), KELPIE_BAD_INPUT);
  std::string flipped = bytes;
  flipped[bytes.size() - 5] ^= 1;
  EXPECT_EQ(load(flipped, &loaded), KELPIE_BAD_INPUT);
  EXPECT_STREQ(kelpie_last_error(), "bytes: are damaged: their checksum doesn't fit");
  EXPECT_EQ(loaded, nullptr);
}

TEST(InC, WrongCallsAreToldWhatIsWrong) {
  kelpie_model* model = nullptr;
  const auto create = [&](const char* settings) {
    return kelpie_create(kInputs.data(), 4, kTargets.data(), 2, settings, &model);
  };
  EXPECT_EQ(create("bufer = 60"), KELPIE_BAD_INPUT);
  EXPECT_NE(std::string(kelpie_last_error()).find("buffer"), std::string::npos);
  EXPECT_EQ(create("buffer"), KELPIE_BAD_INPUT);
  EXPECT_STREQ(kelpie_last_error(), "settings: 'buffer' is no line 'name = value'");
  const std::array<const char*, 65> few{"a", "b"};  // told of more names than there are
  EXPECT_EQ(kelpie_create(kInputs.data(), 4, few.data(), 65, nullptr, &model), KELPIE_BAD_INPUT);
  EXPECT_STREQ(kelpie_last_error(), "targets: 65 given; a model takes at most 64");
  EXPECT_EQ(kelpie_create(few.data(), 65, kTargets.data(), 2, nullptr, &model), KELPIE_BAD_INPUT);
  EXPECT_STREQ(kelpie_last_error(), "inputs: 65 given; a model takes at most 64");
  EXPECT_EQ(kelpie_create(nullptr, 4, kTargets.data(), 2, nullptr, &model), KELPIE_BAD_INPUT);
  EXPECT_EQ(model, nullptr);

  const Model good = made();
  const Sample s = sample(0);
  std::array<double, 2> y{7.0, 7.0};
  EXPECT_EQ(kelpie_predict(good.get(), s.x.data(), 3, y.data(), 2), KELPIE_BAD_INPUT);
  EXPECT_STREQ(kelpie_last_error(), "x: has 3 values; it has to have 4");
  EXPECT_EQ(y[0], 7.0);
  EXPECT_EQ(kelpie_update(good.get(), s.x.data(), 4, s.y.data(), 1, 0.0, nullptr),
            KELPIE_BAD_INPUT);
  EXPECT_EQ(kelpie_update(nullptr, s.x.data(), 4, s.y.data(), 2, 0.0, nullptr), KELPIE_BAD_INPUT);
  EXPECT_STREQ(kelpie_last_error(), "model: is null");
  std::thread([] { EXPECT_STREQ(kelpie_last_error(), ""); }).join();
}

TEST(InC, BadDataAreNoError) {
  const Model model = made();
  learn(model.get(), 0, 60);
  Sample s = sample(60);
  s.x[1] = kNan;
  std::array<kelpie_decision, 2> decisions;
  EXPECT_EQ(kelpie_update(model.get(), s.x.data(), 4, s.y.data(), 2, s.t, decisions.data()),
            KELPIE_OK);
  EXPECT_EQ(decisions[0].verdict, KELPIE_INVALID);
  std::array<double, 2> y{};
  EXPECT_EQ(kelpie_predict(model.get(), s.x.data(), 4, y.data(), 2), KELPIE_OK);
  EXPECT_TRUE(std::isnan(y[0]) && std::isnan(y[1]));
  std::array<kelpie_prediction, 2> assessed{};
  EXPECT_EQ(kelpie_assess(model.get(), s.x.data(), 4, assessed.data(), 2, kNan), KELPIE_OK);
  EXPECT_EQ(assessed[1].novelty, 1.0);
}

TEST(InC, PredictionsAllocateNothing) {
  KELPIE_NEEDS_ALLOCATION_COUNT();
  const Model model = made();
  learn(model.get(), 0, 300);
  const Sample s = sample(300);
  std::array<double, 2> y{};
  std::array<double, 8> jacobian{};
  std::array<kelpie_prediction, 2> assessed{};
  const std::size_t before = testing::allocations;
  kelpie_predict(model.get(), s.x.data(), 4, y.data(), 2);
  kelpie_predict_with_jacobian(model.get(), s.x.data(), 4, y.data(), 2, jacobian.data());
  kelpie_assess(model.get(), s.x.data(), 4, assessed.data(), 2, 0.0);
  EXPECT_EQ(testing::allocations, before);
}

}  // namespace
}  // namespace kelpie::c_test
