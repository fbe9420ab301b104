// SPDX-License-Identifier: Apache-2.0
#include "log/draft.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string_view>

#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/scaling.hpp"
#include "kelpie/motion/unit.hpp"
#include "log/ardusub.hpp"
#include "log/tuning.hpp"
#include "motion/signal_names.hpp"
#include "stream/tuning.hpp"

namespace kelpie::log {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Names that mean something else to a log.
constexpr std::array<std::string_view, 19> kTaken{
    "t",    "time",          "stamp", "u",   "v",  "w",  "p",  "q",
    "r",    "phi",           "theta", "psi", "qw", "qx", "qy", "qz",
    "conf", "configuration", "split"};

std::vector<std::string> parts_of(const std::string& column) {
  std::vector<std::string> parts(1);
  for (const char c : column) {
    const bool is_of_word = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
    if (is_of_word) {
      parts.back() += c;
    } else if (!parts.back().empty()) {
      parts.emplace_back();
    }
  }
  if (parts.back().empty()) {
    parts.pop_back();
  }
  return parts;
}

bool is_taken(const std::string& name) {
  return name.empty() || std::ranges::find(kTaken, name) != kTaken.end();
}

// Pulses of servos and motor controllers, to both sides of rest.
bool are_pulses(const CandidateColumn& command) {
  return are_pulses_about_rest(command.low, command.high) &&
         command.low == std::floor(command.low) && command.high == std::floor(command.high);
}

// Short names for commands, all different, of letters, digits and "_": the words of a column that
// some other column lacks. "/thruster_left/cmd:data" beside "/thruster_right/cmd:data" is left;
// "SERVO_OUTPUT_RAW:servo1_raw" alone is servo1_raw.
std::vector<std::string> short_names(const std::vector<CandidateColumn>& columns) {
  std::vector<std::vector<std::string>> all;
  for (const CandidateColumn& column : columns) {
    all.push_back(parts_of(column.name));
  }
  const auto is_shared = [&](const std::string& part) {
    return std::ranges::all_of(
        all, [&](const auto& parts) { return std::ranges::find(parts, part) != parts.end(); });
  };
  std::set<std::string> used;
  std::vector<std::string> names;
  for (const std::vector<std::string>& parts : all) {
    std::vector<std::string> own;
    std::string shared = "n";  // the last word that all have
    for (const std::string& part : parts) {
      if (!is_shared(part)) {
        own.push_back(part);
      } else if (part != "data" && part != "value") {
        shared = part;
      }
    }
    std::string name = own.empty() ? shared : join_text(own, "_");
    const bool is_number = std::isdigit(static_cast<unsigned char>(name.front())) != 0;
    if (is_number || is_taken(name)) {
      name = (shared == name ? "n" : shared) + (is_number ? "" : "_") + name;
    }
    const std::string stem = name;
    for (int k = 2; is_taken(name) || !used.insert(name).second; ++k) {
      name = stem + "_" + std::to_string(k);
    }
    names.push_back(name);
  }
  return names;
}

// Rates of the signals of a plan.
struct SignalRates {
  std::vector<CandidateColumn> used;
  double duration_s;   // of the rows
  double moving_hz;    // of the slowest learned velocity; +inf: none
  double commands_hz;  // of the slowest command
};

void choose_rate(const RowClock& clock, const SignalRates& rates, Draft& draft) {
  constexpr double kSlowestPose = 0.2;  // rows per second, by hand
  Roles& roles = draft.config.roles;
  StreamPlan& plan = draft.config.plan;
  const bool is_of_poses = !draft.pose.lines.empty();
  if (!clock.problem.empty()) {
    draft.open.push_back(clock.problem);
  } else if (is_of_poses && rates.moving_hz < kSlowestPose && !clock.unit.empty()) {
    draft.open.push_back(fmt::format(
        "time: the column {0} gives {1:.3g} rows per second, which is hardly in s: --units {0}={2} "
        "says that it is in {2}",
        roles.time, rates.moving_hz, clock.unit));
  }
  if (roles.targets.empty()) {
    return;
  }
  if (!(rates.moving_hz > 0.0)) {
    if (clock.problem.empty()) {
      draft.open.emplace_back("velocities: their times tell no rate");
    }
    return;
  }
  // Windows of poses overlap: more rows of a short log tell no more.
  const double wanted = is_of_poses
                            ? kTuning.usual_rate_hz
                            : std::clamp(kTuning.wanted_rows / std::max(rates.duration_s, 1.0),
                                         kTuning.usual_rate_hz, kTuning.fastest_rate_hz);
  double rate_hz = std::min(wanted, rates.moving_hz);
  rate_hz = rate_hz > 1.0 ? std::floor(rate_hz + 0.1) : rate_hz;
  draft.whys["rate"] = rate_hz < wanted - 1.0                 ? "velocities come no faster"
                       : wanted > kTuning.usual_rate_hz + 1.0 ? "the log is short"
                                                              : "enough for a vehicle";
  if (clock.rate_hz > 0.0) {
    rate_hz = clock.rate_hz;
    draft.whys["rate"] = "as given";
  }
  roles.rate_hz = std::stod(fmt::format("{:.4g}", rate_hz));  // as the file says
  double slowest = rates.moving_hz;
  for (const CandidateColumn& column : rates.used) {
    slowest = std::min(slowest, column.rate_hz);
  }
  plan.gap_s = std::clamp(std::ceil(30.0 / slowest) / 10.0, 1.0,
                          is_of_poses ? kInfinity : kTuning.longest_gap_s);
  if (is_of_poses) {
    return;
  }
  plan.derivative.window_s = std::max(0.5, std::ceil(60.0 / rates.moving_hz) / 10.0);
  if (clock.problem.empty() && plan.derivative.window_s > stream::kTuning.longest_window_s) {
    draft.open.push_back(fmt::format(
        "velocities come every {:.3g} s, too slowly for accelerations, which are slopes over six "
        "samples and {:g} s at most; a column of measured accelerations can be named by "
        "--targets{}",
        1.0 / rates.moving_hz, stream::kTuning.longest_window_s,
        clock.unit.empty()
            ? ""
            : fmt::format("; stamps in {0} are told by --units {1}={0}", clock.unit, roles.time)));
  }
}

void choose_clock(const SignalRates& rates, Draft& draft) {
  double low = kInfinity;
  double high = -kInfinity;
  for (const CandidateColumn& column : rates.used) {
    if (!column.stamps || column.stamps->high_s - column.stamps->low_s > kTuning.widest_stamps_s) {
      return;
    }
    low = std::min(low, column.stamps->median_s);
    high = std::max(high, column.stamps->median_s);
  }
  if (high - low <= kTuning.farthest_stamps_s) {
    draft.config.clock = bag::Clock::header;
  }
}

void say_what_is_slow(const SignalRates& rates, Draft& draft) {
  if (rates.commands_hz < kTuning.slow_hz) {
    draft.remarks.push_back(
        fmt::format("commands come at {:.2g} Hz; the log misses faster changes of thrust, "
                    "which limits the model: record at 10 Hz or more",
                    rates.commands_hz));
  }
  if (rates.moving_hz < kTuning.slow_hz && draft.pose.lines.empty()) {
    draft.remarks.push_back(fmt::format(
        "velocities come at {:.2g} Hz: accelerations are slopes over {:.2g} s, and what is "
        "faster can't be seen",
        rates.moving_hz, draft.config.plan.derivative.window_s));
  }
  const double rows = draft.config.roles.rate_hz * rates.duration_s;
  if (!draft.config.roles.targets.empty() && rows < kTuning.few_rows) {
    draft.remarks.push_back(
        fmt::format("{:.0f} rows are few: scores on the last rows are uncertain", rows));
  }
}

// Of a file of MATLAB: how fast its rows were taken nobody can tell.
void ask_for_row_times(const bag::BagReport& report, const SignalRates& rates, Draft& draft) {
  for (const bag::TopicReport& topic : report.topics) {
    const bool is_used = std::ranges::any_of(
        rates.used, [&](const CandidateColumn& column) { return column.topic == topic.name; });
    if ((is_used || rates.used.empty()) && topic.type == "matlab/RowsWithoutTime") {
      draft.open.push_back("time: the rows of " + topic.name +
                           " have none; name their time by time, or write how many there are per "
                           "second by rate");
    }
  }
}

// Chooses rate and clock of the rows, and notes slow signals. Requires the draft's targets.
void plan_times(const bag::BagReport& report, const RowClock& clock, const SignalRates& rates,
                Draft& draft) {
  ask_for_row_times(report, rates, draft);
  choose_rate(clock, rates, draft);
  choose_clock(rates, draft);
  say_what_is_slow(rates, draft);
}

constexpr std::array<const char*, 6> kAxes{"u", "v", "w", "p", "q", "r"};

std::string signal_why(const CandidateColumn& column) {
  return fmt::format("{}{:.3g} Hz, {:.4g} to {:.4g}", column.unit.empty() ? "" : column.unit + ", ",
                     column.rate_hz, column.low, column.high);
}

std::string rate_of_change(const std::string& unit) {
  return unit.ends_with("/s") ? unit + "^2" : unit + "/s";
}

// What a draft makes of a unit: the factor to the unit it writes.
struct DraftUnit {
  std::string text;
  double factor = 1.0;
};

// Units of motion in the SI, as --units converts, and two that no other room converts. The text is
// as people write: rad/s, not rad s^-1.
DraftUnit draft_unit(const std::string& given) {
  if (given.empty() || given == "mV" || given == "m/us") {
    return given.empty()   ? DraftUnit{}
           : given == "mV" ? DraftUnit{"V", 0.001}
                           : DraftUnit{"m/s", 1e6};
  }
  try {
    const auto [unit, factor] = Unit::parse(given).in_si();
    for (const char* const usual : {"m/s", "rad/s", "m/s^2", "rad/s^2"}) {
      if (unit == Unit::parse(usual)) {
        return {usual, factor};
      }
    }
    return {factor == 1.0 ? given : unit.text(), factor};
  } catch (const InputError&) {
    return {given};
  }
}

class Planner {
 public:
  Planner(const bag::BagReport& report, const RowClock& clock,
          const std::set<std::string>& of_world, const Roles& given)
      : report_(report),
        clock_(clock),
        given_(given),
        all_(find_candidates(report)),
        motors_(motor_outputs(report.autopilot.parameters)),
        is_submarine_(is_submarine(report)) {
    for (Candidate& one : all_) {
      if (one.part == Part::velocity && of_world.contains(topic_of(one))) {
        one.frame = "ENU";
        one.why = "along the axes of the world, as the poses of the same messages show";
      }
    }
    roles_.time = clock_.column;
    draft_.is_of_bag = report.topics.size() != 1 || !report.topics.front().name.empty();
  }

