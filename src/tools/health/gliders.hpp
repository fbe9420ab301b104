// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "health/episode.hpp"
#include "log/dataset.hpp"

namespace kelpie::health {

/// Columns of a glider's logs; empty: not logged.
struct GliderColumns {
  std::string time{};     ///< s
  std::string pitch{};    ///< rad, nose up positive
  std::string ballast{};  ///< ml, or cm³
  std::string depth{};    ///< m
  std::string density{};  ///< of the water, kg/m³
  std::string sinking{};  ///< vertical speed, down positive, m/s
  std::string speed{};    ///< through the water, m/s
  std::string mass{};     ///< place of the mass that shifts along the hull
  std::string roll{};     ///< rad
  std::string turn{};     ///< yaw rate, rad/s
};

/// Reads NAME=COLUMN pairs with the names of GliderColumns. Throws InputError (`--glider`) on other
/// text, and without pitch, ballast, depth, and one of sinking and speed.
GliderColumns glider_columns(const std::vector<std::string>& pairs);

/// The columns that are named, without the time.
std::vector<std::string> columns_of(const GliderColumns& columns);

/// A glider's log, and the day of the time 0.
struct GliderLog {
  log::Table table;
  std::string mission;
  double day = 0.0;
};

/// Judges every dive. All parameters of fit_glide() are fitted to all logs together, then buoyancy,
/// its growth with depth, and drag to each dive; besides, the pitch less what mass and
/// ballast make, and the turn rate over roll times sinking. The remarks tell R² of the vertical
/// speed and the root mean square error of the speed: on the second half of each log after learning
/// the first, and of each log after the first dive, by the other logs' parameters adapted to that
/// dive. Rows without finite pitch, ballast and depth are left out. `glides`, where given, gets
/// each log's other rows with all columns and three more, for `kelpie learn`, which learns the
/// rest: glide_sinking and glide_speed, by the glider that the first half of the log tells, and
/// second_half, 1 in the rows of the second half. Throws InputError naming the log.
HealthTable judge_gliders(const std::vector<GliderLog>& logs, const GliderColumns& columns,
                          std::vector<log::Table>* glides = nullptr);

}  // namespace kelpie::health
