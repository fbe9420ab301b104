// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "health/course.hpp"
#include "health/episode.hpp"

namespace kelpie::health {

/// A day from which changes count: the deployment, the last cleaning.
struct Baseline {
  std::string name;
  double day = 0.0;  ///< as Episode::day
};

/// What became of a quantity since a baseline.
struct Change {
  std::size_t quantity = 0;  ///< of HealthTable::quantities
  std::size_t baseline = 0;  ///< of HealthCard::baselines
  Course course;
};

/// The health of one vehicle over many dives.
struct HealthCard {
  std::string vehicle;
  bool is_dated = false;  ///< days are since 1970; else since the first row of the first log
  HealthTable table;      ///< episodes in the order of time
  std::vector<Baseline> baselines;  ///< the first: all episodes
  std::vector<Change> changes;      ///< by quantity, then by baseline
};

/// Judges every quantity since the first episode ("deployment") and since each given baseline.
/// Sorts the episodes by day.
HealthCard make_card(std::string vehicle, bool is_dated, HealthTable table,
                     const std::vector<Baseline>& baselines);

/// The estimates of a quantity from the episodes that tell the quantity.
Series series_of(const HealthTable& table, std::size_t quantity);

/// Whether a change is significant.
bool is_found(const Course& course);

/// "3 March 2026", or the name of the episode at this day.
std::string day_text(const HealthCard& card, double day);

/// Two significant digits of the error, as many places of the value, and a true minus sign:
/// "−2.44".
std::string rounded(double value, double error);

/// A size with its 90 % interval: "+11 % ± 4 %" of a factor, else "+0.02 ± 0.01 m/s²".
std::string change_size(const HealthCard& card, const Change& change);

/// "surge drag +11 % ± 4 % since 3 March 2026, 0.4 % a day"; of a constant: "surge drag: no change
/// (+1 % ± 2 %)".
std::string change_text(const HealthCard& card, const Change& change);

/// Days since 1970 of a date "2026-03-03", or with a time, "2026-03-03T12:30". Throws InputError
/// (`field`) on other text.
double day_of(const std::string& date, const std::string& field);

/// The date in a file's name (2026-03-03, 2026_03_03, 20260303, perhaps with the time of the day
/// behind), in days since 1970; NaN without one.
double day_in_name(const std::string& name);

}  // namespace kelpie::health