  Draft run() {
    keep_thrusters();
    std::optional<Candidate> velocity;
    std::optional<Candidate> rates;
    if (given_.pose.empty()) {
      velocity = choose(Part::velocity, "velocities", "");
      rates = choose(Part::rates, "rates", velocity ? topic_of(*velocity) : "");
    }
    const std::optional<Candidate> commands = given_.pose.empty() || given_.inputs.empty()
                                                  ? choose(Part::commands, "commands", "")
                                                  : given_inputs();
    if (velocity) {
      take_motion(*velocity, 0);
      take_validity(topic_of(*velocity));
      turn_velocity(*velocity);
    }
    if (rates) {
      take_motion(*rates, velocity ? 3 : 0);
    }
    if (!velocity && !rates && !is_asked(Part::velocity) && !is_asked(Part::rates)) {
      take_pose();
    }
    require_motion();
    if (commands) {
      take_commands(*commands);
    } else if (!is_asked(Part::commands)) {
      draft_.open.push_back(none_known(Part::commands, "commands"));
    }
    take_labels();
    keep_armed();
    const double duration_s =
        draft_.config.armed_only ? report_.autopilot.armed_s : report_.duration_s;
    plan_times(report_, clock_, {used_, duration_s, moving_rate_hz_, command_rate_hz_}, draft_);
    take_voltage();
    take_heading();
    if (draft_.is_of_bag && (draft_.states.empty() || draft_.commands.empty())) {
      list_fields();
    }
    tell_unused();
    put_sources();
    return std::move(draft_);
  }

