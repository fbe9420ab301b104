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

}  // namespace
}  // namespace kelpie::alignment_json_test
