// SPDX-License-Identifier: Apache-2.0
// A library of `kelpie export --live` predicts while a learner renews its block.
#include "format/live_library.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <thread>
#include <vector>

#include "file/mapped_file.hpp"
#include "files/model_block.hpp"
#include "format/compiled_model.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"
#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/model/shared_model.hpp"
#include "model/model_axis.hpp"
#include "model/random_model.hpp"
#include "model/vehicle_stream.hpp"
#include "support.hpp"

namespace kelpie::live_library_test {
namespace {

using testing::CasadiFunction;
using testing::Compiled;
using testing::Drive;
using testing::message_of;
using testing::random_model;
using testing::TemporaryFolder;

constexpr double kStepS = 0.1;

/// Memory for a block, at an address of whole words.
class Memory {
 public:
  explicit Memory(const BlockLayout& layout) : words_(layout.bytes() / sizeof(std::uint64_t)) {
    ModelBlock::clear(bytes(), layout);
  }
  std::span<std::byte> bytes() { return std::as_writable_bytes(std::span(words_)); }
  std::vector<std::uint64_t>& words() { return words_; }

 private:
  std::vector<std::uint64_t> words_;
};

BlockLayout layout_of(const TrainedModel& model, bool assess = false) {
  return BlockLayout::of(model.input_names, model.target_names(), model.terms, model.axes, assess);
}

std::string source_of(const TrainedModel& model, bool assess = false) {
  format::CodeOptions options;
  options.casadi = true;
  options.assess = assess;
  options.live = {.file = "/nowhere/none.block", .layout = layout_of(model, assess)};
  return format::model_c(model, options);
}

int attach(Compiled& library, Memory& memory) {
  return library.named<int (*)(const void*, unsigned long long)>("kelpie_model_attach")(
      memory.bytes().data(), memory.bytes().size());
}

std::uint64_t renew(Compiled& library) {
  return library.named<unsigned long long (*)()>("kelpie_model_renew")();
}

std::string problem(Compiled& library) {
  return library.named<const char* (*)()>("kelpie_model_problem")();
}

void publish(Memory& memory, const TrainedModel& model) {
  ModelBlock(memory.bytes(), layout_of(model, ModelBlock::assesses(memory.bytes())))
      .publish(model.input_names, model.axes, model.alignment);
}

// To rounding, of the steepest slope and of the scale of every target.
void expect_predicts_as(Compiled& library, const std::vector<double>& x,
                        const std::vector<double>& y, const std::vector<double>& slopes) {
  std::vector<double> said(y.size());
  std::vector<double> said_slopes(slopes.size());
  library.run<double>(x, said, said_slopes);
  for (std::size_t i = 0; i < y.size(); ++i) {
    ASSERT_NEAR(said[i], y[i], 1e-11 * (1.0 + std::abs(y[i])));
  }
  double steepest = 1.0;
  for (const double slope : slopes) {
    steepest = std::max(steepest, std::abs(slope));
  }
  for (std::size_t i = 0; i < slopes.size(); ++i) {
    ASSERT_NEAR(said_slopes[i], slopes[i], 1e-10 * steepest);
  }
}

// From the files of the command to the last sample of a learner.
TEST(LiveLibrary, FollowsTheLearnerFromTheExportOn) {
  const TemporaryFolder folder;
  const Drive drive = testing::drive(3, 900);
  ModelSettings settings = ModelSettings::from_preset("default", 2);
  settings.assign("buffer", "100");
  DynamicsModel learner(drive.inputs, drive.targets, settings);
  std::size_t row = 0;
  for (; row < 200; ++row) {
    learner.update(drive.x[row], drive.y[row], kStepS * static_cast<double>(row));
  }
  const format::LiveFiles files(folder / "vehicle.so");
  format::CodeOptions options;
  options.assess = true;
  format::write_live_library(files, learner.trained(), options);
  Compiled library(files.library, "kelpie_model");
  ASSERT_TRUE(library);
  std::vector<double> y(2);
  std::vector<double> slopes(4);
  learner.predict_with_jacobian(drive.x[7], y, slopes);
  expect_predicts_as(library, drive.x[7], y, slopes);
  EXPECT_EQ(renew(library), 1U);

  const file::SharedFile block(files.block);
  EXPECT_NE(message_of<InputError>([&] {
              const file::SharedFile second(files.block);
            }).find("is renewed by another process"),
            std::string::npos);
  EXPECT_NE(message_of<InputError>([&] {
              format::write_live_library(files, learner.trained(), options);
            }).find("stop the learner first"),
            std::string::npos);
  SharedModel shared(std::move(learner));
  shared.serve(block.bytes(), drive.inputs, drive.targets);
  EXPECT_EQ(renew(library), 2U);
  std::vector<Prediction> told(2);
  for (; row < drive.x.size(); ++row) {
    shared.update(drive.x[row], drive.y[row], kStepS * static_cast<double>(row));
    EXPECT_EQ(renew(library), row - 197);
    const std::vector<double>& x = drive.x[(7 * row) % drive.x.size()];
    shared.predict_with_jacobian(x, y, slopes);
    expect_predicts_as(library, x, y, slopes);
    expect_bends_of_slopes(library, x, 2, std::vector<double>(2, 1e-6));
    shared.predict(x, told);
    const auto [half_width, novelty] = library.assess<double>(x, 2);
    for (std::size_t k = 0; k < 2; ++k) {
      const double told_half_width = told[k].upper - told[k].value;
      if (half_width[k] != told_half_width) {  // both infinite: an axis of few errors
        EXPECT_NEAR(half_width[k], told_half_width, 1e-12 * (1.0 + told_half_width));
      }
      EXPECT_NEAR(novelty[k], told[k].novelty, 0.02);
    }
  }
}

// Where the words of two publications were mixed, the values would be those of neither.
class TornReads : public ::testing::Test {
 protected:
  static constexpr std::size_t kModels = 3;  // a slot has another model in every publication

