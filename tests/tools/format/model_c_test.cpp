// SPDX-License-Identifier: Apache-2.0
// The exported file is compiled by a C compiler and compared with the model it was made from.
#include "format/model_c.hpp"

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <regex>

#include "format/compiled_model.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/model/trained_model.hpp"
#include "model/random_model.hpp"
#include "model/snapshot.hpp"
#include "simulator/scenario_file.hpp"
#include "simulator/simulation.hpp"
#include "study/simulated_log.hpp"
#include "support.hpp"

namespace kelpie::model_c_test {
namespace {

using testing::CasadiFunction;
using testing::Compiled;
using testing::kCompiler;
using testing::message_of;
using testing::ModelShape;
using testing::random_model;
using testing::TemporaryFolder;

// Predictions to `tolerance` of the target's scale, slopes to that of the steepest (times 10).
void expect_same(const TrainedModel& model, const std::vector<std::vector<double>>& inputs,
                 bool single, const TemporaryFolder& folder) {
  format::CodeOptions options;
  options.single = single;
  Compiled compiled(model, options, folder);
  ASSERT_TRUE(compiled);
  // In float the weights of `precise`, which cancel, leave a few units of the seventh digit.
  const double tolerance = single ? 3e-5 : 1e-12;
  const std::size_t axes = model.axes.size();
  const std::size_t size = model.input_names.size();
  std::vector<double> y(axes);
  std::vector<double> exact(axes);
  std::vector<double> jacobian(axes * size);
  std::vector<double> exact_slopes(axes * size);
  for (std::vector<double> x : inputs) {
    for (double& value : x) {
      value = static_cast<double>(static_cast<float>(value));
    }
    single ? compiled.run<float>(x, y, jacobian) : compiled.run<double>(x, y, jacobian);
    model.predict_with_jacobian(x, exact, exact_slopes);
    for (std::size_t i = 0; i < axes; ++i) {
      const double scale = std::abs(exact[i]) + model.axes[i].scaling.target.scale;
      ASSERT_NEAR(y[i], exact[i], tolerance * scale);
      double steepest = model.axes[i].scaling.target.scale;
      for (std::size_t j = 0; j < size; ++j) {
        steepest = std::max(steepest, std::abs(exact_slopes[i * size + j]));
      }
      for (std::size_t j = 0; j < size; ++j) {
        ASSERT_NEAR(jacobian[i * size + j], exact_slopes[i * size + j], 10 * tolerance * steepest)
            << i << ", " << j;
      }
    }
  }
}

std::vector<std::vector<double>> random_inputs(RandomStream& random, std::size_t size) {
  std::vector<std::vector<double>> inputs{std::vector<double>(size, 0.0)};
  for (int i = 0; i < 100; ++i) {
    inputs.emplace_back(size);
    for (double& value : inputs.back()) {
      value = random.normal();
    }
  }
  return inputs;
}

TEST(ModelC, PredictsAsTheModelDoesWithTermsOfEveryFunction) {
  const TemporaryFolder folder;
  RandomStream random(1, "shapes");
  for (const ScalingKind scaling : {ScalingKind::full, ScalingKind::diagonal}) {
    ModelShape shape;
    shape.scaling = scaling;
    const TrainedModel model = random_model(random, shape);
    for (const bool single : {false, true}) {
      expect_same(model, random_inputs(random, 3), single, folder);
    }
  }
}

TEST(ModelC, OfOneAxisWithoutTermsOrWithoutSupportVectors) {
  const TemporaryFolder folder;
  RandomStream random(2, "small");
  ModelShape shape;
  shape.inputs = {"a"};
  shape.targets = {"x"};
  shape.terms = "none";
  expect_same(random_model(random, shape), random_inputs(random, 1), false, folder);
  shape.samples = 0;
  expect_same(random_model(random, shape), random_inputs(random, 1), true, folder);
  shape.terms = "2; 1e300*1e300; sign(a^2)";
  expect_same(random_model(random, shape), random_inputs(random, 1), false, folder);
}

// Also slopes at kinks and where they have no bound, in all of which a 0 is.
TEST(ModelC, HasTheSlopesOfTheModelAtKinks) {
  const TemporaryFolder folder;
  RandomStream random(3, "kinks");
  ModelShape shape;
  shape.terms =
      "|a|; -|b|; max(a,0)^2; min(0,b); max(-a, 2*a); sqrt(a); sqrt(c^2); a^0.5; 1/b; min(|a|, b);"
      "(a*b)^0; sign(a*b)*c; b^70; tanh(0.3*a)*tanh(3*b)";
  const TrainedModel model = random_model(random, shape);
  std::vector<std::vector<double>> inputs;
  for (const double a : {-1.0, 0.0, 1.0}) {
    for (const double b : {-1.0, 0.0, 1.0}) {
      for (const double c : {-1.0, 0.0, 1.0}) {
        inputs.push_back({a, b, c});
      }
    }
  }
  expect_same(model, inputs, false, folder);
}

// Among the numbers are members that disagree or are at a limit, and terms beyond their ranges.
TEST(ModelC, HasTheSecondDerivativesOfItsSlopes) {
  const TemporaryFolder folder;
  RandomStream random(13, "bends");
  format::CodeOptions options;
  options.hessian = true;
  for (const char* const terms : {testing::kEveryFunction, "none"}) {
    ModelShape shape;
    shape.terms = terms;
    shape.scaling = terms == std::string("none") ? ScalingKind::diagonal : ScalingKind::full;
    const TrainedModel model = random_model(random, shape);
    options.single = false;
    Compiled compiled(model, options, folder);
    options.single = true;
    Compiled single(model, options, folder);
    ASSERT_TRUE(compiled && single);
    for (std::vector<double> x : random_inputs(random, 3)) {
      x[0] += 1e-3;  // beside the kinks at 0
      x[1] += 2e-3;
      x[2] -= 3e-3;
      std::ranges::transform(x, x.begin(), [](double v) { return static_cast<float>(v); });
      expect_bends_of_slopes(compiled, x, 3, {1e-5, 1e-5, 1e-5});
      const std::vector<double> exact = compiled.hessian<double>(x, 3);
      const std::vector<double> rounded = single.hessian<float>(x, 3);
      double largest = 0.0;
      for (const double value : exact) {
        largest = std::max(largest, std::abs(value));
      }
      for (std::size_t n = 0; n < exact.size(); ++n) {
        ASSERT_NEAR(rounded[n], exact[n], 1e-3 * largest);
      }
    }
  }
}

TEST(ModelC, ItsSecondDerivativesAtKinksAreBetweenThoseOfBothSides) {
  const TemporaryFolder folder;
  RandomStream random(14, "bent kinks");
  ModelShape shape;
  shape.targets = {"x"};
  format::CodeOptions options;
  options.hessian = true;
  // The second derivative by a of one term, as a share of that at a = 1; all samples are far away.
  const auto bend = [&](const char* terms, double a) {
    shape.terms = terms;
    TrainedModel model = random_model(random, shape);
    model.axes[0].function.limits = {};
    model.axes[0].function.term_ranges.clear();
    model.axes[0].scaling.input.mean = {1e3, 1e3, 1e3};
    Compiled compiled(model, options, folder);
    return compiled.hessian<double>({a, 0.5, 0.25}, 1)[0] /
           compiled.hessian<double>({1.0, 0.5, 0.25}, 1)[0];
  };
  EXPECT_EQ(bend("a*|a|", 0.0), 0.0);
  EXPECT_EQ(bend("a*|a|", -2.0), -1.0);
  EXPECT_EQ(bend("max(a,0)^2", -1.0), 0.0);
  EXPECT_EQ(bend("max(a,0)^2", 0.0), 0.25);
  EXPECT_EQ(bend("max(a,0)^2", 3.0), 1.0);
  EXPECT_EQ(bend("sqrt(a)", 0.0), 0.0);  // none that is finite
  EXPECT_EQ(bend("1/a", 0.0), 0.0);
  EXPECT_DOUBLE_EQ(bend("1/a", 2.0), 0.125);
}

TEST(ModelC, KeepsNamesAndUnitsWhateverIsInThem) {
  const TemporaryFolder folder;
  RandomStream random(4, "names");
  ModelShape shape;
  shape.inputs = {"*/ int x, /*", "a\nb \"c\" ?\?/\\", "\xc3\xbc // %s {} $NAME", "9 lives"};
  shape.targets = {"d?\?/\t'", "\xff\x01*"};
  shape.terms = "'*/ int x, /*'*|'9 lives'|; '\xc3\xbc // %s {} $NAME'^2";
  const TrainedModel model = random_model(random, shape);
  format::CodeOptions options;
  options.name = "int";
  options.source = "/tmp/*/\n*/x.json";
  options.units = {{"9 lives", Unit::parse("m/s")}};
  Compiled compiled(model, options, folder);
  ASSERT_TRUE(compiled);
  for (std::size_t i = 0; i < shape.inputs.size(); ++i) {
    EXPECT_EQ(compiled.text("_input_names", i), shape.inputs[i]);
  }
  EXPECT_EQ(compiled.text("_target_names", 0), shape.targets[0]);
  EXPECT_EQ(compiled.text("_target_names", 1), shape.targets[1]);
  EXPECT_EQ(compiled.text("_input_units", 3), "m s^-1");
  EXPECT_EQ(compiled.text("_input_units", 0), "");
}

// The evaluator that every exported file holds, on tables written by hand.
TEST(ModelC, ItsEvaluatorComputesWhatWasWorkedOutByHand) {
  const TemporaryFolder folder;
  const std::string source = KELPIE_SOURCE_DIR;
  const std::string library = folder / "check.so";
  const std::string command = kCompiler + "-O1 -fPIC -shared -I" + source +
                              "/src/tools/format -o " + library + " " + source +
                              "/tests/tools/format/model_eval/check.c -lm";
  ASSERT_EQ(std::system(command.c_str()), 0);  // NOLINT: the command is the test's own
  const std::unique_ptr<void, int (*)(void*)> loaded(dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL),
                                                     &dlclose);
  ASSERT_TRUE(loaded);
  void* const check = dlsym(loaded.get(), "check");
  ASSERT_NE(check, nullptr);
  EXPECT_EQ(reinterpret_cast<int (*)()>(check)(), 0);  // NOLINT: how dlsym is used
}

// What is compiled as C is called from C++.
TEST(ModelC, ItsHeaderIsForCAndForCpp) {
  const TemporaryFolder folder;
  RandomStream random(6, "header");
  const TrainedModel model = random_model(random, {});
  std::ofstream(folder / "model.c") << format::model_c(model, {});
  std::ofstream(folder / "model.h") << format::model_h(model, {});
  std::ofstream(folder / "caller.cpp")
      << "#include \"model.h\"\n#include \"model.h\"\nint main() {\n"
         "  double x[kelpie_model_inputs] = {}, y[kelpie_model_targets];\n"
         "  kelpie_model_predict(x, y);\n  return kelpie_model_input_names[0] == nullptr;\n}\n";
  const std::string c = kCompiler + "-c model.c && ";
  const std::string cpp = std::string(KELPIE_C_COMPILER) + "++ -Wall -Werror caller.cpp -x none ";
  const std::string command = "cd " + folder.path().string() + " && " + c + cpp + "model.o -lm";
  EXPECT_EQ(std::system(command.c_str()), 0);  // NOLINT: the command is the test's own
}

TEST(ModelC, TellsIntervalAndNoveltyWhereAsked) {
  const TemporaryFolder folder;
  RandomStream random(8, "assess");
  TrainedModel model = random_model(random, {});
  model.axes[0].half_width = 0.25;
  model.axes[0].known = testing::random_places(random, 3, 90);
  model.axes[1].known = testing::random_places(random, 3, 0);  // and of the third nothing is known
  for (const bool single : {false, true}) {
    format::CodeOptions options;
    options.single = single;
    options.assess = true;
    Compiled compiled(model, options, folder);
    ASSERT_TRUE(compiled);
    std::vector<Prediction> expected(3);
    for (std::vector<double> x : random_inputs(random, 3)) {
      const auto [half_width, novelty] =
          single ? compiled.assess<float>(x, 3) : compiled.assess<double>(x, 3);
      std::ranges::transform(x, x.begin(), [](double v) { return static_cast<float>(v); });
      model.predict(x, expected);
      EXPECT_EQ(half_width, (std::vector{0.25, HUGE_VAL, HUGE_VAL}));
      EXPECT_NEAR(novelty[0], expected[0].novelty, single ? 0.03 : 1e-12);
      EXPECT_EQ(novelty[1], 1.0);
      EXPECT_TRUE(std::isnan(novelty[2]));
    }
  }
}

TEST(ModelC, IsCalledAsCasadiCallsItsOwnCode) {
  const TemporaryFolder folder;
  RandomStream random(5, "casadi");
  const TrainedModel model = random_model(random, {});
  format::CodeOptions options;
  options.casadi = true;
  Compiled compiled(model, options, folder);
  ASSERT_TRUE(compiled);
  using Shape = std::array<CasadiFunction::Integer, 3>;
  const auto inputs = static_cast<CasadiFunction::Integer>(model.input_names.size());
  const auto targets = static_cast<CasadiFunction::Integer>(model.axes.size());

  CasadiFunction value(compiled, "kelpie_model");
  EXPECT_EQ(value.count("_n_in"), 1);
  EXPECT_EQ(value.count("_n_out"), 1);
  EXPECT_EQ(value.name_of("_name_in", 0), "x");
  EXPECT_EQ(value.name_of("_name_out", 0), "y");
  EXPECT_EQ(value.shape("_sparsity_in", 0), (Shape{inputs, 1, inputs}));
  EXPECT_EQ(value.shape("_sparsity_out", 0), (Shape{targets, 1, targets}));

  CasadiFunction jacobian(compiled, "jac_kelpie_model");
  EXPECT_EQ(jacobian.count("_n_in"), 2);  // and the value, which it doesn't need
  EXPECT_EQ(jacobian.name_of("_name_in", 1), "out_y");
  EXPECT_EQ(jacobian.name_of("_name_out", 0), "jac_y_x");
  EXPECT_EQ(jacobian.shape("_sparsity_in", 1), (Shape{targets, 1, 0}));
  EXPECT_EQ(jacobian.shape("_sparsity_out", 0), (Shape{targets, inputs, targets * inputs}));

  CasadiFunction bends(compiled, "jac_jac_kelpie_model");
  EXPECT_EQ(bends.count("_n_in"), 3);
  EXPECT_EQ(bends.count("_n_out"), 2);
  EXPECT_EQ(bends.name_of("_name_in", 2), "out_jac_y_x");
  EXPECT_EQ(bends.name_of("_name_out", 0), "jac_jac_y_x_x");
  EXPECT_EQ(bends.name_of("_name_out", 1), "jac_jac_y_x_out_y");
  EXPECT_EQ(bends.shape("_sparsity_in", 2), (Shape{targets, inputs, 0}));
  EXPECT_EQ(bends.shape("_sparsity_out", 0),
            (Shape{targets * inputs, inputs, targets * inputs * inputs}));
  EXPECT_EQ(bends.shape("_sparsity_out", 1), (Shape{targets * inputs, targets, 0}));

  const std::size_t columns = model.input_names.size();
  const std::size_t rows = model.axes.size();
  std::vector<double> y(rows);
  std::vector<double> slopes(rows * columns);
  for (const std::vector<double>& x : random_inputs(random, columns)) {
    model.predict_with_jacobian(x, y, slopes);
    const std::vector<double> said = value.call(x.data());
    const std::vector<double> by_columns = jacobian.call(x.data());
    const std::vector<double> bent = bends.call(x.data());
    const std::vector<double> hessian = compiled.hessian<double>(x, rows);
    for (std::size_t i = 0; i < rows; ++i) {
      ASSERT_NEAR(said[i], y[i], 1e-9 * (1.0 + std::abs(y[i])));
      for (std::size_t k = 0; k < columns; ++k) {
        const double slope = slopes[i * columns + k];
        ASSERT_NEAR(by_columns[k * rows + i], slope, 1e-9 * (1.0 + std::abs(slope)));
        for (std::size_t j = 0; j < columns; ++j) {
          ASSERT_EQ(bent[k * rows * columns + j * rows + i],
                    hessian[(i * columns + j) * columns + k]);
        }
      }
    }
  }
  EXPECT_EQ(value.call(nullptr), value.call(std::vector<double>(columns, 0.0).data()));
  options.single = true;
  EXPECT_EQ(message_of<InputError>([&] { format::model_c(model, options); }),
            "--casadi: calls with double; it doesn't go with --float");
}

TEST(ModelC, OfANumberThatIsNoneNothingIsKnown) {
  const TemporaryFolder folder;
  RandomStream random(9, "none");
  TrainedModel model = random_model(random, {});
  for (TrainedModel::Axis& axis : model.axes) {
    axis.known = testing::random_places(random, 3, 20);
  }
  format::CodeOptions options;
  options.assess = true;
  options.hessian = true;
  Compiled compiled(model, options, folder);
  ASSERT_TRUE(compiled);
  for (const double none : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    const std::vector<double> x{0.1, none, 0.2};
    std::vector<double> y(3);
    std::vector<double> jacobian(9);
    compiled.run<double>(x, y, jacobian);
    EXPECT_TRUE(std::ranges::all_of(y, [](double v) { return std::isnan(v); }));
    EXPECT_TRUE(std::ranges::all_of(jacobian, [](double v) { return std::isnan(v); }));
    EXPECT_EQ(compiled.assess<double>(x, 3).second, (std::vector{1.0, 1.0, 1.0}));
    const auto is_nan = [](double v) { return std::isnan(v); };
    EXPECT_TRUE(std::ranges::all_of(compiled.hessian<double>(x, 3), is_nan));
    const std::vector<double> zeros(3);
    EXPECT_TRUE(std::ranges::all_of(compiled.hessian_vector(x, zeros, zeros), is_nan));
  }
}

// Steps of the compiled actuators beside AlignedRows, at uneven times.
template <typename Real>
void expect_same_effects(const TrainedModel& model, double step_s, double tolerance,
                         const TemporaryFolder& folder) {
  format::CodeOptions options;
  options.single = std::is_same_v<Real, float>;
  Compiled compiled(model, options, folder);
  ASSERT_TRUE(compiled);
  alignas(16) std::array<std::byte, 8192> state{};
  compiled.named<void (*)(void*)>("kelpie_model_actuators_rest")(state.data());
  const auto step = compiled.named<void (*)(void*, Real, Real*)>("kelpie_model_actuators_step");
  AlignedRows rows(0, {1, 2}, 3, 0, 1.0 / step_s, model.alignment.actuators);
  RandomStream random(11, "actuators");
  double t = 0.0;
  double n = 0.0;
  for (int row = 0; row < 600; ++row) {
    const double dt = row % 50 == 7 ? 0.0 : step_s * random.uniform(0.5, 2.0);
    t += dt;
    n = row % 40 == 0 ? random.uniform(-3.0, 3.0) : dt > 0.0 ? n + 0.1 * random.normal() : n;
    const std::array<double, 3> x{0.5, 1500.0 + 100.0 * n, n};
    std::array<Real, 3> effects{0.5F, static_cast<Real>(x[1]), static_cast<Real>(x[2])};
    step(state.data(), static_cast<Real>(dt), effects.data());
    rows.push(x, {}, t, [&](std::span<const double> expected, std::span<const double>, double) {
      EXPECT_EQ(effects[0], static_cast<Real>(0.5));
      EXPECT_NEAR(effects[1], expected[1], 100.0 * tolerance) << row;
      EXPECT_NEAR(effects[2], expected[2], tolerance) << row;
    });
  }
}

TEST(ModelC, ItsActuatorsMakeOfCommandsWhatTheRowsOfALogGet) {
  const TemporaryFolder folder;
  RandomStream random(10, "actuators");
  TrainedModel model = random_model(random, {});
  const std::vector<std::vector<Actuator>> kinds{
      {{.neutral = 1500.0, .dead_band = 20.0, .astern = 0.8}, {.lag_s = 0.7}},
      {{.neutral = 1500.0, .rate = 150.0}, {.lag_s = 0.3, .rate = 2.0}},
      {{.neutral = 1500.0, .lag_s = 0.5, .delay_s = 0.35}, {.delay_s = 0.8}},
      {{}, {.dead_band = 0.1, .lag_s = 2.0, .rate = 0.5, .delay_s = 1.0}}};
  for (const std::vector<Actuator>& actuators : kinds) {
    model.alignment = {.commands = {"b", "c"}, .actuators = actuators};
    expect_same_effects<double>(model, 0.1, 1e-11, folder);
    expect_same_effects<float>(model, 0.1, 1e-3, folder);
  }
  // Of steps far shorter than the delay few are kept.
  expect_same_effects<double>(model, 0.002, 0.03, folder);
}

TEST(ModelC, WithoutActuatorsHasNothingOfThem) {
  RandomStream random(12, "none");
  TrainedModel model = random_model(random, {});
  const std::string without = format::model_c(model, {});
  EXPECT_EQ(without.find("ctuator"), std::string::npos);
  model.alignment = {.commands = {"b", "c"}, .actuators = {{}, {}}};
  EXPECT_EQ(format::model_c(model, {}), without);
}

TEST(ModelC, RefusesWhatIsNoName) {
  RandomStream random(5, "refused");
  const TrainedModel model = random_model(random, {});
  format::CodeOptions options;
  for (const char* const name : {"", "9a", "a-b", "a b", "_a", "\xc3\xbc", "a;"}) {
    options.name = name;
    EXPECT_NE(message_of<InputError>([&] { format::model_c(model, options); }).find("--name: '"),
              std::string::npos)
        << name;
  }
  options = {};
  options.units = {{"aa", Unit()}};
  EXPECT_EQ(
      message_of<InputError>([&] { format::model_c(model, options); }),
      "--units: 'aa' is no column of the model (did you mean 'a'?); there are a, b, c, x, y, z");
  TrainedModel large = model;
  large.axes[0].scaling.target.mean = 1e60;
  options = {};
  EXPECT_EQ(message_of<InputError>([&] { format::model_c(large, options); }), "");
  options.single = true;
  EXPECT_EQ(message_of<InputError>([&] { format::model_c(large, options); }),
            "model.json: --float: 1e+60 is out of range for float; export without --float");
  large.axes[0].scaling.target.mean = HUGE_VAL;
  options.single = false;
  EXPECT_EQ(message_of<InputError>([&] { format::model_c(large, options); }),
            "model.json: evaluating the model overflows a double");
}

// A vehicle's usual terms are multiplied out: of the mathematical library only exp is left. The
// second derivatives are those of a learned model, and of what the actuators make of commands.
TEST(ModelC, OfTheSimulatedVehicleNeedsNothingButExp) {
  const TemporaryFolder folder;
  simulator::Scenario scenario = simulator::read_scenario(std::filesystem::path(KELPIE_SOURCE_DIR) /
                                                          "scenarios" / "small.toml");
  scenario.phases.front().duration_s = 250.0;
  const log::Table table = study::log_table(simulator::simulate(scenario), "simulated");
  const log::Dataset data = log::make_dataset(table, log::guess_roles(table, {}));
  const ModelSettings settings = ModelSettings::from_preset("default", 3);
  DynamicsModel learner(data.input_names, data.target_names, settings);
  std::vector<std::vector<double>> inputs;
  for (std::size_t row = 0; row < data.rows(); ++row) {
    const std::span<const double> x = data.input(row);
    const std::span<const double> y(&data.targets[3 * row], 3);
    learner.update(x, y, data.times_s[row]);
    if (row % 10 == 0) {
      inputs.emplace_back(x.begin(), x.end());
    }
  }
  TrainedModel model = learner.trained();
  ASSERT_GT(model.terms.size(), 10U);
  const std::string code = format::model_c(model, {});
  EXPECT_FALSE(std::regex_search(code, std::regex("[^_a-z](sqrt|sin|cos|tanh|pow|fabs|log)\\(")));
  expect_same(model, inputs, false, folder);
  expect_same(model, inputs, true, folder);

  model.alignment = {.commands = {data.input_names[3], data.input_names[4]},
                     .actuators = {{.dead_band = 0.1}, {.astern = 0.7, .lag_s = 0.5}}};
  format::CodeOptions options;
  options.hessian = true;
  Compiled compiled(model, options, folder);
  ASSERT_TRUE(compiled);
  alignas(16) std::array<std::byte, 8192> state{};
  compiled.named<void (*)(void*)>("kelpie_model_actuators_rest")(state.data());
  const auto step = compiled.named<void (*)(void*, double, double*)>("kelpie_model_actuators_step");
  for (std::vector<double>& x : inputs) {
    step(state.data(), 0.5, x.data());
    for (double& value : x) {
      value += std::abs(value) < 1e-4 ? 1e-3 : 0.0;  // beside kinks
    }
    expect_bends_of_slopes(compiled, x, 3, std::vector<double>(x.size(), 1e-6));
  }
}

TEST(ModelC, NamesOfMembersAreNoCode) {
  const TemporaryFolder folder;
  RandomStream random(6, "names");
  TrainedModel model = random_model(random, {});
  model.axes[0].function.members[0].name = "*/ int injected; /*";
  EXPECT_EQ(format::model_c(model, {}).find("*/ int injected"), std::string::npos);
  expect_same(model, random_inputs(random, model.input_names.size()), false, folder);
}

}  // namespace
}  // namespace kelpie::model_c_test
