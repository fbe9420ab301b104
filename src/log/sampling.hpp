// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "kelpie/physics/frame.hpp"
#include "log/dataset.hpp"
#include "log/derivative.hpp"
#include "log/lag.hpp"
#include "log/signal.hpp"

namespace kelpie::log {

/// What a table at one common rate is made of.
struct SamplingPlan {
  /// A signal that is in the log.
  struct Source {
    std::string name;
    std::string from;  ///< "/odom:twist.twist.linear.x" in a bag, a column in a table
    Between between = Between::line;
    std::optional<double> lag_s = 0.0;  ///< how late its stamps are [s]; none: to be estimated
  };
  /// A derivative by time.
  struct Derived {
    std::string name;
    std::string of;  ///< the source it is the derivative of
  };
  /// Three signals that are one vector.
  struct Vector {
    std::array<std::string, 3> columns;
    Frame from = Frame::flu;
    Frame to = Frame::flu;
  };
  /// Where the velocity is measured, seen from where it is wanted.
  struct LeverArm {
    std::array<std::string, 3> velocity;
    std::array<std::string, 3> rates;
    Triple arm_m{};
  };

  std::vector<Source> sources;
  std::vector<Derived> derived;
  std::vector<Vector> vectors;         ///< brought into another frame, first of all
  std::optional<LeverArm> lever_arm;   ///< taken out then
  std::vector<std::string> responses;  ///< sources or derived that lags are estimated from
  DerivativeSettings derivative;
  double rate_hz = 0.0;
  double gap_s = 1.0;           ///< nothing bridges a longer silence
  double lag_part = 0.5;        ///< lags are estimated from this first share of the rows …
  std::size_t lag_rows = 1600;  ///< … but no more than so many

  /// Throws InputError (name) on a rate, gap or filter out of range, a name used twice, a derived
  /// column, vector or lever arm of unknown sources.
  void validate() const;
};

/// What was done to the signals.
struct SamplingReport {
  /// What was found in a signal, and done to it.
  struct OfSource {
    std::string name;
    std::string from;
    double rate_hz = 0.0;
    SignalFaults faults;
    double lag_s = 0.0;
    std::string lag_origin;  ///< "", "given", "estimated", "estimated, common"
  };
  /// What a derivative was taken with.
  struct OfDerived {
    std::string name;
    DerivativeInfo info;  ///< at the source's median step
  };
  std::vector<OfSource> sources;
  std::vector<OfDerived> derived;
  std::optional<LagResult> lags;
  double lag_until_s = 0.0;  ///< end of the rows that lags were estimated from
  std::size_t rows = 0;
  std::size_t whole_rows = 0;  ///< with a value in every column
  std::size_t segments = 0;    ///< stretches of whole rows
};

/// A log at one common rate.
struct Samples {
  Table table;  ///< columns t [s], sources, derived; NaN where something is silent
  SamplingReport report;
};

/// Puts signals on one grid of times, multiples of 1/rate, as far as all of them reach, but where
/// all are silent for longer than the gap: frames, lever arm, lags, lines or holds, derivatives.
/// `signals` are those of plan.sources, in their order, in seconds of one clock; `source` is what
/// messages call the log. Throws InputError (source, then name, topic or field): what validate()
/// refuses, what tidy() and estimate_lags() refuse, signals that never overlap in time, a state
/// whose samples are all farther apart than the gap, components of a vector that come in different
/// messages, too few samples in the window of a derivative, more than 1000 rows per sample.
Samples sample(const SamplingPlan& plan, std::vector<Signal> signals, const std::string& source);

}  // namespace kelpie::log
