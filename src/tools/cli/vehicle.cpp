// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstddef>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "cli/output.hpp"
#include "core/text.hpp"
#include "file/atomic_file.hpp"
#include "file/content.hpp"
#include "kelpie/core/error.hpp"
#include "log/dataset.hpp"
#include "simulator/scenario_file.hpp"
#include "simulator/stability.hpp"
#include "simulator/thruster_frame.hpp"
#include "simulator/vehicle_text.hpp"

namespace kelpie::cli {
namespace {

using simulator::Thruster;
using simulator::VehicleParameters;

constexpr std::size_t kMostBytes = 1'000'000;  // of a table of thrusters
constexpr std::array<const char*, 6> kPlaces{"x", "y", "z", "dx", "dy", "dz"};

struct NewVehicleArguments {
  std::string frame;
  std::string csv;
  Words thrusters;
  std::string like;
  double mass_kg = 0.0;
  std::vector<double> size_m;
  std::vector<double> thrust_n{51.5, 40.2};
  double dead_band = 0.0625;
  std::string out;
};

Thruster thruster_at(const std::string& name, const std::array<double, 6>& numbers,
                     const std::string& option) {
  constexpr std::string_view kBare =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  if (name.empty() || name.find_first_not_of(kBare) != std::string::npos) {
    throw InputError(option, "'" + name + "' is no name of a thruster: letters, digits, _ and -");
  }
  Thruster thruster;
  thruster.name = name;
  thruster.position_m = {numbers[0], numbers[1], numbers[2]};
  thruster.direction = {numbers[3], numbers[4], numbers[5]};
  if (!thruster.direction.allFinite() || !thruster.position_m.allFinite() ||
      thruster.direction.norm() < 1e-6) {
    throw InputError(
        option, "the direction of " + name + " must have a length, and all numbers must be finite");
  }
  thruster.direction.normalize();
  thruster.max_speed_rps = 1.0;
  return thruster;
}

// "m1=x,y,z,dx,dy,dz"
Thruster parse_thruster(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::string how =
      "'" + text + "' must read NAME=x,y,z,dx,dy,dz: place in m and direction, FRD";
  std::array<double, 6> numbers{};
  const char* at = text.data() + std::min(text.size(), equals + 1);
  const char* const end = text.data() + text.size();
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto [stop, error] = std::from_chars(at, end, numbers.at(i));
    const bool is_last = i + 1 == numbers.size();
    if (equals == std::string::npos || error != std::errc() ||
        (is_last ? stop != end : stop == end || *stop != ',')) {
      throw InputError("--thruster", how);
    }
    at = stop + 1;
  }
  return thruster_at(text.substr(0, equals), numbers, "--thruster");
}

std::vector<Thruster> read_thrusters(const std::string& file) {
  const log::Table table =
      log::parse_csv(file::read_content(file, "a table of thrusters", kMostBytes), file);
  const std::size_t names = table.find("name");
  if (table.texts.size() <= names || table.texts[names].words.size() != table.rows()) {
    throw InputError({.file = file, .line = 0, .field = "name"},
                     "must be words, such as m1, in every row");
  }
  std::array<std::size_t, 6> columns{};
  for (std::size_t i = 0; i < columns.size(); ++i) {
    columns.at(i) = table.find(kPlaces.at(i));
    table.require_numbers(columns.at(i));
  }
  std::vector<Thruster> thrusters;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    std::array<double, 6> numbers{};
    for (std::size_t i = 0; i < columns.size(); ++i) {
      numbers.at(i) = table.columns[columns.at(i)][row];
    }
    const std::string where = fmt::format("{}:{}", file, table.lines[row]);
    thrusters.push_back(thruster_at(table.texts[names].words[row].second, numbers, where));
  }
  return thrusters;
}

// A later thruster of the same name replaces the former.
void add_thruster(std::vector<Thruster>& thrusters, const Thruster& one) {
  const auto same = std::ranges::find(thrusters, one.name, &Thruster::name);
  if (same == thrusters.end()) {
    thrusters.push_back(one);
  } else {
    *same = one;
  }
}

VehicleParameters body_of(const NewVehicleArguments& options, const Eigen::Vector3d& size_m) {
  if (options.like.empty()) {
    if (options.mass_kg <= 0.0) {
      throw InputError("--mass", "give the mass in kg and --size, or --like with a vehicle file");
    }
    return simulator::similar_vehicle(options.mass_kg, size_m);
  }
  VehicleParameters body = simulator::read_vehicle(options.like);
  if (body.command_unit == simulator::CommandUnit::speed) {
    throw InputError("--like", options.like +
                                   " takes commands as speeds of rotors; thrusts at full command "
                                   "belong to a vehicle that takes pwm or share");
  }
  if (options.mass_kg > 0.0) {
    throw InputError("--mass", "stands beside --like, which has the mass");
  }
  body.thrusters.clear();
  return body;
}

VehicleParameters new_vehicle(const NewVehicleArguments& options) {
  if (options.frame.empty() && options.csv.empty() && options.thrusters.empty()) {
    throw InputError("--frame", "give a frame of ArduSub, --thrusters FILE or --thruster");
  }
  const bool needs_size = options.like.empty() || !options.frame.empty();
  if (needs_size && options.size_m.empty()) {
    throw InputError("--size", "give length,width,height in m");
  }
  const Eigen::Vector3d size_m =
      options.size_m.empty() ? Eigen::Vector3d::Ones() : Eigen::Vector3d(options.size_m.data());
  VehicleParameters result = body_of(options, size_m);
  if (!options.frame.empty()) {
    try {
      result.thrusters = simulator::frame_thrusters(options.frame, size_m);
    } catch (const InputError& error) {
      throw InputError("--frame", error.what());
    }
  }
  if (!options.csv.empty()) {
    for (const Thruster& one : read_thrusters(options.csv)) {
      add_thruster(result.thrusters, one);
    }
  }
  for (const std::string& text : options.thrusters) {
    add_thruster(result.thrusters, parse_thruster(text));
  }
  for (Thruster& thruster : result.thrusters) {
    thruster.forward = options.thrust_n[0];
    thruster.reverse = options.thrust_n[1];
    thruster.dead_band = options.dead_band;
  }
  result.validate();
  return result;
}

