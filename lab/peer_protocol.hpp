// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lab/contenders.hpp"

namespace kelpie::lab {

/// The opponents' streams: planar, simulated, 1 Hz, a switch half-way; target du alone.
/// `unmodelled`: effects that no textbook regressor holds. `outliers`: textbook physics, 2 % of the
/// training targets off by 3 to 8 standard deviations. `both`: both.
inline constexpr std::array<std::string_view, 3> kPeerStreams{"unmodelled", "outliers", "both"};

/// When the learners are judged, on the held-out rows of the configuration then running: after so
/// many samples, at the end of configuration 0, so many samples after the switch, at the end.
inline constexpr std::array<std::string_view, 6> kPeerMarks{"1,000",  "end of 0", "switch +500",
                                                            "+1,000", "+2,000",   "end of 1"};

/// One learner on one of the opponents' streams.
struct PeerRun {
  std::string stream;
  std::string learner;
  std::array<double, kPeerMarks.size()> r2{};  ///< at kPeerMarks
  double median_us = 0.0;                      ///< time of an update; others may run beside it
  double p99_us = 0.0;
};

/// A line of the table measured for the project before: R² as text, "" where not measured.
struct PeerFigure {
  std::string_view learner;
  std::string_view update_us;
  std::array<std::string_view, 5> unmodelled;  ///< 1,000, end of 0, +500, +1,000, end of 1
  std::array<std::string_view, 3> outliers;    ///< end of 0, +1,000, end of 1
};
std::span<const PeerFigure> peer_figures();  ///< All lines of that table.

/// Reads a stream's file (columns conf, split, u, v, r, n1, n2, n3, du) and runs one learner on it:
/// inputs and target scaled by the training rows (split 0) of configuration 0, those of both
/// configurations shown in order. Throws InputError as log::read_log and make_dataset do, and when
/// the rows are not those of such a stream.
PeerRun run_peer(const std::filesystem::path& file, const Contender& contender,
                 const std::function<bool(std::size_t)>& keep_going);

}  // namespace kelpie::lab
