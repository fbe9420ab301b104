// SPDX-License-Identifier: Apache-2.0
#include "format/memory_json.hpp"
#include "report/memory_table.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "kelpie/core/error.hpp"
#include "kelpie/model/stored_past_model.hpp"
#include "support.hpp"

namespace kelpie::memory_json_test {
namespace {

using testing::message_of;

// Of a constant and a term.
StoredPastModel past(std::int64_t number) {
  return {.info = {.number = number,
                   .from_s = 0.1,
                   .until_s = 1e9 / 3.0,
                   .samples = 12'345,
                   .recalls = 2,
                   .usual_error = 0.1 + 0.2},
          .rows_per_sample = 2.5,
          .sums = {0.5, 60.0, 58.0, 7.0, 1.0, 1.0 / 3.0, 58.0, -2.0, 40.0}};
}

format::PastModelsFile memory() {
  return {.inputs = {"u", "n"},
          .units = {{"u", "m s^-1"}, {"udot", "m s^-2"}},
          .terms = {"1", "u"},
          .axes = {{"udot", {past(1), past(3)}}, {"rdot", {past(1)}}}};
}

ModelSettings settings_of(const std::string& terms) {
  ModelSettings settings = ModelSettings::from_preset("default", 2);
  settings.assign("terms", terms);
  return settings;
}

log::Dataset log() {
  log::Dataset data;
  data.input_names = {"u", "n"};
  data.target_names = {"udot", "rdot"};
  data.units.emplace("u", Unit::parse("m/s"));
  return data;
}

TEST(MemoryJson, ReadsBackToTheLastBit) {
  const std::string text = format::memory_json(memory());
  const format::PastModelsFile read = format::parse_memory_json(text, "m.json");
  EXPECT_EQ(format::memory_json(read), text);
  EXPECT_EQ(read.size(), 3U);
  const StoredPastModel& model = read.axes[0].models[1];
  EXPECT_EQ(model.info.number, 3);
  EXPECT_EQ(model.info.usual_error, 0.1 + 0.2);
  EXPECT_EQ(model.info.until_s, 1e9 / 3.0);
  EXPECT_EQ(read.terms, memory().terms);
  EXPECT_EQ(model.sums, past(3).sums);
  EXPECT_EQ(model.rows_per_sample, 2.5);
}

TEST(MemoryJson, RefusesNumbersThatNobodyCanCalculateWith) {
  auto json = nlohmann::json::parse(format::memory_json(memory()));
  json["axes"][0]["models"][1]["sums"][2] = -1.7e308;
  EXPECT_EQ(
      message_of<InputError>([&] { format::parse_memory_json(json.dump(), "m.json"); }),
      "m.json: axes[0].models[1].sums[2]: is out of range; kelpie writes numbers within ±1e100");
}

TEST(MemoryJson, RefusesWhatDoesNotFitWithItsPlace) {
  const auto good = nlohmann::json::parse(format::memory_json(memory()));
  const auto refusal = [](const nlohmann::json& json) {
    return message_of<InputError>([&] { format::parse_memory_json(json.dump(), "m.json"); });
  };
  EXPECT_EQ(refusal(good), "");
  auto bad = good;
  bad["version"] = 1;
  EXPECT_EQ(refusal(bad),
            "m.json: version: 1 holds the samples of past models, as kelpie 1.x wrote them; kelpie "
            "2.0.0 keeps sums (CHANGELOG.md): give the name of a new file");
  bad["version"] = 3;
  EXPECT_EQ(refusal(bad), "m.json: version: this kelpie reads version 2");
  bad = good;
  bad["axes"][0]["models"][0]["sums"][2] = 0;
  EXPECT_EQ(refusal(bad), "m.json: axes[0].models[0].sums: are of no samples");
  bad = good;
  bad["terms"].push_back("n");
  EXPECT_EQ(refusal(bad), "m.json: axes[0].models[0].sums: holds 9 numbers; 13 are needed");
  bad = good;
  bad["axes"][0]["models"][1]["number"] = 1;
  EXPECT_EQ(refusal(bad), "m.json: axes[0].models[1].number: is that of two models");
  bad = good;
  bad["axes"][0]["models"][1]["number"] = 0.5;
  EXPECT_EQ(refusal(bad), "m.json: axes[0].models[1].number: has to be a whole number >= 1");
  bad = good;
  bad["axes"][1]["models"][0]["usual_error"] = 0;
  EXPECT_EQ(refusal(bad), "m.json: axes[1].models[0].usual_error: has to be > 0");
  bad = good;
  bad["axes"][1]["target"] = "udot";
  EXPECT_EQ(refusal(bad), "m.json: axes[1].target: is that of two axes");
  const std::string text = format::memory_json(memory());
  for (std::size_t length = 0; length + 2 < text.size(); length += 7) {
    EXPECT_NE(
        message_of<InputError>([&] { format::parse_memory_json(text.substr(0, length), "m"); }),
        "");
  }
}

TEST(MemoryJson, IsGivenToItsOwnVehicleOnly) {
  const ModelSettings settings = settings_of("u");
  const auto refusal = [&](const format::PastModelsFile& known, const log::Dataset& data,
                           const ModelSettings& used) {
    DynamicsModel model(data.input_names, data.target_names, used);
    std::string message =
        message_of<InputError>([&] { known.give_to(model, data, used, "m.json"); });
    EXPECT_EQ(model.past_models(0).size() + model.past_models(1).size(),
              message.empty() ? known.size() : 0U);
    return message;
  };
  EXPECT_EQ(refusal(memory(), log(), settings), "");
  EXPECT_EQ(refusal(memory(), log(), settings_of("n")),
            "m.json: terms: are '1; u' there, '1; n' in the run: give the same terms");
  log::Dataset other = log();
  other.input_names = {"n", "u"};
  EXPECT_EQ(refusal(memory(), other, settings),
            "m.json: inputs: are 'u, n' there, 'n, u' in the log: not the same vehicle's memory");
  other = log();
  other.units.at("u") = Unit::parse("km/s");
  EXPECT_NE(refusal(memory(), other, settings).find("units.u: is 'm s^-1' there, 'km s^-1'"),
            std::string::npos);
  other = log();
  other.target_names = {"udot", "vdot"};
  EXPECT_NE(refusal(memory(), other, settings)
                .find("'rdot' is no target (did you mean 'udot'?); there are udot, vdot"),
            std::string::npos);
  ModelSettings small = settings;
  small.assign("memory", "1");
  EXPECT_NE(refusal(memory(), log(), small).find("udot: holds 2 models; the settings keep 1"),
            std::string::npos);
}

// What a run has learned, whatever others have written since it began.
TEST(MemoryJson, NothingThatTwoRunsHaveLearnedIsLost) {
  const ModelSettings settings = settings_of("u");
  const auto begin = [] {
    return format::parse_memory_json(format::memory_json(memory()), "m.json");
  };
  const auto learn = [](format::PastModelsFile& run, std::size_t model, std::int64_t samples) {
    run.axes[0].models[model].info.samples += samples;
  };
  format::PastModelsFile a = begin();
  learn(a, 0, 100);
  a.axes[0].models.push_back(past(4));
  format::PastModelsFile b = begin();
  learn(b, 1, 50);
  b.axes[0].models.push_back(past(4));
  b.axes[0].models.back().sums[0] = 7.0;

  format::PastModelsFile file = begin();
  file.add(a, settings, "m.json");
  file.add(b, settings, "m.json");
  EXPECT_EQ(file.find("udot:1", "m").info.samples, 12'345 + 100);
  EXPECT_EQ(file.find("udot:3", "m").info.samples, 12'345 + 50);
  EXPECT_EQ(file.find("udot:4", "m").sums[0], 0.5);
  EXPECT_EQ(file.find("udot:5", "m").sums[0], 7.0);
  EXPECT_EQ(file.axes[1].models.size(), 1U);

  format::PastModelsFile forgotten = begin();
  forgotten.forget("udot:1", "m.json");
  forgotten.forget("udot:3", "m.json");
  forgotten.add(b, settings, "m.json");  // it has learned nothing of udot:1
  EXPECT_EQ(forgotten.axes[0].models.size(), 2U);
  EXPECT_EQ(forgotten.find("udot:3", "m").info.samples, 12'345 + 50);
}

TEST(MemoryJson, WhenTheFileIsFullTheLeastUsefulLeaves) {
  ModelSettings settings = ModelSettings::from_preset("default", 2);
  settings.assign("memory", "2");
  format::PastModelsFile run = memory();
  run.axes[0].models = {past(7)};
  run.axes[0].models[0].info.until_s = 1.0;
  run.axes[0].models[0].info.recalls = 5;
  format::PastModelsFile file = memory();
  file.axes[0].models[1].info.until_s = 1.0;
  file.add(run, settings, "m.json");
  ASSERT_EQ(file.axes[0].models.size(), 2U);
  EXPECT_EQ(file.axes[0].models[0].info.number, 1);
  EXPECT_EQ(file.axes[0].models[1].info.number, 7);
}

TEST(MemoryJson, AnotherVehiclesModelsAreNotAdded) {
  const ModelSettings settings = ModelSettings::from_preset("default", 2);
  format::PastModelsFile other = memory();
  other.inputs = {"v", "n"};
  format::PastModelsFile file = memory();
  EXPECT_EQ(message_of<InputError>([&] { file.add(other, settings, "m.json"); }),
            "m.json: inputs: are 'u, n' there, 'v, n' in the log: not the same vehicle's memory");
}

TEST(MemoryJson, ModelsAreFoundAndForgottenByName) {
  format::PastModelsFile known = memory();
  EXPECT_EQ(known.find("udot:3", "m.json").info.number, 3);
  const auto refusal = [&](const char* name) {
    return message_of<InputError>([&] { known.find(name, "m.json"); });
  };
  EXPECT_EQ(refusal("udot:2"),
            "m.json: udot:2: isn't there (did you mean 'udot:1'?); there are udot:1, udot:3, "
            "rdot:1");
  known.forget("udot:1", "m.json");
  EXPECT_EQ(known.size(), 2U);
  EXPECT_NE(refusal("udot:1"), "");
  known.forget("udot:3", "m.json");
  known.forget("rdot:1", "m.json");
  EXPECT_EQ(refusal("udot:1"), "m.json: udot:1: isn't there: the memory holds no models");
}

TEST(MemoryJson, TablesTellWithUnits) {
  format::PastModelsFile known = memory();
  const std::string list = report::memory_table(known);
  for (const char* const part : {"udot:3", "12,345", "0.3 m s^-2", "rdot:1"}) {
    EXPECT_NE(list.find(part), std::string::npos) << part << "\n" << list;
  }
  const std::string one = report::past_model_table(known, "udot:3", known.find("udot:3", "m"));
  for (const char* const part :
       {"60 samples", "root mean square", "-0.03448", "0.8305", "Recalls: 2"}) {
    EXPECT_NE(one.find(part), std::string::npos) << part << "\n" << one;
  }
}

}  // namespace
}  // namespace kelpie::memory_json_test
