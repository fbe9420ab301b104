// SPDX-License-Identifier: Apache-2.0
// The interface for C says what the class says, and fails with a code and a message.
#include "kelpie/kelpie.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "allocation_count.hpp"
#include "files/model_block.hpp"
#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/model/trained_model.hpp"
#include "kelpie/navigation/dead_reckoning.hpp"
#include "kelpie/vehicle/diagnosis.hpp"
#include "model/model_axis.hpp"

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
  const std::array twice{"udot", "udot"};
  EXPECT_EQ(kelpie_create(kInputs.data(), 4, twice.data(), 2, nullptr, &model), KELPIE_BAD_INPUT);
  EXPECT_STREQ(kelpie_last_error(), "targets: name 'udot' twice");
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
  EXPECT_TRUE(std::isnan(decisions[0].predicted));
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

// A vehicle with two thrusters whose second one gives half its thrust from row `kDamage` on.
constexpr int kDamage = 4000;
constexpr std::array kBoat{"u", "v", "r", "n1", "n2"};
constexpr std::array kBoatTargets{"udot", "vdot", "rdot"};

class Boat {
 public:
  struct Row {
    std::array<double, 5> x;
    std::array<double, 3> y;
    double t;
  };
  Row next() {
    const double t = 0.1 * row_;
    const double left = 6.0 * std::sin(0.23 * t) + 2.0 * std::sin(1.3 * t);
    const double right = 6.0 * std::cos(0.31 * t) + 2.0 * std::sin(0.9 * t);
    const double thrust = row_ < kDamage ? 1.0 : 0.5;
    const double push_left = 0.01 * left * std::abs(left);
    const double push_right = thrust * 0.01 * right * std::abs(right);
    const double noise = 2e-3 * std::sin(1e4 * t);
    const auto [u, v, r] = state_;
    const std::array y{push_left + push_right - 0.3 * u - 0.8 * u * std::abs(u), -0.5 * v - u * r,
                       1.5 * (push_right - push_left) - 0.6 * r};
    const Row row{{u, v, r, left, right}, {y[0] + noise, y[1] - noise, y[2] + noise}, t};
    for (std::size_t i = 0; i < state_.size(); ++i) {
      state_[i] += 0.1 * y[i];
    }
    ++row_;
    return row;
  }

 private:
  std::array<double, 3> state_{};
  int row_ = 0;
};

Model boat_model(const std::array<const char*, 5>& inputs = kBoat) {
  kelpie_model* model = nullptr;
  EXPECT_EQ(kelpie_create(inputs.data(), 5, kBoatTargets.data(), 3, "buffer = 60", &model),
            KELPIE_OK)
      << kelpie_last_error();
  return {model, kelpie_free};
}

DynamicsModel class_of_boat() {
  ModelSettings settings = ModelSettings::from_preset("default", 3);
  settings.assign("buffer", "60");
  return {{kBoat.begin(), kBoat.end()}, {kBoatTargets.begin(), kBoatTargets.end()}, settings};
}

void learn_boat(const Model& model, Boat& boat, int rows, DynamicsModel* the_same = nullptr) {
  for (int i = 0; i < rows; ++i) {
    const auto [x, y, t] = boat.next();
    ASSERT_EQ(kelpie_update(model.get(), x.data(), 5, y.data(), 3, t, nullptr), KELPIE_OK);
    if (the_same != nullptr) {
      the_same->update(x, y, t);
    }
  }
}

