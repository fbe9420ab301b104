// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "lab/contenders.hpp"
#include "log/dataset.hpp"
#include "study/split.hpp"

namespace kelpie::lab {

/// The rows of the published experiment of Tesnar, Wehbe & Valdenegro-Toro 2025 (arXiv:2504.04583)
/// on the log of AUV Dagon: the first row is dropped; every fifth of the remaining rows, from the
/// second on, is for testing; every fourth of the rest, from the second on, for validation; the
/// stream is the remainder in the order of time.
struct PublishedRows {
  std::vector<std::size_t> stream;  ///< the first kPublishedBuffer rows fill the buffer
  std::vector<std::size_t> validation;
  std::vector<std::size_t> test;
};

inline constexpr std::size_t kPublishedBuffer = 100;
inline constexpr std::size_t kPublishedLogRows = 11'567;

/// Requires rows > kPublishedBuffer. The rule leaves 6,940 rows to the stream; the published run
/// ends a row earlier (6,839 steps after the first 100), and so does ours.
PublishedRows published_rows(std::size_t rows);

/// A learner on the stream. R² is the mean over the axes, on the test rows.
struct PublishedRun {
  std::string name;
  std::string settings;
  std::vector<std::size_t> steps{};  ///< after the initial buffer, at every look
  std::vector<double> r2{};
  double mean = 0.0;
  double minimum = 0.0;
  double end = 0.0;
  double mean_late = 0.0;  ///< from step 1,000 on; NaN without such steps
  double minimum_late = 0.0;
};

/// Published results, read off the curves.
struct PublishedFigure {
  const char* name;
  double mean;
};
inline constexpr std::array<PublishedFigure, 5> kPublished{{{"FIFO", 0.081},
                                                            {"first in, random out", 0.367},
                                                            {"random in, random out", 0.527},
                                                            {"greedy", 0.632},
                                                            {"threshold", 0.606}}};
/// The published "threshold" from step 1,000 on, and the published off-line model.
inline constexpr double kPublishedLateMean = 0.717;
inline constexpr double kPublishedLateMinimum = 0.506;
inline constexpr double kPublishedEnd = 0.641;
inline constexpr double kPublishedOffline = 0.97;

/// Learners with a buffer of 100, scaled by the first 100 samples: the proposed learner with the
/// best of 90 random settings on the validation rows; FIFO with the same settings, and with the
/// best of the 90 for FIFO; the default preset.
std::vector<Contender> published_contenders(std::size_t axes);

/// Shows `stream` to a learner per axis and scores on `judged` after every `every`-th step.
/// `keep_going` as in StreamOptions.
PublishedRun run_published(const log::Dataset& data, const std::vector<std::size_t>& stream,
                           const std::vector<std::size_t>& judged, const Contender& contender,
                           std::size_t every, const std::function<bool(std::size_t)>& keep_going);

/// The opponents' streams: planar, simulated, 1 Hz, a switch half-way; target du alone.
/// `unmodelled`: effects outside textbook regressors. `outliers`: textbook physics, 2 % of the
/// training targets off by 3 to 8 standard deviations. `both`: both.
inline constexpr std::array<std::string_view, 3> kPeerStreams{"unmodelled", "outliers", "both"};

/// Moments of the scores, on held-out rows of the running configuration: a number of samples, the
/// end of configuration 0, a number of samples after the switch, the end.
inline constexpr std::array<std::string_view, 6> kPeerMarks{"1,000",  "end of 0", "switch +500",
                                                            "+1,000", "+2,000",   "end of 1"};

/// A learner on an opponents' stream.
struct PeerRun {
  std::string stream;
  std::string learner;
  std::array<double, kPeerMarks.size()> r2{};  ///< at kPeerMarks
  double median_us = 0.0;                      ///< time of an update, with other jobs in parallel
  double p99_us = 0.0;
};

/// Reads a stream's file (columns conf, split, u, v, r, n1, n2, n3, du) and runs a learner on the
/// training rows (split 0), scaled by the training rows of configuration 0. Throws InputError as
/// log::read_log and make_dataset do, and on rows unlike such a stream.
PeerRun run_peer(const std::filesystem::path& file, const Contender& contender,
                 const std::function<bool(std::size_t)>& keep_going);

}  // namespace kelpie::lab
