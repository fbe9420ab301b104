// SPDX-License-Identifier: Apache-2.0
// A host of FMI 2.0: units are unpacked, the shared object is loaded by the names of the standard,
// and the numbers are compared with those of the library.
#include "fmu/fmu_file.hpp"
#include "fmu/guid.hpp"

#include <dlfcn.h>
#include <gtest/gtest.h>
#include <tinyxml2.h>
#include <zip.h>

#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "file/atomic_file.hpp"
#include "fmu/fmi2.hpp"
#include "fmu/vehicle.hpp"
#include "format/model_json.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"
#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/model/rollout.hpp"
#include "kelpie/model/trained_model.hpp"
#include "support.hpp"

namespace kelpie::fmu_file_test {
namespace {

namespace fs = std::filesystem;
using namespace fmu;  // NOLINT(google-build-using-namespace): names of the standard
using testing::message_of;
using testing::TemporaryFolder;

const std::vector<std::string> kInputs{"u", "v", "r", "th1", "th2"};
const std::vector<std::string> kTargets{"udot", "vdot", "rdot"};
constexpr double kStepS = 0.1;

void write_fmu(const fs::path& file, const TrainedModel& model, const FmuOptions& options) {
  file::write_file_whole(file, fmu_content(model, options));
}

// A boat with two propellers, of which a model is learned.
TrainedModel learned_boat() {
  RandomStream random(7, "boat");
  DynamicsModel model(kInputs, kTargets, ModelSettings::from_preset("small", kTargets.size()));
  std::array<double, 5> x{};
  for (int row = 0; row < 3000; ++row) {
    if (row % 20 == 0) {
      x[3] = random.uniform(-1.0, 1.0);
      x[4] = random.uniform(-1.0, 1.0);
    }
    const std::array<double, 3> a{
        0.3 * (x[3] + x[4]) - 0.3 * x[0] - 0.2 * x[0] * std::abs(x[0]) + 0.5 * x[1] * x[2],
        -0.6 * x[1] - 0.5 * x[0] * x[2], 0.5 * (x[3] - x[4]) - 0.8 * x[2]};
    std::array<double, 3> y = a;
    for (double& value : y) {
      value += 0.002 * random.normal();
    }
    model.update(x, y, kStepS * row);
    for (std::size_t k = 0; k < 3; ++k) {
      x[k] += kStepS * a[k];
    }
  }
  TrainedModel trained = model.trained();
  trained.alignment.commands = {"th1", "th2"};
  return trained;
}

const TrainedModel& boat() {
  static const TrainedModel model = learned_boat();
  return model;
}

TrainedModel boat_with_actuators() {
  TrainedModel model = boat();
  model.alignment.actuators = {{.lag_s = 0.8}, {.neutral = 0.1, .delay_s = 0.2}};
  return model;
}

std::string entry_of(const fs::path& archive, const std::string& name) {
  int error = 0;
  zip_t* const zip = zip_open(archive.c_str(), ZIP_RDONLY, &error);
  if (zip == nullptr) {
    ADD_FAILURE() << archive << " is no archive: " << error;
    return "";
  }
  zip_stat_t about;
  std::string content;
  if (zip_stat(zip, name.c_str(), 0, &about) == 0) {
    content.resize(about.size);
    zip_file_t* const file = zip_fopen(zip, name.c_str(), 0);
    EXPECT_EQ(zip_fread(file, content.data(), content.size()),
              static_cast<zip_int64_t>(content.size()));
    zip_fclose(file);
  }
  zip_discard(zip);
  return content;
}

std::string last_message;  // NOLINT: the logger of the standard is a plain function

void keep_message(fmi2ComponentEnvironment /*environment*/, fmi2String /*instance*/,
                  fmi2Status /*status*/, fmi2String /*category*/, fmi2String format, ...) {
  std::array<char, 512> text{};
  std::va_list values;
  va_start(values, format);
  std::ignore = std::vsnprintf(text.data(), text.size(), format, values);
  va_end(values);
  last_message = text.data();
}

/// A unit, unpacked and loaded as a host does.
class Host {
 public:
  explicit Host(const TrainedModel& model, const fmu::FmuOptions& options = {}) {
    const fs::path file = folder_ / "vehicle.fmu";
    write_fmu(file, model, options);
    description_ = entry_of(file, "modelDescription.xml");
    for (const char* const part : {"resources/model.json", "binaries/linux64/kelpie_vehicle.so"}) {
      fs::create_directories((folder_ / part).parent_path());
      std::ofstream(folder_ / part, std::ios::binary) << entry_of(file, part);
    }
    library_.reset(::dlopen((folder_ / "binaries/linux64/kelpie_vehicle.so").c_str(), RTLD_NOW));
    EXPECT_NE(library_, nullptr) << ::dlerror();  // NOLINT(concurrency-mt-unsafe)
    xml_.Parse(description_.c_str());
    guid_ = xml_.RootElement()->Attribute("guid");
  }