 private:
  // Of MAVLink's vehicles by MAV_TYPE_SUBMARINE; ArduSub alone has the parameter FRAME_CONFIG.
  static bool is_submarine(const bag::BagReport& report) {
    constexpr double kSubmarine = 12.0;
    const auto topic = std::ranges::find(report.topics, "HEARTBEAT", &bag::TopicReport::name);
    const bool has_type =
        topic != report.topics.end() &&
        std::ranges::any_of(topic->fields, [](const bag::FieldRange& field) {
          return field.path == "type" && field.low == kSubmarine && field.high == kSubmarine;
        });
    return has_type || report.autopilot.parameters.contains("FRAME_CONFIG");
  }

  const MotorActuator* motor_at(const CandidateColumn& column) const {
    const auto found = std::ranges::find(motors_, output_of(column.name), &MotorActuator::output);
    return found == motors_.end() ? nullptr : &*found;
  }

  // Of an autopilot's outputs those that drive motors, in the motors' order, as the parameters tell
  // them; without parameters the first eight.
  void keep_thrusters() {
    constexpr std::size_t kUsualOutputs = 8;
    for (Candidate& one : all_) {
      if (one.part != Part::commands) {
        continue;
      }
      std::erase_if(one.columns, [&](const CandidateColumn& column) {
        const std::size_t output = output_of(column.name);
        return motors_.empty() ? output > kUsualOutputs : output > 0 && motor_at(column) == nullptr;
      });
      std::ranges::stable_sort(one.columns, {}, [&](const CandidateColumn& column) {
        const MotorActuator* const motor = motor_at(column);
        return motor == nullptr ? 0 : motor->motor;
      });
    }
    std::erase_if(all_, [](const Candidate& one) { return one.columns.empty(); });
    const std::string frame = sub_frame_name(report_.autopilot.parameters);
    if (!frame.empty()) {
      draft_.taken.push_back("ArduSub's frame: " + frame);
    }
    if (const std::string others = other_outputs_text(report_.autopilot.parameters);
        !motors_.empty() && !others.empty()) {
      draft_.remarks.push_back("no thrusters by SERVOn_FUNCTION, not taken: outputs " + others);
    }
  }

