// SPDX-License-Identifier: Apache-2.0
#include "live/configuration.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "format/checkpoint_file.hpp"
#include "kelpie/core/error.hpp"
#include "live/checkpoint.hpp"
#include "live/mission.hpp"
#include "support.hpp"

namespace kelpie::live_configuration_test {
namespace {

using testing::message_of;
using testing::mission_config;
using testing::TemporaryFolder;

std::string refusal_of(const std::string& config) {
  const TemporaryFolder folder;
  testing::write_text(folder / "x.toml", config);
  const std::string text =
      message_of<InputError>([&] { live::read_configuration(folder / "x.toml", {}); });
  const std::size_t name = text.find("x.toml");
  return name == std::string::npos ? "no file: " + text : text.substr(name);
}

TEST(LiveConfiguration, ErrorsNameFileLineAndKey) {
  EXPECT_EQ(refusal_of(mission_config("", "chekpoint = 3")).substr(0, 30),
            "x.toml:15: live.chekpoint: unk");
  for (const std::string key : {"checkpoint", "status"}) {
    for (const char* const value : {"-1", "0", "-0.0", "1e-300", "0.09", "1e7"}) {
      EXPECT_EQ(refusal_of(mission_config("", key + " = " + value)),
                "x.toml:15: live." + key + ": is out of range; it has to be from 0.1 to 1000000 s");
    }
    for (const char* const value : {"nan", "inf", "-inf", "\"often\"", "[1, 2]"}) {
      EXPECT_EQ(refusal_of(mission_config("", key + " = " + value)),
                "x.toml:15: live." + key + ": has to be a number of s")
          << value;
    }
  }
  EXPECT_EQ(refusal_of(mission_config("", "frozen = \"perhaps\"")),
            "x.toml:15: live.frozen: 'perhaps' has to be \"skip\" or \"learn\"");
  EXPECT_EQ(refusal_of(mission_config("", "align = 11")),
            "x.toml:15: live.align: is out of range; it has to lie within ±10 s");
  EXPECT_NE(refusal_of(mission_config("", "plotjuggler = \"here:\""))
                .find("x.toml:15: live.plotjuggler: 'here:'"),
            std::string::npos);
  EXPECT_NE(refusal_of(mission_config("lag = \"auto\"")).find("log.lag.n"), std::string::npos);
  EXPECT_NE(refusal_of("buffer = 3\n").find("log: names no topics"), std::string::npos);
  EXPECT_NE(refusal_of(mission_config("") + "[lives]\n").find("did you mean 'live'"),
            std::string::npos);
}

TEST(LiveConfiguration, WhatMakesAnotherModelIsInItsIdentity) {
  const TemporaryFolder folder;
  const auto identity_of = [&](const std::string& config) {
    testing::write_text(folder / "x.toml", config);
    return live::read_configuration(folder / "x.toml", {}).identity();
  };
  const live::Fields fields = identity_of(mission_config());
  EXPECT_EQ(identity_of(mission_config("", "checkpoint = 3\nout = \"there\"")), fields);
  for (const char* const log : {"gap = 2", "window = 0.7", "degree = 1", "filter = \"causal\"",
                                "clock = \"header\"", "lag = 0.1"}) {
    EXPECT_NE(identity_of(mission_config(log)), fields) << log;
  }
  EXPECT_NE(identity_of(mission_config("", "align = \"none\"")), fields);
  for (const char* const log : {"scale = {u = 0.01}", "units = {u = \"cm/s\"}", "armed_only = true",
                                "scale = {n = {by = -1, about = 1500}}"}) {
    EXPECT_NE(identity_of(mission_config(log)), fields) << log;
  }
  EXPECT_EQ(identity_of(mission_config("units = {u = \"m/s\"}")), fields);
  const auto with_vectors = [&](const std::string& attitude) {
    return identity_of(
        "[log]\ninputs = [\"u\"]\ntargets = [\"udot\"]\nrate = 10\n"
        "vectors = [{columns = [\"u\", \"v\", \"w\"], from = \"NED\", to = \"FRD\"" +
        attitude +
        "}]\n[log.derived]\nudot = \"d(u)\"\n[log.states]\nu = \"/a:u\"\nv = \"/a:v\"\n"
        "w = \"/a:w\"\na = \"/b:a\"\nb = \"/b:b\"\nc = \"/b:c\"\n");
  };
  const live::Fields turned = with_vectors(", attitude = [\"a\", \"b\", \"c\"]");
  EXPECT_NE(with_vectors(", attitude = [\"b\", \"a\", \"c\"]"), turned);
  EXPECT_NE(with_vectors(", attitude = [\"a\", \"b\", \"c\"], angles = \"deg\""), turned);
}

// One that does not tell the scales, of an earlier build.
TEST(LiveConfiguration, AnEarlierCheckpointGoesOnInTheUnitsOfItsLog) {
  const TemporaryFolder folder;
  const auto configuration_of = [&](const std::string& log) {
    testing::write_text(folder / "x.toml", mission_config(log));
    return live::read_configuration(folder / "x.toml", {});
  };
  const live::Configuration plain = configuration_of("");
  const std::string model = live::model_to_begin_with(plain, {}, std::nullopt).save();
  live::write_checkpoint(folder.path(), plain,
                         {.progress = {}, .alignment = {}, .model = model, .file = {}, .note = {}});
  const auto refusal = [&](const std::string& log) {
    return message_of<InputError>(
        [&] { live::find_checkpoint(folder.path(), configuration_of(log)); });
  };
  EXPECT_EQ(refusal("units = {u = \"m/s\"}"), "");
  EXPECT_NE(refusal("units = {u = \"cm/s\"}").find("log.scale.u: is '1' there, '0.01' in this"),
            std::string::npos);
  format::Checkpoint earlier = format::find_checkpoint(folder.path())->checkpoint;
  nlohmann::json header = nlohmann::json::parse(earlier.header);
  for (const char* const key : {"log.scale.u", "log.scale.n", "log.armed_only"}) {
    EXPECT_EQ(header["run"].erase(key), 1U);
  }
  earlier.header = header.dump();
  format::write_checkpoint(folder.path(), earlier);
  EXPECT_EQ(refusal(""), "");
  EXPECT_NE(refusal("scale = {u = 0.01}").find("log.scale.u: is 'not told' there"),
            std::string::npos);
  EXPECT_NE(refusal("armed_only = true").find("log.armed_only"), std::string::npos);
}

TEST(LiveConfiguration, AHeadingIsAnAngleOfAVehicleInThePlane) {
  const TemporaryFolder folder;
  const auto refusal = [&](const std::string& states, const std::string& units = "") {
    testing::write_text(folder / "x.toml",
                        "[log]\nstates = {v = \"/a:v\", w = \"/a:w\", u = \"/a:u\", "
                        "r = \"/a:r\", psi = \"/b:psi\"}\nrate = 10\ninputs = [" +
                            states + "]\ntargets = [\"a\", \"b\", \"c\"]\nunits = {" + units +
                            "}\n[log.derived]\na = \"d(u)\"\nb = \"d(v)\"\nc = \"d(r)\"\n"
                            "[live]\nheading = \"psi\"\n");
    return message_of<InputError>([&] { live::read_configuration(folder / "x.toml", {}); });
  };
  EXPECT_EQ(refusal("\"u\", \"v\", \"r\""), "");
  EXPECT_EQ(refusal("\"u\", \"v\", \"r\"", "psi = \"deg\""), "");  // becomes rad
  const std::string field = "x.toml:12: live.heading: ";
  EXPECT_NE(refusal("\"u\", \"v\", \"r\"", "psi = \"m\"").find(field + "'psi' is in m;"),
            std::string::npos);
  const std::string other = refusal("\"u\", \"v\", \"w\"");
  EXPECT_NE(other.find(field + "is used for vehicles in the plane"), std::string::npos) << other;
  testing::write_text(folder / "x.toml", mission_config("", "heading = \"uu\""));
  const std::string unknown =
      message_of<InputError>([&] { live::read_configuration(folder / "x.toml", {}); });
  EXPECT_NE(
      unknown.find("live.heading: 'uu' is no signal of [log.states] or [log.commands] (did you "
                   "mean 'u'?)"),
      std::string::npos)
      << unknown;
}

TEST(LiveConfiguration, AnEndpointIsAPortOrAHostAndAPort) {
  EXPECT_EQ(live::parse_endpoint("9870", "x"), (live::Endpoint{"127.0.0.1", 9870}));
  EXPECT_EQ(live::parse_endpoint("rov.local:1", "x"), (live::Endpoint{"rov.local", 1}));
  for (const char* const bad : {"", ":", "host", "host:", ":9870", "65536", "0", "1.5", "h:-1"}) {
    EXPECT_THROW(live::parse_endpoint(bad, "x"), InputError) << bad;
  }
}

}  // namespace
}  // namespace kelpie::live_configuration_test
