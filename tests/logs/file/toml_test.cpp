// SPDX-License-Identifier: Apache-2.0
#include "file/toml.hpp"

#include <gtest/gtest.h>

#include <array>
#include <fstream>

#include "kelpie/core/error.hpp"
#include "support.hpp"

namespace kelpie::toml_test {
namespace {

using file::TomlNode;

class Toml : public ::testing::Test {
 protected:
  TomlNode read(const std::string& text) {
    std::ofstream(folder_ / "a.toml", std::ios::binary) << text;
    return TomlNode::read(folder_ / "a.toml");
  }

  // What `use` says of the file, without its folder.
  template <typename Use>
  std::string refusal(const std::string& text, Use use) {
    const std::string said = testing::message_of<InputError>([&] { use(read(text)); });
    return said.substr(std::min(said.size(), folder_.path().string().size() + 1));
  }

  testing::TemporaryFolder folder_;
};

TEST_F(Toml, AValueOutlivesTheTableItStandsIn) {
  const TomlNode speed = read("[motor]\nspeed = 2.5\n")["motor"]["speed"];
  EXPECT_EQ(speed.number(), 2.5);
  EXPECT_EQ(speed.key(), "speed");
  EXPECT_EQ(speed.place().line, 2U);
}

TEST_F(Toml, MembersComeInTheOrderOfTheFile) {
  std::string keys;
  for (const TomlNode& member : read("z = 1\na = 2\n[m]\nx = 1\n[b]\nx = 1\n").members()) {
    keys += member.key();
  }
  for (const TomlNode& member :
       read("[log]\ncommands = {v = 1, n = 2, a = 3}\n")["log"]["commands"].members()) {
    keys += member.key();
  }
  EXPECT_EQ(keys, "zambvna");
}

TEST_F(Toml, ASettingIsTextWhateverItIsWrittenAs) {
  const TomlNode root = read("a = 900\nb = 1e-3\nc = \"off\"\nd = [1, 0.5, \"auto\"]\ne = inf\n");
  EXPECT_EQ(root["a"].setting(), "900");
  EXPECT_EQ(root["b"].setting(), "0.001");
  EXPECT_EQ(root["c"].setting(), "off");
  EXPECT_EQ(root["d"].setting(), "1,0.5,auto");
  EXPECT_EQ(root["e"].setting(), "inf");
}

TEST_F(Toml, WhatIsWrongIsToldWithFileLineAndKey) {
  EXPECT_EQ(refusal("\n[m]\nv = \"2\"\n", [](const TomlNode& root) { root["m"]["v"].number(); }),
            "a.toml:3: m.v: has to be a finite number");
  EXPECT_EQ(refusal("v = nan\n", [](const TomlNode& root) { root["v"].number("a speed"); }),
            "a.toml:1: v: has to be a speed");
  EXPECT_EQ(refusal("\n[m]\n", [](const TomlNode& root) { root["m"]["v"].number(); }),
            "a.toml:2: m.v: is missing");
  EXPECT_EQ(refusal("[m]\nspead = 1\n",
                    [](const TomlNode& root) {
                      root["m"].table({"speed", "lag"});
                    }),
            "a.toml:2: m.spead: unknown key (did you mean 'speed'?); the keys are speed, lag");
  EXPECT_EQ(refusal("m = 1\n", [](const TomlNode& root) { root["m"].table({"speed"}); }),
            "a.toml:1: m: has to be a table");
  EXPECT_EQ(refusal("[[m]]\nv = 1\n[[m]]\nlag = 1\n",
                    [](const TomlNode& root) { root["m"].tables({"v"}); }),
            "a.toml:4: m[1].lag: unknown key; the keys are v");
  EXPECT_EQ(refusal("a = [1,\n \"b\"]\n",
                    [](const TomlNode& root) {
                      std::array<double, 2> values{};
                      file::read_numbers(root["a"], values);
                    }),
            "a.toml:2: a: has to be a finite number");
  EXPECT_EQ(refusal("a = -1\n", [](const TomlNode& root) { root["a"].count(); }),
            "a.toml:1: a: has to be a whole number, 0 or more");
  EXPECT_EQ(refusal("a = [[1], [2]]\n", [](const TomlNode& root) { root["a"].setting(); }),
            "a.toml:1: a: is a list of lists; one value per target is wanted");
}

TEST_F(Toml, AnErrorFoundLaterGetsTheLineOfItsKeyOrOfWhatEnclosesIt) {
  const auto checked = [&](const std::string& field) {
    return refusal("[[m]]\nv = 1\n[[m]]\nv = 2\n", [&](const TomlNode& root) {
      root.locate_errors(
          [&] { throw InputError({.file = {}, .line = 0, .field = field}, "is too fast"); });
    });
  };
  EXPECT_EQ(checked("m[1].v"), "a.toml:4: m[1].v: is too fast");
  EXPECT_EQ(checked("m[1].lag"), "a.toml:3: m[1].lag: is too fast");
}

TEST_F(Toml, AnErrorAboutAValueGetsThePlaceOfTheValue) {
  EXPECT_EQ(refusal("[m]\nv = 1\n",
                    [](const TomlNode& root) {
                      file::located(root["m"]["v"], [] { throw InputError("is too fast"); });
                    }),
            "a.toml:2: m.v: is too fast");
  const TomlNode root = read("v = 1\n");
  EXPECT_EQ(file::located(root["v"], [&] { return root["v"].number(); }), 1.0);
}

TEST_F(Toml, KeysOfVeryManyPartsAreRefusedAndDotsElsewhereAreNot) {
  std::string dots;
  for (int i = 0; i < 50'000; ++i) {
    dots += "a.";
  }
  const std::string why = "a.toml:2: a key of more than 16 dotted parts";
  const auto start = [&](const std::string& text) {
    return refusal(text, [](const TomlNode&) {}).substr(0, why.size());
  };
  EXPECT_EQ(start("x = 1\n" + dots + "a = 1\n"), why);
  EXPECT_EQ(start("x = 1\n[" + dots + "a]\n"), why);
  EXPECT_EQ(start("x = [1,\n{" + dots + "a = 1}]\n"), why);
  EXPECT_EQ(start("x = \"\\\" #\"\n" + dots + "\"b\" = 1\n"), why);
  EXPECT_EQ(start("x = \"" + dots + "\"\ny = '" + dots + "' # " + dots + "\n"), "");
  EXPECT_EQ(start("x = \"\"\"\n\"" + dots + "\n\"\"\"\ny = '''\n'" + dots + "'''\n"), "");
}

TEST_F(Toml, WhatIsNoTomlIsRefused) {
  EXPECT_TRUE(
      refusal("a = 1\nb = = 2\n", [](const TomlNode&) {}).starts_with("a.toml:2: is not TOML: "));
  for (const auto& path : {folder_ / "none.toml", folder_.path()}) {
    EXPECT_NE(testing::message_of<InputError>([&] {
                TomlNode::read(path);
              }).find("a TOML file is needed"),
              std::string::npos);
  }
}

}  // namespace
}  // namespace kelpie::toml_test