  TornReads() : random_(21, "torn") {
    for (TrainedModel& model : models_) {
      model = random_model(random_, {});
      model.terms = models_[0].terms;
    }
  }

  // Whether one of so many renewals, within a minute, gives other values than those of its
  // publication.
  bool finds_torn(const std::string& code, std::uint64_t most_renewals) {
    Memory memory(layout_of(models_[0]));
    Compiled library(code, "kelpie_model", folder_);
    if (!library || attach(library, memory) != 0) {
      ADD_FAILURE() << problem(library);
      return false;
    }
    const std::vector<double> x{0.3, -0.2, 0.1};
    std::array<std::vector<double>, kModels> expected;
    for (std::size_t n = 1; n <= kModels; ++n) {
      publish(memory, models_[n % kModels]);
      expected[n % kModels] = predicted(library, x);
    }
    std::atomic<bool> going{true};
    std::thread writer([&] {
      ModelBlock block(memory.bytes(), layout_of(models_[0]));
      for (std::size_t n = kModels + 1; going; ++n) {
        block.publish(models_[0].input_names, models_[n % kModels].axes, {});
      }
    });
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    bool torn = false;
    std::uint64_t renewals = 0;
    for (std::uint64_t last = 0;
         !torn && renewals < most_renewals && std::chrono::steady_clock::now() < end;) {
      const std::vector<double> y = predicted(library, x);
      library.named<void (*)(int)>("kelpie_model_hold")(1);
      const std::uint64_t number = renew(library);
      library.named<void (*)(int)>("kelpie_model_hold")(0);
      torn = number > 0 && y != expected[number % kModels];
      renewals += number != last ? 1 : 0;
      last = number;
    }
    going = false;
    writer.join();
    EXPECT_TRUE(torn || renewals > 100) << renewals;
    return torn;
  }

  // Value, and a product with the second derivatives by the numbers of the value.
  static std::vector<double> predicted(Compiled& library, const std::vector<double>& x) {
    std::vector<double> y(3);
    const auto hold = library.named<void (*)(int)>("kelpie_model_hold");
    library.named<void (*)(const double*, double*)>("kelpie_model_predict")(x.data(), y.data());
    hold(1);
    const std::vector<double> bent = library.hessian_vector(x, {1.0, -2.0, 0.5}, {1.0, 2.0, -1.0});
    hold(0);
    y.insert(y.end(), bent.begin(), bent.end());
    return y;
  }