TEST(InC, AChangeIsToldWithCauseSizeIntervalAndTime) {
  const Model model = boat_model();
  Boat boat;
  std::size_t count = 1;
  ASSERT_EQ(kelpie_findings(model.get(), nullptr, 0, &count), KELPIE_OK);
  EXPECT_EQ(count, 0U);
  learn_boat(model, boat, kDamage + 1500);
  std::array<kelpie_finding, KELPIE_MOST_FINDINGS> findings{};
  ASSERT_EQ(kelpie_findings(model.get(), findings.data(), findings.size(), &count), KELPIE_OK);
  ASSERT_EQ(count, 1U);
  const kelpie_finding& found = findings[0];
  EXPECT_EQ(found.state, KELPIE_NAMED);
  EXPECT_NEAR(found.since_s, 0.1 * kDamage, 3.0);
  ASSERT_EQ(found.count, 1);
  EXPECT_EQ(found.causes[0].kind, KELPIE_THRUSTER);
  EXPECT_EQ(found.causes[0].place, 4);
  EXPECT_NEAR(found.causes[0].size, 0.5, 0.03);
  EXPECT_LE(found.causes[0].lower, found.causes[0].size);
  EXPECT_GE(found.causes[0].upper, found.causes[0].size);
  std::array<char, 200> text{};
  ASSERT_EQ(kelpie_finding_text(model.get(), 0, text.data(), text.size()), KELPIE_OK);
  EXPECT_NE(std::string(text.data()).find("n2 gives "), std::string::npos) << text.data();
  ASSERT_EQ(kelpie_finding_text(model.get(), 0, text.data(), 5), KELPIE_OK);
  EXPECT_EQ(std::string(text.data()).size(), 4U);
  EXPECT_EQ(kelpie_finding_text(model.get(), 1, text.data(), text.size()), KELPIE_BAD_INPUT);
  EXPECT_EQ(kelpie_findings(model.get(), nullptr, 2, &count), KELPIE_BAD_INPUT);
}

TEST(InC, OneThreadTeachesWhileAnotherPredicts) {
  kelpie_model* const model = boat_model().release();
  kelpie_shared* shared = nullptr;
  ASSERT_EQ(kelpie_share(model, &shared), KELPIE_OK) << kelpie_last_error();
  const std::unique_ptr<kelpie_shared, decltype(&kelpie_free_shared)> owned(shared,
                                                                            kelpie_free_shared);
  ASSERT_EQ(kelpie_shared_model(shared), model);
  EXPECT_STREQ(kelpie_target_name(kelpie_shared_model(shared), 2), "rdot");
  std::array<kelpie_prediction, 3> y{};
  const std::array x{0.1, 0.0, 0.0, 3.0, 3.0};
  std::int64_t number = -1;
  ASSERT_EQ(kelpie_shared_assess(shared, x.data(), 5, y.data(), 3, 0.0, &number), KELPIE_OK);
  EXPECT_EQ(number, 0);
  std::atomic<bool> is_over{false};
  std::int64_t last = 0;
  bool goes_up = true;
  std::thread reader([&] {
    std::array<double, 3> values{};
    std::array<double, 15> jacobian{};
    std::int64_t seen = 0;
    while (!is_over.load()) {
      if (kelpie_shared_predict_with_jacobian(shared, x.data(), 5, values.data(), 3,
                                              jacobian.data(), &seen) != KELPIE_OK) {
        goes_up = false;
      }
      goes_up = goes_up && seen >= last && (seen == 0 || std::isfinite(values[0]));
      last = seen;
    }
  });
  Boat boat;
  for (int i = 0; i < 1000; ++i) {
    const Boat::Row row = boat.next();
    std::array<kelpie_decision, 3> decisions;
    ASSERT_EQ(
        kelpie_shared_update(shared, row.x.data(), 5, row.y.data(), 3, row.t, decisions.data()),
        KELPIE_OK);
  }
  is_over.store(true);
  reader.join();
  EXPECT_TRUE(goes_up);
  // What the class says, from the model within.
  ASSERT_EQ(kelpie_shared_assess(shared, x.data(), 5, y.data(), 3, 0.0, &number), KELPIE_OK);
  EXPECT_GT(number, 0);
  std::array<kelpie_prediction, 3> own{};
  ASSERT_EQ(kelpie_assess(kelpie_shared_model(shared), x.data(), 5, own.data(), 3, 0.0), KELPIE_OK);
  EXPECT_EQ(y[0].value, own[0].value);
  EXPECT_EQ(y[2].lower, own[2].lower);
  EXPECT_FALSE(saved(kelpie_shared_model(shared)).empty());
  // The model belongs to the shared one.
  const Boat::Row row = boat.next();
  EXPECT_EQ(kelpie_update(model, row.x.data(), 5, row.y.data(), 3, row.t, nullptr),
            KELPIE_BAD_INPUT);
  kelpie_shared* twice = nullptr;
  EXPECT_EQ(kelpie_share(model, &twice), KELPIE_BAD_INPUT);
  EXPECT_EQ(kelpie_share(nullptr, &twice), KELPIE_BAD_INPUT);
}

