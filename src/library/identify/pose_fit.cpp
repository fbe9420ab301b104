// SPDX-License-Identifier: Apache-2.0
#include "identify/pose_fit.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <span>

#include "core/angle.hpp"
#include "core/eigen.hpp"
#include "core/normal_equations.hpp"
#include "identify/output_error.hpp"
#include "identify/planar_estimate.hpp"
#include "identify/tuning.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/setting.hpp"

namespace kelpie {
namespace {

using Eigen::Index;
using Places = std::vector<Index>;

constexpr double kMeasured = 1.0;
constexpr Index kCoupling = PlanarPlace::sway_yaw_inertia;

// Pieces of the rows, and the first row of each.
struct PathCut {
  std::vector<PathPiece> pieces{};
  std::vector<std::size_t> first{};
};

PathPiece piece_of(const PoseRows& rows, const Eigen::VectorXd& greatest, std::size_t begin,
                   std::size_t end) {
  const auto count = static_cast<Index>(end - begin);
  const auto thrusters = static_cast<Index>(rows.thrusters.size());
  const auto first = static_cast<Index>(begin);
  PathPiece piece{
      .times_s = as_vector(rows.times_s).segment(first, count),
      .poses = columns_of(rows.poses, 3).middleCols(first, count),
      .speeds = columns_of(rows.speeds, rows.thrusters.size()).middleCols(first, count)};
  for (Index i = 0; i < thrusters; ++i) {
    piece.speeds.row(i) /= greatest(i);
  }
  return piece;
}

// The first row of each stretch without a gap or a hole in the headings, in which full turns are
// lost; then the number of rows.
std::vector<std::size_t> starts_with_holes(const PoseRows& rows) {
  std::vector<std::size_t> starts = rows.starts;
  double last_s = std::numeric_limits<double>::infinity();
  for (std::size_t row = 0; row < rows.times_s.size(); ++row) {
    if (std::isfinite(rows.poses[3 * row + 2])) {
      if (rows.times_s[row] - last_s > kPath.longest_hole_s) {
        starts.push_back(row);
      }
      last_s = rows.times_s[row];
    }
  }
  starts.push_back(rows.times_s.size());
  std::ranges::sort(starts);
  return starts;
}

// Stretches in equal parts of about this length.
PathCut cut(const PoseRows& rows, const Eigen::VectorXd& greatest, double length_s) {
  PathCut found;
  const std::vector<std::size_t> starts = starts_with_holes(rows);
  for (std::size_t stretch = 0; stretch + 1 < starts.size(); ++stretch) {
    const std::size_t begin = starts[stretch];
    const std::size_t end = starts[stretch + 1];
    if (end < begin + 2 || rows.times_s[end - 1] - rows.times_s[begin] < kPath.least_stretch_s) {
      continue;
    }
    const double duration_s = rows.times_s[end - 1] - rows.times_s[begin];
    const auto parts = static_cast<std::size_t>(std::max(1.0, std::round(duration_s / length_s)));
    for (std::size_t part = 0; part < parts; ++part) {
      const std::size_t from = begin + part * (end - begin) / parts;
      const std::size_t to = begin + (part + 1) * (end - begin) / parts;
      found.pieces.push_back(piece_of(rows, greatest, from, to));
      found.first.push_back(from);
    }
  }
  return found;
}

// At rest, where the pose of a piece is first measured.
std::vector<PoseState> starts_at_rest(const std::vector<PathPiece>& pieces) {
  std::vector<PoseState> starts;
  for (const PathPiece& piece : pieces) {
    PoseState& start = starts.emplace_back(PoseState::Zero());
    for (Index part = 0; part < 3; ++part) {
      const auto values = piece.poses.row(part);
      const auto measured = std::find_if(values.begin(), values.end(),
                                         [](double value) { return std::isfinite(value); });
      start(part) = measured != values.end() ? *measured : 0.0;
    }
  }
  return starts;
}

// The starts of other pieces of the same rows, from the paths of the estimate.
std::vector<PoseState> starts_along(const PathCut& from, const PathEstimate& estimate,
                                    const PathCut& to) {
  std::vector<PoseState> starts = starts_at_rest(to.pieces);
  std::size_t next = 0;
  for (std::size_t i = 0; i < from.pieces.size(); ++i) {
    const PathStates path = drive_piece(from.pieces[i], estimate.parameters, estimate.starts[i],
                                        estimate.between, {}, false);
    const auto end = from.first[i] + static_cast<std::size_t>(path.states.cols());
    for (; next < to.first.size() && to.first[next] < end; ++next) {
      starts[next] = path.states.col(static_cast<Index>(to.first[next] - from.first[i]));
      // Headings of a piece count from the heading measured first there.
      const double measured = starts_at_rest({to.pieces[next]}).front()(2);
      starts[next](2) = measured + wrapped(starts[next](2) - measured);
    }
  }
  return starts;
}

// The first estimate of a vehicle, stage by stage.
class PathStart {
 public:
  PathStart(const std::vector<PathPiece>& pieces, const Places& ratios)
      : pieces_(pieces), ratios_(ratios), thrusters_(pieces.front().speeds.rows()) {
    estimate_.parameters = Eigen::VectorXd::Zero(PathPlace::count(thrusters_));
    estimate_.parameters(PlanarPlace::surge_inertia) = 1.0;
    estimate_.parameters(PlanarPlace::yaw_inertia) = 1.0;
    for (Index i = 0; i < thrusters_; ++i) {
      estimate_.parameters(PathPlace::thruster(i) + PathPlace::ratio) = 1.0;
    }
    estimate_.starts = starts_at_rest(pieces);
  }

