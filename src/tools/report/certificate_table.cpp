// SPDX-License-Identifier: Apache-2.0
#include "report/certificate_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "chart/wording.hpp"

namespace kelpie::report {
namespace {

std::string one_r2(double r2) {
  return r2 < -1.0 ? "< −1" : chart::decimal(r2);
}

// Of up to three axes all, else the least with its axis.
std::string r2_text(const study::DrivenHorizon& horizon, const std::array<bool, 6>& free) {
  if (horizon.starts < 2) {
    return "–";
  }
  std::string text;
  std::size_t least = free.size();
  for (std::size_t axis = 0; axis < free.size(); ++axis) {
    if (free[axis]) {
      text += (text.empty() ? "" : "/") + one_r2(horizon.r2[axis]);
      least = least == free.size() || horizon.r2[axis] < horizon.r2[least] ? axis : least;
    }
  }
  const auto count = std::ranges::count(free, true);
  return count <= 3 ? text : one_r2(horizon.r2[least]) + " " + simulator::axis_text(least);
}

std::string step_text(double step_s) {
  return fmt::format("{:.4g}", 1e3 * step_s);
}

std::string bound_text(const simulator::StepLimit& limit) {
  return limit.term ? fmt::format("{}, {}", simulator::term_text(*limit.term),
                                  simulator::axis_text(limit.axis))
                    : "–";
}

}  // namespace

chart::TextTable certificate_view(const study::CertificateList& list) {
  chart::TextTable table{"Driven again by the equations of simulators",
                         {"engine", "step/ms", "R² after 1 s", "10 s", "40 s",
                          "largest stable\nstep/ms", "bounded by"},
                         {}};
  for (const study::Certificate& certificate : list.engines) {
    const simulator::StepLimit& limit = certificate.limit;
    std::vector<std::string> row{std::string(certificate.engine.name),
                                 step_text(certificate.engine.step_s)};
    for (const study::DrivenHorizon& horizon : certificate.horizons) {
      row.push_back(r2_text(horizon, list.free));
    }
    row.push_back(!limit.largest_s ? "none"
                  : *limit.largest_s >= simulator::StepLimit::kMostS
                      ? "above " + step_text(simulator::StepLimit::kMostS)
                      : step_text(*limit.largest_s));
    row.push_back(bound_text(limit));
    table.rows.push_back(row);
  }
  std::vector<std::string> axes;
  for (std::size_t axis = 0; axis < list.free.size(); ++axis) {
    if (list.free[axis]) {
      axes.emplace_back(simulator::axis_text(axis));
    }
  }
  table.left = {0, 6};
  table.notes = {
      fmt::format("R² of the velocities of {}, in open loop from the measured velocity; "
                  "{}",
                  chart::list_text(axes), list.rows)};
  return table;
}

std::vector<std::string> certificate_remarks(const study::CertificateList& list) {
  std::vector<std::string> remarks;
  for (const study::Certificate& certificate : list.engines) {
    const simulator::StepLimit& limit = certificate.limit;
    if (!limit.stable) {
      remarks.push_back(fmt::format(
          "{} ({}) is unstable at its step of {} ms: {}{}.", certificate.engine.name,
          certificate.engine.title, step_text(certificate.engine.step_s),
          limit.term
              ? fmt::format("to blame: the {} on the axis of {}, ",
                            simulator::term_text(*limit.term), simulator::axis_text(limit.axis))
              : std::string(),
          limit.largest_s ? "and steps up to " + step_text(*limit.largest_s) + " ms are stable"
                          : std::string("and no step is stable")));
    }
  }
  return remarks;
}

}  // namespace kelpie::report
