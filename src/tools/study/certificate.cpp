// SPDX-License-Identifier: Apache-2.0
#include "study/certificate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "study/metrics.hpp"
#include "study/open_loop_study.hpp"

namespace kelpie::study {
namespace {

using simulator::EngineRun;
using simulator::EngineState;
using simulator::Vector6;

constexpr double kWild = 1e3;  // m/s, rad/s: a rollout beyond has failed

// Where each axis is fastest.
std::vector<EngineState> operating_points(const RecordedDrive& drive) {
  std::vector<EngineState> points;
  for (Eigen::Index axis = 0; axis < 6; ++axis) {
    const auto row = std::ranges::max_element(
        drive.velocities, {}, [&](const Vector6& velocity) { return std::abs(velocity(axis)); });
    if (row != drive.velocities.end() && std::abs((*row)(axis)) > 0.0) {
      const auto at = static_cast<std::size_t>(row - drive.velocities.begin());
      points.push_back(EngineState::at(drive.attitudes[at], *row));
    }
  }
  return points;
}

Vector6 mixed(const std::vector<Vector6>& rows, std::size_t row, double share) {
  return (1.0 - share) * rows[row] + share * rows[row + 1];
}

// A time in a stretch as a row and a share of the way to the next row.
class RowTime {
 public:
  RowTime(const RecordedDrive& drive, std::size_t start, std::size_t end)
      : times_(drive.times_s), row_(start), last_(end - 2) {}

  void advance_to(double time) {
    while (row_ < last_ && times_[row_ + 1] <= time) {
      ++row_;
    }
    share_ = std::clamp((time - times_[row_]) / (times_[row_ + 1] - times_[row_]), 0.0, 1.0);
  }
  Vector6 of(const std::vector<Vector6>& rows) const { return mixed(rows, row_, share_); }

 private:
  const std::vector<double>& times_;
  std::size_t row_;
  std::size_t last_;
  double share_ = 0.0;
};

// Driven and measured velocities of one horizon, axis by axis.
struct Pairs {
  std::array<std::vector<double>, 6> measured{};
  std::array<std::vector<double>, 6> driven{};

  void add(const Vector6& truth, const Vector6& found) {
    for (std::size_t axis = 0; axis < 6; ++axis) {
      measured[axis].push_back(truth(static_cast<Eigen::Index>(axis)));
      driven[axis].push_back(found(static_cast<Eigen::Index>(axis)));
    }
  }
};

// One rollout; adds a pair at every horizon within the stretch.
void drive_from(const EngineRun& run, const RecordedDrive& drive, std::size_t start,
                std::size_t end, const DriveStudy& study, std::vector<Pairs>& pairs) {
  EngineState state = EngineState::at(drive.attitudes[start], drive.velocities[start]);
  const double begin = drive.times_s[start];
  RowTime clock(drive, start, end);
  bool wild = false;
  long step = 0;
  for (std::size_t i = 0; i < study.horizons_s.size(); ++i) {
    if (drive.times_s[end - 1] < begin + study.horizons_s[i]) {
      break;
    }
    for (const auto last = std::lround(study.horizons_s[i] / run.step_s()); step < last; ++step) {
      clock.advance_to(begin + static_cast<double>(step) * run.step_s());
      if (!wild) {
        state = run.next(state, clock.of(drive.forces));
        wild = !state.is_finite() || state.velocity.cwiseAbs().maxCoeff() > kWild;
      }
    }
    clock.advance_to(begin + study.horizons_s[i]);
    pairs[i].add(clock.of(drive.velocities), wild ? Vector6::Constant(kWild) : state.velocity);
  }
}

std::vector<DrivenHorizon> driven_horizons(const EngineRun& run, const RecordedDrive& drive,
                                           const DriveStudy& study) {
  std::vector<Pairs> pairs(study.horizons_s.size());
  for (std::size_t stretch = 0; stretch < drive.starts.size(); ++stretch) {
    const std::size_t end = drive.end_of(stretch);
    for (const std::size_t row :
         starts_in(drive.times_s, {drive.starts[stretch], end}, study.start_every_s)) {
      drive_from(run, drive, row, end, study, pairs);
    }
  }
  std::vector<DrivenHorizon> horizons;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    DrivenHorizon horizon{.seconds = study.horizons_s[i], .starts = pairs[i].measured[0].size()};
    for (std::size_t axis = 0; axis < 6; ++axis) {
      horizon.r2[axis] = run.body().free[axis]
                             ? r_squared(pairs[i].measured[axis], pairs[i].driven[axis])
                             : std::numeric_limits<double>::quiet_NaN();
    }
    horizons.push_back(horizon);
  }
  return horizons;
}

}  // namespace

CertificateList certify(std::span<const simulator::Engine> engines,
                        const simulator::EngineBody& body, const RecordedDrive& drive,
                        const DriveStudy& study) {
  CertificateList list{.rows = drive.rows_text, .free = body.free};
  const std::vector<EngineState> points = operating_points(drive);
  for (const simulator::Engine& engine : engines) {
    list.engines.push_back(
        {.engine = engine,
         .horizons = driven_horizons(EngineRun(engine, body, engine.step_s), drive, study),
         .limit = step_limit(engine, body, points)});
  }
  return list;
}

}  // namespace kelpie::study