  // Columns that the caller names (given_inputs()) keep their names.
  std::vector<std::string> command_names(const Candidate& one) const {
    std::vector<std::string> names = short_names(one.columns);
    if (one.what.empty()) {
      std::ranges::transform(one.columns, names.begin(), &CandidateColumn::name);
    }
    for (std::size_t k = 0; k < names.size(); ++k) {
      if (const MotorActuator* const motor = motor_at(one.columns[k])) {
        names[k] = fmt::format("m{}", motor->motor);
      }
    }
    return names;
  }

  void keep_armed() {
    const bag::AutopilotReport& autopilot = report_.autopilot;
    if (autopilot.was_armed && autopilot.was_disarmed) {
      draft_.config.armed_only = true;
      draft_.taken.push_back(fmt::format("rows while the motors are armed: {:.0f} s of {:.0f} s",
                                         autopilot.armed_s, report_.duration_s));
    } else if (autopilot.was_disarmed) {
      draft_.remarks.emplace_back("the motors are never armed in this log; its rows are kept");
    }
  }

  // Beside the rows; a message without the clock of the others can't be.
  void take_voltage() {
    const auto found = std::ranges::find(all_, Part::voltage, &Candidate::part);
    if (found == all_.end() || roles_.targets.empty()) {
      return;
    }
    const CandidateColumn& column = found->columns.front();
    const bool is_taken = draft_.config.clock == bag::Clock::receive || column.stamps.has_value();
    Draft::Group group{.head = found->what + ": battery voltage, " + found->why,
                       .lines = {},
                       .is_taken = is_taken};
    if (is_taken) {
      add_line(group, "voltage", column);
    } else {
      group.head += "; it has no sender's time: change clock to \"receive\" to have it";
      group.head += column.unit == "mV" ? ", and scale the column by 0.001 to have V" : "";
      group.lines.push_back({"voltage", column.name, signal_why(column)});
    }
    draft_.states.push_back(std::move(group));
  }

  // Of a table, beside the rows: a current is found by it. Rows end with the first signal to end,
  // so a heading that is not there in every row is none.
  void take_heading() {
    if (draft_.is_of_bag || roles_.targets.empty() || !draft_.pose.lines.empty()) {
      return;
    }
    const bag::TopicReport& topic = report_.topics.front();
    Table table;
    std::ranges::transform(topic.fields, std::back_inserter(table.names), &bag::FieldRange::path);
    const auto field = std::ranges::find(topic.fields, find_heading(table), &bag::FieldRange::path);
    if (field == topic.fields.end() || field->not_finite > 0) {
      return;
    }
    if (const CandidateColumn column = column_of(topic, *field); column.varies()) {
      Draft::Group group{.head = "the heading, for the current: a column beside, no input",
                         .lines = {}};
      add_line(group, "psi", column);
      draft_.states.push_back(std::move(group));
    }
  }

  static std::string topic_of(const Candidate& one) {
    for (const CandidateColumn& column : one.columns) {
      if (column.exists()) {
        return column.topic;
      }
    }
    return "";
  }

  static bool varies(const Candidate& one) {
    return std::ranges::any_of(one.columns, &CandidateColumn::varies);
  }

  std::string none_known(Part part, const std::string& table) const {
    const std::string name = part == Part::commands ? "commands" : "velocities";
    const auto still = still_.find(part);
    return still != still_.end()
               ? fmt::format("{}: {} constant, and no other signal was found", name, still->second)
               : fmt::format("no {} are known by type or name; name them in [log.{}]", name, table);
  }

