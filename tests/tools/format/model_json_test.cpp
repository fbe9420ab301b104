// SPDX-License-Identifier: Apache-2.0
#include "format/model_json.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "kelpie/alignment/alignment.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/kelpie.h"
#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/model/trained_model.hpp"
#include "model/snapshot.hpp"
#include "model/steady_part.hpp"
#include "model/vehicle_stream.hpp"
#include "support.hpp"

namespace kelpie::model_json_test {
namespace {

using testing::Drive;
using testing::drive;
using testing::message_of;

TrainedModel trained(const Drive& samples, const char* scaling) {
  ModelSettings settings = ModelSettings::from_preset("default", 2);
  settings.shared.warmup = 50;
  settings.assign("scaling", scaling);
  settings.assign("gamma", "0.5,0.30000000000000004");
  DynamicsModel model(samples.inputs, samples.targets, settings);
  for (std::size_t i = 0; i < samples.x.size(); ++i) {
    model.update(samples.x[i], samples.y[i], static_cast<double>(i));
  }
  return model.trained();
}

// The same bytes in C, which needs none of the tools.
TEST(ModelJson, IsReadInCToTheSamePredictionsToTheLastBit) {
  const Drive samples = drive(1, 500);
  TrainedModel model = trained(samples, "full");
  const std::vector<std::size_t> commands{samples.inputs.size() - 1};
  model.alignment = Alignment::by(0.5, samples.inputs, commands, 4.0);
  const std::string text = format::model_json(model);
  kelpie_trained* read = nullptr;
  ASSERT_EQ(kelpie_read_trained(text.data(), text.size(), &read), KELPIE_OK) << kelpie_last_error();
  const std::unique_ptr<kelpie_trained, decltype(&kelpie_free_trained)> owned(read,
                                                                              kelpie_free_trained);
  const std::size_t inputs = samples.inputs.size();
  ASSERT_EQ(kelpie_trained_input_count(read), inputs);
  ASSERT_EQ(kelpie_trained_target_count(read), 2U);
  EXPECT_EQ(kelpie_trained_input_name(read, 0), samples.inputs[0]);
  EXPECT_EQ(kelpie_trained_target_name(read, 1), samples.targets[1]);
  EXPECT_EQ(kelpie_trained_target_name(read, 2), nullptr);
  EXPECT_STREQ(kelpie_trained_alignment(read), "commands are taken 0.5 s later");
  std::array<double, 2> a{};
  std::array<double, 2> b{};
  std::array<Prediction, 2> p{};
  std::array<kelpie_prediction, 2> q{};
  std::vector<double> slopes(2 * inputs);
  std::vector<double> jacobian(2 * inputs);
  for (const std::vector<double>& x : drive(2, 100).x) {
    model.predict(x, a);
    ASSERT_EQ(kelpie_trained_predict(read, x.data(), inputs, b.data(), 2), KELPIE_OK);
    ASSERT_EQ(a, b);
    model.predict(x, std::span<Prediction>(p));
    ASSERT_EQ(kelpie_trained_assess(read, x.data(), inputs, q.data(), 2), KELPIE_OK);
    ASSERT_EQ(p[1].lower, q[1].lower);
    ASSERT_EQ(p[1].novelty, q[1].novelty);
    model.predict_with_jacobian(x, a, slopes);
    ASSERT_EQ(
        kelpie_trained_predict_with_jacobian(read, x.data(), inputs, b.data(), 2, jacobian.data()),
        KELPIE_OK);
    ASSERT_EQ(slopes, jacobian);
  }
  EXPECT_EQ(kelpie_trained_predict(read, a.data(), inputs - 1, b.data(), 2), KELPIE_BAD_INPUT);
  kelpie_trained* none = nullptr;
  for (std::size_t size = 0; size < text.size(); size = size < 400 ? size + 1 : 2 * size) {
    ASSERT_EQ(kelpie_read_trained(text.data(), size, &none), KELPIE_BAD_INPUT) << size;
  }
  const std::string deep =
      "{\"more\": " + std::string(100'000, '[') + std::string(100'000, ']') + "," + text.substr(1);
  EXPECT_EQ(kelpie_read_trained(deep.data(), deep.size(), &none), KELPIE_BAD_INPUT);
  EXPECT_NE(std::string(kelpie_last_error()).find("within each other"), std::string::npos);
  EXPECT_EQ(kelpie_read_trained(nullptr, 0, &none), KELPIE_BAD_INPUT);
  EXPECT_EQ(none, nullptr);
}

TEST(ModelJson, LoadsBackToTheSamePredictionsToTheLastBit) {
  const Drive samples = drive(1, 500);
  for (const char* const scaling : {"full", "diagonal"}) {
    const TrainedModel model = trained(samples, scaling);
    const std::string text = format::model_json(model);
    const TrainedModel loaded = format::parse_model_json(text, "model.json");
    EXPECT_EQ(loaded.input_names, model.input_names);
    EXPECT_EQ(loaded.settings.values(), model.settings.values());
    EXPECT_EQ(format::model_json(loaded), text);
    std::array<double, 2> a{};
    std::array<double, 2> b{};
    std::array<Prediction, 2> p{};
    std::array<Prediction, 2> q{};
    for (const std::vector<double>& x : drive(2, 300).x) {
      model.predict(x, a);
      loaded.predict(x, b);
      ASSERT_EQ(a, b);
      model.predict(x, std::span<Prediction>(p));
      loaded.predict(x, std::span<Prediction>(q));
      ASSERT_EQ(p[1].lower, q[1].lower);
      ASSERT_EQ(p[1].novelty, q[1].novelty);
    }
    EXPECT_LT(q[1].upper, HUGE_VAL);
  }
}

// Version 3 had one learner per axis, whose support vectors held their terms; `terms = auto` went
// by the inputs' names, and older files still had the weight of the kernel as a setting.
TEST(ModelJson, ReadsOlderFiles) {
  ModelSettings settings = ModelSettings::from_preset("default", 2);
  settings.assign("learner", "svr");
  settings.assign("terms", "none");
  const Drive samples = drive(1, 500);
  DynamicsModel learner(samples.inputs, samples.targets, settings);
  for (std::size_t i = 0; i < samples.x.size(); ++i) {
    learner.update(samples.x[i], samples.y[i], static_cast<double>(i));
  }
  const TrainedModel model = learner.trained();
  auto json = nlohmann::json::parse(format::model_json(model));
  json["version"] = 3;
  json["settings"].erase("learner");
  json["settings"]["terms"] = "auto";
  json["settings"]["s"] = "1";
  for (auto& axis : json["axes"]) {
    for (const char* const key : {"kernel", "bias", "beta", "support_vectors"}) {
      axis[key] = axis["members"][0][key];
    }
    axis.erase("members");
    axis.erase("bounds");
    axis.erase("steady");
  }
  const TrainedModel loaded = format::parse_model_json(json.dump(), "model.json");
  EXPECT_EQ(loaded.settings.values(), model.settings.values());
  std::array<double, 2> a{};
  std::array<double, 2> b{};
  for (const std::vector<double>& x : drive(2, 100).x) {
    model.predict(x, a);
    loaded.predict(x, b);
    ASSERT_EQ(a, b);
  }
}

// In version 4 `terms = auto` was the set that is `quadratic` now.
TEST(ModelJson, ReadsTheAutoOfVersion4AsQuadratic) {
  ModelSettings settings = ModelSettings::from_preset("small", 2);
  settings.assign("terms", "quadratic");
  const Drive samples = drive(1, 300);
  DynamicsModel learner({"speed", "roll"}, samples.targets, settings);
  for (std::size_t i = 0; i < samples.x.size(); ++i) {
    learner.update(samples.x[i], samples.y[i], static_cast<double>(i));
  }
  const TrainedModel model = learner.trained();
  auto json = nlohmann::json::parse(format::model_json(model));
  json["settings"]["terms"] = "auto";
  EXPECT_THROW(format::parse_model_json(json.dump(), "model.json"), InputError);
  json["version"] = 4;
  const TrainedModel loaded = format::parse_model_json(json.dump(), "model.json");
  std::array<double, 2> a{};
  std::array<double, 2> b{};
  for (const std::vector<double>& x : drive(2, 20).x) {
    model.predict(x, a);
    loaded.predict(x, b);
    ASSERT_EQ(a, b);
  }
}

TEST(ModelJson, KeepsTheSteadyPart) {
  Drive samples = drive(1, 500);
  ModelSettings settings = ModelSettings::from_preset("default", 2);
  settings.assign("states", "speed,thrust");
  DynamicsModel model(samples.inputs, samples.targets, settings);
  for (std::size_t i = 0; i < samples.x.size(); ++i) {
    model.update(samples.x[i], samples.y[i], static_cast<double>(i));
  }
  TrainedModel saved = model.trained();
  SteadyModel& steady = saved.axes[0].steady;
  steady = {.state = 0,
            .weights = std::vector<double>(
                TermSet::open_loop(samples.inputs, std::vector<std::size_t>{0, 1}).size() + 1, 0.1),
            .share = 0.75,
            .error = 0.5,
            .error_time_s = 2.5,
            .noise = 0.25,
            .off = {0.1, 0.2, 0.3, 0.4},
            .kept = {1.0, 0.9, 0.8, 0.7},
            .seen = {{-1.0, 1.0}, {0.0, 3.0}}};
  const TrainedModel loaded = format::parse_model_json(format::model_json(saved), "m.json");
  EXPECT_EQ(loaded.axes[0].steady.weights, saved.axes[0].steady.weights);
  EXPECT_EQ(loaded.axes[0].steady.state, 0U);
  EXPECT_EQ(loaded.axes[0].steady.error, 0.5);
  EXPECT_EQ(loaded.axes[0].steady.error_time_s, 2.5);
  EXPECT_EQ(loaded.axes[0].steady.share, 0.75);
  EXPECT_EQ(loaded.axes[0].steady.off, steady.off);
  EXPECT_EQ(loaded.axes[0].steady.kept, steady.kept);
  EXPECT_EQ(loaded.axes[0].steady.noise, 0.25);
  EXPECT_EQ(loaded.axes[0].steady.seen[1].high, 3.0);
  auto json = nlohmann::json::parse(format::model_json(saved));
  json["axes"][0]["steady"]["seen"].erase(0);
  EXPECT_EQ(message_of<InputError>([&] { format::parse_model_json(json.dump(), "m.json"); }),
            "m.json: axes[0].steady.seen: needs one range per input");
}

std::string refusal(const nlohmann::json& json) {
  return message_of<InputError>([&] { format::parse_model_json(json.dump(), "m.json"); });
}

TEST(ModelJson, UnitsAndDoubtAreKeptAndWrongOnesNamed) {
  const testing::TemporaryFolder folder;
  const TrainedModel model = trained(drive(3, 200), "diagonal");
  const format::ModelInfo info{.units = {{"u", "m s^-1"}, {"udot", "m s^-2"}},
                               .doubt = "udot is in g"};
  testing::write_text(folder / "m.json", format::model_json(model, info));
  format::ModelInfo read;
  format::read_model(folder / "m.json", &read);
  EXPECT_EQ(read.units, info.units);
  EXPECT_EQ(read.doubt, info.doubt);
  EXPECT_EQ(format::model_json(format::read_model(folder / "m.json")), format::model_json(model));
  auto bad = nlohmann::json::parse(format::model_json(model, info));
  bad["doubt"] = 3;
  EXPECT_EQ(refusal(bad), "m.json: doubt: is not a text");
  bad.erase("doubt");
  bad["units"]["u"] = "m//s";
  EXPECT_EQ(refusal(bad).find("m.json: units.u: 'm//s' is not a unit"), 0U) << refusal(bad);
}

TEST(ModelJson, RefusesDamagedFilesNamingTheKey) {
  const auto good = nlohmann::json::parse(format::model_json(trained(drive(3, 200), "diagonal")));
  EXPECT_EQ(refusal(good), "");
  EXPECT_EQ(message_of<InputError>([] {
              format::parse_model_json("{\"format\": ", "m.json");
            }).substr(0, 27),
            "m.json: file: is not JSON (");
  auto bad = good;
  bad["format"] = "other";
  EXPECT_EQ(refusal(bad), "m.json: format: has to be 'kelpie-model'");
  bad = good;
  bad["axes"][0]["members"][0]["bias"] = 1e200;
  EXPECT_EQ(
      refusal(bad),
      "m.json: axes[0].members[0].bias: is out of range; kelpie writes numbers within ±1e100");
  EXPECT_TRUE(message_of<InputError>([] {
                format::parse_model_json("{\"format\": 1e999}", "m.json");
              }).starts_with("m.json: file: holds a number out of a double's range: "));
  bad = good;
  bad["version"] = 1;
  EXPECT_EQ(refusal(bad), "m.json: version: this kelpie reads version 6");
  bad = good;
  bad["axes"][1]["members"][0].erase("bias");
  EXPECT_EQ(refusal(bad), "m.json: axes[1].members[0]: has no 'bias'");
  bad = good;
  bad["axes"][0]["members"][0]["beta"].erase(0);
  EXPECT_NE(refusal(bad).find("m.json: axes[0].members[0].beta: holds"), std::string::npos);
  bad = good;
  bad["axes"][0]["members"][0]["support_vectors"][3] = {1.0};
  EXPECT_EQ(refusal(bad),
            "m.json: axes[0].members[0].support_vectors[3]: holds 1 numbers; 2 are needed");
  bad = good;
  bad["axes"][0]["members"][0]["share"] = 0.9;
  EXPECT_EQ(refusal(bad), "m.json: axes[0].members: needs shares that add up to 1");
  bad = good;
  bad["axes"][0]["bounds"] = {1.0, -1.0};
  EXPECT_EQ(refusal(bad), "m.json: axes[0].bounds: has to go up");
  bad = good;
  bad["axes"][0]["scaling"]["target_scale"] = 0.0;
  EXPECT_EQ(refusal(bad), "m.json: axes[0].scaling.target_scale: has to be > 0");
  bad = good;
  bad["settings"]["gamma"] = "-1";
  EXPECT_EQ(refusal(bad),
            "m.json: settings: gamma: -1 is out of range; it has to be more than 0, up to 1e+09");
  bad = good;
  bad["axes"] = nlohmann::json::array();
  EXPECT_EQ(refusal(bad), "m.json: axes: needs 1 to 64 axes");
  EXPECT_NE(refusal(nlohmann::json(7)), "");
  EXPECT_NE(message_of<InputError>([] {
              format::read_model("/nonexistent/model.json");
            }).find("cannot be read"),
            std::string::npos);
}

}  // namespace
}  // namespace kelpie::model_json_test
