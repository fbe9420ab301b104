// SPDX-License-Identifier: Apache-2.0
// Input has bounds (reference/limits.md), and mistakes show before any work: files that never end
// or never begin, lines and tables beyond any log, numbers beyond any vehicle.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <zlib.h>

#include <algorithm>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <string>
#include <vector>

#include "bag/endless_db3.hpp"
#include "cli/command.hpp"
#include "cli/running.hpp"

namespace kelpie::bounds_test {
namespace {

const std::string kSource = KELPIE_SOURCE_DIR;

class Bounds : public testing::CommandTest {
 protected:
  void SetUp() override { write("log.csv", testing::little_log(300)); }

  void expect_refused(const std::string& arguments, const std::string& message) const {
    testing::expect_refused(run(arguments), message);
    EXPECT_FALSE(exists("out")) << arguments;
  }
};

TEST_F(Bounds, ADeviceIsNeitherLogNorModelNorConfiguration) {
  for (const char* const command :
       {"inspect /dev/zero", "learn /dev/zero", "learn log.csv --config /dev/zero",
        "learn log.csv --from /dev/zero", "learn log.csv --scales /dev/zero",
        "predict log.csv --model /dev/zero", "memory list /dev/zero", "simulate /dev/zero --out x",
        "study /dev/zero", "study fleet.toml --against /dev/zero", "compare /dev/zero",
        "tune /dev/zero", "identify /dev/zero", "plan /dev/zero", "vehicle check /dev/zero",
        "rollout log.csv --model /dev/zero", "export /dev/zero --c x.c"}) {
    write("fleet.toml", "logs = \"log.csv\"\n");
    expect_refused(command, "/dev/zero: is a device; ");
  }
}

TEST_F(Bounds, AWaitForAPipeIsSaidAndEndedByCtrlC) {
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  testing::Running running(folder_.path(), {"learn", "pipe"});
  EXPECT_TRUE(running.wait_for_text("pipe: is a pipe, and nothing has come for 5 s; waiting"))
      << running.terminal_text();
  running.press_ctrl_c();
  EXPECT_EQ(running.exit_code(), -SIGINT);
}

TEST_F(Bounds, AFewBytesDoNotUnpackToMuch) {
  gzFile file = ::gzopen((folder_ / "line.csv.gz").c_str(), "wb");
  const std::string piece(1 << 20, 'a');
  for (int k = 0; k < 200; ++k) {
    ::gzwrite(file, piece.data(), static_cast<unsigned>(piece.size()));
  }
  ::gzclose(file);
  expect_refused("inspect line.csv.gz", "line.csv.gz: unpacks to more than 32 MB");
}

TEST_F(Bounds, LinesAndColumnsAreBounded) {
  std::string names = "t";
  std::string row = "0";
  for (int k = 1; k <= 10'000; ++k) {
    names += ",c" + std::to_string(k);
    row += ",1";
  }
  write("wide.csv", names + "\n" + row + "\n");
  expect_refused("inspect wide.csv", "wide.csv:1: 10001 columns; at most 10000 are read");
  write("long.csv", "t,u\n0,1\n1," + std::string(1 << 20, '1') + "\n");
  expect_refused("inspect long.csv", "long.csv:3: is a line of 1048578 characters; at most ");
  write("big.toml", "# " + std::string(5 << 20, 'x') + "\n");
  expect_refused("learn log.csv --config big.toml", "big.toml: is larger than 4 MB");
}

// One more key, as deep as no stack or with as many members as no search survives.
TEST_F(Bounds, JsonIsNeitherDeepNorOfManyKeys) {
  learn_little_log();
  write("fleet.toml", "logs = \"log.csv\"\n");
  const std::string sound = content("out/model.json");
  std::string keys = "{";
  for (int k = 0; k < 2'000; ++k) {
    keys += "\"k" + std::to_string(k) + "\": 0,";
  }
  const std::map<std::string, std::string> kinds{
      {std::string(100'000, '[') + std::string(100'000, ']'),
       "100 lists and objects within each other"},
      {keys + "\"end\": 0}", "1000 keys in an object"}};
  for (const auto& [value, message] : kinds) {
    write("bad.json", "{\"more\": " + value + "," + sound.substr(sound.find('{') + 1));
    for (const char* const command :
         {"predict log.csv --model bad.json", "export bad.json --c x.c",
          "rollout log.csv --model bad.json", "learn log.csv --from bad.json --out out2",
          "learn log.csv --nominal bad.json --out out2",
          "learn log.csv --scales bad.json --out out2",
          "learn log.csv --memory bad.json --out out2", "memory list bad.json",
          "study fleet.toml --against bad.json"}) {
      testing::expect_refused(run(command), "bad.json: file: has more than " + message);
    }
  }
}

TEST_F(Bounds, ARecordingHasNoMoreRowsThanBytes) {
  testing::write_endless_db3(folder_ / "endless.db3", 3);
  for (const char* const command : {"inspect endless.db3", "learn endless.db3"}) {
    expect_refused(command, "holds more rows than can come of its 40960 bytes");
  }
  const testing::Outcome outcome = testing::succeeded(run("inspect endless.db3 --recover"));
  EXPECT_NE((outcome.out + outcome.err).find("holds more rows than"), std::string::npos);
}

TEST_F(Bounds, NoMessageEchoesAMegabyteOrTheLinesOfAName) {
  const std::string much(1'900'000, 'a');
  const std::string lines = "a\nkelpie: all is well\n\x1b[31m";
  for (const std::string& text : {much, lines, much + lines}) {
    const auto toml = [](const std::string& value) { return "\"\"\"" + value + "\"\"\"\n"; };
    const std::string key = std::string("'") + (text == much ? text : "a") + "'";
    write("term.toml", "terms = [" + toml(text) + "]\n");
    write("unit.toml", "[log]\nunits = {u = " + toml(text) + "}\n");
    write("value.toml", "solver = " + toml(text));
    write("number.toml", "gamma = " + toml(text));
    write("column.toml", "[log]\ninputs = [" + toml(text) + "]\n");
    write("key.toml", key + " = 1\n");
    write("deep_key.toml", "[log]\n" + key + " = 1\n");
    write("broken.toml", key + " = \n");
    write("column.csv",
          "t,\"" + text.substr(0, 900'000) + "\",\"" + text.substr(0, 900'000) + "\"\n1,2,3\n");
    nlohmann::json model{{"format", text}, {"version", 1}};
    write("format.json", model.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
    const std::vector<std::vector<std::string>> doors{
        {text},
        {"learn", "log.csv", "--" + text},
        {"learn", "log.csv", "--rate", text},
        {"learn", "log.csv", "--threads", text},
        {"learn", "log.csv", "--time", text},
        {"learn", "log.csv", "--inputs", text, "--targets", "udot"},
        {"learn", "log.csv", "--set", text},
        {"learn", "log.csv", "--set", text + "=1"},
        {"learn", "log.csv", "--set", "gamma=" + text},
        {"learn", "log.csv", "--set", "terms=" + text},
        {"learn", "log.csv", "--set", "preset=" + text},
        {"learn", "log.csv", "--split", text},
        {"learn", "log.csv", "--config", "term.toml"},
        {"learn", "log.csv", "--config", "unit.toml"},
        {"learn", "log.csv", "--config", "value.toml"},
        {"learn", "log.csv", "--config", "number.toml"},
        {"learn", "log.csv", "--config", "column.toml"},
        {"learn", "log.csv", "--config", text},
        {"learn", text},
        {"inspect", text},
        {"inspect", "log.csv", text},
        {"inspect", "column.csv"},
        {"convert", text, "--out", "x.mcap"},
        {"predict", "log.csv", "--model", "format.json"},
        {"predict", "log.csv", "--model", text},
        {"plan", "format.json", "--range", text},
        {"vehicle", "check", text},
    };
    std::vector<std::vector<std::string>> all = doors;
    if (text == much) {
      for (const char* const file : {"key.toml", "deep_key.toml", "broken.toml"}) {
        all.push_back({"learn", "log.csv", "--config", file});
      }
    }
    for (const std::vector<std::string>& words : all) {
      const testing::Outcome outcome = testing::kelpie(folder_.path(), words);
      const std::string door = words[0] + " " + words.back().substr(0, 20);
      EXPECT_EQ(outcome.exit_code, 2) << door << outcome.err.substr(0, 300);
      EXPECT_LE(outcome.err.size(), 2'100U) << door;
      EXPECT_LE(std::ranges::count(outcome.err, '\n'), 4) << door << outcome.err;
      EXPECT_EQ(outcome.err.find("\nkelpie: all is well"), std::string::npos) << outcome.err;
      EXPECT_EQ(outcome.err.find('\x1b'), std::string::npos) << outcome.err;
    }
  }
}

TEST_F(Bounds, AColumnMayBeCalledAnything) {
  for (const char* const name : {"n's", "'", "''n'", "n]]", "*/n", "1", "--n", "|n|", "n;u"}) {
    std::string text = testing::little_log(120);
    text.replace(text.find(",n,"), 3, std::string(",") + name + ",");
    write("named.csv", text);
    succeeded(run("learn named.csv --align none --set preset=small --set warmup=20 --out named"));
    succeeded(run("predict named.csv --model named/model.json --out named.out.csv"));
    succeeded(run("export named/model.json --c named.c"));
  }
}

TEST_F(Bounds, ATermOfThousandsOfFactorsIsRefused) {
  std::string term = "u";
  for (int k = 0; k < 1000; ++k) {
    term += "*u";
  }
  write("terms.toml", "terms = \"" + term + "\"\n");
  expect_refused("learn log.csv --config terms.toml",
                 "has more than 500 columns, numbers and operations");
}

TEST_F(Bounds, NumbersOfTheConfigurationAreCheckedBeforeTheLogIsRead) {
  const std::string log = R"toml([log]
time = "t"
states = {u = "u"}
commands = {n = "n"}
derived = {udot = "d(u)"}
)toml";
  const auto expect = [&](const std::string& line, const std::string& message) {
    write("c.toml", log + line + "\n");
    expect_refused("learn missing.csv --config c.toml", "c.toml:6: log." + message);
  };
  expect("rate = -0.0", "rate: 0 is out of range; it has to be more than 0");
  expect("rate = 1e7", "rate: 1e+07 is out of range; it has to be more than 0, up to 1e+06");
  expect("window = 1e18", "window: 1e+18 is out of range");
  expect("window = 61", "window: 61 is out of range; it has to be more than 0, up to 60");
  expect("gap = 1e9", "gap: 1e+09 is out of range");
  expect("lag = {n = -1e9}", "lag.n: -1e+09 is out of range");
  expect(R"(lever_arm = {velocity=["u","u","u"], rates=["u","u","u"], arm=[1e300,0,0]})",
         "lever_arm.arm: 1e+300 is out of range");
}

TEST_F(Bounds, OptionsHaveEnds) {
  const std::string learn = "learn missing.csv ";
  expect_refused(learn + "--align -inf", "--align: '-inf' is not known");
  expect_refused("learn log.csv --set gamma=1e308", "gamma: 1e+308 is out of range");
  expect_refused("tune missing.csv --candidates 1000000000000", "--candidates: Value");
  expect_refused("tune missing.csv --threads 1000000", "--threads: Value");
}

TEST_F(Bounds, AbsurdNumbersOfOptionsAreRefusedBeforeAnyFileIsRead) {
  const std::string count = "a whole number, 0 or more";
  const auto expect = [&](const std::string& command, const std::string& option,
                          const std::string& right, std::initializer_list<const char*> values) {
    for (const std::string value : values) {
      expect_refused(command + " " + option + " " + value,
                     option + ": '" + value + "' has to be " + right);
    }
  };
  const std::string learn = "learn missing.csv";
  const std::string rollout = "rollout missing.csv --model missing.json";
  const std::string identify = "identify missing.csv";
  expect(learn, "--rate", "a number from 1e-06 to 1e+06", {"-1", "-0.0", "0", "nan", "inf", "x"});
  expect(learn, "--seed", count, {"-1", "nan", "1e18", "18446744073709551616"});
  expect(learn, "--validate-every", count, {"-1", "0.5"});
  expect(learn, "--checkpoint-every", count, {"-1", "inf"});
  expect(rollout, "--step", "a number from 0.001 to 60",
         {"-1", "-0.0", "0", "nan", "inf", "-inf", "1e18", "1e-300", "x"});
  expect(rollout, "--horizons", "a number from 0.001 to 86400", {"-1", "0", "nan", "inf", "1e18"});
  expect("tune missing.csv", "--most-iterations", "a number from 1 to 1e+09",
         {"-1", "0", "nan", "inf", "1e18", "1e-300"});
  expect("tune missing.csv", "--only", "a whole number within", {"nan", "1e18", "0.5"});
  expect(identify, "--mass", "a number from 1e-06 to 1e+09", {"-1", "0", "nan", "inf", "1e18"});
  expect(identify, "--surge-added-mass", "a number from 1e-06 to 1e+09", {"0", "nan", "inf"});
  expect("study missing.toml --against missing.json", "--fail-if-worse", "a number from 0 to 1e+09",
         {"-1", "nan", "inf", "1e18"});
  expect("simulate missing.toml --out out", "--seed", count, {"-1", "x"});
  for (const std::string value : {"-1", "0", "nan", "inf", "1e18", "x"}) {
    expect_refused(identify + " --thrust n=" + value,
                   "--thrust: '" + value + "' of 'n' has to be a number > 0, up to 1e+09");
  }
}

TEST_F(Bounds, ListsHaveEnds) {
  std::string horizons = "1";
  std::string names = "u";
  for (int k = 2; k <= 20'000; ++k) {
    horizons += "," + std::to_string(k);
    names += ",u";
  }
  expect_refused("rollout missing.csv --model missing.json --horizons " + horizons,
                 "--horizons: are at most 100");
  expect_refused("learn log.csv --inputs " + names, "inputs");
  expect_refused("learn log.csv --targets " + names, "targets");
}

TEST_F(Bounds, AMemoryIsAFile) {
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  expect_refused("learn log.csv --memory /dev/zero", "/dev/zero: --memory: is no regular file; ");
  expect_refused("learn log.csv --memory pipe", "pipe: --memory: is no regular file; ");
  expect_refused("learn log.csv --memory .", ".: --memory: is a folder; ");
  expect_refused("predict log.csv --model missing.json --out .", ".: --out: is a folder; ");
}

TEST_F(Bounds, AStudyIsCheckedBeforeAnyRun) {
  std::filesystem::create_directory(folder_ / "dives");
  const auto expect = [&](const std::string& text, const std::string& message) {
    write("fleet.toml", text);
    expect_refused("study fleet.toml --out out", message);
  };
  expect("logs = \"log.csv\"\nalign = -inf\n", "fleet.toml:2: align: '-inf' is not known");
  expect("logs = \"log.csv\"\nalign = nan\n", "fleet.toml:2: align: 'nan' is not known");
  expect("logs = \"log.csv\"\n[log]\nrate = -0.0\n", "fleet.toml:3: log.rate: 0 is out of range");
  expect("logs = \"/dev/zero\"\n", "matches /dev/zero, which is no file");
  expect("logs = \"dives\"\n", "is a folder without metadata.yaml, so no bag");
}

TEST_F(Bounds, AScenarioIsNotDrivenForYearsNorWithNumbersOfNoVehicle) {
  const std::string begin = "vehicle = \"" + kSource + "/vehicles/dagon.toml\"\n";
  const auto expect = [&](const std::string& head, const std::string& configuration,
                          const std::string& duration, const std::string& message) {
    write("s.toml", begin + head + "[[configurations]]\nname = \"A\"\n" + configuration +
                        "[[phases]]\nconfiguration = \"A\"\nduration_s = " + duration + "\n");
    expect_refused("simulate s.toml --out out", message);
  };
  const std::string rate = "rate_hz = 4.0\n";
  expect(rate, "", "1e9", "s.toml:5: phases: take 1e+09 s together; at most 2.592e+06 s");
  expect("rate_hz = 100.0\n", "", "100000.0", "give 1e+07 rows together at 100 Hz");
  expect(rate, "payload = {buoyancy_n = 1e308}\n", "10.0",
         "s.toml:5: configurations[0].payload.buoyancy_n: 1e+308 is out of range");
  expect(rate, "payload = {buoyancy_n = 1e12}\n", "10.0", "s.toml: the simulation left finite");
  expect(rate + "[excitation]\nperiod_s = [1e-9, 1.0]\n", "", "10.0", "both at least 0.1 s");
}

#ifdef KELPIE_WITH_MATIO
// Each of these ended libmatio or HDF5 by a signal, or never ended.
TEST_F(Bounds, NoFileOfMatlabEndsTheProgram) {
  const std::filesystem::path corpus = kSource + "/tests/fuzz/corpus_mat";
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(corpus)) {
    if (entry.path().filename().string().starts_with("crash")) {
      ++count;
      const testing::Outcome strict = run("inspect " + entry.path().string());
      EXPECT_EQ(strict.exit_code, 2) << entry.path() << strict.err;
      EXPECT_NE(strict.err.find(entry.path().filename().string() + ": is damaged"),
                std::string::npos)
          << strict.err;
      const int recovered = run("inspect --recover " + entry.path().string()).exit_code;
      EXPECT_TRUE(recovered == 0 || recovered == 2) << entry.path() << recovered;
    }
  }
  EXPECT_GE(count, 2U);
}
#endif

}  // namespace
}  // namespace kelpie::bounds_test