  bool is_asked(Part part) const { return asked_.contains(part); }

  // Of a table: a bag has too many.
  void tell_unused() {
    constexpr std::size_t kShown = 16;
    std::vector<std::string> names;
    std::size_t more = 0;
    for (const bag::FieldRange& field :
         draft_.is_of_bag ? std::vector<bag::FieldRange>{} : report_.topics.front().fields) {
      const CandidateColumn column = column_of(report_.topics.front(), field);
      const bool is_of_draft =
          field.path == roles_.time || !column.varies() || !can_be_written(column.name) ||
          std::ranges::find(used_, column.name, &CandidateColumn::name) != used_.end();
      if (!is_of_draft && names.size() < kShown) {
        names.push_back(column.name);
      } else if (!is_of_draft) {
        ++more;
      }
    }
    if (!names.empty()) {
      draft_.taken.push_back("not used: " + join_text(names, ", ") +
                             (more > 0 ? fmt::format(" and {} more", more) : ""));
    }
  }

  void list_fields() {
    constexpr std::size_t kMost = 200;
    for (const bag::TopicReport& topic : report_.topics) {
      for (const bag::FieldRange& field : topic.fields) {
        const CandidateColumn column = column_of(topic, field);
        if (column.varies() && field.elements.empty() && can_be_written(column.name) &&
            draft_.others.size() < kMost) {
          draft_.others.push_back({{}, column.name, signal_why(column)});
        }
      }
    }
  }

  // The one of the least rank that moves at all; of `topic` before all others. Where two have that
  // rank both are written, as comments.
  std::optional<Candidate> choose(Part part, const std::string& name, const std::string& topic) {
    std::vector<const Candidate*> likely;
    std::vector<const Candidate*> others;
    for (const Candidate& one : all_) {
      if (one.part != part) {
        continue;
      }
      if (!varies(one)) {
        draft_.remarks.push_back(fmt::format("{}: constant, not taken for {}", one.what, name));
        still_.try_emplace(part, one.what);
      } else if (likely.empty() || one.rank == likely.front()->rank) {
        likely.push_back(&one);
      } else {
        others.push_back(&one);
      }
    }
    const auto own = std::ranges::find_if(
        likely, [&](const Candidate* one) { return !topic.empty() && topic_of(*one) == topic; });
    if (own != likely.end()) {
      likely = {*own};
    }
    if (likely.size() > 1) {
      asked_.insert(part);
      std::vector<std::string> names;
      for (const Candidate* const one : likely) {
        names.push_back(one->what);
        write_as_comment(*one, "one of several readings: ");
      }
      draft_.open.push_back(fmt::format("{}: {}: which of them?", name, join_text(names, ", or ")));
      return std::nullopt;
    }
    if (part == Part::commands) {
      for (const Candidate* const one : others) {
        write_as_comment(*one, "not taken: ");
      }
    }
    return likely.empty() ? std::nullopt : std::optional(*likely.front());
  }

  void write_as_comment(const Candidate& one, const std::string& why) {
    if (one.columns.size() > kMostInputs) {
      return;
    }
    Draft::Group group{.head = why + one.what + ": " + one.why, .lines = {}, .is_taken = false};
    const std::vector<std::string> names = one.part == Part::commands
                                               ? command_names(one)
                                               : names_of_axes(one.part == Part::velocity ? 0 : 3);
    for (std::size_t k = 0; k < one.columns.size(); ++k) {
      if (one.columns[k].varies()) {
        group.lines.push_back({names[k], one.columns[k].name, signal_why(one.columns[k])});
      }
    }
    (one.part == Part::commands ? draft_.commands : draft_.states).push_back(std::move(group));
  }

  static std::vector<std::string> names_of_axes(std::size_t first) {
    return {kAxes[first], kAxes[first + 1], kAxes[first + 2]};
  }

  void add_line(Draft::Group& group, const std::string& name, const CandidateColumn& column) {
    group.lines.push_back({name, column.name, signal_why(column)});
    used_.push_back(column);
    const DraftUnit unit = draft_unit(column.unit);
    StreamPlan::Source& source = plan_.sources.emplace_back();
    source.name = name;
    source.from = column.name;
    if (unit.factor != 1.0) {
      source.scale = unit.factor;
      draft_.whys["scale." + name] = fmt::format("{} to {}", column.unit, unit.text);
    }
    if (!unit.text.empty()) {
      roles_.units[name] = unit.text;
    }
    draft_.taken.push_back(fmt::format("{} = {} ({})", name, column.name, signal_why(column)));
  }