// An update that allocates nothing allocates nothing after the model is shared, either.
TEST(InC, ASharedModelHasTheRoomOfItsOwn) {
  KELPIE_NEEDS_ALLOCATION_COUNT();
  const Model alone = boat_model();
  kelpie_shared* shared = nullptr;
  ASSERT_EQ(kelpie_share(boat_model().release(), &shared), KELPIE_OK);
  const std::unique_ptr<kelpie_shared, decltype(&kelpie_free_shared)> owned(shared,
                                                                            kelpie_free_shared);
  Boat boat;
  std::size_t more = 0;
  for (int i = 0; i < kDamage + 600; ++i) {
    const Boat::Row row = boat.next();
    std::size_t before = testing::allocations;
    kelpie_update(alone.get(), row.x.data(), 5, row.y.data(), 3, row.t, nullptr);
    const bool allocates = testing::allocations > before;
    before = testing::allocations;
    kelpie_shared_update(shared, row.x.data(), 5, row.y.data(), 3, row.t, nullptr);
    more += allocates ? 0 : testing::allocations - before;
  }
  EXPECT_EQ(more, 0U);
}

TEST(InC, ALearnerRenewsABlock) {
  const DynamicsModel like = the_class();
  const std::vector<Snapshot> capacity{like.mechanisms(0).snapshot(),
                                       like.mechanisms(1).snapshot()};
  const std::vector<std::string> inputs(kInputs.begin(), kInputs.end());
  const std::vector<std::string> targets(kTargets.begin(), kTargets.end());
  const BlockLayout layout =
      BlockLayout::of(inputs, targets, like.mechanisms(0).terms(), capacity, false);
  std::vector<std::uint64_t> words(layout.bytes() / sizeof(std::uint64_t));
  ModelBlock::clear(std::as_writable_bytes(std::span(words)), layout);
  kelpie_shared* shared = nullptr;
  ASSERT_EQ(kelpie_share(made().release(), &shared), KELPIE_OK);
  const std::unique_ptr<kelpie_shared, decltype(&kelpie_free_shared)> owned(shared,
                                                                            kelpie_free_shared);
  EXPECT_EQ(kelpie_shared_serve(shared, words.data(), 64), KELPIE_BAD_INPUT);
  EXPECT_EQ(std::string(kelpie_last_error()).find("block: is no block"), 0U);
  EXPECT_EQ(kelpie_shared_serve(shared, nullptr, 64), KELPIE_BAD_INPUT);
  EXPECT_EQ(kelpie_shared_serve(nullptr, words.data(), 64), KELPIE_BAD_INPUT);
  ASSERT_EQ(kelpie_shared_serve(shared, words.data(), layout.bytes()), KELPIE_OK);
  std::int64_t number = 0;
  for (int i = 0; i < 100; ++i) {
    const Sample s = sample(i);
    ASSERT_EQ(kelpie_shared_update(shared, s.x.data(), 4, s.y.data(), 2, s.t, nullptr), KELPIE_OK);
  }
  std::array<kelpie_prediction, 2> y{};
  kelpie_shared_assess(shared, sample(3).x.data(), 4, y.data(), 2, 0.0, &number);
  EXPECT_EQ(words[3], static_cast<std::uint64_t>(number));
  EXPECT_EQ(kelpie_shared_serve(shared, nullptr, 0), KELPIE_OK);
}