  template <typename Function>
  Function* function(const char* name) const {
    auto* const found = reinterpret_cast<Function*>(::dlsym(library_.get(), name));  // NOLINT
    EXPECT_NE(found, nullptr) << name;
    return found;
  }

  fmi2Component instantiate(const std::string& guid) const {
    return function<decltype(fmi2Instantiate)>("fmi2Instantiate")(
        "boat", fmi2CoSimulation, guid.c_str(),
        ("file://" + folder_.path().string() + "/resources").c_str(), &callbacks_, 0, 1);
  }

  void put_model(const std::string& text) const {
    std::ofstream(folder_ / "resources/model.json", std::ios::binary) << text;
  }

  const std::string& description() const { return description_; }
  const std::string& guid() const { return guid_; }
  const tinyxml2::XMLElement& root() const { return *xml_.RootElement(); }

 private:
  TemporaryFolder folder_;
  std::string description_;
  std::string guid_;
  tinyxml2::XMLDocument xml_;
  fmi2CallbackFunctions callbacks_{keep_message, nullptr, nullptr, nullptr, nullptr};
  struct Close {
    void operator()(void* library) const { ::dlclose(library); }
  };
  std::unique_ptr<void, Close> library_;
};

/// A unit of the boat: writing one takes a second.
const Host& boat_host() {
  static const Host host(boat());
  return host;
}

/// A unit of the boat with actuators.
const Host& actuators_host() {
  static const Host host(boat_with_actuators());
  return host;
}

/// An instance of a unit, with the calls that the tests need.
class Instance {
 public:
  explicit Instance(const Host& host) : host_(host), component_(host.instantiate(host.guid())) {
    EXPECT_NE(component_, nullptr) << last_message;
  }
  ~Instance() { host_.function<decltype(fmi2FreeInstance)>("fmi2FreeInstance")(component_); }
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  void start(double t = 0.0) {
    EXPECT_EQ(host_.function<decltype(fmi2SetupExperiment)>("fmi2SetupExperiment")(component_, 0,
                                                                                   0.0, t, 0, 0.0),
              fmi2OK);
    EXPECT_EQ(call("fmi2EnterInitializationMode"), fmi2OK);
    EXPECT_EQ(call("fmi2ExitInitializationMode"), fmi2OK);
  }
  fmi2Status call(const char* name) {
    return host_.function<decltype(fmi2Reset)>(name)(component_);
  }
  fmi2Status set(fmi2ValueReference variable, double value) {
    return host_.function<decltype(fmi2SetReal)>("fmi2SetReal")(component_, &variable, 1, &value);
  }
  double get(fmi2ValueReference variable) {
    double value = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(
        host_.function<decltype(fmi2GetReal)>("fmi2GetReal")(component_, &variable, 1, &value),
        fmi2OK)
        << last_message;
    return value;
  }
  fmi2Status step(double step_s) {
    return host_.function<decltype(fmi2DoStep)>("fmi2DoStep")(component_, 0.0, step_s, 1);
  }
  fmi2FMUstate keep() {
    fmi2FMUstate state = nullptr;
    EXPECT_EQ(host_.function<decltype(fmi2GetFMUstate)>("fmi2GetFMUstate")(component_, &state),
              fmi2OK);
    return state;
  }
  void back_to(fmi2FMUstate state) {
    EXPECT_EQ(host_.function<decltype(fmi2SetFMUstate)>("fmi2SetFMUstate")(component_, state),
              fmi2OK);
  }
  void forget(fmi2FMUstate state) {
    EXPECT_EQ(host_.function<decltype(fmi2FreeFMUstate)>("fmi2FreeFMUstate")(component_, &state),
              fmi2OK);
    EXPECT_EQ(state, nullptr);
  }

