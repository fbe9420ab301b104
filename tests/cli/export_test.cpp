// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include "cli/command.hpp"
#include "support.hpp"

namespace kelpie::export_test {
namespace {

using testing::content_of;
using testing::kelpie;
using testing::little_log;
using testing::Outcome;
using testing::TemporaryFolder;
using testing::write_text;

TEST(Export, WritesACFileAndRefusesWhatCannotBeOne) {
  const TemporaryFolder folder;
  write_text(folder / "log.csv", little_log(2400));
  ASSERT_EQ(kelpie(folder.path(), "learn log.csv --out out").exit_code, 0);
  const auto run = [&](const std::string& options) {
    return kelpie(folder.path(), "export out/model.json --c model.c " + options);
  };
  Outcome outcome = run("--name 2fast");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("--name: '2fast' can't begin names in C"), std::string::npos);
  outcome = run("--units udott=m/s^2");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("no column 'udott' (did you mean 'udot'?)"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder / "model.c"));
  EXPECT_EQ(kelpie(folder.path(), "export out/model.json").exit_code, 2);
  EXPECT_EQ(kelpie(folder.path(), "export log.csv --c model.c").exit_code, 2);

  const std::string model = content_of(folder / "out" / "model.json");
  EXPECT_EQ(kelpie(folder.path(), "export out/model.json --c out/model.json").exit_code, 2);
  EXPECT_EQ(run("--header out/model.json").exit_code, 2);
  EXPECT_EQ(content_of(folder / "out" / "model.json"), model);

  ASSERT_EQ(run("--name surge --units u=m/s,udot=m/s^2").exit_code, 0);
  const std::string code = content_of(folder / "model.c");
  EXPECT_NE(code.find("void surge_predict(const double x[2], double y[1]);"), std::string::npos);
  EXPECT_NE(code.find("\"out/model.json\""), std::string::npos);
  EXPECT_NE(code.find("surge_target_units[1] = {\"m s^-2\"};"), std::string::npos);
  ASSERT_EQ(run("--float").exit_code, 0);
  EXPECT_NE(content_of(folder / "model.c").find("kelpie_model_predict(const float x[2]"),
            std::string::npos);
}

}  // namespace
}  // namespace kelpie::export_test