TEST(InC, AuthorityIsThatOfTheClass) {
  const Model model = made();
  kelpie_authority* authority = nullptr;
  const std::array thrusters{"n1", "n2"};
  const std::array least{-5.0, -5.0};
  const std::array most{5.0, 5.0};
  const auto create = [&](const char* const* names) {
    return kelpie_authority_create(model.get(), names, least.data(), most.data(), 2, &authority);
  };
  EXPECT_EQ(create(thrusters.data()), KELPIE_BAD_INPUT);
  EXPECT_EQ(std::string(kelpie_last_error()).find("diagnosis: knows too little"), 0U);
  learn(model.get(), 0, 3000);
  ASSERT_EQ(create(thrusters.data()), KELPIE_OK) << kelpie_last_error();
  kelpie_axis_authority axis{};
  ASSERT_EQ(kelpie_authority_axis(authority, 0, &axis), KELPIE_OK);
  EXPECT_NEAR(axis.most, 0.25, 0.02);  // 0.01 n1²
  EXPECT_NEAR(axis.left, 1.0, 1e-9);
  EXPECT_EQ(kelpie_authority_axis(authority, 2, &axis), KELPIE_BAD_INPUT);
  std::array<double, 2> commands{};
  double missing = 1.0;
  const std::array wanted{0.16, 0.0};
  ASSERT_EQ(kelpie_authority_allocate(authority, wanted.data(), 2, commands.data(), 2, &missing),
            KELPIE_OK);
  EXPECT_NEAR(commands[0], 4.0, 0.2);
  EXPECT_LT(missing, 1e-3);
  EXPECT_EQ(kelpie_authority_allocate(authority, wanted.data(), 1, commands.data(), 2, nullptr),
            KELPIE_BAD_INPUT);
  EXPECT_NE(std::string(kelpie_authority_text(authority)).find("of nominal left"),
            std::string::npos);
  kelpie_authority_free(authority);
  EXPECT_EQ(kelpie_authority_create(model.get(), thrusters.data(), least.data(), most.data(), 0,
                                    &authority),
            KELPIE_BAD_INPUT);
  EXPECT_STREQ(kelpie_last_error(), "ranges: have to name a thruster or more");
  const std::array wrong{"n1", "n3"};
  EXPECT_EQ(create(wrong.data()), KELPIE_BAD_INPUT);
  EXPECT_STREQ(kelpie_last_error(), "thrusters: 'n3' is no input");
  const std::array twice{"n1", "n1"};
  EXPECT_EQ(create(twice.data()), KELPIE_BAD_INPUT);
  EXPECT_STREQ(kelpie_last_error(), "ranges: name input 2 twice");
}

// A roll rate is measured, has no target, and is no thruster.
TEST(InC, AuthorityTakesNoOtherVelocityForAThruster) {
  constexpr std::array kRolling{"u", "v", "r", "n1", "n2", "p"};
  kelpie_model* made = nullptr;
  ASSERT_EQ(kelpie_create(kRolling.data(), 6, kBoatTargets.data(), 3, "buffer = 60", &made),
            KELPIE_OK);
  const Model model(made, kelpie_free);
  Boat boat;
  for (int i = 0; i < kDamage; ++i) {
    const auto [x, y, t] = boat.next();
    const std::array row{x[0], x[1], x[2], x[3], x[4], 0.1 * std::sin(2.0 * t)};
    ASSERT_EQ(kelpie_update(made, row.data(), 6, y.data(), 3, t, nullptr), KELPIE_OK);
  }
  const double least = -5.0;
  const double most = 5.0;
  const auto create = [&](const char* name) {
    kelpie_authority* authority = nullptr;
    const kelpie_status status = kelpie_authority_create(made, &name, &least, &most, 1, &authority);
    kelpie_authority_free(authority);
    return status;
  };
  EXPECT_EQ(create("n1"), KELPIE_OK) << kelpie_last_error();
  EXPECT_EQ(create("p"), KELPIE_BAD_INPUT);
  EXPECT_STREQ(kelpie_last_error(), "ranges: input 5 is no thruster");
}

