// SPDX-License-Identifier: Apache-2.0
// 01: the smallest learner on a stream. Each sample is first predicted, then learned, in a buffer
// of 200 samples, whatever the length of the stream.
//
// Prints:
//   R² of the last 1000 predictions: 0.968
//   200 samples in the buffer, 146 of them support vectors

#include <array>
#include <cmath>
#include <cstdio>

#include "kelpie/core/random.hpp"
#include "kelpie/svr/online_svr.hpp"

int main() {
  constexpr int kSamples = 2000;
  constexpr int kJudged = 1000;  // the last ones
  kelpie::OnlineSvrSettings settings;
  settings.buffer = 200;
  settings.gamma = 0.5;  // inputs and targets have unit size here; for others see 02
  kelpie::OnlineSvr learner(2, settings);

  kelpie::RandomStream random(1, "stream");
  double error = 0.0;
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const std::array<double, 2> x{random.normal(), random.normal()};
    const double y = std::sin(2.0 * x[0]) + 0.5 * x[1] * std::abs(x[1]) + 0.05 * random.normal();
    const kelpie::Decision decision = learner.update(x, y, 0.1 * i);  // never throws on data
    if (i >= kSamples - kJudged) {
      error += (y - decision.prediction.value) * (y - decision.prediction.value);
      sum += y;
      squares += y * y;
    }
  }
  const kelpie::Status status = learner.status();
  std::printf("R² of the last %d predictions: %.3f\n", kJudged,
              1.0 - error / (squares - sum * sum / kJudged));
  std::printf("%d samples in the buffer, %d of them support vectors\n", status.buffer,
              status.support_vectors);
}
