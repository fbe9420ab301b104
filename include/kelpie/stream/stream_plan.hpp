// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "kelpie/motion/frame.hpp"
#include "kelpie/stream/derivative.hpp"
#include "kelpie/stream/signal_history.hpp"

namespace kelpie {

/// How rows at one common rate are made of signals with stamps of their own.
struct StreamPlan {
  static constexpr std::size_t kUsualKeep = 1024;  ///< samples: two seconds of 500 Hz

  /// A signal that is shown.
  struct Source {
    std::string name;
    std::string from{};  ///< "/odom:twist.twist.linear.x" in a bag, a column in a table
    Between between = Between::line;
    std::optional<double> lag_s = 0.0;  ///< how late its stamps are [s]; none: to be estimated
    std::size_t keep = kUsualKeep;      ///< the last samples that are kept
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
    /// Sources of the vehicle's attitude in the world `from`: roll, pitch, yaw, or a quaternion w,
    /// x, y, z; between frames of one kind none.
    std::vector<std::string> attitude{};
    bool is_in_degrees = false;  ///< its angles; else rad
  };
  /// Where the velocity is measured, seen from where it is wanted.
  struct LeverArm {
    std::array<std::string, 3> velocity;
    std::array<std::string, 3> rates;
    Triple arm_m{};
  };

  std::vector<Source> sources;
  std::vector<Derived> derived;
  std::vector<Vector> vectors;        ///< brought into another frame, first of all
  std::optional<LeverArm> lever_arm;  ///< taken out then
  std::vector<std::string> inputs;    ///< of a row: names of sources or derived
  std::vector<std::string> targets;   ///< The same.
  DerivativeSettings derivative;
  double rate_hz = 0.0;
  double gap_s = 1.0;   ///< nothing bridges a longer silence
  double wait_s = 0.2;  ///< messages come at most so much later than others with their stamp

  /// The place among the sources. Throws InputError (name) with the nearest that is one.
  std::size_t source(const std::string& name) const;

  /// Throws InputError (name) on a rate, gap, wait or filter out of range, a name used twice, a
  /// derived column, vector or lever arm of unknown sources, inputs or targets that are neither.
  void validate() const;
};

}  // namespace kelpie