TEST(InC, VelocitiesGoOnThroughAnOutage) {
  const Model model = made();
  kelpie_reckoning* reckoning = nullptr;
  EXPECT_EQ(kelpie_reckoning_create(model.get(), 0, &reckoning), KELPIE_BAD_INPUT);
  EXPECT_STREQ(kelpie_last_error(), "model: has learned too little so far");
  learn(model.get(), 0, 1000);
  ASSERT_EQ(kelpie_reckoning_create(model.get(), 0, &reckoning), KELPIE_OK) << kelpie_last_error();
  ASSERT_EQ(kelpie_reckoning_states(reckoning), 2U);
  std::array<double, 2> velocity{};
  std::array<double, 4> covariance{};
  std::array<std::int32_t, 2> faults{};
  const auto update = [&](int k, bool is_silent) {
    Sample s = sample(k);
    if (is_silent) {
      s.x[0] = s.x[1] = kNan;
    }
    EXPECT_EQ(kelpie_reckoning_update(reckoning, s.x.data(), 4, s.t, nullptr), KELPIE_OK);
    EXPECT_EQ(
        kelpie_reckoning_velocity(reckoning, velocity.data(), covariance.data(), faults.data(), 2),
        KELPIE_OK);
    return s;
  };
  EXPECT_EQ(kelpie_reckoning_velocity(reckoning, velocity.data(), nullptr, nullptr, 2), KELPIE_OK);
  EXPECT_TRUE(std::isnan(velocity[0]));
  for (int k = 1000; k < 1100; ++k) {
    update(k, false);
  }
  EXPECT_EQ(faults[0], 0);
  const double sure = covariance[0];
  for (int k = 1100; k < 1120; ++k) {
    update(k, true);
  }
  EXPECT_EQ(faults[0], KELPIE_VELOCITY_MISSING);
  EXPECT_GT(kelpie_reckoning_silent_s(reckoning), 0.0);
  EXPECT_GT(covariance[0], sure);
  EXPECT_TRUE(std::isfinite(velocity[0]) && std::isfinite(velocity[1]));
  EXPECT_EQ(kelpie_reckoning_use(reckoning, model.get()), KELPIE_OK);
  const std::array<double, 4> x{};
  EXPECT_EQ(kelpie_reckoning_update(reckoning, x.data(), 3, 0.0, nullptr), KELPIE_BAD_INPUT);
  EXPECT_STREQ(kelpie_last_error(), "x: has 3 values; it has to have 4");
  EXPECT_EQ(kelpie_reckoning_update(nullptr, x.data(), 4, 0.0, nullptr), KELPIE_BAD_INPUT);
  kelpie_reckoning_free(reckoning);
  kelpie_reckoning_free(nullptr);
}

