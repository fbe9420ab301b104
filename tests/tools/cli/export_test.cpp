// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <cstdlib>

#include "cli/command.hpp"

namespace kelpie::export_test {
namespace {

using testing::kelpie;
using testing::little_log;
using testing::Outcome;

using Export = testing::CommandTest;

TEST_F(Export, WritesACFileAndRefusesWhatCannotBeOne) {
  learn_little_log();
  const auto exported = [&](const std::string& options) {
    return run("export out/model.json --c model.c " + options);
  };
  Outcome outcome = exported("--name 2fast");
  testing::expect_refused(outcome, "--name: '2fast' can't begin names in C");
  outcome = exported("--units udott=m/s^2");
  testing::expect_refused(outcome, "'udott' is no column of the model (did you mean 'udot'?)");
  EXPECT_FALSE(exists("model.c"));
  testing::expect_refused(run("export out/model.json"),
                          "needs --c FILE, --live FILE or --fmu FILE");
  EXPECT_EQ(run("export log.csv --c model.c").exit_code, 2);

  const std::string model = content("out/model.json");
  EXPECT_EQ(run("export out/model.json --c out/model.json").exit_code, 2);
  EXPECT_EQ(run("--header out/model.json").exit_code, 2);
  EXPECT_EQ(content("out/model.json"), model);

  testing::succeeded(exported("--name surge --units u=m/s,udot=m/s^2"));
  const std::string code = content("model.c");
  EXPECT_NE(code.find("void surge_predict(const double x[2], double y[1]);"), std::string::npos);
  EXPECT_NE(code.find("\"out/model.json\""), std::string::npos);
  EXPECT_NE(code.find("surge_target_units[1] = {\"m s^-2\"};"), std::string::npos);
  testing::succeeded(exported("--float"));
  EXPECT_NE(content("model.c").find("kelpie_model_predict(const float x[2]"), std::string::npos);
}

TEST_F(Export, WritesEveryFileOrNone) {
  learn_little_log(600);
  const std::string model = "export out/model.json ";
  testing::expect_refused(run(model + "--c out.c --header ./out.c"), "--header");
  EXPECT_FALSE(exists("out.c"));
  testing::expect_refused(run(model + "--fmu a.fmu --float"), "--float: needs --c FILE");
  testing::expect_refused(run(model + "--fmu a.fmu --assess"), "--assess: needs --c FILE");
  testing::expect_refused(run(model + "--fmu a.fmu --casadi"), "--casadi: needs --c FILE");
  testing::expect_refused(run(model + "--fmu a.fmu --hessian"), "--hessian: needs --c FILE");
  EXPECT_FALSE(exists("a.fmu"));

  testing::succeeded(run(model + "--live twin.so"));
  const std::string block = content("twin.block");
  const std::string source = content("twin.c");
  testing::succeeded(run("learn log.csv --set buffer=20 --out other"));
  ::setenv("CC", "false", 1);  // NOLINT(concurrency-mt-unsafe): one thread
  const Outcome without = run("export other/model.json --live twin.so --c all.c");
  ::unsetenv("CC");  // NOLINT(concurrency-mt-unsafe): one thread
  EXPECT_EQ(without.exit_code, 1);
  EXPECT_EQ(content("twin.block"), block);
  EXPECT_EQ(content("twin.c"), source);
  EXPECT_FALSE(exists("all.c"));
  EXPECT_FALSE(exists("twin.so.draft.c"));

  testing::succeeded(
      run("learn log.csv --inputs n --targets udot --out still" + testing::kFewSamples));
  testing::expect_refused(run("export still/model.json --c still.c --fmu still.fmu"),
                          "cannot be rolled out");
  EXPECT_FALSE(exists("still.c"));
}

TEST_F(Export, KeepsTheUnitsOfTheModel) {
  write("log.csv", little_log(600));
  testing::succeeded(
      run("learn log.csv --units u=m/s,udot=m/s^2 --out out" + testing::kFewSamples));
  testing::succeeded(run("export out/model.json --c model.c --units n=rev/s"));
  const std::string code = content("model.c");
  EXPECT_NE(code.find("_target_units[1] = {\"m s^-2\"};"), std::string::npos) << code;
  EXPECT_NE(code.find("_input_units[2] = {\"m s^-1\", \"rev s^-1\"};"), std::string::npos) << code;
}

TEST_F(Export, WritesAUnitOfFmi) {
  learn_little_log();
  const Outcome outcome =
      testing::succeeded(run("export out/model.json --fmu vehicle.fmu --name twin"));
  EXPECT_NE(outcome.out.find("FMU: vehicle.fmu (FMI 2.0, co-simulation"), std::string::npos);
  EXPECT_EQ(content("vehicle.fmu").substr(0, 2), "PK");
  testing::expect_refused(run("export out/model.json --fmu vehicle.fmu --units w=m/s"),
                          "there is no column 'w' in the model");
  EXPECT_EQ(run("export out/model.json --fmu out/model.json").exit_code, 2);
}

TEST_F(Export, WritesALibraryWithABlockAndRefusesWhatItCannot) {
  learn_little_log(600);
  const Outcome outcome =
      testing::succeeded(run("export out/model.json --live twin.so --header twin.h --name twin"));
  EXPECT_NE(outcome.out.find("library: twin.so"), std::string::npos);
  EXPECT_NE(outcome.out.find("external(\"twin\", \"./twin.so\")"), std::string::npos);
  EXPECT_EQ(content("twin.block").substr(0, 8), "blkelk04");
  EXPECT_NE(content("twin.h").find("unsigned long long twin_renew(void);"), std::string::npos);
  EXPECT_EQ(content("twin.so").substr(1, 3), "ELF");
  testing::expect_refused(run("export out/model.json --live a.so --float"),
                          "--live: renews doubles");
  EXPECT_FALSE(exists("a.so"));
  testing::expect_refused(run("export out/model.json --live twin.c"), "--live");
  testing::expect_refused(run("export out/model.json --fmu a.fmu --header a.h"),
                          "--header: needs --c FILE or --live FILE");
  ::setenv("CC", "no-such-compiler", 1);  // NOLINT(concurrency-mt-unsafe): one thread
  const Outcome without = run("export out/model.json --live a.so");
  ::unsetenv("CC");  // NOLINT(concurrency-mt-unsafe): one thread
  EXPECT_EQ(without.exit_code, 1);
  EXPECT_NE(without.err.find("CC names another"), std::string::npos) << without.err;
  EXPECT_FALSE(exists("a.so"));
  EXPECT_FALSE(exists("a.so.draft.c"));
  ::setenv("CC", "env cc", 1);  // NOLINT(concurrency-mt-unsafe): one thread
  const Outcome words = run("export out/model.json --live a.so");
  ::unsetenv("CC");  // NOLINT(concurrency-mt-unsafe): one thread
  testing::succeeded(words);
}

}  // namespace
}  // namespace kelpie::export_test
