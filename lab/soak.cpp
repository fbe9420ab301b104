// SPDX-License-Identifier: Apache-2.0
#include "lab/soak.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "chart/wording.hpp"
#include "core/quantile.hpp"
#include "lab/sliding_window.hpp"
#include "lab/update_times.hpp"

namespace kelpie::lab {

SoakStream::SoakStream(std::uint64_t seed) : random_(seed, "soak") {
  for (double& phase : phase_) {
    phase = random_.uniform(0.0, 6.0);
  }
}

SoakStream::Sample SoakStream::next() {
  drift_ += 0.002 * random_.normal();
  resting_ = resting_ > 0 ? resting_ - 1 : (random_.below(500) == 0 ? 50 : 0);
  Sample sample = last_;
  if (random_.below(20) > 0) {  // else an exact duplicate
    for (std::size_t k = 0; k < kInputs; ++k) {
      phase_[k] += resting_ > 0 ? 1e-9 : random_.uniform(0.02, 0.2);
      sample.z[k] = 1.4 * std::sin(phase_[k]);
    }
    sample.y = function(sample.z) + 0.05 * random_.normal();
  } else if (random_.below(2) == 0) {
    sample.y += random_.normal();
  }
  last_ = sample;
  if (random_.below(100) == 0) {
    sample.y += 10.0 * random_.normal();
  }
  return sample;
}

double SoakStream::function(const std::array<double, kInputs>& z) const {
  return std::sin(z[0] + drift_) + 0.3 * z[1] * std::abs(z[1]) - 0.4 * z[2] * z[3] +
         0.2 * std::cos(drift_) * z[4] - 0.1 * z[5];
}

SoakRun run_soak(const SoakPlan& plan) {
  OnlineSvrSettings settings;
  settings.buffer = static_cast<int>(plan.window);
  settings.storage = Storage::float64;
  SlidingWindow window(SoakStream::kInputs, settings);
  SoakStream stream(plan.seed);
  SoakRun run;
  std::vector<double> times;
  times.reserve(plan.updates);
  while (run.updates < plan.updates && plan.keep_going(run.updates)) {
    const SoakStream::Sample sample = stream.next();
    SolveReport report;
    times.push_back(timed_us([&] { report = window.step(sample.z, sample.y); }));
    run.fallbacks += report.fell_back ? 1 : 0;
    if (++run.updates % plan.check_every == 0 || run.updates == plan.updates) {
      run.gap = std::max(run.gap, kkt_afresh(window.problem()).gap());
    }
  }
  if (!times.empty()) {
    run.max_us = std::ranges::max(times);
    run.median_us = quantile(times, 0.5);
  }
  return run;
}

std::string soak_text(const SoakRun& run) {
  return fmt::format(
      "{} updates, {} fallbacks, largest gap {:.1e} (allowed {:.0e}), median {}, max {}: {}",
      chart::grouped(run.updates), run.fallbacks, run.gap, SoakRun::kGapAllowed,
      chart::duration(run.median_us), chart::duration(run.max_us),
      run.good() ? "good" : "NOT GOOD");
}

}  // namespace kelpie::lab