// A gyro goes on while the velocity log gives zeros; it is told by the names of the velocities.
TEST(InC, ALogOfZerosIsSilentWhileAGyroGoesOn) {
  const Model model = boat_model({"u", "w", "r", "n1", "n2"});
  Boat boat;
  Boat::Row row{};
  learn_boat(model, boat, 2000);
  kelpie_reckoning* reckoning = nullptr;
  EXPECT_EQ(kelpie_reckoning_create(model.get(), 1, &reckoning), KELPIE_BAD_INPUT);
  EXPECT_STREQ(kelpie_last_error(),
               "planar: needs surge, sway and yaw rate as the first three velocities");
  ASSERT_EQ(kelpie_reckoning_create(model.get(), 0, &reckoning), KELPIE_OK) << kelpie_last_error();
  std::array<double, 3> velocity{};
  std::array<std::int32_t, 3> faults{};
  for (int i = 0; i < 400; ++i) {
    row = boat.next();
    std::array<double, 5> x = row.x;
    if (i >= 300) {
      x[0] = x[1] = 0.0;
    }
    ASSERT_EQ(kelpie_reckoning_update(reckoning, x.data(), 5, row.t, nullptr), KELPIE_OK);
  }
  ASSERT_EQ(kelpie_reckoning_velocity(reckoning, velocity.data(), nullptr, faults.data(), 3),
            KELPIE_OK);
  EXPECT_EQ(faults, (std::array<std::int32_t, 3>{KELPIE_VELOCITY_ZERO, KELPIE_VELOCITY_ZERO, 0}));
  EXPECT_NEAR(kelpie_reckoning_silent_s(reckoning), 10.0, 1.0);
  EXPECT_NEAR(velocity[0], row.x[0], 0.05);
  EXPECT_NEAR(velocity[2], row.x[2], 0.05);
  kelpie_reckoning_free(reckoning);
}

// The matrix after half of a thruster's thrust is lost, by the class and in C.
TEST(InC, TheEffectivenessMatrixIsThatOfTheClass) {
  const Model model = boat_model();
  DynamicsModel the_same = class_of_boat();
  Boat boat;
  learn_boat(model, boat, kDamage + 1500, &the_same);
  const std::array thrusters{"n2", "n1"};
  const std::array least{-4.0, -5.0};
  const std::array most{6.0, 5.0};
  kelpie_authority* made = nullptr;
  ASSERT_EQ(
      kelpie_authority_create(model.get(), thrusters.data(), least.data(), most.data(), 2, &made),
      KELPIE_OK)
      << kelpie_last_error();
  const std::unique_ptr<kelpie_authority, decltype(&kelpie_authority_free)> authority(
      made, kelpie_authority_free);
  const Authority expected(*the_same.diagnosis(), {{4, -4.0, 6.0}, {3, -5.0, 5.0}});
  kelpie_thruster_effect effect{};
  for (std::size_t j = 0; j < 2; ++j) {
    const ThrusterEffect& one = expected.thrusters()[j];
    for (std::size_t i = 0; i < 3; ++i) {
      ASSERT_EQ(kelpie_authority_thruster(made, j, i, &effect), KELPIE_OK);
      const std::array in_c{effect.ahead,        effect.astern,        effect.ahead_width,
                            effect.astern_width, effect.nominal_ahead, effect.nominal_astern,
                            effect.share};
      const std::array by_the_class{
          one.ahead[i],         one.astern[i],         one.ahead_width[i], one.astern_width[i],
          one.nominal_ahead[i], one.nominal_astern[i], one.share};
      EXPECT_EQ(in_c, by_the_class) << j << " " << i;
    }
  }
  ASSERT_EQ(kelpie_authority_thruster(made, 0, 0, &effect), KELPIE_OK);
  EXPECT_NEAR(effect.share, 0.5, 0.03);
  EXPECT_NEAR(effect.nominal_ahead, 0.36, 0.02);  // 0.01 n2²
  EXPECT_NEAR(effect.ahead, 0.18, 0.02);
  double value = 0.0;
  double nominal = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    ASSERT_EQ(kelpie_authority_singular_value(made, i, &value, &nominal), KELPIE_OK);
    EXPECT_EQ(value, expected.singular_values()[i]);
    EXPECT_EQ(nominal, expected.nominal_singular_values()[i]);
  }
  EXPECT_EQ(kelpie_authority_singular_value(made, 0, &value, nullptr), KELPIE_OK);
  EXPECT_EQ(kelpie_authority_singular_value(made, 3, &value, nullptr), KELPIE_BAD_INPUT);
  EXPECT_STREQ(kelpie_last_error(), "i: is beyond the last singular value");
  EXPECT_EQ(kelpie_authority_singular_value(made, 0, nullptr, nullptr), KELPIE_BAD_INPUT);
  EXPECT_EQ(kelpie_authority_thruster(made, 2, 0, &effect), KELPIE_BAD_INPUT);
  EXPECT_STREQ(kelpie_last_error(), "thruster: is beyond the last");
  EXPECT_EQ(kelpie_authority_thruster(made, 0, 3, &effect), KELPIE_BAD_INPUT);
  EXPECT_EQ(kelpie_authority_thruster(made, 0, 0, nullptr), KELPIE_BAD_INPUT);
}