  // Of velocities that are turned into the body's axes all three have to be there; ranges don't
  // tell then which of them move.
  void take_motion(const Candidate& one, std::size_t least) {
    const std::size_t first = one.part == Part::velocity ? 0 : 3;
    const bool is_of_world =
        one.part == Part::velocity && (one.frame == "NED" || one.frame == "ENU");
    Draft::Group group{
        .head = one.what + ": " + (one.frame.empty() ? "" : one.frame + ": ") + one.why,
        .lines = {}};
    double widest = 0.0;
    for (const CandidateColumn& column : one.columns) {
      widest = std::max(widest, column.high - column.low);
    }
    for (std::size_t k = 0; k < one.columns.size(); ++k) {
      const CandidateColumn& column = one.columns[k];
      const std::string name = kAxes[first + k];
      if (!column.exists()) {
        continue;
      }
      add_line(group, name, column);
      const bool moves =
          column.varies() &&
          (is_of_world || name != "w" || column.high - column.low > kTuning.least_motion * widest);
      const bool is_steered = first == 0 || name == "r" || least == 0 || is_submarine_;
      if (moves && is_steered) {
        moving_.push_back(name);
        moving_rate_hz_ = std::min(moving_rate_hz_, column.rate_hz);
      }
    }
    draft_.states.insert(draft_.states.begin() + static_cast<std::ptrdiff_t>(taken_groups_++),
                         std::move(group));
  }

  // What the velocity's message says of itself, where that is not always good.
  void take_validity(const std::string& name) {
    if (name.empty()) {  // drop_missing() knows the columns of a table
      return;
    }
    const auto topic = std::ranges::find(report_.topics, name, &bag::TopicReport::name);
    auto known = validity_of_message(short_type(topic->type));
    for (const bag::FieldRange& field : topic->fields) {
      if (!known && validity_by_name(field.path) == Validity::where_1 && field.high == 1.0) {
        known = std::pair(field.path, 1.0);
      }
    }
    const auto field = std::ranges::find_if(topic->fields, [&](const bag::FieldRange& one) {
      return known && one.path == known->first;
    });
    if (field == topic->fields.end() || field->low >= known->second || !can_be_written(name)) {
      return;
    }
    const std::string column = name + ":" + known->first;
    draft_.config.valid[column] = known->second;
    draft_.whys["valid." + column] =
        fmt::format("{:g} to {:g} in this log", field->low, field->high);
    draft_.taken.push_back(
        fmt::format("velocities where {} is {:g} or more", known->first, known->second));
  }

  // The attitude of the world `frame`, of `topic` before all others; or null.
  const Candidate* attitude_of(const std::string& frame, const std::string& topic) const {
    const Candidate* best = nullptr;
    for (const Candidate& one : all_) {
      const bool is_one = (one.part == Part::angles || one.part == Part::quaternion) &&
                          one.frame == frame && one.columns.front().exists();
      if (is_one && (best == nullptr || (topic_of(one) == topic && topic_of(*best) != topic))) {
        best = &one;
      }
    }
    return best;
  }

  // A velocity of the world is turned; of a submarine roll and pitch are inputs in any case.
  void turn_velocity(const Candidate& velocity) {
    const bool is_of_world = velocity.frame == "NED" || velocity.frame == "ENU";
    const bool has_restoring = is_submarine_ && velocity.frame == "FRD";
    if (!is_of_world && !has_restoring) {
      return;
    }
    const Candidate* const best =
        attitude_of(is_of_world ? velocity.frame : "NED", topic_of(velocity));
    if (best == nullptr && !is_of_world) {
      return;
    }
    if (best == nullptr) {
      draft_.open.push_back(
          fmt::format("velocities: {} is of the world ({}), and there is no attitude to turn it by",
                      velocity.what, velocity.frame));
      return;
    }
    const bool is_angles = best->part == Part::angles;
    const std::vector<std::string> names = is_angles
                                               ? std::vector<std::string>{"phi", "theta", "psi"}
                                               : std::vector<std::string>{"qw", "qx", "qy", "qz"};
    Draft::Group group{.head = best->what + ": " + best->why, .lines = {}};
    bool is_in_degrees = false;
    for (std::size_t k = 0; k < names.size(); ++k) {
      const CandidateColumn& column = best->columns[k];
      add_line(group, names[k], column);
      is_in_degrees = is_in_degrees || (column.unit != "deg" && column.high > 7.0);
    }
    if (is_submarine_ && is_angles) {
      angles_ = {names[0], names[1]};
    }
    draft_.states.insert(draft_.states.begin() + static_cast<std::ptrdiff_t>(taken_groups_++),
                         std::move(group));
    if (!is_of_world) {
      return;
    }
    plan_.vectors.push_back({.columns = {"u", "v", "w"},
                             .from = frame_from(velocity.frame),
                             .to = velocity.frame == "NED" ? Frame::frd : Frame::flu,
                             .attitude = names,
                             .is_in_degrees = is_angles && is_in_degrees});
  }