 private:
  const Host& host_;
  fmi2Component component_;
};

constexpr fmi2ValueReference kSurge = 0, kThrust1 = 3, kThrust2 = 4, kPositionX = 5, kHeading = 7,
                             kUdot = 8;

TEST(Fmu, SaysAccelerationsOfTheModelAndVelocitiesOfARollout) {
  const Host& host = boat_host();
  Instance instance(host);
  std::vector<double> x{0.2, -0.1, 0.05, 0.6, -0.3};
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_EQ(instance.set(static_cast<fmi2ValueReference>(i), x[i]), fmi2OK);
  }
  instance.start();

  OpenLoop loop = open_loop(boat());
  loop.kept.clear();  // a simulation keeps the whole change
  Rollout rollout(loop, {.step_s = fmu::Vehicle::kStepS, .between = CommandPath::held});
  rollout.start(x);
  std::vector<double> y(3);
  RandomStream random(3, "boat");
  for (int step = 0; step < 200; ++step) {
    boat().predict(x, y);
    for (std::size_t k = 0; k < y.size(); ++k) {
      EXPECT_NEAR(instance.get(kUdot + static_cast<fmi2ValueReference>(k)), y[k], 1e-12);
    }
    for (const fmi2ValueReference command : {kThrust1, kThrust2}) {
      x[command] = random.uniform(-1.0, 1.0);
      EXPECT_EQ(instance.set(command, x[command]), fmi2OK);
    }
    EXPECT_EQ(instance.step(kStepS), fmi2OK) << last_message;
    rollout.advance(x, 0.0);
    rollout.advance(x, kStepS);
    for (fmi2ValueReference k = 0; k < 3; ++k) {
      EXPECT_NEAR(instance.get(k), rollout.velocity(k), 1e-9) << step;
      x[k] = instance.get(k);
    }
  }
}

TEST(Fmu, APoseFollowsFromTheVelocities) {
  fmu::Vehicle boat_ahead(boat());
  boat_ahead.set(kThrust1, 0.5);
  boat_ahead.set(kThrust2, 0.4);
  boat_ahead.start(0.0);
  double x = 0.0;
  double heading = 0.0;
  for (int step = 0; step < 20'000; ++step) {  // Euler, with steps of a hundredth
    const double u = boat_ahead.value(0);
    const double v = boat_ahead.value(1);
    x += 0.001 * (u * std::cos(heading) - v * std::sin(heading));
    heading += 0.001 * boat_ahead.value(2);
    boat_ahead.advance(0.001);
  }
  EXPECT_GT(std::abs(heading), 1.0);
  EXPECT_NEAR(boat_ahead.value(kPositionX), x, 0.005);
  EXPECT_NEAR(boat_ahead.value(kHeading), heading, 0.005);
}

TEST(Fmu, CommandsGoThroughTheActuators) {
  const Host& host = actuators_host();
  Instance instance(host);
  EXPECT_EQ(instance.get(kThrust2), 0.1);  // at rest in its neutral point
  instance.start();
  const double before = instance.get(kUdot);
  instance.set(kThrust1, 1.0);
  instance.step(0.05);
  EXPECT_LT(instance.get(kUdot) - before, 0.06);  // of 0.3, after a sixteenth of the lag
  instance.step(2.0);
  EXPECT_GT(instance.get(kUdot) - before + 0.3 * instance.get(kSurge), 0.2);
}

// When a command of a host with this step first moves the vehicle whose propeller is 0.2 s late.
double seconds_until_it_moves(double step_s) {
  fmu::Vehicle vehicle(boat_with_actuators());
  vehicle.start(50.0);
  const double before = vehicle.value(kUdot);
  for (int step = 0; step * step_s < 0.5; ++step) {
    vehicle.advance(step_s);  // at rest: every command kept is the same
  }
  const double begin = vehicle.time_s();
  vehicle.set(kThrust2, 0.9);
  while (std::abs(vehicle.value(kUdot) - before) < 0.05 && vehicle.time_s() < begin + 1.0) {
    vehicle.advance(step_s);
  }
  return vehicle.time_s() - begin;
}

TEST(Fmu, ADelayIsWholeHoweverQuicklyTheHostSteps) {
  for (const double step_s : {0.1, 0.05, 0.01, 0.001, 0.0001}) {
    EXPECT_NEAR(seconds_until_it_moves(step_s), 0.2, 1.5 * step_s + 0.002) << step_s;
  }
}

TEST(Fmu, OneLongStepIsManyShortOnes) {
  const Host& host = actuators_host();
  Instance far(host);
  Instance near(host);
  for (Instance* const instance : {&far, &near}) {
    instance->start(100.0);
    instance->set(kThrust1, 0.8);
  }
  far.step(2.0);
  for (int step = 0; step < 40; ++step) {
    near.step(0.05);
  }
  for (fmi2ValueReference variable = 0; variable < 11; ++variable) {
    EXPECT_NEAR(far.get(variable), near.get(variable), 1e-9) << variable;
  }
}

TEST(Fmu, AStateKeptIsComeBackTo) {
  const Host& host = boat_host();
  Instance instance(host);
  instance.start();
  instance.set(kThrust1, 0.7);
  instance.step(1.0);
  fmi2FMUstate kept = instance.keep();
  instance.step(1.0);
  const double later = instance.get(kSurge);
  instance.set(kThrust1, -1.0);
  instance.step(3.0);
  EXPECT_NE(instance.get(kSurge), later);
  instance.back_to(kept);
  instance.step(1.0);
  EXPECT_EQ(instance.get(kSurge), later);
  instance.forget(kept);

  EXPECT_EQ(instance.call("fmi2Reset"), fmi2OK);
  instance.start();
  EXPECT_EQ(instance.get(kSurge), 0.0);
}

TEST(Fmu, WhatIsNoCallIsRefusedAndChangesNothing) {
  const Host& host = boat_host();
  EXPECT_EQ(host.instantiate("{another}"), nullptr);
  EXPECT_NE(last_message.find("guid"), std::string::npos);
  Instance instance(host);
  EXPECT_EQ(instance.step(0.1), fmi2Error);
  instance.start();
  EXPECT_EQ(instance.set(kUdot, 1.0), fmi2Error);
  EXPECT_NE(last_message.find("udot: is a result"), std::string::npos) << last_message;
  EXPECT_EQ(instance.set(kSurge, 1.0), fmi2Error);
  EXPECT_EQ(instance.set(kThrust1, std::nan("")), fmi2Error);
  EXPECT_EQ(instance.set(1000, 1.0), fmi2Error);
  for (const double step : {-0.1, 1e300, std::nan("")}) {
    EXPECT_EQ(instance.step(step), fmi2Error);
  }
  EXPECT_EQ(instance.step(0.1), fmi2OK);
  EXPECT_EQ(instance.call("fmi2Terminate"), fmi2OK);
  EXPECT_EQ(instance.step(0.1), fmi2Error);
}

TEST(Fmu, AModelNestedWithoutEndIsRefused) {
  const Host host(boat());
  const std::string deep =
      "{\"more\": " + std::string(100'000, '[') + std::string(100'000, ']') + "}";
  host.put_model(deep);
  EXPECT_EQ(host.instantiate(fmu::guid_of(deep)), nullptr);
  EXPECT_NE(last_message.find("lists and objects within each other"), std::string::npos)
      << last_message;
}

TEST(Fmu, TheDescriptionNamesEveryVariableAtItsReference) {
  const Host host(boat(), {.name = "a <boat>", .units = {{"u", Unit::parse("m/s")}}});
  EXPECT_STREQ(host.root().Attribute("modelName"), "a <boat>");
  EXPECT_STREQ(host.root().Attribute("fmiVersion"), "2.0");
  const fmu::Vehicle vehicle(boat());
  const tinyxml2::XMLElement* variable =
      host.root().FirstChildElement("ModelVariables")->FirstChildElement("ScalarVariable");
  for (std::size_t i = 0; i < vehicle.variables().size(); ++i) {
    ASSERT_NE(variable, nullptr);
    EXPECT_EQ(variable->Attribute("name"), vehicle.variables()[i].name);
    EXPECT_EQ(variable->UnsignedAttribute("valueReference"), i);
    variable = variable->NextSiblingElement();
  }
  EXPECT_EQ(variable, nullptr);
  EXPECT_STREQ(host.root()
                   .FirstChildElement("ModelVariables")
                   ->FirstChildElement()
                   ->FirstChildElement("Real")
                   ->Attribute("unit"),
               "m s^-1");
  EXPECT_EQ(message_of<InputError>([] {
              fmu::model_description(fmu::Vehicle(boat()), "", {.units = {{"w", Unit{}}}});
            }).substr(0, 7),
            "--units");
}

TEST(Fmu, TheDescriptionFollowsTheSchemaOfTheStandard) {
  if (std::system("command -v xmllint >/dev/null") != 0) {  // NOLINT: the test's own words
    GTEST_SKIP() << "there is no xmllint";
  }
  const TemporaryFolder folder;
  const std::string file = (folder / "modelDescription.xml").string();
  const std::string check = std::string("xmllint --noout --schema '") + KELPIE_SOURCE_DIR +
                            "/tests/tools/fmu/co_simulation.xsd' '" + file + "' 2>/dev/null";
  const std::map<std::string, Unit> units{{"u", Unit::parse("m/s")}, {"th1", Unit::parse("rev/s")}};
  std::string text = fmu::model_description(fmu::Vehicle(boat()), "", {.units = units});
  std::ofstream(file) << text;
  EXPECT_EQ(std::system(check.c_str()), 0) << text;  // NOLINT: the test's own words
  const std::size_t place = text.find("causality=\"input\"");
  ASSERT_NE(place, std::string::npos);
  std::ofstream(file) << text.replace(place, 17, "causality=\"given\"");
  EXPECT_NE(std::system(check.c_str()), 0);  // NOLINT: the test's own words
}

TEST(Fmu, TheSameModelGivesTheSameBytes) {
  const TemporaryFolder folder;
  write_fmu(folder / "a.fmu", boat(), {});
  write_fmu(folder / "b.fmu", boat(), {});
  const auto bytes = [&](const char* name) {
    std::ifstream stream(folder / name, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(stream), {});
  };
  EXPECT_EQ(bytes("a.fmu"), bytes("b.fmu"));
}

TEST(Fmu, TheSharedObjectNeedsNoReaderOfLogs) {
  const TemporaryFolder folder;
  write_fmu(folder / "a.fmu", boat(), {});
  const std::string object = entry_of(folder / "a.fmu", "binaries/linux64/kelpie_vehicle.so");
  EXPECT_NE(object.find("libstdc++.so"), std::string::npos);
  for (const char* const library :
       {"libsqlite3.so", "libmatio.so", "libyaml-cpp.so", "libfmt.so"}) {
    EXPECT_EQ(object.find(library), std::string::npos) << library;
  }
}

TEST(Fmu, AModelThatCannotBeRolledOutIsNoUnit) {
  DynamicsModel model({"a", "b"}, {"c"}, ModelSettings::from_preset("small", 1));
  RandomStream random(1, "boat");
  for (int row = 0; row < 300; ++row) {
    const std::array x{random.normal(), random.normal()};
    model.update(x, std::array{x[0]}, 0.1 * row);
  }
  const TemporaryFolder folder;
  EXPECT_NE(message_of<InputError>([&] {
              write_fmu(folder / "a.fmu", model.trained(), {});
            }).find("cannot be rolled out"),
            std::string::npos);
  EXPECT_FALSE(fs::exists(folder / "a.fmu"));
}

}  // namespace
}  // namespace kelpie::fmu_file_test
