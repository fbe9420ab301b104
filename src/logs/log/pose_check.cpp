// SPDX-License-Identifier: Apache-2.0
#include "log/pose_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <map>
#include <optional>

#include "core/angle.hpp"
#include "log/known_roles.hpp"
#include "log/pair_moments.hpp"
#include "log/read_log.hpp"
#include "log/row_clock.hpp"
#include "log/tuning.hpp"

namespace kelpie::log {
namespace {

using Complex = std::complex<double>;
constexpr const auto& kPose = kTuning.pose_check;

// How two complex signals go together: γ², the share of one that the other explains, and the
// factor between them.
struct Coherence {
  double share = 0.0;
  Complex factor;
};

Coherence coherence(const std::vector<Complex>& ways, const std::vector<Complex>& others) {
  Complex mean_way;
  Complex mean_other;
  for (std::size_t k = 0; k < ways.size(); ++k) {
    mean_way += ways[k] / static_cast<double>(ways.size());
    mean_other += others[k] / static_cast<double>(ways.size());
  }
  double of_ways = 0.0;
  double of_others = 0.0;
  Complex both;
  for (std::size_t k = 0; k < ways.size(); ++k) {
    const Complex way = ways[k] - mean_way;
    const Complex other = others[k] - mean_other;
    of_ways += std::norm(way);
    of_others += std::norm(other);
    both += way * std::conj(other);
  }
  return of_ways > 0.0 && of_others > 0.0
             ? Coherence{std::norm(both) / (of_ways * of_others), both / of_others}
             : Coherence{};
}

// Velocities as they may be meant.
enum Meaning { kOfBody, kMirroredSway, kOfWorld, kMeanings };

// Means over windows: of the way between poses per second, and of the velocities in each meaning.
struct WayWindows {
  std::vector<Complex> ways;
  std::array<std::vector<Complex>, kMeanings> velocities;
  PairMoments turns;  // of the yaw rate and the slope of yaw
};

WayWindows way_windows_of(const PoseTrack& track, double length_s) {
  WayWindows windows;
  const std::vector<double>& t = track.times_s;
  const std::size_t rows = t.size();
  for (std::size_t first = 0; first + 1 < rows;) {
    std::size_t last = first + 1;
    std::array<Complex, kMeanings> sums{};
    double turn = 0.0;
    double rate = 0.0;
    bool is_whole = true;
    for (; last < rows; ++last) {
      const double step_s = t[last] - t[last - 1];
      const Complex heading = std::polar(1.0, track.yaw[last]);
      const Complex velocity(track.u[last], track.v[last]);
      is_whole = is_whole && step_s > 0.0 && step_s < length_s;
      sums[kOfBody] += step_s * velocity * heading;
      sums[kMirroredSway] += step_s * std::conj(velocity) * heading;
      sums[kOfWorld] += step_s * velocity;
      turn += std::remainder(track.yaw[last] - track.yaw[last - 1], kFullTurn);
      rate += track.r.empty() ? 0.0 : step_s * track.r[last];
      if (t[last] - t[first] >= length_s) {
        break;
      }
    }
    if (last == rows) {
      break;
    }
    const double span_s = t[last] - t[first];
    const Complex way(track.x[last] - track.x[first], track.y[last] - track.y[first]);
    is_whole = is_whole && std::isfinite(std::norm(way) + std::norm(sums[kOfBody]) + turn);
    if (is_whole) {
      windows.ways.push_back(way / span_s);
      for (std::size_t k = 0; k < kMeanings; ++k) {
        windows.velocities[k].push_back(sums[k] / span_s);
      }
      windows.turns.add(rate / span_s, turn / span_s);
    }
    first = last;
  }
  return windows;
}

// In a world or in its mirror, as a compass beside east and north has it.
std::array<Coherence, kMeanings> coherences(const WayWindows& windows, bool& is_mirrored) {
  std::vector<Complex> mirrored = windows.ways;
  std::ranges::for_each(mirrored, [](Complex& way) { way = std::conj(way); });
  std::array<Coherence, kMeanings> plain;
  std::array<Coherence, kMeanings> mirror;
  for (std::size_t k = 0; k < kMeanings; ++k) {
    plain.at(k) = coherence(windows.ways, windows.velocities.at(k));
    mirror.at(k) = coherence(mirrored, windows.velocities.at(k));
  }
  const auto best = [](const auto& all) {
    return std::ranges::max(all, {}, &Coherence::share).share;
  };
  is_mirrored =
      best(mirror) > best(plain) + kPose.least_gain && mirror[kOfBody].share > best(plain);
  return is_mirrored ? mirror : plain;
}

std::optional<Mistake> meaning_mistake(const std::array<Coherence, kMeanings>& shares,
                                       const PoseNames& names, bool& is_world) {
  const double body = 1.0 - shares[kOfBody].share;
  std::size_t best = kOfBody;
  for (std::size_t k = 0; k < kMeanings; ++k) {
    best = shares.at(k).share > shares.at(best).share ? k : best;
  }
  const double left = 1.0 - shares.at(best).share;
  if (best == kOfBody || body < kPose.least_unexplained || left * kPose.clearer > body ||
      shares.at(best).share < kPose.least_share) {
    return std::nullopt;
  }
  is_world = best == kOfWorld;
  const std::string how =
      fmt::format("the poses explain {:.3g} of {} and {} so, and {:.3g} as axes of the vehicle",
                  shares.at(best).share, names.u, names.v, shares[kOfBody].share);
  if (is_world) {
    return Mistake{fmt::format("{} and {} are velocities along the axes of the world, not of the "
                               "vehicle ({})",
                               names.u, names.v, how),
                   "--pose " + names.pose + " takes the motion from the poses"};
  }
  // A mirror that is turned by a quarter exchanges the axes.
  const double cosine = std::cos(std::arg(shares.at(best).factor));
  if (std::abs(cosine) < std::sqrt(0.5)) {
    return Mistake{fmt::format("{} and {} are exchanged ({})", names.u, names.v, how),
                   "exchange their names"};
  }
  const std::string& wrong = cosine > 0.0 ? names.v : names.u;
  return Mistake{fmt::format("{} has the sign opposite to the poses ({})", wrong, how),
                 "change the sign of " + wrong};
}

// Of a factor that a unit explains, or an angle that no convention of headings does.
std::optional<Mistake> size_mistake(const Coherence& body, const PoseNames& names) {
  constexpr std::array<std::pair<const char*, double>, 4> kSpeedUnits{
      {{"cm/s", 0.01}, {"mm/s", 0.001}, {"knots", 0.514444}, {"km/h", 0.277778}}};
  const double size = std::abs(body.factor);
  for (const auto& [unit, factor] : kSpeedUnits) {
    if (std::abs(std::log(size / factor)) < kPose.near_factor) {
      return Mistake{
          fmt::format("the ways between poses are {:.3g} times as long as {} and {} say, "
                      "which are in {}",
                      size, names.u, names.v, unit),
          fmt::format("--units {}={},{}={} converts", names.u, unit, names.v, unit)};
    }
  }
  const double quarters = std::arg(body.factor) / (kFullTurn / 4.0);
  const double off = (quarters - std::round(quarters)) * 90.0;
  if (std::abs(off) > kPose.least_turn_deg) {
    return Mistake{fmt::format("the ways between poses lie {:.0f} degrees beside {} and {}: is the "
                               "sensor of the velocity mounted so?",
                               off, names.u, names.v),
                   "turn the velocities into the vehicle's axes", false};
  }
  return std::nullopt;
}

std::optional<Mistake> turn_mistake(const PairMoments& turns, const PoseNames& names) {
  if (std::abs(turns.correlation()) < kPose.least_correlation) {
    return std::nullopt;
  }
  const double slope = turns.xy / turns.xx;
  if (slope < 0.0) {
    return Mistake{fmt::format("{} has the sign opposite to the slope of {}", names.r, names.yaw),
                   fmt::format("change the sign of {} or of {}", names.r, names.yaw)};
  }
  if (std::abs(std::log(slope / kRadPerDegree)) < kPose.near_factor) {
    return Mistake{fmt::format("{} is {:.3g} times the slope of {}: degrees per second", names.r,
                               1.0 / slope, names.yaw),
                   fmt::format("--units {}=deg/s converts", names.r)};
  }
  return std::nullopt;
}

using Columns = std::map<std::string, std::size_t>;  // of the parts of a pose

// A column in units of the SI.
std::vector<double> si_values(const Table& table, const Roles& given, std::size_t column) {
  const auto own = given.units.find(table.names[column]);
  const std::string unit = own != given.units.end()      ? own->second
                           : column < table.units.size() ? table.units[column]
                                                         : "";
  const double factor =
      unit.empty() ? 1.0 : si_unit(table.source, table.names[column], unit).second;
  std::vector<double> all = table.columns[column];
  std::ranges::for_each(all, [&](double& value) { value *= factor; });
  return all;
}

// Of the quaternion's columns [rad].
std::vector<double> yaw_of_quaternion(const Table& table, const Columns& parts) {
  std::vector<double> yaw(table.rows());
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const auto q = [&](const char* part) { return table.columns[parts.at(part)][row]; };
    yaw[row] = std::atan2(2.0 * (q("qw") * q("qz") + q("qx") * q("qy")),
                          1.0 - 2.0 * (q("qy") * q("qy") + q("qz") * q("qz")));
  }
  return yaw;
}

}  // namespace

