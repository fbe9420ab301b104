// SPDX-License-Identifier: Apache-2.0
// What model.json and the C file say of the alignment.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "format/model_c.hpp"
#include "format/model_json.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/model/trained_model.hpp"
#include "model/random_model.hpp"
#include "support.hpp"

namespace kelpie::alignment_json_test {
namespace {

using testing::message_of;

TrainedModel shifted_model() {
  RandomStream random(1, "model");
  TrainedModel model = testing::random_model(random, {});
  model.alignment = {.lag_s = -0.3, .rows = -6, .commands = {model.input_names.back()}};
  return model;
}

TEST(AlignmentJson, IsKeptByModelJsonAndToldByTheCFile) {
  const TrainedModel model = shifted_model();
  const TrainedModel loaded = format::parse_model_json(format::model_json(model), "m.json");
  EXPECT_EQ(loaded.alignment.lag_s, -0.3);
  EXPECT_EQ(loaded.alignment.rows, -6);
  EXPECT_EQ(loaded.alignment.commands, model.alignment.commands);
  EXPECT_NE(format::model_c(model, {}).find("0.3 s earlier"), std::string::npos);
}

TrainedModel model_with_actuators() {
  TrainedModel model = shifted_model();
  model.alignment = {
      .commands = {model.input_names[1], model.input_names[2]},
      .actuators = {{.neutral = 1500.0, .lag_s = 0.1 + 0.2},
                    {.dead_band = 0.1, .astern = 0.8, .lag_s = 1.5, .rate = 3.0, .delay_s = 0.25}}};
  return model;
}

TEST(AlignmentJson, ActuatorsAreKeptToTheBitWithoutAShift) {
  const TrainedModel model = model_with_actuators();
  const TrainedModel loaded = format::parse_model_json(format::model_json(model), "m.json");
  EXPECT_FALSE(loaded.alignment.shifts());
  EXPECT_EQ(loaded.alignment.commands, model.alignment.commands);
  EXPECT_EQ(loaded.alignment.actuators, model.alignment.actuators);
}

TEST(AlignmentJson, ACommandWithoutAnEntryActsAtOnce) {
  const TrainedModel model = model_with_actuators();
  auto json = nlohmann::json::parse(format::model_json(model));
  json["alignment"]["actuators"].erase(0);
  const TrainedModel loaded = format::parse_model_json(json.dump(), "m.json");
  EXPECT_EQ(loaded.alignment.actuators, (std::vector<Actuator>{{}, model.alignment.actuators[1]}));
}

TEST(AlignmentJson, RefusesActuatorsThatCantBe) {
  const auto good = nlohmann::json::parse(format::model_json(model_with_actuators()));
  const auto refusal = [&](const char* key, const nlohmann::json& value) {
    auto bad = good;
    bad["alignment"]["actuators"][1][key] = value;
    return message_of<InputError>([&] { format::parse_model_json(bad.dump(), "m.json"); });
  };
  const std::string place = "m.json: alignment.actuators[1]";
  EXPECT_EQ(refusal("lag_s", -0.1), place + ": lag_s: has to be 0 s or more");
  EXPECT_EQ(refusal("delay_s", 11), place + ": delay_s: has to be from 0 to 10 s");
  EXPECT_EQ(refusal("astern", 0), place + ": astern: has to be > 0");
  EXPECT_EQ(refusal("rate", -1), place + ": rate: has to be 0 or more");
  EXPECT_EQ(refusal("dead_band", -1), place + ": dead_band: has to be 0 or more");
  EXPECT_EQ(refusal("command", "x"), place + ".command: has to be among 'commands'");
  EXPECT_EQ(refusal("command", good["inputs"][1]), place + ".command: has an actuator already");
  for (const Actuator::Field& field : Actuator::fields()) {
    const std::string name(field.name);
    EXPECT_EQ(refusal(name.c_str(), "a").substr(0, place.size() + name.size() + 1),
              place + "." + name);
  }
  auto nothing = good;
  nothing["alignment"]["actuators"].clear();
  EXPECT_EQ(message_of<InputError>([&] {
              format::parse_model_json(nothing.dump(), "m.json");
            }).substr(0, 25),
            "m.json: alignment.shift_s");
}

TEST(AlignmentJson, FilesWithoutItHaveNone) {
  auto json = nlohmann::json::parse(format::model_json(shifted_model()));
  json.erase("alignment");
  const TrainedModel loaded = format::parse_model_json(json.dump(), "m.json");
  EXPECT_TRUE(loaded.alignment.none());
  EXPECT_EQ(format::model_c(loaded, {}).find("Alignment"), std::string::npos);
}

TEST(AlignmentJson, RefusesValuesThatCantBe) {
  const auto good = nlohmann::json::parse(format::model_json(shifted_model()));
  const auto refusal = [&](const char* key, const nlohmann::json& value) {
    auto bad = good;
    bad["alignment"][key] = value;
    return message_of<InputError>([&] { format::parse_model_json(bad.dump(), "m.json"); });
  };
  for (const nlohmann::json& shift : std::vector<nlohmann::json>{0.3, 0, -11, "a", nullptr}) {
    EXPECT_EQ(refusal("shift_s", shift).substr(0, 25), "m.json: alignment.shift_s") << shift;
  }
  for (const nlohmann::json& rows : std::vector<nlohmann::json>{-0.5, -1e12, "a"}) {
    EXPECT_EQ(refusal("rows", rows).substr(0, 22), "m.json: alignment.rows") << rows;
  }
  EXPECT_NE(refusal("commands", {"no such input"}), "");
  EXPECT_NE(refusal("commands", nlohmann::json::array()), "");
}

TEST(AlignmentJson, ACurrentIsReadBackAndBadOnesAreRefused) {
  TrainedModel model = shifted_model();
  Current& water = model.alignment.water;
  water = {.heading = "psi",
           .unit = -0.5,
           .surge = model.input_names[0],
           .sway = model.input_names[0],
           .yaw_rate = model.input_names[0],
           .targets = {0, 0},
           .times_s = {0.0, 1.5},
           .velocity = {{0.1, -0.2}, {0.3, 0.4}}};
  const auto good = nlohmann::json::parse(format::model_json(model));
  EXPECT_EQ(format::parse_model_json(good.dump(), "m.json").alignment.water, water);
  const auto refusal = [&](const char* key, const nlohmann::json& value) {
    auto bad = good;
    bad["alignment"]["current"][key] = value;
    return message_of<InputError>([&] { format::parse_model_json(bad.dump(), "m.json"); });
  };
  const std::string place = "m.json: alignment.current";
  EXPECT_EQ(refusal("surge", "x"), place + ".surge: has to be an input");
  EXPECT_EQ(refusal("targets", {0, 64}), place + ".targets: has to hold places of targets, from 0");
  EXPECT_EQ(refusal("times_s", nlohmann::json::array()), place + ".times_s: has to hold a time");
  for (const char* const key : {"unit_rad", "times_s", "velocity_m_s"}) {
    EXPECT_EQ(refusal(key, {0, 0}).substr(0, place.size()), place) << key;
  }
}

}  // namespace
}  // namespace kelpie::alignment_json_test
