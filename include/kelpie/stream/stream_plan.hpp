// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "kelpie/motion/frame.hpp"
#include "kelpie/stream/signal_history.hpp"

namespace kelpie {

/// Position of the window of a derivative.
enum class FilterWindow {
  centred,  ///< around the time of the row; available half a window later
  causal,   ///< before the time of the row
};

/// The slope of a polynomial fitted to a window of samples by least squares: the filter of Savitzky
/// and Golay (Anal. Chem. 36, 1964), here for stamps of any spacing.
struct DerivativeSettings {
  FilterWindow window = FilterWindow::centred;
  double window_s = 0.5;  ///< width of the window [s], > 0
  int degree = 2;         ///< of the polynomial, 1 to 4

  double back_s() const;   ///< Extent of the window into the past [s].
  double ahead_s() const;  ///< Extent of the window into the future [s].
  void validate() const;   ///< Throws InputError naming the field.
};

/// Effect of the filter on a slowly changing acceleration and on noise.
struct DerivativeInfo {
  std::size_t points = 0;   ///< samples in the window
  double delay_s = 0.0;     ///< of a steadily changing acceleration: −½ Σ wᵢ (tᵢ − t)²
  double noise_gain = 0.0;  ///< σ of the result per σ of white noise on the samples [1/s]: ‖w‖
};

/// For a signal with a sample every `period_s` seconds, at the time of a sample. Throws InputError
/// for a window with too few samples. Allocates.
DerivativeInfo derivative_info(double period_s, const DerivativeSettings& settings);

/// Plan for rows at one common rate from signals with stamps of their own.
struct StreamPlan {
  static constexpr std::size_t kUsualKeep = 1024;  ///< samples: two seconds of 500 Hz

  /// An input signal of the stream.
  struct Source {
    std::string name;
    std::string from{};  ///< "/odom:twist.twist.linear.x" in a bag, a column in a table
    Interpolation between = Interpolation::line;
    std::optional<double> lag_s = 0.0;  ///< delay of the stamps [s]; empty: to be estimated
    std::size_t keep = kUsualKeep;      ///< number of stored samples
    /// A sample is about + scale (value − about): another unit (scale), or a mirror (scale −1).
    double scale = 1.0;
    double about = 0.0;
  };
  /// A time derivative.
  struct Derived {
    std::string name;
    std::string of;  ///< name of a source
  };
  /// Three signals as the components of a vector.
  struct Vector {
    std::array<std::string, 3> columns;
    Frame from = Frame::flu;
    Frame to = Frame::flu;
    /// Sources of the vehicle's attitude in the world frame `from`: roll, pitch, yaw, or a
    /// quaternion w, x, y, z; empty between frames of one kind.
    std::vector<std::string> attitude{};
    bool is_in_degrees = false;  ///< the angles; otherwise [rad]
  };
  /// Position of the velocity sensor relative to the point whose velocity is wanted.
  struct LeverArm {
    std::array<std::string, 3> velocity;
    std::array<std::string, 3> rates;
    Triple arm_m{};
  };
  /// Measured poses in place of velocities. A row holds the means of all signals over a window of
  /// ± half_s, and with the same weights w the velocities and accelerations of the body in the weak
  /// form (Shinbrot 1957), which differentiates no measurement:
  ///
  ///     u = ∫ w Rᵀ dp,    u̇ = −∫ ẇ Rᵀ dp,    w(s) ∝ (1 − s²)³ (3 − 11 s²),  s = (τ − t) / half_s
  ///
  /// w is a kernel of order four (Gasser, Müller & Mammitzsch 1985): motion up to the third power
  /// of time passes unchanged. A linear equation of motion holds for the means without bias.
  struct Pose {
    /// Sources of x, y and z along right-handed axes of the world; "": not measured.
    std::array<std::string, 3> position{};
    /// Sources of roll, pitch and yaw [rad] in the order of Vector::attitude, "" where not
    /// measured; a quaternion w, x, y, z; or empty.
    std::vector<std::string> attitude{};
    double half_s = 0.0;          ///< half of the window; 0: to be found in a log
    bool has_tilt_rates = false;  ///< p and q among the columns

    static constexpr std::array<const char*, 6> kVelocities{"u", "v", "w", "p", "q", "r"};

    /// Measured axes, as places in kVelocities: u and v of x, y and yaw, w of z, r of yaw.
    std::vector<std::size_t> axes() const;
    /// Columns in the order of a table: velocities, phi, theta and psi of a quaternion, and
    /// accelerations ("udot").
    std::vector<std::string> columns() const;
    std::vector<std::string> accelerations() const;  ///< The last of columns().
    std::vector<std::string> sources() const;        ///< Names of measured sources.
  };

  std::vector<Source> sources;
  std::vector<Derived> derived;
  std::vector<Vector> vectors;        ///< step 1: conversion to another frame
  std::optional<LeverArm> lever_arm;  ///< step 2: removal of the lever arm
  std::optional<Pose> pose;           ///< step 3: velocities and accelerations from poses
  std::vector<std::string> inputs;    ///< of a row: names of sources, derivatives, pose columns
  std::vector<std::string> targets;   ///< of a row, likewise
  DerivativeSettings derivative;
  double rate_hz = 0.0;
  double gap_s = 1.0;   ///< longest silence that is interpolated
  double wait_s = 0.2;  ///< greatest delay of a message after another with the same stamp

  /// The place of a source. Throws InputError (name) with the most similar name.
  std::size_t source(const std::string& name) const;

  /// Throws InputError (name) on a rate, gap, wait or filter out of range, a duplicate name, and
  /// unknown sources of a derivative, vector, lever arm, pose, input or target, a pose without a
  /// measured axis, x or y without the other or without a yaw, derivatives beside a pose.
  void validate() const;
};

}  // namespace kelpie