  PathEstimate run() {
    constexpr double kNone = kNotCounted;
    const Index linear = PlanarPlace::linear_drag;
    const Index constant = PlanarPlace::constant_force;
    Places yaw = of_thrusters({PathPlace::moment});
    yaw.push_back(constant + 2);
    try_time_constants(yaw, {linear + 2}, {kNone, kNone, kMeasured});
    yaw.insert(yaw.end(), {linear + 2, static_cast<Index>(PlanarPlace::quadratic_drag) + 2,
                           PathPlace::shift(thrusters_)});
    yaw.insert(yaw.end(), ratios_.begin(), ratios_.end());
    fit(yaw, {kNone, kNone, kMeasured});

    Places plane = of_thrusters({PathPlace::surge, PathPlace::sway});
    const Index current = PathPlace::current(thrusters_);
    plane.insert(plane.end(), {constant, constant + 1, current, current + 1});
    // With the headings, which hold the starts where yaw alone has left them.
    try_time_constants(plane,
                       {linear, linear + 1, PlanarPlace::sway_inertia, PlanarPlace::yaw_inertia},
                       PoseNoise::Constant(kMeasured));

    plane.insert(plane.end(), yaw.begin(), yaw.end());
    plane.insert(plane.end(),
                 {PlanarPlace::sway_inertia, PlanarPlace::yaw_inertia, linear, linear + 1});
    fit(plane, PoseNoise::Constant(kMeasured));
    return estimate_;
  }

 private:
  Places of_thrusters(std::initializer_list<Index> parts) const {
    Places places;
    for (Index i = 0; i < thrusters_; ++i) {
      for (const Index part : parts) {
        places.push_back(PathPlace::thruster(i) + part);
      }
    }
    return places;
  }

  PoseNoise fit(const Places& sought, const PoseNoise& counted) {
    return minimise_output_errors(pieces_, sought, counted, kPath.coarse_gain, estimate_);
  }