  // A column of the table that the caller names.
  CandidateColumn given_column(const std::string& name) const {
    const bag::TopicReport& topic = report_.topics.front();
    return column_of(topic, *std::ranges::find(topic.fields, name, &bag::FieldRange::path));
  }

  // "x", "yaw=psi".
  PoseColumns given_pose() const {
    PoseColumns parts;
    for (const std::string& text : given_.pose) {
      const auto [part, column] = pose_part(text);
      parts.emplace(part, given_column(column));
    }
    return parts;
  }

  // Without the velocities and the columns of the poses.
  Candidate given_inputs() const {
    Candidate one{.part = Part::commands, .what = {}, .columns = {}, .why = "as given"};
    const PoseColumns pose = given_pose();
    for (const std::string& name : given_.inputs) {
      const auto is_it = [&](const auto& part) { return part.second.name == name; };
      if (std::ranges::count(StreamPlan::Pose::kVelocities, name) == 0 &&
          std::ranges::none_of(pose, is_it)) {
        one.columns.push_back(given_column(name));
      }
    }
    return one;
  }

  // The columns beside poses that the caller names as labels of rows.
  void take_labels() {
    for (const std::string& label : {given_.configuration, given_.held_out}) {
      if (!given_.pose.empty() && !label.empty() &&
          std::ranges::find(used_, label, &CandidateColumn::name) == used_.end()) {
        Draft::Group group{.head = "a label of rows"};
        add_line(group, label, given_column(label));
        draft_.commands.push_back(std::move(group));
      }
    }
  }

  // Where no velocity is known, poses tell the motion.
  void take_pose() {
    const auto [best, rivals] =
        given_.pose.empty() ? choose_pose(report_) : PoseChoice{.parts = given_pose()};
    if (rivals.size() > 1) {
      draft_.open.push_back(fmt::format("poses: {}: which of them?", join_text(rivals, ", or ")));
      asked_.insert(Part::velocity);
      return;
    }
    for (const auto& [part, column] : best) {
      add_line(draft_.pose, part, column);
      moving_rate_hz_ = std::min(moving_rate_hz_, column.rate_hz);
    }
    const bool has_yaw = best.contains("yaw") || best.contains("qw");
    for (const auto& [axis, is_there] :
         {std::pair("u", best.contains("x")), std::pair("v", best.contains("x")),
          std::pair("w", best.contains("z")), std::pair("r", has_yaw)}) {
      if (is_there) {
        roles_.inputs.emplace_back(axis);
        roles_.targets.push_back(std::string(axis) + "dot");
      }
    }
    for (const char* const tilt : {"roll", "pitch"}) {
      if (best.contains(tilt) && best.at(tilt).varies()) {
        roles_.inputs.emplace_back(tilt);
      }
    }
    if (!best.empty()) {
      std::map<std::string, std::string> names;
      std::ranges::transform(best, std::inserter(names, names.end()),
                             [](const auto& part) { return std::pair(part.first, part.first); });
      plan_.pose = pose_from(names);
      draft_.taken.emplace_back("no velocities are known; poses tell the motion");
    }
  }

  // Sources in the order of a file: states, commands, parts of the pose.
  void put_sources() {
    std::vector<StreamPlan::Source> sources;
    const auto put = [&](const Draft::Group& group, Interpolation between) {
      for (const Draft::Line& line : group.lines) {
        if (group.is_taken) {
          sources.push_back(plan_.sources[plan_.source(line.name)]);
          sources.back().between = between;
        }
      }
    };
    for (const Draft::Group& group : draft_.states) {
      put(group, Interpolation::line);
    }
    for (const Draft::Group& group : draft_.commands) {
      put(group, Interpolation::hold);
    }
    put(draft_.pose, Interpolation::line);
    plan_.sources = std::move(sources);
  }

