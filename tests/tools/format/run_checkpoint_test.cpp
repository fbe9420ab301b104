// SPDX-License-Identifier: Apache-2.0
#include "format/run_checkpoint.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "kelpie/core/error.hpp"
#include "support.hpp"

namespace kelpie::run_checkpoint_test {
namespace {

using testing::message_of;

log::Dataset small_data() {
  log::Dataset data;
  data.source = "log.csv";
  data.input_names = {"u"};
  data.target_names = {"udot"};
  data.inputs = {1.0, 2.0, 3.0};
  data.targets = {0.1, 0.2, 0.3};
  data.times_s = {0.0, 0.25, 0.5};
  data.configurations = {0, 0, 0};
  data.units.emplace("u", Unit::parse("m/s"));
  return data;
}

format::RunIdentity identity(const log::Dataset& data, const std::string& gamma = "0.1",
                             std::uint64_t seed = 1) {
  ModelSettings settings = ModelSettings::from_preset("default", 1);
  settings.assign("gamma", gamma);
  return format::identify_run(data, {"by hand", {0, 1}, {2}}, settings,
                              {.kelpie = "0.1.0",
                               .seed = seed,
                               .scales = "first 200",
                               .align = "none",
                               .validate_every = 0});
}

format::FoundCheckpoint found(const format::Checkpoint& checkpoint) {
  return {checkpoint, "out/checkpoint.kelpie", ""};
}

const format::RunState kState{42, "model", "stream", ""};

std::string refusal(const format::RunIdentity& now) {
  const format::FoundCheckpoint there = found(format::pack_run(identity(small_data()), kState));
  return message_of<InputError>([&] { format::unpack_run(there, now); });
}

TEST(RunCheckpoint, TheSameRunTakesUpItsState) {
  const format::Checkpoint packed = format::pack_run(identity(small_data()), kState);
  const format::RunState state = format::unpack_run(found(packed), identity(small_data()));
  EXPECT_EQ(state.samples_shown, 42U);
  EXPECT_EQ(state.model, "model");
  EXPECT_EQ(state.stream, "stream");
  EXPECT_EQ(state.file, "out/checkpoint.kelpie");
  const auto header = nlohmann::json::parse(packed.header);
  EXPECT_EQ(header["units"]["u"], "m s^-1");
  EXPECT_EQ(header["settings"]["buffer"], "900");
}

// A log may move, and units are for display: neither stands in the way.
TEST(RunCheckpoint, PathAndUnitsMayChange) {
  log::Dataset data = small_data();
  data.source = "/elsewhere/log.csv";
  data.units.clear();
  EXPECT_EQ(refusal(identity(data)), "");
}

TEST(RunCheckpoint, WhatDiffersIsNamedWithBothValues) {
  EXPECT_EQ(refusal(identity(small_data(), "0.2")),
            "out/checkpoint.kelpie: gamma: is '0.1' there, '0.2' in this run; a run goes on only "
            "as it began");
  EXPECT_NE(refusal(identity(small_data(), "0.1", 2)).find("seed: is '1' there, '2'"),
            std::string::npos);
  log::Dataset data = small_data();
  data.inputs[1] = 2.0000000001;
  EXPECT_NE(refusal(identity(data)).find("log.checksum: is '"), std::string::npos);
  data = small_data();
  data.times_s.back() = 0.75;
  EXPECT_NE(refusal(identity(data)).find("log.last_time_s: is '0.5' there, '0.75'"),
            std::string::npos);
  data = small_data();
  data.target_names = {"vdot"};
  EXPECT_NE(refusal(identity(data)).find("targets: is 'udot' there, 'vdot'"), std::string::npos);
}

TEST(RunCheckpoint, AHeaderOfSomethingElseIsRefused) {
  const format::Checkpoint good = format::pack_run(identity(small_data()), kState);
  for (const std::string header : {"", "[]", "{}", R"({"format": "kelpie-model"})", "\xFF{",
                                   R"({"format": "kelpie-checkpoint", "model_bytes": -1})"}) {
    EXPECT_EQ(message_of<InputError>([&] {
                format::unpack_run(found({header, good.state}), identity(small_data()));
              }),
              "out/checkpoint.kelpie: is no checkpoint of a run")
        << header;
  }
  EXPECT_THROW(format::unpack_run(found({good.header, good.state + "x"}), identity(small_data())),
               InputError);
}

}  // namespace
}  // namespace kelpie::run_checkpoint_test
