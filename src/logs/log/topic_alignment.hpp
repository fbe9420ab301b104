// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "kelpie/stream/signal_history.hpp"

namespace kelpie::log {

/// How far topics lag behind the accelerations they go with. With a lag of 0.2 s, what is stamped
/// t + 0.2 s belongs to the acceleration at t. Negative: it comes before (commands, ahead of their
/// rotors).
struct TopicAlignmentProblem {
  /// Signals of one topic.
  struct Group {
    std::string topic;
    std::vector<const SignalHistory*> signals;  ///< with all samples, lag 0
    Interpolation between = Interpolation::hold;
  };

  std::vector<Group> groups;                    ///< their lags are asked for
  std::vector<double> times_s;                  ///< rows used
  std::vector<std::vector<double>> responses;   ///< [target][row]: accelerations; NaN: left out
  std::vector<std::vector<double>> background;  ///< [state][row]: velocities; NaN: left out
  double step_s = 0.05;                         ///< of the search
};

/// How late one topic was found to be.
struct TopicLag {
  std::string topic;
  double lag_s = 0.0;
  bool is_own = false;  ///< false: the common lag, for its own explained hardly more
};

/// The lags of all topics, and what they explain.
struct TopicAlignment {
  static constexpr double kFarthest = 1.0;  ///< lags are looked for in ± this [s]
  static constexpr double kOwnRange = 0.3;  ///< … and a topic's own within this of the common one
  static constexpr double kOwnGain = 0.2;   ///< share of what is unexplained that it has to explain
  std::vector<TopicLag> topics;
  std::size_t rows = 0;            ///< that have all values over the whole range of lags
  double explained_at_zero = 0.0;  ///< share of the accelerations' variance, mean over targets
  double explained = 0.0;          ///< the same with the lags found
};

/// Cross-correlation of thrust and acceleration with the drag taken out: accelerations are fitted
/// by 1, v, v|v| and vᵢvⱼ of the states and by n|n| of the topics' signals, shifted by a lag, and
/// the lag that explains most is taken: one for all, then one topic after the other, kept as its
/// own where it adds kOwnGain. (Plain correlation is drawn to wrong lags, for the drag answers the
/// thrust that was.) Interpolates between the steps of the search by a parabola.
/// Throws InputError when fewer than ten rows per coefficient are left, or when the best lag lies
/// at the end of the range.
/// Cost: (topics + 1) × 2 kFarthest / step_s fits.
TopicAlignment align_topics(const TopicAlignmentProblem& problem);

}  // namespace kelpie::log
