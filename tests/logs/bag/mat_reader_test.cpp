// SPDX-License-Identifier: Apache-2.0
#include "bag/mat_reader.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "bag/bags.hpp"
#include "bag/hash.hpp"
#include "bag/inspect.hpp"
#include "bag/mat_topics.hpp"
#include "bag/mats.hpp"
#include "bag/open_bag.hpp"
#include "bag/series.hpp"
#include "kelpie/core/error.hpp"
#include "support.hpp"

#ifdef KELPIE_WITH_MATIO
#include <matio.h>
#include <zlib.h>
#endif

namespace kelpie::mat_reader_test {
namespace {

using bag::MatArray;
using bag::MatTopic;

// 0, step, 2 step…
MatArray column(const std::string& path, std::size_t count, double step, double first = 0.0) {
  MatArray array{.path = path, .rows = count, .columns = 1, .values = {}};
  for (std::size_t k = 0; k < count; ++k) {
    array.values.push_back(first + step * static_cast<double>(k));
  }
  return array;
}

std::vector<std::string> names_of(const std::vector<MatTopic>& topics) {
  std::vector<std::string> names;
  for (const MatTopic& topic : topics) {
    names.push_back(topic.name + (topic.has_time ? "" : " without time") + ": " + topic.definition);
  }
  return names;
}

using Names = std::vector<std::string>;

TEST(MatTopics, WhatHasTheLengthOfATimeBelongsToIt) {
  const std::vector<MatArray> arrays{
      column("t", 5, 0.1),
      column("u", 5, 1.0),
      {.path = "tau", .rows = 5, .columns = 2, .values = {1, 2, 3, 4, 5, 10, 20, 30, 40, 50}},
      {.path = "across", .rows = 2, .columns = 5, .values = {1, 10, 2, 20, 3, 30, 4, 40, 5, 50}},
      {.path = "mass", .rows = 1, .columns = 1, .values = {12}},
      column("lengths", 3, 1.0),
  };
  const auto topics = bag::mat_topics(arrays, {});
  ASSERT_EQ(names_of(topics), (Names{"workspace: float64 u\nfloat64[2] tau\nfloat64[2] across\n",
                                     "workspace_2 without time: float64 lengths\n"}));
  EXPECT_EQ(topics[0].times_ns,
            (std::vector<std::int64_t>{0, 100'000'000, 200'000'000, 300'000'000, 400'000'000}));
  for (std::size_t row = 0; row < 5; ++row) {
    const auto value = static_cast<double>(row + 1);
    EXPECT_EQ(topics[0].columns[1].value(row, 1), 10 * value);
    EXPECT_EQ(topics[0].columns[2].value(row, 0), value);
    EXPECT_EQ(topics[0].columns[2].value(row, 1), 10 * value);
  }
}

TEST(MatTopics, StructsHaveTimesOfTheirOwnOrThatAroundThem) {
  const std::vector<MatArray> arrays{
      column("log.time_ms", 4, 100.0), column("log.u", 4, 1.0),     column("log.imu.t", 8, 0.05),
      column("log.imu.gyro", 8, 1.0),  column("log.dvl.v", 4, 1.0), column("par.k", 4, 1.0),
  };
  const auto topics = bag::mat_topics(arrays, {});
  EXPECT_EQ(names_of(topics), (Names{"log: float64 u\nfloat64 dvl_v\n", "log.imu: float64 gyro\n",
                                     "par without time: float64 k\n"}));
  EXPECT_EQ(topics[0].times_ns[3], 300'000'000);
  EXPECT_EQ(topics[1].times_ns[3], 150'000'000);
}

TEST(MatTopics, TimesOfSeveralRatesBesideEachOtherNameTheirTopics) {
  const std::vector<MatArray> arrays{column("t_imu", 8, 0.1), column("t_cmd", 4, 0.2),
                                     column("gyro", 8, 1.0), column("rpm", 4, 1.0)};
  EXPECT_EQ(names_of(bag::mat_topics(arrays, {})),
            (Names{"t_imu: float64 gyro\n", "t_cmd: float64 rpm\n"}));
}

TEST(MatTopics, TheUnitOfATimeFollowsFromItsNameOrItsSize) {
  const auto step_of = [](const std::string& name, double first, double step) {
    const std::vector<MatArray> arrays{column(name, 3, step, first), column("u", 3, 1.0)};
    const auto topics = bag::mat_topics(arrays, {});
    EXPECT_TRUE(topics[0].has_time) << name;
    return static_cast<double>(topics[0].times_ns[1] - topics[0].times_ns[0]) / 1e9;
  };
  EXPECT_NEAR(step_of("t", 0.0, 0.5), 0.5, 1e-9);
  EXPECT_NEAR(step_of("Time_us", 0.0, 5e5), 0.5, 1e-9);
  EXPECT_NEAR(step_of("stamp", 1.7e9, 0.5), 0.5, 1e-6);
  EXPECT_NEAR(step_of("stamp", 1.7e12, 500.0), 0.5, 1e-6);
  EXPECT_NEAR(step_of("stamp", 1.7e15, 5e5), 0.5, 1e-6);
  EXPECT_NEAR(step_of("stamp", 1.7e18, 5e8), 0.5, 1e-6);
  EXPECT_NEAR(step_of("time", 739'000.0, 0.5 / 86'400.0), 0.5, 1e-4);  // datenum has that much
  EXPECT_NEAR(step_of("time", 739'000.0, 0.5), 0.5, 1e-9);             // seconds
  EXPECT_NEAR(step_of("t", -1.0, 0.5), 0.5, 1e-9);
}

TEST(MatTopics, AnArrayThatFallsOrIsNamedOtherwiseIsATimeOnlyIfAskedFor) {
  const std::vector<MatArray> falling{column("t", 3, -1.0), column("u", 3, 1.0)};
  EXPECT_FALSE(bag::mat_topics(falling, {})[0].has_time);
  const std::vector<MatArray> other{column("log.clock", 3, 0.1), column("log.u", 3, 1.0)};
  for (const char* const name : {"clock", "log.clock"}) {
    const auto topics = bag::mat_topics(other, {.time = name});
    EXPECT_EQ(names_of(topics), (Names{"log: float64 u\n"}));
  }
  EXPECT_NE(testing::message_of<InputError>([&] {
              bag::mat_topics(other, {.time = "clok"});
            }).find("clok: there is no vector"),
            std::string::npos);
  const std::vector<MatArray> bare{column("u", 3, 1.0)};
  EXPECT_EQ(bag::mat_topics(bare, {.rate_hz = 20.0})[0].times_ns,
            (std::vector<std::int64_t>{0, 50'000'000, 100'000'000}));
}

#ifdef KELPIE_WITH_MATIO

using Variable = std::unique_ptr<matvar_t, decltype(&Mat_VarFree)>;

Variable numbers(const char* name, std::vector<double> values, std::size_t columns = 1) {
  std::array<std::size_t, 2> sizes{values.size() / columns, columns};
  return {Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, sizes.data(), values.data(), 0),
          &Mat_VarFree};
}

void write(const std::filesystem::path& file, mat_ft version, const std::vector<Variable>& all,
           matio_compression compression = MAT_COMPRESSION_NONE) {
  mat_t* const mat = Mat_CreateVer(file.c_str(), nullptr, version);
  for (const Variable& one : all) {
    Mat_VarWrite(mat, one.get(), compression);
  }
  Mat_Close(mat);
}

// t, u and a struct log with x and a text.
std::vector<Variable> small_variables() {
  std::vector<Variable> all;
  all.push_back(numbers("t", {0.0, 0.5, 1.0}));
  all.push_back(numbers("u", {1.0, 2.0, std::nan("")}));
  std::array<std::size_t, 2> one{1, 1};
  std::array<const char*, 2> fields{"x", "note"};
  Variable log(Mat_VarCreateStruct("log", 2, one.data(), fields.data(), 2), &Mat_VarFree);
  std::array<std::size_t, 2> sizes{1, 3};
  std::array<std::int16_t, 3> x{4, -5, 6};
  Mat_VarSetStructFieldByName(
      log.get(), "x", 0,
      Mat_VarCreate("x", MAT_C_INT16, MAT_T_INT16, 2, sizes.data(), x.data(), 0));
  std::string note = "hi!";
  Mat_VarSetStructFieldByName(
      log.get(), "note", 0,
      Mat_VarCreate("note", MAT_C_CHAR, MAT_T_UTF8, 2, sizes.data(), note.data(), 0));
  all.push_back(std::move(log));
  return all;
}

bag::BagReport report_of(const std::filesystem::path& file,
                         bag::ReadMode mode = bag::ReadMode::strict) {
  return bag::inspect_bag(*bag::open_bag(file, mode), bag::MessageDefinitions());
}

TEST(MatReader, EveryVersionGivesTheSameRows) {
  const testing::TemporaryFolder folder;
  for (const auto& [version, compression] :
       {std::pair(MAT_FT_MAT5, MAT_COMPRESSION_NONE), std::pair(MAT_FT_MAT5, MAT_COMPRESSION_ZLIB),
        std::pair(MAT_FT_MAT73, MAT_COMPRESSION_NONE)}) {
    write(folder / "a.bin", version, small_variables(), compression);
    ASSERT_TRUE(bag::is_bag(folder / "a.bin"));
    const auto bag = bag::open_bag(folder / "a.bin");
    const auto series = bag::read_series(*bag, bag::MessageDefinitions(),
                                         std::vector<std::string>{"workspace:u", "workspace:log_x"},
                                         bag::Clock::receive);
    EXPECT_EQ(series[0].times_ns, (std::vector<std::int64_t>{0, 500'000'000, 1'000'000'000}));
    EXPECT_EQ(series[0].values[0][1], 2.0);
    EXPECT_TRUE(std::isnan(series[0].values[0][2]));
    EXPECT_EQ(series[0].values[1], (std::vector<double>{4, -5, 6}));
  }
}

TEST(MatReader, AFileCutOffIsNamedAndReadUpToThere) {
  const testing::TemporaryFolder folder;
  for (const matio_compression compression : {MAT_COMPRESSION_NONE, MAT_COMPRESSION_ZLIB}) {
    write(folder / "a.mat", MAT_FT_MAT5, small_variables(), compression);
    const std::string good = testing::read_text(folder / "a.mat");
    for (std::size_t size = 129; size < good.size(); ++size) {
      testing::write_text(folder / "b.mat", good.substr(0, size));
      const std::string said =
          testing::message_of<InputError>([&] { report_of(folder / "b.mat"); });
      if (!said.empty()) {
        EXPECT_NE(said.find("b.mat: "), std::string::npos) << said;
        continue;
      }
      // Variables follow each other without a count: a file may end between two.
      for (const bag::TopicReport& topic : report_of(folder / "b.mat").topics) {
        EXPECT_LT(topic.fields.size(), 2U) << size;
      }
    }
  }
}

TEST(MatReader, WhatIsNoneOrHasNoNumbersIsNamed) {
  const testing::TemporaryFolder folder;
  testing::write_text(folder / "a.mat", "MATLAB 5.0 MAT-file");
  EXPECT_FALSE(bag::is_bag(folder / "a.mat"));
  std::vector<Variable> none;
  std::array<std::size_t, 2> sizes{1, 3};
  std::string note = "hi!";
  none.emplace_back(Mat_VarCreate("note", MAT_C_CHAR, MAT_T_UTF8, 2, sizes.data(), note.data(), 0),
                    &Mat_VarFree);
  write(folder / "b.mat", MAT_FT_MAT5, none);
  EXPECT_NE(testing::message_of<InputError>([&] {
              report_of(folder / "b.mat");
            }).find("b.mat: has no arrays"),
            std::string::npos);
}

TEST(MatReader, AnyBytesEndInRowsOrAnInputError) {
  const testing::TemporaryFolder folder;
  std::mt19937 random(19);
  write(folder / "a.mat", MAT_FT_MAT5, small_variables(), MAT_COMPRESSION_ZLIB);
  const std::string good = testing::read_text(folder / "a.mat");
  for (int round = 0; round < 500; ++round) {
    std::string file = good;
    for (int k = 0; k < 3; ++k) {
      file[128 + random() % (file.size() - 128)] = static_cast<char>(random() % 256);
    }
    testing::write_text(folder / "b.mat", file);
    try {
      EXPECT_LE(report_of(folder / "b.mat", bag::ReadMode::recover).messages, 9U);
    } catch (const InputError&) {  // nothing is left
      continue;
    }
  }
}

// The head of a variable: class, sizes, name.
std::string mat_variable(std::uint32_t kind, std::uint32_t rows, std::uint32_t columns,
                         const std::string& name) {
  using testing::mat_element;
  using testing::mat_raw;
  return mat_element(6, mat_raw(kind) + mat_raw(std::uint32_t{0})) +
         mat_element(5, mat_raw(rows) + mat_raw(columns)) + mat_element(1, name);
}

std::string compressed(const std::string& element) {
  std::string packed(compressBound(element.size()), '\0');
  uLongf size = packed.size();
  compress(reinterpret_cast<Bytef*>(packed.data()), &size,                   // NOLINT: C
           reinterpret_cast<const Bytef*>(element.data()), element.size());  // NOLINT: C
  packed.resize(size);
  return testing::mat_raw(std::uint32_t{15}) +
         testing::mat_raw(static_cast<std::uint32_t>(packed.size())) + packed;
}

// An object as MATLAB writes strings, tables and timeseries: name, type system, class, content.
std::string mat_object(const std::string& name, const std::string& kind) {
  using testing::mat_element;
  using testing::mat_raw;
  return mat_element(14, mat_element(6, mat_raw(std::uint32_t{17}) + mat_raw(std::uint32_t{0})) +
                             mat_element(1, name) + mat_element(1, "MCOS") + mat_element(1, kind) +
                             mat_element(14, mat_variable(13, 1, 1, "") +
                                                 mat_element(6, mat_raw(std::uint32_t{1}))));
}

const std::vector<std::pair<std::string, std::vector<double>>> kColumns{{"t", {0.0, 0.5}},
                                                                        {"u", {1.0, 2.0}}};

// All variables are read as before; the note names what is not.
void expect_left_out(const std::string& file, const std::string& note) {
  const testing::TemporaryFolder folder;
  testing::write_text(folder / "a.mat", file);
  const auto bag = bag::open_bag(folder / "a.mat");
  EXPECT_NE(bag->losses_text().find("left out: " + note), std::string::npos) << bag->losses_text();
  const bag::BagReport report = report_of(folder / "a.mat");
  ASSERT_FALSE(report.topics.empty());
  EXPECT_EQ(report.topics[0].fields[0].path, "u");
  EXPECT_EQ(report.left_out.size(), 1U);
}

TEST(MatReader, AnObjectIsLeftOutByNameAndTheArraysBesideItAreRead) {
  const std::string arrays = testing::mat_file(kColumns).substr(testing::mat_head().size());
  for (const auto& [name, kind] :
       {std::pair("vehicle", "string"), std::pair("runs", "timeseries")}) {
    const std::string note = fmt::format("{} is an object of class {};", name, kind);
    const std::string object = mat_object(name, kind);
    expect_left_out(testing::mat_head() + object + arrays, note);
    expect_left_out(testing::mat_head() + arrays + object, note);
    expect_left_out(testing::mat_head() + compressed(object) + arrays, note);
  }
}

TEST(MatReader, WhatWasNeverFilledIsLeftOutByName) {
  using testing::mat_element;
  using testing::mat_raw;
  const std::string one = mat_element(14, mat_variable(6, 1, 1, "") + mat_element(9, mat_raw(7.0)));
  const std::string cells =
      mat_element(14, mat_variable(1, 1, 3, "gains") + one + mat_element(14, "") + one);
  const std::string structs = mat_element(
      14, mat_variable(2, 1, 2, "S") + mat_raw(std::uint32_t{(4U << 16U) | 5U}) +
              mat_raw(std::uint32_t{8}) + mat_element(1, std::string("a\0\0\0\0\0\0\0", 8)) +
              mat_element(14, "") + one);
  const std::string arrays = testing::mat_file(kColumns).substr(testing::mat_head().size());
  expect_left_out(testing::mat_head() + arrays + cells, "gains_2 was never filled");
  expect_left_out(testing::mat_head() + arrays + structs, "S_1.a was never filled");
}

// 2^40 structs of 2^20 fields, a cell array of 2^31 cells, zeros that unpack to 64 MB and are 0.5
// GB as numbers, 1000 numbers in 80 bytes: libmatio believes each size.
TEST(MatReader, AForgedSizeEndsInAnErrorThatNamesTheFile) {
  using testing::mat_element;
  using testing::mat_raw;
  const testing::TemporaryFolder folder;
  constexpr std::uint32_t kMany = 1U << 20U;
  const std::string structs = mat_element(
      14, mat_variable(2, kMany, kMany, "s") + mat_raw(std::uint32_t{(4U << 16U) | 5U}) +
              mat_raw(std::uint32_t{1}) + mat_element(1, std::string(kMany, 'a')));
  const std::string cells = mat_element(14, mat_variable(1, 1U << 16U, 1U << 15U, "c"));
  const std::string bomb = compressed(mat_element(
      14, mat_variable(9, kMany, 1U << 6U, "b") + mat_element(2, std::string(1U << 26U, '\0'))));
  const std::string few =
      mat_element(14, mat_variable(6, 1000, 1, "d") + mat_element(9, std::string(80, '\0')));
  for (const std::string& forged : {structs, cells, bomb, few}) {
    testing::write_text(folder / "b.mat", testing::mat_head() + forged);
    const std::string said = testing::message_of<InputError>([&] { report_of(folder / "b.mat"); });
    EXPECT_NE(said.find("b.mat: "), std::string::npos) << said;
  }
}

// Of SciPy 1.10.1: hashes of all values, row by row.
TEST(MatReader, EveryValueOfARealFileIsWhatAnotherImplementationReads) {
  const std::filesystem::path file = testing::data_file("logs/matlab_v5_fish.mat");
  if (file.empty()) {
    GTEST_SKIP() << "the log isn't there";
  }
  const auto found = testing::hashes_of(*bag::open_bag(file));
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found.at("workspace").messages, 76'589);
  EXPECT_EQ(found.at("workspace").values, 2461025300U);
  EXPECT_EQ(found.at("workspace_2").messages, 72);
  EXPECT_EQ(found.at("workspace_2").values, 1401866171U);
}

#endif

}  // namespace
}  // namespace kelpie::mat_reader_test