std::string head_of(const NewVehicleArguments& options) {
  std::string like = options.like;  // in a comment, which a line end would end
  std::erase_if(like, [](unsigned char letter) { return std::iscntrl(letter) != 0; });
  std::string text =
      "# Written by `kelpie vehicle new`. Frame FRD: x forward, y right, z down, about the centre "
      "of "
      "gravity.\n";
  if (!options.frame.empty()) {
    text += "# Motors numbered and signed as in ArduSub's frame " + options.frame +
            "; ArduSub knows no places: measure them.\n";
  }
  text +=
      options.like.empty()
          ? "# Body, water and hold are assumed, by similarity with a BlueROV2 Heavy (von Benzon "
            "et al. 2022):\n# replace them by what `kelpie identify` finds.\n"
          : "# Body, water, actuators and hold as in " + like + ".\n";
  return text +
         fmt::format("# Thrusts of {:g} N forwards and {:g} N in reverse at full command.\n\n",
                     options.thrust_n[0], options.thrust_n[1]);
}

// Which axes the thrusters drive, a line each where an axis is not driven by itself.
void say_axes(const VehicleParameters& of) {
  const auto driven = simulator::driven_axes(of.thrusters);
  std::vector<std::string> alone;
  for (std::size_t axis = 0; axis < driven.size(); ++axis) {
    if (driven.at(axis) == simulator::AxisDrive::alone) {
      alone.emplace_back(simulator::axis_text(axis));
    }
  }
  say("{} thrusters, {} independent wrenches; driven by themselves: {}\n", of.thrusters.size(),
      simulator::wrench_rank(of.thrusters), alone.empty() ? "no axis" : join_text(alone, ", "));
  for (std::size_t axis = 0; axis < driven.size(); ++axis) {
    if (driven.at(axis) == simulator::AxisDrive::none) {
      say("{} cannot be driven: no thruster pushes along this axis\n", simulator::axis_text(axis));
    } else if (driven.at(axis) == simulator::AxisDrive::together) {
      say("{} cannot be driven by itself: every push along this axis pushes another axis, too\n",
          simulator::axis_text(axis));
    }
  }
}

void run_new(const NewVehicleArguments& options) {
  check_output("--out", options.out, {options.csv, options.like});
  const VehicleParameters made = new_vehicle(options);
  file::write_file_whole(options.out, head_of(options) + simulator::vehicle_text(made));
  say("{}\n", options.out);
  say_axes(made);
}

}  // namespace

void add_vehicle(CLI::App& app) {
  CLI::App* const command =
      app.add_subcommand("vehicle", "Write or check the vehicle file of a simulated vehicle");
  command->require_subcommand(1);
  const auto [made, options] = add_command(
      *command, "new", "Write a vehicle file for a frame of thrusters, and check it", run_new);
  made->add_option("--frame", options->frame,
                   "A frame of ArduSub: " + join_text(simulator::frame_names(), ", "));
  add_file(made, "--thrusters", options->csv,
           "CSV file with the columns name,x,y,z,dx,dy,dz: place in m, direction; FRD");
  made->add_option("--thruster", options->thrusters,
                   "NAME=x,y,z,dx,dy,dz: one thruster, over those of frame and file (repeatable)")
      ->allow_extra_args(false);
  add_file(made, "--like", options->like,
           "Vehicle file with the body, the water and the actuators");
  made->add_option("--mass", options->mass_kg, "kg; body and water by similarity with a BlueROV2")
      ->check(within(0.1, 1e6));
  made->add_option("--size", options->size_m, "Length,width,height in m")
      ->delimiter(',')
      ->expected(3)
      ->check(within(0.01, 1000.0));
  made->add_option("--thrust", options->thrust_n,
                   "Forwards,reverse in N at full command; default a T200's at 16 V")
      ->delimiter(',')
      ->expected(2)
      ->check(within(1e-3, 1e6));
  made->add_option("--dead-band", options->dead_band, "Share of the greatest command")
      ->check(within(0.0, 0.99))
      ->capture_default_str();
  add_file(made, "--out", options->out, "Vehicle file to write")->required();
  add_examples(made, "vehicle new --frame vectored --mass 11 --size 0.46,0.34,0.25 --out rov.toml",
               "vehicle new --thrusters frame.csv --like vehicles/bluerov2.toml --out rov.toml");

  auto checked = std::make_shared<std::string>();
  CLI::App* const check =
      command->add_subcommand("check", "Check a vehicle file, and tell which axes it can drive");
  add_file(check, "file", *checked, "Vehicle file")->required();
  check->callback([checked] { say_axes(simulator::read_vehicle(*checked)); });
  add_examples(check, "vehicle check vehicles/bluerov2.toml", "vehicle check rov.toml");
  add_examples(command,
               "vehicle new --frame vectored --mass 11 --size 0.46,0.34,0.25 --out rov.toml",
               "vehicle check rov.toml");
}

}  // namespace kelpie::cli