using Reckoning = std::unique_ptr<kelpie_reckoning, decltype(&kelpie_reckoning_free)>;

Reckoning reckoning_of(const Model& model, int planar) {
  kelpie_reckoning* reckoning = nullptr;
  EXPECT_EQ(kelpie_reckoning_create(model.get(), planar, &reckoning), KELPIE_OK)
      << kelpie_last_error();
  return {reckoning, kelpie_reckoning_free};
}

void expect_same_navigation(const kelpie_reckoning* in_c, const DeadReckoning& by_the_class) {
  std::array<double, 2> current{};
  Drift drift{};
  ASSERT_EQ(kelpie_reckoning_current(in_c, current.data()), KELPIE_OK);
  ASSERT_EQ(kelpie_reckoning_drift(in_c, drift.position_m.data(), drift.covariance_m2.data()),
            KELPIE_OK);
  EXPECT_EQ(current, by_the_class.current());
  EXPECT_EQ(drift.position_m, by_the_class.drift().position_m);
  EXPECT_EQ(drift.covariance_m2, by_the_class.drift().covariance_m2);
  EXPECT_EQ(kelpie_reckoning_heading(in_c), by_the_class.heading());
  EXPECT_EQ(kelpie_reckoning_step(in_c), by_the_class.step());
  EXPECT_EQ(kelpie_reckoning_noise_factor(in_c), by_the_class.noise_factor());
}

// Measured headings, an outage, and commands restated within: all numbers of navigation.
TEST(InC, HeadingCurrentAndPositionAreThoseOfTheClass) {
  const Model model = boat_model();
  DynamicsModel the_same = class_of_boat();
  Boat boat;
  learn_boat(model, boat, 2000, &the_same);
  const Reckoning reckoning = reckoning_of(model, 1);
  DeadReckoning by_the_class(open_loop(the_same.trained(), OpenLoopPart::steady));
  double heading = 0.7;
  const auto drive = [&](int rows, bool is_silent) {
    for (int i = 0; i < rows; ++i) {
      auto [x, y, t] = boat.next();
      heading += 0.1 * x[2];
      if (is_silent) {
        x[0] = x[1] = kNan;
      }
      ASSERT_EQ(kelpie_reckoning_update(reckoning.get(), x.data(), 5, t, nullptr), KELPIE_OK);
      by_the_class.update(x, t);
      ASSERT_EQ(kelpie_reckoning_measured_heading(reckoning.get(), heading, 0.02), KELPIE_OK);
      by_the_class.measured_heading(heading, 0.02);
    }
  };
  drive(600, false);
  EXPECT_GT(kelpie_reckoning_step(reckoning.get()), 0.0);
  expect_same_navigation(reckoning.get(), by_the_class);
  drive(100, true);
  const std::array<double, 5> x{kNan, kNan, kNan, 4.0, -2.0};
  ASSERT_EQ(kelpie_reckoning_restate(reckoning.get(), x.data(), 5, KELPIE_COMMANDS_HELD),
            KELPIE_OK);
  by_the_class.restate(x, CommandPath::held);
  drive(100, true);
  expect_same_navigation(reckoning.get(), by_the_class);
  EXPECT_NEAR(kelpie_reckoning_heading(reckoning.get()), heading, 0.05);
  std::array<double, 2> position{};
  ASSERT_EQ(kelpie_reckoning_drift(reckoning.get(), position.data(), nullptr), KELPIE_OK);
  EXPECT_GT(std::hypot(position[0], position[1]), 0.1);
}

