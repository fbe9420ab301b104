// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "file/toml.hpp"
#include "kelpie/model/settings.hpp"
#include "kelpie/motion/unit.hpp"
#include "kelpie/stream/stream_plan.hpp"
#include "log/dataset.hpp"
#include "log/read_log.hpp"

namespace kelpie::live {

/// A host and a port.
struct Endpoint {
  std::string host;
  std::uint16_t port = 0;

  bool operator==(const Endpoint&) const = default;
};

/// Reads "9870", a port of this machine, or "10.0.0.2:9870". Throws InputError (field) on other
/// texts.
Endpoint parse_endpoint(const std::string& text, const std::string& field);

/// Treatment of rows with a stuck velocity: constant for longer than `log.gap`.
enum class Frozen : std::uint8_t { skip, learn };

/// The table [live.parameters]: what to tell of the vehicle's parameters while it drives, as by
/// `kelpie plan`.
struct ParameterSettings {
  std::vector<std::string> tell{};       ///< study::wanted_places()
  double percent = 5.0;                  ///< wanted half width of the 90 % intervals
  std::vector<std::string> thrusters{};  ///< inputs that are thrusters; empty: by their names
  std::vector<std::pair<std::string, double>>
      thrust{};  ///< N per square of the unit; empty: ratios
};

/// The table [live] of a configuration file (docs/howto/live.md).
struct LiveSettings {
  std::string out = "out/live";  ///< folder of checkpoint and model
  double checkpoint_s = 10.0;    ///< between two checkpoints [s]; a crash loses at most this
  std::string align = "auto";    ///< alignment: auto, none, or a lag [s]
  Frozen frozen = Frozen::skip;  ///< treatment of stuck velocities
  std::string record{};          ///< folder for recordings (MCAP); empty: none
  std::string nominal{};         ///< model.json known beforehand; empty: nothing is known
  std::string heading{};         ///< signal of a measured heading [rad]; empty: none
  std::string block{};           ///< file of `kelpie export --live` to renew; empty: none
  std::string plotjuggler{};     ///< parse_endpoint; empty: none
  std::string page{};            ///< parse_endpoint, to listen on; empty: no page
  std::string token{};           ///< access token of the page; empty: not given
  double status_s = 60.0;        ///< between two status lines [s]
  /// Columns that tell whether their topic's velocities are valid: at this value and above.
  std::map<std::string, double> valid{};
  std::optional<ParameterSettings> parameters{};  ///< none: parameters are not identified
  std::optional<file::TomlNode> dds{};            ///< [live.dds], read by the room `ros`
  std::optional<file::TomlNode> mavlink{};        ///< [live.mavlink], read by `autopilot`
};

/// Rows that follow the rows of a table, made while the table is replayed.
struct FurtherRows {
  double end_s = 0.0;                                 ///< time of the last one
  std::function<std::optional<log::Dataset>()> next;  ///< some more; none at the end
};

/// Names and values.
using Fields = std::vector<std::pair<std::string, std::string>>;

/// Content of a configuration file: messages and samples, the learner's settings, outputs.
struct Configuration {
  std::string file;
  log::LogConfig log;
  StreamPlan plan;  ///< valid, with sources from topics
  ModelSettings settings;
  LiveSettings live;
  std::shared_ptr<const log::Dataset> rows{};  ///< of a table to be replayed; null: messages
  std::shared_ptr<FurtherRows> further{};      ///< null: none

  /// Everything besides the settings that a checkpoint must match to be resumed. Keys as in the
  /// file ("log.rate").
  Fields identity() const;
  /// Units of columns, as `kelpie learn` has them of the same rows.
  std::map<std::string, Unit> units() const;
  /// Topics and fields of the sources and of LiveSettings::valid, without repeats.
  std::vector<std::string> columns() const;
};

/// Reads a file; `set` (key=value) overrides settings. Throws InputError (file, line, key) as
/// log::read_log_config, log::stream_plan and format::make_settings do, on an invalid table [live],
/// and where [log] names no topics.
Configuration read_configuration(const std::filesystem::path& file,
                                 const std::vector<std::string>& set);

/// The same of a text that was read; messages call the text `name`.
Configuration read_configuration(const file::TomlNode& root, const std::string& name,
                                 const std::vector<std::string>& set);

/// The configuration that is drafted for a recording (log::draft_of), and what was taken, in
/// `summary`. Throws as read_configuration() does, and InputError (file) on a draft that leaves
/// points open.
Configuration draft_configuration(const log::LogSource& source, const std::vector<std::string>& set,
                                  std::string& summary);

/// The configuration for replaying the rows of a table: inputs, targets and rate are those of the
/// rows; settings and [live] come from `file`, where one is given. Throws as read_configuration()
/// does.
Configuration rows_configuration(log::Dataset rows, const std::filesystem::path& file,
                                 const std::vector<std::string>& set);

}  // namespace kelpie::live
