// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "file/toml.hpp"
#include "kelpie/model/settings.hpp"
#include "kelpie/stream/stream_plan.hpp"
#include "log/log_config.hpp"

namespace kelpie::live {

/// A host and a port to send to.
struct Endpoint {
  std::string host;
  std::uint16_t port = 0;

  bool operator==(const Endpoint&) const = default;
};

/// "9870" is a port of this machine, "10.0.0.2:9870" one of another.
/// Throws InputError (field) on anything else.
Endpoint parse_endpoint(const std::string& text, const std::string& field);

/// What is done with velocities whose value doesn't change for longer than `log.gap`.
enum class Frozen : std::uint8_t { skip, learn };

/// The table [live] of a configuration file (docs/live.md).
struct LiveSettings {
  std::string out = "out/live";         ///< folder of checkpoint and model
  double checkpoint_s = 10.0;           ///< time between two checkpoints [s]: so much may be lost
  std::string align = "auto";           ///< how commands are shifted: auto, none, or seconds
  Frozen frozen = Frozen::skip;         ///< of velocities
  std::string record{};                 ///< folder for recordings (MCAP); empty: none
  std::string plotjuggler{};            ///< parse_endpoint; empty: none
  std::string page{};                   ///< parse_endpoint, to listen on; empty: no page
  std::string token{};                  ///< that who looks at the page needs; empty: none is given
  double status_s = 60.0;               ///< time between two lines of status [s]
  std::optional<file::TomlNode> dds{};  ///< the table [live.dds], which the room `ros` reads
  std::optional<file::TomlNode> mavlink{};  ///< [live.mavlink], which the room `autopilot` reads
};

/// Names and values.
using Fields = std::vector<std::pair<std::string, std::string>>;

/// All that a configuration file says: which messages become which samples, how they are learned,
/// and what comes of it.
struct Configuration {
  std::string file;
  log::LogConfig log;
  StreamPlan plan;  ///< valid; its sources come from topics
  ModelSettings settings;
  LiveSettings live;

  /// What makes a model this one, besides its settings: only under the same can a checkpoint be
  /// gone on with. Keys as in the file ("log.rate").
  Fields identity() const;
  std::vector<std::string> columns() const;  ///< Topics and fields of the sources, each once.
};

/// Reads a file; `set` are key=value over its settings. Throws InputError (file, line, key) as
/// log::read_log_config, log::stream_plan and format::make_settings do, on a table [live] that
/// can't be, and where [log] names no topics.
Configuration read_configuration(const std::filesystem::path& file,
                                 const std::vector<std::string>& set);

}  // namespace kelpie::live