PoseFinding check_pose(const PoseTrack& track, const PoseNames& names) {
  PoseFinding found;
  WayWindows windows;
  std::array<Coherence, kMeanings> shares{};
  bool is_mirrored = false;
  double best = -1.0;
  for (const double length_s : {2.0, 8.0}) {
    WayWindows tried = way_windows_of(track, length_s);
    if (static_cast<double>(tried.ways.size()) < kPose.least_windows) {
      continue;
    }
    bool mirrored = false;
    const auto all = coherences(tried, mirrored);
    if (const double share = std::ranges::max(all, {}, &Coherence::share).share; share > best) {
      best = share;
      shares = all;
      is_mirrored = mirrored;
      windows = std::move(tried);
    }
  }
  found.share = best;
  if (best < kPose.least_share) {
    return found;
  }
  if (const auto mistake = meaning_mistake(shares, names, found.is_world)) {
    found.mistakes.push_back(*mistake);
  } else if (const auto size = size_mistake(shares[kOfBody], names)) {
    found.mistakes.push_back(*size);
  }
  if (const auto turn =
          track.r.empty() || is_mirrored ? std::nullopt : turn_mistake(windows.turns, names)) {
    found.mistakes.push_back(*turn);
  }
  return found;
}

PoseFinding check_pose(const Table& table, const Roles& given) {
  Columns parts;
  std::array<std::optional<std::size_t>, 6> axes;
  for (std::size_t column = 0; column < table.names.size(); ++column) {
    const std::string& name = table.names[column];
    if (table.is_of_words(column)) {
      continue;
    }
    if (const auto axis = velocity_by_name(name)) {
      axes.at(*axis) = axes.at(*axis).value_or(column);
    } else if (const auto part = measured_pose_part(name)) {
      parts.try_emplace(*part, column);
    }
  }
  const RowClock clock = row_clock(table, given);
  const bool is_quaternion =
      parts.contains("qw") && parts.contains("qx") && parts.contains("qy") && parts.contains("qz");
  const bool has_all = parts.contains("x") && parts.contains("y") &&
                       (is_quaternion || parts.contains("yaw")) && axes[0] && axes[1] &&
                       clock.problem.empty();
  if (!has_all) {
    return {};
  }
  const auto values = [&](std::size_t column) { return si_values(table, given, column); };
  PoseTrack track{.times_s = row_times_s(table, clock.column, clock.rate_hz),
                  .x = values(parts.at("x")),
                  .y = values(parts.at("y")),
                  .yaw = is_quaternion ? yaw_of_quaternion(table, parts) : values(parts.at("yaw")),
                  .u = values(*axes[0]),
                  .v = values(*axes[1]),
                  .r = axes[5] ? values(*axes[5]) : std::vector<double>{}};
  const auto name = [&](std::optional<std::size_t> column) {
    return column ? table.names[*column] : "";
  };
  const std::string heading = table.names[parts.at(is_quaternion ? "qw" : "yaw")];
  const PoseNames names{
      .u = name(axes[0]),
      .v = name(axes[1]),
      .r = name(axes[5]),
      .yaw = heading,
      .pose = fmt::format("{},{},{}", name(parts.at("x")), name(parts.at("y")),
                          is_quaternion ? fmt::format("{},{},{},{}", heading, name(parts.at("qx")),
                                                      name(parts.at("qy")), name(parts.at("qz")))
                                        : heading)};
  PoseFinding found = check_pose(track, names);
  if (std::ranges::none_of(track.yaw, [](double yaw) { return std::abs(yaw) > kFullTurn; })) {
    return found;
  }
  std::ranges::for_each(track.yaw, [](double& yaw) { yaw *= kRadPerDegree; });
  const PoseFinding in_degrees = check_pose(track, names);
  return in_degrees.share > found.share ? in_degrees : found;
}

bool is_twist_of_world(const LogSource& source, const std::string& topic) {
  const auto at = [&](const char* field) { return topic + ":" + field; };
  const std::vector<std::string> columns{
      at("pose.pose.position.x"),    at("pose.pose.position.y"),    at("pose.pose.orientation.w"),
      at("pose.pose.orientation.x"), at("pose.pose.orientation.y"), at("pose.pose.orientation.z"),
      at("twist.twist.linear.x"),    at("twist.twist.linear.y")};
  Table table = read_columns(source, columns, bag::Clock::receive).table;
  table.names = {"t", "x", "y", "qw", "qx", "qy", "qz", "u", "v"};
  return check_pose(table, {}).is_world;
}

}  // namespace kelpie::log