  // `forces` are linear in the path. `drags` first as of each time constant, then free.
  void try_time_constants(const Places& forces, const Places& drags, const PoseNoise& counted) {
    constexpr auto linear_drag = static_cast<Index>(PlanarPlace::linear_drag);
    const PathEstimate before = estimate_;
    PathEstimate best = before;
    double least = kNotCounted;
    Places all = forces;
    all.insert(all.end(), drags.begin(), drags.end());
    for (const double constant_s : kPath.time_constants_s) {
      estimate_ = before;
      for (const Index drag : drags) {
        if (drag >= linear_drag) {
          estimate_.parameters(drag) = 1.0 / constant_s;
        }
      }
      fit(forces, counted);
      const PoseNoise noise = fit(all, counted);
      const double error = std::isfinite(noise(0)) ? noise(0) : noise(2);
      if (error < least) {
        least = error;
        best = estimate_;
      }
    }
    estimate_ = best;
  }

  const std::vector<PathPiece>& pieces_;
  const Places& ratios_;
  Index thrusters_;
  PathEstimate estimate_;
};

// 1 + 2 Σ ρ_k of errors over noise, up to a lag of kPath.correlated_s: the variance of a mean of
// errors over that of as many independent ones.
double correlation_sum(const std::vector<PathPiece>& pieces, const PoseErrors& errors, Index part,
                       double noise) {
  const double step_s = (pieces.front().times_s.tail<1>()(0) - pieces.front().times_s(0)) /
                        static_cast<double>(pieces.front().times_s.size() - 1);
  const auto lags = static_cast<Index>(kPath.correlated_s / step_s);
  const double most = kPath.huber_sigmas * noise;
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(lags + 1);
  Eigen::VectorXd pairs = Eigen::VectorXd::Constant(lags + 1, 1e-300);
  for (const Eigen::Matrix3Xd& of_piece : errors) {
    for (Index at = 0; at < of_piece.cols(); ++at) {
      for (Index lag = 0; lag <= std::min(lags, at); ++lag) {
        const double product = std::clamp(of_piece(part, at), -most, most) *
                               std::clamp(of_piece(part, at - lag), -most, most);
        if (std::isfinite(product)) {
          sums(lag) += product;
          pairs(lag) += 1.0;
        }
      }
    }
  }
  const Eigen::VectorXd means = sums.cwiseQuotient(pairs);
  return std::max(1.0, 2.0 * means.sum() / std::max(means(0), 1e-300) - 1.0);
}

// PathPlace to PlanarPlace, for speeds in the log's unit: values and derivatives.
struct PlanarValues {
  Eigen::VectorXd values;
  Eigen::MatrixXd slopes;  // PlanarPlace × PathPlace
};

PlanarValues planar_values(const Eigen::VectorXd& path, const Eigen::VectorXd& greatest) {
  const Index count = PathPlace::munk(greatest.size());
  PlanarValues planar{path.head(count), Eigen::MatrixXd::Identity(count, path.size())};
  const auto inertia = static_cast<Index>(PlanarPlace::yaw_inertia);
  const auto sway_inertia = static_cast<Index>(PlanarPlace::sway_inertia);
  const double m33 = path(inertia);
  planar.values(sway_inertia) = 1.0 + path(sway_inertia) * m33;
  planar.slopes(sway_inertia, sway_inertia) = m33;
  planar.slopes(sway_inertia, inertia) = path(sway_inertia);
  for (const std::size_t first :
       {PlanarPlace::linear_drag, PlanarPlace::quadratic_drag, PlanarPlace::constant_force}) {
    const Index yaw = static_cast<Index>(first) + 2;
    planar.values(yaw) = m33 * path(yaw);
    planar.slopes(yaw, yaw) = m33;
    planar.slopes(yaw, inertia) = path(yaw);
  }
  for (Index i = 0; i < greatest.size(); ++i) {
    const Index at = PathPlace::thruster(i);
    const double surge = path(at + PathPlace::surge);
    const double sway = path(at + PathPlace::sway);
    const double moment = m33 * path(at + PathPlace::moment);
    const double ratio = path(at + PathPlace::ratio);
    const double force = std::max(std::hypot(surge, sway), std::numeric_limits<double>::min());
    const double unit = 1.0 / (greatest(i) * greatest(i));
    planar.values.segment<4>(at) << force * unit, ratio * force * unit, std::atan2(sway, surge),
        moment / force;
    Eigen::Matrix4d slopes = Eigen::Matrix4d::Zero();  // by surge, ratio, sway, moment
    slopes.row(0) << surge / force * unit, 0.0, sway / force * unit, 0.0;
    slopes.row(1) = ratio * slopes.row(0);
    slopes(1, PathPlace::ratio) = force * unit;
    slopes.row(2) << -sway / (force * force), 0.0, surge / (force * force), 0.0;
    slopes.row(3) = -moment / (force * force * unit) * slopes.row(0);
    slopes(3, PathPlace::moment) = m33 / force;
    planar.slopes.block<4, 4>(at, at) = slopes;
    planar.slopes(at + 3, inertia) = path(at + PathPlace::moment) / force;
  }
  return planar;
}

// Accelerations and terms along the simulated paths.
WeakRows simulated_rows(const PathCut& cut, const PathEstimate& estimate,
                        const Eigen::VectorXd& greatest) {
  const auto thrusters = static_cast<std::size_t>(greatest.size());
  Index rows = 0;
  for (const PathPiece& piece : cut.pieces) {
    rows += piece.times_s.size();
  }
  WeakRows weak{Eigen::MatrixXd(rows, 3), Eigen::MatrixXd(rows, term_count(thrusters)),
                Eigen::MatrixXd::Zero(rows, 3)};
  PlanarTerms evaluated(thrusters);
  Eigen::VectorXd terms(weak.terms.cols());
  Index at = 0;
  for (std::size_t i = 0; i < cut.pieces.size(); ++i) {
    const PathPiece& piece = cut.pieces[i];
    const PathStates path =
        drive_piece(piece, estimate.parameters, estimate.starts[i], estimate.between, {}, false);
    for (Index row = 0; row < piece.times_s.size(); ++row, ++at) {
      const Eigen::VectorXd speeds = piece.speeds.col(row);
      const PoseState state = path.states.col(row);
      weak.acceleration.row(at) = path_acceleration(estimate.parameters, state, speeds);
      const Eigen::VectorXd own = speeds.cwiseProduct(greatest);
      evaluated.evaluate(std::span<const double, 3>(state.data() + 3, 3),
                         std::span(own.data(), thrusters), terms);
      weak.terms.row(at) = terms;
    }
  }
  return weak;
}

// All parameters sought in the end, and `ratios` alone.
Places all_places(Index thrusters, const Places& ratios) {
  Places places;
  for (Index place = 1; place < PathPlace::count(thrusters); ++place) {
    const Index of_thruster = place - PathPlace::thruster(0);
    const bool is_ratio = of_thruster >= 0 && place < PathPlace::munk(thrusters) &&
                          of_thruster % 4 == PathPlace::ratio;
    if (place == PathPlace::munk(thrusters)) {
      continue;
    }
    if (!is_ratio || std::ranges::find(ratios, place) != ratios.end()) {
      places.push_back(place);
    }
  }
  return places;
}

// Of thrusters that ran both ways.
Places known_ratios(const PoseRows& rows) {
  const auto speeds = columns_of(rows.speeds, rows.thrusters.size());
  Places places;
  for (Index i = 0; i < speeds.rows(); ++i) {
    if (speeds.row(i).minCoeff() < 0.0 && speeds.row(i).maxCoeff() > 0.0) {
      places.push_back(PathPlace::thruster(i) + PathPlace::ratio);
    }
  }
  return places;
}

// The estimate with speeds between rows as explains most.
PathEstimate best_between(const PathCut& cut, const Places& sought, const PathEstimate& ramps) {
  PathEstimate best = ramps;
  double least = kNotCounted;
  for (const BetweenRows between :
       {BetweenRows::ramps, BetweenRows::steps_after, BetweenRows::steps_before}) {
    PathEstimate estimate = ramps;
    estimate.between = between;
    const PoseNoise noise = minimise_output_errors(
        cut.pieces, sought, PoseNoise::Constant(kMeasured), kPath.coarse_gain, estimate);
    const double spread = 2.0 * std::log(noise(0)) + std::log(noise(2));
    if (spread < least) {
      least = spread;
      best = estimate;
    }
  }
  return best;
}

PlanarFit finished(const PoseRows& rows, const PathCut& cut, const PathEstimate& estimate,
                   const Places& sought, const PoseNoise& noise, double misfit,
                   const Eigen::VectorXd& greatest) {
  const WeakRows weak = simulated_rows(cut, estimate, greatest);
  const PlanarValues planar = planar_values(estimate.parameters, greatest);
  MinimumDistance best{.parameters = planar.values};
  best.free = sought_places(weak.terms.transpose() * weak.terms, planar.values.size());
  best.at_bound.assign(static_cast<std::size_t>(planar.values.size()), false);
  Places inner;
  for (const Index place : sought) {
    const bool is_bounded = place < planar.values.size() && planar.values(place) == 0.0;
    if (is_bounded) {
      best.at_bound[static_cast<std::size_t>(place)] = true;
    } else {
      inner.push_back(place);
    }
  }
  inner.push_back(PathPlace::munk(greatest.size()));
  const Eigen::MatrixXd information = output_information(cut.pieces, inner, noise, estimate);
  inner.pop_back();
  // The Munk moment is a small difference of inertias, which the plane tells to 0.3 % only.
  const auto count = static_cast<Index>(inner.size());
  Eigen::MatrixXd covariance = equilibrated_inverse(information.topLeftCorner(count, count));
  const Eigen::VectorXd by_munk =
      kIdentification.plane_allowance * covariance * information.col(count).head(count);
  covariance += by_munk * by_munk.transpose();
  const Eigen::MatrixXd slopes = planar.slopes(best.free, inner);
  Eigen::MatrixXd errors = slopes * covariance * slopes.transpose();
  const auto coupling = std::ranges::find(best.free, kCoupling) - best.free.begin();
  errors(coupling, coupling) += std::pow(kIdentification.plane_allowance, 2.0) *
                                planar.values(PlanarPlace::sway_inertia) *
                                planar.values(PlanarPlace::yaw_inertia);
  PlanarFit fit = planar_estimate(rows.thrusters, weak, best, errors, 1.0);
  fit.windows = cut.pieces.size();
  fit.window_s = kPath.piece_s;
  fit.misfit = misfit;
  require_excitation(fit, best);
  return fit;
}

}  // namespace

PlanarFit fit_poses(const PoseRows& rows) {
  const Eigen::VectorXd greatest = columns_of(rows.speeds, rows.thrusters.size())
                                       .rowwise()
                                       .lpNorm<Eigen::Infinity>()
                                       .cwiseMax(std::numeric_limits<double>::min());
  const PathCut brief = cut(rows, greatest, kPath.brief_piece_s);
  const PathCut whole = cut(rows, greatest, kPath.piece_s);
  if (whole.pieces.size() < kPath.least_pieces) {
    throw InputError("too few poses: " + std::to_string(whole.pieces.size()) + " pieces of " +
                     number_text(kPath.piece_s) + " s without a gap, " +
                     std::to_string(kPath.least_pieces) + " are needed");
  }
  const Places ratios = known_ratios(rows);
  const Places sought = all_places(greatest.size(), ratios);
  const PathEstimate start = PathStart(brief.pieces, ratios).run();
  PathEstimate estimate = best_between(brief, sought, start);
  estimate.starts = starts_along(brief, estimate, whole);
  PoseNoise noise = minimise_output_errors(whole.pieces, sought, PoseNoise::Constant(kMeasured),
                                           kPath.fine_gain, estimate);
  const PoseErrors errors = pose_errors(whole.pieces, estimate);
  double misfit = 1.0;
  for (Index part = 0; part < 3; ++part) {
    const double sum = correlation_sum(whole.pieces, errors, part, noise(part));
    noise(part) *= std::sqrt(sum);
    misfit = std::max(misfit, sum);
  }
  return finished(rows, whole, estimate, sought, noise, misfit, greatest);
}

}  // namespace kelpie