// Held commands and linear commands drive differently: the path reaches the estimator.
TEST(InC, CommandsGoOnAsTheyAreRestated) {
  const Model model = boat_model();
  Boat boat;
  learn_boat(model, boat, 2000);
  const auto surge_after = [&](std::int32_t path) {
    const Reckoning reckoning = reckoning_of(model, 1);
    const std::array<double, 5> at_rest{};
    kelpie_reckoning_update(reckoning.get(), at_rest.data(), 5, 0.0, nullptr);
    EXPECT_EQ(kelpie_reckoning_restate(reckoning.get(), at_rest.data(), 5, path), KELPIE_OK);
    const std::array<double, 5> ahead{kNan, kNan, kNan, 6.0, 6.0};
    kelpie_reckoning_update(reckoning.get(), ahead.data(), 5, 0.5, nullptr);
    std::array<double, 3> velocity{};
    kelpie_reckoning_velocity(reckoning.get(), velocity.data(), nullptr, nullptr, 3);
    return velocity[0];
  };
  EXPECT_NEAR(surge_after(KELPIE_COMMANDS_HELD), 0.0, 0.02);
  EXPECT_GT(surge_after(KELPIE_COMMANDS_LINEAR), 0.05);
}

TEST(InC, NavigationRefusesWhatTheClassRefuses) {
  const Model model = made();
  learn(model.get(), 0, 1000);
  const Reckoning reckoning = reckoning_of(model, 0);
  std::array<double, 5> x{};
  const auto refused = [](kelpie_status status, const std::string& message) {
    EXPECT_EQ(status, KELPIE_BAD_INPUT);
    EXPECT_EQ(kelpie_last_error(), message);
  };
  refused(kelpie_reckoning_measured_heading(reckoning.get(), 0.0, 0.1),
          "heading: is known of planar motion only");
  refused(kelpie_reckoning_measured_heading(nullptr, 0.0, 0.1), "reckoning: is null");
  refused(kelpie_reckoning_restate(reckoning.get(), x.data(), 5, KELPIE_COMMANDS_HELD),
          "x: has 5 values; it has to have 4");
  refused(kelpie_reckoning_restate(reckoning.get(), nullptr, 4, KELPIE_COMMANDS_HELD),
          "x: is null");
  refused(kelpie_reckoning_restate(reckoning.get(), x.data(), 4, 2),
          "path: has to be KELPIE_COMMANDS_HELD or KELPIE_COMMANDS_LINEAR");
  refused(kelpie_reckoning_restate(nullptr, x.data(), 4, 0), "reckoning: is null");
  refused(kelpie_reckoning_current(reckoning.get(), nullptr), "current: is null");
  refused(kelpie_reckoning_current(nullptr, x.data()), "reckoning: is null");
  refused(kelpie_reckoning_drift(reckoning.get(), nullptr, x.data()), "position: is null");
  refused(kelpie_reckoning_drift(nullptr, x.data(), nullptr), "reckoning: is null");
  EXPECT_EQ(kelpie_reckoning_heading(reckoning.get()), 0.0);
  const Model boat = boat_model();
  Boat vehicle;
  learn_boat(boat, vehicle, 2000);
  const Reckoning planar = reckoning_of(boat, 1);
  refused(kelpie_reckoning_measured_heading(planar.get(), kNan, 0.1), "heading: has to be finite");
  refused(kelpie_reckoning_measured_heading(planar.get(), 0.0, 0.0),
          "deviation: has to be > 0 rad");
}

}  // namespace
}  // namespace kelpie::c_test