  void require_motion() {
    if (!draft_.pose.lines.empty()) {
      return;
    }
    if (moving_.empty() && !is_asked(Part::velocity) && !is_asked(Part::rates)) {
      draft_.open.push_back(none_known(Part::velocity, "states"));
    }
    for (const std::string& name : moving_) {
      roles_.inputs.push_back(name);
      roles_.targets.push_back(name + "dot");
      plan_.derived.push_back({name + "dot", name});
    }
    if (!moving_.empty()) {
      roles_.inputs.insert(roles_.inputs.end(), angles_.begin(), angles_.end());
    }
    if (!moving_.empty() && !std::ranges::any_of(moving_, [](const auto& name) {
          return name == "u" || name == "v" || name == "w";
        })) {
      draft_.remarks.emplace_back("no velocities over ground: only turning can be learned");
    }
    for (const std::string& name : moving_) {
      if (const auto unit = roles_.units.find(name); unit != roles_.units.end()) {
        roles_.units[name + "dot"] = rate_of_change(unit->second);
      }
    }
  }

  void take_commands(const Candidate& one) {
    if (roles_.inputs.size() + one.columns.size() > kMostInputs) {
      draft_.open.push_back(
          fmt::format("commands: {}: {} are more than a model takes; which of them?", one.what,
                      one.columns.size()));
      return;
    }
    const std::vector<std::string> names = command_names(one);
    Draft::Group group{.head = one.what.size() > 200 ? one.why : one.what + ": " + one.why,
                       .lines = {}};
    std::vector<std::string> still;
    for (std::size_t k = 0; k < names.size(); ++k) {
      if (!one.columns[k].varies() && !one.what.empty()) {
        still.push_back(one.columns[k].name);
        continue;
      }
      add_line(group, names[k], one.columns[k]);
      roles_.inputs.push_back(names[k]);
      const MotorActuator* const motor = motor_at(one.columns[k]);
      if (motor != nullptr && motor->direction < 0.0) {
        plan_.sources.back().scale = -1.0;
        plan_.sources.back().about = kNeutralPulseUs;
        draft_.whys["scale." + names[k]] = fmt::format("MOT_{}_DIRECTION is -1", motor->motor);
      }
      if (motor != nullptr || are_pulses(one.columns[k])) {
        draft_.taken.back() += fmt::format(", pulses that rest at {:g} µs", kNeutralPulseUs);
        roles_.actuators[names[k]].neutral = kNeutralPulseUs;
        draft_.whys["actuators." + names[k]] = fmt::format("{:g} to {:g}: pulses of a servo in µs",
                                                           one.columns[k].low, one.columns[k].high);
      }
      command_rate_hz_ = std::min(command_rate_hz_, one.columns[k].rate_hz);
    }
    if (!still.empty()) {
      draft_.remarks.push_back("constant, not taken: " + join_text(still, ", "));
    }
    tell_motors_at_rest(one);
    draft_.commands.insert(draft_.commands.begin(), std::move(group));
  }

  void tell_motors_at_rest(const Candidate& one) {
    double low = kInfinity;
    double high = -kInfinity;
    for (const CandidateColumn& column : one.columns) {
      if (column.varies()) {
        low = std::min(low, column.low);
        high = std::max(high, column.high);
      }
    }
    if (low >= kNeutralPulseUs - kTuning.dead_band_us &&
        high <= kNeutralPulseUs + kTuning.dead_band_us) {
      draft_.remarks.push_back(fmt::format(
          "commands stay within {:g} to {:g} µs, where usual motor controllers stand still ({:g} "
          "to {:g} µs): nothing moves the vehicle",
          low, high, kNeutralPulseUs - kTuning.dead_band_us,
          kNeutralPulseUs + kTuning.dead_band_us));
    }
  }

  const bag::BagReport& report_;
  const RowClock& clock_;
  const Roles& given_;
  std::vector<Candidate> all_;
  std::vector<MotorActuator> motors_;
  bool is_submarine_;  // roll and pitch are learned, too
  Draft draft_;
  Roles& roles_ = draft_.config.roles;
  SamplingPlan& plan_ = draft_.config.plan;
  std::map<Part, std::string> still_;  // what is constant
  std::set<Part> asked_;               // which of two isn't told
  std::vector<CandidateColumn> used_;  // states and commands that are taken
  std::vector<std::string> moving_;    // velocities that are learned
  std::vector<std::string> angles_;    // roll and pitch that are inputs
  std::size_t taken_groups_ = 0;       // of the states
  double moving_rate_hz_ = kInfinity;
  double command_rate_hz_ = kInfinity;
};

}  // namespace

Draft plan_draft(const bag::BagReport& report, const RowClock& clock,
                 const std::set<std::string>& of_world, const Roles& given) {
  return Planner(report, clock, of_world, given).run();
}

}  // namespace kelpie::log