  TemporaryFolder folder_;
  RandomStream random_;
  std::array<TrainedModel, kModels> models_;
};

TEST_F(TornReads, AreNotSeen) {
  EXPECT_FALSE(finds_torn(source_of(models_[0]), 20'000));
}

// The second look at the number of the slot is what keeps them away.
TEST_F(TornReads, AreSeenWithoutTheSecondLook) {
  std::string code = source_of(models_[0]);
  const std::string look = "return kelpie_load(slot) != number;";
  const std::size_t at = code.find(look);
  ASSERT_NE(at, std::string::npos);
  code.replace(at, look.size(), "return 0;");
  EXPECT_TRUE(finds_torn(code, 1'000'000'000));
}

TEST_F(TornReads, ASlotThatIsBeingWrittenIsNotTaken) {
  Memory memory(layout_of(models_[0]));
  Compiled library(source_of(models_[0]), "kelpie_model", folder_);
  ASSERT_TRUE(library);
  ASSERT_EQ(attach(library, memory), 0);
  const std::vector<double> x{0.3, -0.2, 0.1};
  EXPECT_TRUE(std::isnan(predicted(library, x)[0]));
  EXPECT_EQ(problem(library), "no model was published yet");
  publish(memory, models_[0]);
  const std::vector<double> y = predicted(library, x);
  EXPECT_FALSE(std::isnan(y[0]));
  EXPECT_EQ(problem(library), "");
  publish(memory, models_[1]);
  std::uint64_t& number = memory.words()[BlockLayout::kHeaderWords];  // of publication 2
  EXPECT_EQ(number, 2U);
  number = 0;  // as a learner begins to write
  EXPECT_TRUE(std::isnan(predicted(library, x)[0]));
  EXPECT_EQ(problem(library), "the learner renews the block without a pause");
  number = 2;
  EXPECT_FALSE(std::isnan(predicted(library, x)[0]));
  EXPECT_NE(predicted(library, x), y);
}

TEST(LiveLibrary, IsCalledAsCasadiCallsItsOwnCodeAndFailsWithoutAModel) {
  const TemporaryFolder folder;
  RandomStream random(22, "casadi");
  const TrainedModel model = random_model(random, {});
  Memory memory(layout_of(model));
  Compiled library(source_of(model), "kelpie_model", folder);
  ASSERT_TRUE(library);
  const std::vector<double> x{0.3, -0.2, 0.1};
  std::vector<double> y(3);
  std::vector<double> none(27);
  const double* argument = x.data();
  double* result = y.data();
  using Call = int (*)(const double**, double**, long long*, double*, int);
  EXPECT_EQ(library.named<Call>("kelpie_model")(&argument, &result, nullptr, nullptr, 0), 1);
  EXPECT_TRUE(std::isnan(y[2]));
  EXPECT_EQ(problem(library), "the file of the block cannot be opened");
  result = none.data();
  EXPECT_EQ(library.named<Call>("jac_jac_kelpie_model")(&argument, &result, nullptr, nullptr, 0),
            1);
  EXPECT_TRUE(std::isnan(none[26]));

  ASSERT_EQ(attach(library, memory), 0);
  publish(memory, model);
  CasadiFunction value(library, "kelpie_model");
  CasadiFunction jacobian(library, "jac_kelpie_model");
  CasadiFunction bends(library, "jac_jac_kelpie_model");
  const std::vector<double> hessian = library.hessian<double>(x, 3);
  const std::vector<double> bent = bends.call(x.data());
  std::vector<double> slopes(9);
  model.predict_with_jacobian(x, y, slopes);
  const std::vector<double> said = value.call(x.data());
  const std::vector<double> by_columns = jacobian.call(x.data());
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(said[i], y[i], 1e-11 * (1.0 + std::abs(y[i])));
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(by_columns[3 * k + i], slopes[3 * i + k], 1e-10 * (1.0 + std::abs(y[i])));
      EXPECT_EQ(bent[9 * k + i], hessian[9 * i + k]);  // ∂²y_i / ∂x_0 ∂x_k
    }
  }
}

TEST(LiveLibrary, BoundsActuatorsAndShiftAreThoseOfTheBlock) {
  const TemporaryFolder folder;
  RandomStream random(23, "bounds");
  TrainedModel model = random_model(random, {});
  model.axes[1].known = testing::random_places(random, 3, 90);
  model.alignment = {.lag_s = -0.4,
                     .rows = -4,
                     .commands = {"b", "c"},
                     .actuators = {{.neutral = 1500.0, .dead_band = 20.0}, {.astern = 0.5}}};
  Memory memory(layout_of(model, true));
  Compiled library(source_of(model, true), "kelpie_model", folder);
  ASSERT_TRUE(library);
  ASSERT_EQ(attach(library, memory), 0);
  std::array<double, 3> low{};
  std::array<double, 3> high{};
  const auto bounds = library.named<int (*)(double*, double*)>("kelpie_model_bounds");
  EXPECT_EQ(bounds(low.data(), high.data()), 1);
  EXPECT_EQ(low[0], -std::numeric_limits<double>::infinity());
  publish(memory, model);
  EXPECT_EQ(bounds(low.data(), high.data()), 0);
  std::vector<double> z(3);
  const SampleStore& samples = model.axes[1].known->samples;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples.get(i, z);
    const ScaledInput x = model.axes[1].scaling.input.invert(z);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_LE(low[k], x[k]);
      EXPECT_GE(high[k], x[k]);
    }
  }
  EXPECT_LT(high[0] - low[0], 40.0);
  EXPECT_EQ(library.named<double (*)()>("kelpie_model_shift")(), -0.4);

  alignas(16) std::array<std::byte, 8192> state{};
  library.named<void (*)(void*)>("kelpie_model_actuators_rest")(state.data());
  const auto step = library.named<void (*)(void*, double, double*)>("kelpie_model_actuators_step");
  std::array<double, 3> effects{0.7, 1480.0 - 100.0, -2.0};
  step(state.data(), 0.1, effects.data());
  EXPECT_EQ(effects, (std::array{0.7, -100.0, -1.0}));
  model.alignment.actuators[0].dead_band = 0.0;  // a learner has found so
  publish(memory, model);
  effects = {0.7, 1400.0, -2.0};
  step(state.data(), 0.1, effects.data());
  EXPECT_EQ(effects, (std::array{0.7, -100.0, -1.0}));
}

TEST(LiveLibrary, RefusesTheBlockOfAnotherModel) {
  const TemporaryFolder folder;
  RandomStream random(24, "other");
  const TrainedModel model = random_model(random, {});
  const auto refusal = [&](const TrainedModel& other, auto change) {
    Memory memory(layout_of(other));
    publish(memory, other);
    change(memory.words());
    Compiled library(source_of(model), "kelpie_model", folder);
    EXPECT_EQ(attach(library, memory), 1);
    return problem(library);
  };
  const auto nothing = [](std::vector<std::uint64_t>&) {};
  testing::ModelShape shape;
  shape.inputs = {"a", "b", "d"};
  shape.terms = "a";
  EXPECT_EQ(refusal(random_model(random, shape), nothing),
            "the block belongs to a model with other inputs, targets or terms");
  shape = {};
  shape.samples = 41;
  EXPECT_EQ(refusal(random_model(random, shape), nothing),
            "the block was written by another export");
  EXPECT_EQ(refusal(model, [](auto& words) { words[0] ^= 1; }),
            "no block of this version of kelpie");
}

TEST(LiveLibrary, NoNumberInADamagedBlockLeadsOutOfIt) {
  const TemporaryFolder folder;
  RandomStream random(25, "damaged");
  const TrainedModel model = random_model(random, {});
  Memory memory(layout_of(model));
  Compiled library(source_of(model), "kelpie_model", folder);
  ASSERT_TRUE(library);
  ASSERT_EQ(attach(library, memory), 0);
  const std::size_t slot = layout_of(model).slot_words();
  std::size_t refused = 0;
  for (int round = 0; round < 600; ++round) {
    publish(memory, model);
    const std::size_t begin = BlockLayout::kHeaderWords + (memory.words()[3] % 2) * slot;
    // Counts and ranges stand among the first words.
    const auto word = static_cast<std::size_t>(random.uniform(1.0, round % 2 == 0 ? 60.0 : 400.0));
    const double wrong = round % 3 == 0 ? 1e300 : round % 3 == 1 ? -7.5 : std::nan("");
    std::memcpy(&memory.words()[begin + word], &wrong, sizeof(wrong));
    refused += renew(library) == 0 ? 1 : 0;
    std::vector<double> y(3);
    std::vector<double> slopes(9);
    const std::vector<double> x{0.1, 0.2, 0.3};
    library.named<void (*)(const double*, double*, double*)>("kelpie_model_predict_with_jacobian")(
        x.data(), y.data(), slopes.data());
    library.hessian<double>(x, 3);
  }
  EXPECT_GT(refused, 10U);
}

TEST(LiveLibrary, ALearnerRefusesABlockThatIsNotItsOwn) {
  const Drive drive = testing::drive(3, 10);
  ModelSettings settings = ModelSettings::from_preset("default", 2);
  const auto layout = [&](const std::vector<std::string>& inputs) {
    const DynamicsModel learner(inputs, drive.targets, settings);
    std::vector<Snapshot> capacity{learner.mechanisms(0).snapshot(),
                                   learner.mechanisms(1).snapshot()};
    return BlockLayout::of(inputs, drive.targets, learner.mechanisms(0).terms(), capacity, false);
  };
  Memory memory(layout(drive.inputs));
  Memory other(layout({"speed", "rudder"}));
  SharedModel shared(DynamicsModel(drive.inputs, drive.targets, settings));
  const auto refusal = [&](std::span<std::byte> block) {
    return message_of<InputError>([&] { shared.serve(block, drive.inputs, drive.targets); });
  };
  EXPECT_EQ(refusal(memory.bytes()), "");
  EXPECT_EQ(refusal({}), "");
  EXPECT_NE(refusal(other.bytes()).find("other inputs, targets or terms"), std::string::npos);
  EXPECT_NE(refusal(memory.bytes().first(64)).find("is no block of this version"),
            std::string::npos);
  EXPECT_NE(refusal(memory.bytes().first(memory.bytes().size() - 8)).find("is damaged"),
            std::string::npos);
  settings.assign("buffer", "100");
  Memory small(layout(drive.inputs));
  EXPECT_NE(refusal(small.bytes()).find("the settings of the learner allow"), std::string::npos);
}

}  // namespace
}  // namespace kelpie::live_library_test
