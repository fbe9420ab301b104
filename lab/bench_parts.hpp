// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <span>
#include <vector>

#include "lab/bench.hpp"

namespace kelpie::lab {

/// One axis of a stream, standardised.
struct BenchSamples {
  std::string stream;
  bool simulated = false;
  std::string axis;
  std::size_t inputs = 0;
  std::vector<double> z;  ///< row-major, rows × inputs
  std::vector<double> y;
  std::vector<double> times_s;
  OnlineSvrSettings settings;

  std::size_t rows() const { return y.size(); }
  std::span<const double> input(std::size_t row) const {
    return std::span(z).subspan(row * inputs, inputs);
  }
};

/// Hears whether to go on while updates are counted.
class BenchProgress {
 public:
  BenchProgress(const BenchPlan& plan, double planned) : plan_(plan), planned_(planned) {}

  /// False when the work is to stop, from then on.
  bool advance(double updates) {
    done_ += updates;
    stopped_ = stopped_ || !plan_.keep_going(done_ < planned_ ? done_ / planned_ : 1.0);
    return !stopped_;
  }
  bool stopped() const { return stopped_; }

 private:
  const BenchPlan& plan_;
  double planned_;
  double done_ = 0.0;
  bool stopped_ = false;
};

template <typename Work>
double timed_us(Work work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start)
      .count();
}

/// Each fills in its part of the result, unless stopped.
void compare_solvers(const BenchSamples& samples, const BenchPlan& plan, BenchProgress& progress,
                     BenchAxis& axis);
void measure_learner(const BenchSamples& samples, const BenchPlan& plan, BenchProgress& progress,
                     BenchAxis& axis);
BenchGrowth growth_over_window(const BenchSamples& samples, const BenchPlan& plan,
                               BenchProgress& progress);
BenchGrowth growth_over_inputs(const BenchSamples& samples, const BenchPlan& plan,
                               BenchProgress& progress);
BenchKernel measure_kernel(const BenchSamples& samples, const BenchPlan& plan);

/// Updates each of the above is about to make.
double compare_updates(const BenchSamples& samples, const BenchPlan& plan);
double growth_updates(const BenchPlan& plan);

}  // namespace kelpie::lab
