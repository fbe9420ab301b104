// SPDX-License-Identifier: Apache-2.0
#include "health/gliders.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <span>

#include "core/quantile.hpp"
#include "core/seconds.hpp"
#include "core/text.hpp"
#include "health/glide_fit.hpp"
#include "health/tuning.hpp"
#include "kelpie/core/error.hpp"
#include "study/metrics.hpp"

namespace kelpie::health {
namespace {

constexpr std::array<std::pair<const char*, std::string GliderColumns::*>, 10> kNames{
    {{"time", &GliderColumns::time},
     {"pitch", &GliderColumns::pitch},
     {"ballast", &GliderColumns::ballast},
     {"depth", &GliderColumns::depth},
     {"density", &GliderColumns::density},
     {"sinking", &GliderColumns::sinking},
     {"speed", &GliderColumns::speed},
     {"mass", &GliderColumns::mass},
     {"roll", &GliderColumns::roll},
     {"turn", &GliderColumns::turn}}};

// A log's rows, and what trim and turns are told by.
struct GliderRows {
  GlideRows glide;
  std::vector<std::size_t> rows{};  // of the table
  std::vector<double> mass{};
  std::vector<double> roll{};
  std::vector<double> turn{};
};

std::vector<double> picked(const std::vector<double>& values, std::size_t begin, std::size_t end) {
  return values.empty() ? values
                        : std::vector<double>(values.begin() + static_cast<std::ptrdiff_t>(begin),
                                              values.begin() + static_cast<std::ptrdiff_t>(end));
}

GlideRows part_of(const GlideRows& rows, std::size_t begin, std::size_t end) {
  return {.times_s = picked(rows.times_s, begin, end),
          .pitch_rad = picked(rows.pitch_rad, begin, end),
          .ballast_ml = picked(rows.ballast_ml, begin, end),
          .depth_m = picked(rows.depth_m, begin, end),
          .density = picked(rows.density, begin, end),
          .sinking = picked(rows.sinking, begin, end),
          .speed = picked(rows.speed, begin, end),
          .surface_m = rows.surface_m};
}

GliderRows rows_of(const log::Table& table, const GliderColumns& columns) {
  const auto column = [&](const std::string& name) {
    const std::size_t at = table.find(name);
    table.require_numbers(at);
    return at;
  };
  const std::array needed{column(columns.time), column(columns.pitch), column(columns.ballast),
                          column(columns.depth)};
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const bool is_known = std::ranges::all_of(
        needed, [&](std::size_t at) { return std::isfinite(table.columns[at][row]); });
    const bool is_later =
        rows.empty() || table.columns[needed[0]][row] > table.columns[needed[0]][rows.back()];
    if (is_known && is_later) {
      rows.push_back(row);
    }
  }
  const auto values = [&](const std::string& name) {
    std::vector<double> all;
    if (!name.empty()) {
      const std::vector<double>& from = table.columns[column(name)];
      std::ranges::transform(rows, std::back_inserter(all),
                             [&](std::size_t row) { return from[row]; });
    }
    return all;
  };
  GliderRows found{.glide = {.times_s = values(columns.time),
                             .pitch_rad = values(columns.pitch),
                             .ballast_ml = values(columns.ballast),
                             .depth_m = values(columns.depth),
                             .density = values(columns.density),
                             .sinking = values(columns.sinking),
                             .speed = values(columns.speed)},
                   .rows = rows,
                   .mass = values(columns.mass),
                   .roll = values(columns.roll),
                   .turn = values(columns.turn)};
  if (rows.size() < 2) {
    throw InputError({.file = table.source, .line = 0, .field = columns.pitch},
                     "fewer than two rows have pitch, ballast and depth");
  }
  std::vector<double> depths = found.glide.depth_m;
  found.glide.surface_m = quantile(depths, kTuning.surface_quantile);
  return found;
}

using Places = std::vector<std::size_t>;

// What all logs tell together; a speed through the water alone tells neither path nor lag.
Places common_places(const GliderColumns& columns) {
  Places free{GlidePlace::buoyancy, GlidePlace::drag};
  if (!columns.density.empty()) {
    free.push_back(GlidePlace::density);
  }
  if (!columns.sinking.empty()) {
    free.insert(free.end(), {GlidePlace::depth, GlidePlace::attack, GlidePlace::lag});
  }
  return free;
}

// What a dive may change.
Places dive_places(const GliderColumns& columns) {
  Places free{GlidePlace::buoyancy, GlidePlace::drag};
  if (!columns.sinking.empty()) {
    free.push_back(GlidePlace::depth);
  }
  return free;
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Estimate slope_of(const std::vector<double>& x, const std::vector<double>& y) {
  const auto [slope, error] = fit_slope(x, y);
  return {slope, error};
}

// Pitch as a plane over the shifting mass and the ballast, by all logs: place and slope of each.
struct TrimPlane {
  double mass = 0.0, ballast = 0.0;  // means
  double by_mass = 0.0, by_ballast = 0.0;

  double pitch(const GliderRows& rows, std::size_t i) const {
    return by_mass * (rows.mass[i] - mass) + by_ballast * (rows.glide.ballast_ml[i] - ballast);
  }
};

template <typename Function>
void for_each_trim_row(const std::vector<GliderRows>& logs, Function function) {
  for (const GliderRows& rows : logs) {
    for (std::size_t i = 0; i < rows.mass.size(); ++i) {
      if (std::isfinite(rows.mass[i])) {
        function(rows.mass[i], rows.glide.ballast_ml[i], rows.glide.pitch_rad[i]);
      }
    }
  }
}

TrimPlane trim_plane(const std::vector<GliderRows>& logs) {
  TrimPlane plane;
  double count = 0.0;
  for_each_trim_row(logs, [&](double mass, double ballast, double) {
    plane.mass += mass;
    plane.ballast += ballast;
    count += 1.0;
  });
  plane.mass /= std::max(count, 1.0);
  plane.ballast /= std::max(count, 1.0);
  double mm = 0.0, mb = 0.0, bb = 0.0, mp = 0.0, bp = 0.0;
  for_each_trim_row(logs, [&](double mass, double ballast, double pitch) {
    const double m = mass - plane.mass;
    const double b = ballast - plane.ballast;
    mm += m * m;
    mb += m * b;
    bb += b * b;
    mp += m * pitch;
    bp += b * pitch;
  });
  const double determinant = mm * bb - mb * mb;
  if (determinant > 1e-9 * mm * bb) {
    plane.by_mass = (bb * mp - mb * bp) / determinant;
    plane.by_ballast = (mm * bp - mb * mp) / determinant;
  }
  return plane;
}

Estimate trim_of(const GliderRows& rows, std::size_t begin, std::size_t end,
                 const TrimPlane& plane) {
  std::vector<double> left;
  for (std::size_t i = begin; i < end; ++i) {
    if (std::isfinite(rows.mass[i])) {
      left.push_back(rows.glide.pitch_rad[i] - plane.pitch(rows, i));
    }
  }
  return slope_of(std::vector<double>(left.size(), 1.0), left);
}

Estimate turn_of(const GliderRows& rows, std::size_t begin, std::size_t end) {
  std::vector<double> x;
  std::vector<double> y;
  for (std::size_t i = begin; i < end; ++i) {
    const double one = std::sin(rows.roll[i]) * rows.glide.sinking[i];
    if (std::isfinite(one) && std::isfinite(rows.turn[i])) {
      x.push_back(one);
      y.push_back(rows.turn[i]);
    }
  }
  return slope_of(x, y);
}

struct ScoredText {
  const char* name;
  const std::vector<double>& measured;
  const std::vector<double>& predicted;
};

// "vertical speed R² 0.971, 0.012 m/s rms, 0.010 one row ahead on line", of the rows from `begin`;
// on line the mean of the last errors is taken off.
std::string score_text(const GlideRows& rows, const GlideParameters& parameters,
                       std::size_t begin) {
  const GlideMotion motion = glide(rows, parameters);
  std::vector<std::string> texts;
  for (const auto& [name, measured, predicted] :
       {ScoredText{"vertical speed", rows.sinking, motion.sinking},
        ScoredText{"speed through the water", rows.speed, motion.speed}}) {
    std::vector<double> y;
    std::vector<double> f;
    double squares = 0.0;
    double squares_on_line = 0.0;
    double bias = 0.0;
    for (std::size_t i = 0; i < measured.size(); ++i) {
      if (!std::isfinite(measured[i])) {
        continue;
      }
      const double ahead = measured[i] - predicted[i] - bias;
      bias += ahead / kTuning.bias_rows;
      if (i >= begin) {
        y.push_back(measured[i]);
        f.push_back(predicted[i]);
        squares += (y.back() - f.back()) * (y.back() - f.back());
        squares_on_line += ahead * ahead;
      }
    }
    if (!y.empty()) {
      const auto count = static_cast<double>(y.size());
      texts.push_back(fmt::format("{} R² {:.3f}, {:.4f} m/s rms, {:.4f} one row ahead on line",
                                  name, study::r_squared(y, f), std::sqrt(squares / count),
                                  std::sqrt(squares_on_line / count)));
    }
  }
  return join_text(texts, "; ");
}

// The first row of the second half of the time.
std::size_t half_of(const GlideRows& rows) {
  const double middle = 0.5 * (rows.times_s.front() + rows.times_s.back());
  return static_cast<std::size_t>(std::ranges::lower_bound(rows.times_s, middle) -
                                  rows.times_s.begin());
}

// The glider that the first half of a log tells; `refusal` tells why there is none.
struct HalfFit {
  std::size_t begin = 0;  // row of the second half
  GlideParameters parameters{};
  std::string refusal{};
};

HalfFit fit_half(const GlideRows& rows, const GliderColumns& columns) {
  HalfFit half{.begin = half_of(rows)};
  const std::array first{part_of(rows, 0, half.begin)};
  try {
    half.parameters = fit_glide(first, first_glide(), common_places(columns)).parameters;
  } catch (const InputError& error) {
    half.refusal = error.what();
  }
  return half;
}

// Where rows don't suffice there is no remark.
void remark_on_scores(const std::vector<GliderLog>& logs, const std::vector<GliderRows>& rows,
                      const std::vector<HalfFit>& halves, const GliderColumns& columns,
                      HealthTable& table) {
  for (std::size_t i = 0; i < logs.size(); ++i) {
    const GlideRows& own = rows[i].glide;
    if (halves[i].refusal.empty()) {
      table.remarks.push_back(logs[i].mission + ", second half after learning the first: " +
                              score_text(own, halves[i].parameters, halves[i].begin));
    }
    const auto dives = find_dives(own.depth_m);
    if (logs.size() < 2 || dives.empty()) {
      continue;
    }
    std::vector<GlideRows> others;
    for (std::size_t k = 0; k < logs.size(); ++k) {
      if (k != i) {
        others.push_back(rows[k].glide);
      }
    }
    Places adapted = dive_places(columns);
    if (!columns.sinking.empty()) {
      adapted.push_back(GlidePlace::lag);
    }
    try {
      const GlideParameters start =
          fit_glide(others, first_glide(), common_places(columns)).parameters;
      const std::size_t end = dives.front().second;
      const std::array first{part_of(own, 0, end)};
      const GlideParameters own_glider = fit_glide(first, start, adapted).parameters;
      table.remarks.push_back(fmt::format(
          "{}, by the other logs' glider: {}; adapted to the first dive: {}", logs[i].mission,
          score_text(own, start, 0), score_text(own, own_glider, end)));
    } catch (const InputError&) {
      continue;
    }
  }
}

// A log's rows with all columns, the speeds of the half's glider, and which half a row is of.
log::Table glide_table(const GliderLog& log, const GliderRows& rows, const HalfFit& half) {
  if (!half.refusal.empty()) {
    throw InputError({.file = log.table.source, .line = 0, .field = {}}, half.refusal);
  }
  log::Table table;
  table.source = log.table.source;
  table.names = log.table.names;
  for (const std::vector<double>& column : log.table.columns) {
    std::vector<double>& values = table.columns.emplace_back();
    std::ranges::transform(rows.rows, std::back_inserter(values),
                           [&](std::size_t row) { return column[row]; });
  }
  for (std::size_t row = 0; row < rows.rows.size(); ++row) {
    table.lines.push_back(row + 2);
  }
  const GlideMotion motion = glide(rows.glide, half.parameters);
  table.names.insert(table.names.end(), {"glide_sinking", "glide_speed", "second_half"});
  table.columns.push_back(motion.sinking);
  table.columns.push_back(motion.speed);
  std::vector<double>& held = table.columns.emplace_back(rows.rows.size(), 1.0);
  std::fill_n(held.begin(), half.begin, 0.0);
  return table;
}

// The estimates of a dive, in the order of the quantities.
std::vector<Estimate> dive_estimates(const GliderRows& rows, std::size_t begin, std::size_t end,
                                     const GlideFit& common, const GliderColumns& columns,
                                     const TrimPlane& plane) {
  const Places free = dive_places(columns);
  const std::array part{part_of(rows.glide, begin, end)};
  std::vector<Estimate> estimates;
  std::optional<GlideFit> fit;
  try {
    fit = fit_glide(part, common.parameters, free);
  } catch (const InputError&) {
    fit.reset();
  }
  for (const std::size_t place : free) {
    const double scale = place == GlidePlace::drag ? common.parameters[GlidePlace::drag] : 1.0;
    estimates.push_back(fit ? Estimate{fit->parameters[place] / scale, fit->errors[place] / scale}
                            : Estimate{kNan, kNan});
  }
  if (!columns.mass.empty()) {
    estimates.push_back(trim_of(rows, begin, end, plane));
  }
  if (!columns.turn.empty()) {
    estimates.push_back(turn_of(rows, begin, end));
  }
  return estimates;
}

std::vector<Quantity> quantities_of(const GliderColumns& columns) {
  std::vector<Quantity> quantities{{"net buoyancy at ballast 0", "ml"}, {"drag", ""}};
  if (!columns.sinking.empty()) {
    quantities.push_back({"net buoyancy with depth", "ml/m"});
  }
  if (!columns.mass.empty()) {
    quantities.push_back({"pitch trim", "rad"});
  }
  if (!columns.turn.empty()) {
    quantities.push_back({"turn by roll", "rad/m"});
  }
  return quantities;
}

}  // namespace

GliderColumns glider_columns(const std::vector<std::string>& pairs) {
  GliderColumns columns{.time = "time"};
  for (const std::string& pair : pairs) {
    const std::size_t equals = pair.find('=');
    const auto* const known = std::ranges::find(
        kNames, pair.substr(0, equals), [](const auto& one) { return std::string(one.first); });
    std::vector<std::string> names;
    for (const auto& [name, member] : kNames) {
      names.emplace_back(name);
    }
    require(equals != std::string::npos && known != kNames.end(), "--glider",
            "'" + pair + "' is no NAME=COLUMN; names are " + join_text(names, ", "));
    columns.*known->second = pair.substr(equals + 1);
  }
  require(!columns.pitch.empty() && !columns.ballast.empty() && !columns.depth.empty(), "--glider",
          "needs pitch, ballast and depth");
  require(!columns.sinking.empty() || !columns.speed.empty(), "--glider",
          "needs sinking (the vertical speed) or speed (through the water)");
  require(columns.turn.empty() || (!columns.roll.empty() && !columns.sinking.empty()), "--glider",
          "turn needs roll and sinking");
  return columns;
}

std::vector<std::string> columns_of(const GliderColumns& columns) {
  std::vector<std::string> names;
  for (const auto& [name, member] : kNames) {
    const std::string& column = columns.*member;
    if (member != &GliderColumns::time && !column.empty() &&
        std::ranges::find(names, column) == names.end()) {
      names.push_back(column);
    }
  }
  return names;
}

HealthTable judge_gliders(const std::vector<GliderLog>& logs, const GliderColumns& columns,
                          std::vector<log::Table>* glides) {
  std::vector<GliderRows> rows;
  std::vector<GlideRows> all;
  std::vector<HalfFit> halves;
  for (const GliderLog& log : logs) {
    rows.push_back(rows_of(log.table, columns));
    all.push_back(rows.back().glide);
    halves.push_back(fit_half(all.back(), columns));
  }
  const GlideFit common = in_file(logs.front().table.source, [&] {
    return fit_glide(all, first_glide(), common_places(columns));
  });
  HealthTable table{.quantities = quantities_of(columns), .episodes = {}, .estimates = {}};
  const TrimPlane plane = trim_plane(rows);
  for (std::size_t i = 0; i < logs.size(); ++i) {
    const std::vector<double>& times = rows[i].glide.times_s;
    std::size_t number = 0;
    for (const auto& [begin, end] : find_dives(rows[i].glide.depth_m)) {
      table.episodes.push_back(
          {.mission = logs[i].mission,
           .name = fmt::format("{}, dive {}", logs[i].mission, ++number),
           .day = logs[i].day + 0.5 * (times[begin] + times[end - 1]) / kSecondsPerDay,
           .hours = (times[end - 1] - times[begin]) / kSecondsPerHour});
      table.estimates.push_back(dive_estimates(rows[i], begin, end, common, columns, plane));
    }
  }
  if (table.episodes.empty()) {
    throw InputError({.file = logs.front().table.source, .line = 0, .field = columns.depth},
                     "shows no dive");
  }
  table.remarks.push_back(
      fmt::format("lag of the speeds {:.0f} s, drag {:.0f} ml s²/m², {:.2g} of the lift's slope",
                  common.parameters[GlidePlace::lag], common.parameters[GlidePlace::drag],
                  common.parameters[GlidePlace::attack]));
  remark_on_scores(logs, rows, halves, columns, table);
  for (std::size_t i = 0; glides != nullptr && i < logs.size(); ++i) {
    glides->push_back(glide_table(logs[i], rows[i], halves[i]));
  }
  return table;
}

}  // namespace kelpie::health
