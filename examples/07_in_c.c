// SPDX-License-Identifier: Apache-2.0
// 07: a model in C. A vehicle with one thruster: its acceleration is learned, predicted with its
// derivative by the rotor speed and with an interval, and the model is saved and loaded again.
//
// Prints:
//   2000 of 2000 samples were accepted
//   udot 0.152 m/s2 (true 0.152), by n 0.120 (true 0.120)
//   between 0.142 and 0.161, novelty 0.1
//   loaded, it says the same
//   without u: nan, novelty 1.0
//   status 2: x: has 1 values; it has to have 2

#include <kelpie/kelpie.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void check(kelpie_status status) {
  if (status != KELPIE_OK) {
    fprintf(stderr, "%s\n", kelpie_last_error());
    exit(status);
  }
}

// Surge: a thruster's push, and the water's drag.
static double acceleration(double u, double n) {
  return (0.6 * n * fabs(n) - 40.0 * u * fabs(u) - 5.0 * u) / 60.0;
}

int main(void) {
  const char* const inputs[] = {"u", "n"};
  const char* const targets[] = {"udot"};
  kelpie_model* model = NULL;
  check(kelpie_create(inputs, 2, targets, 1, "buffer = 200\ncoverage = 0.9", &model));

  double x[] = {0.0, 0.0};
  int learned = 0;
  for (int i = 0; i < 2000; ++i) {
    const double t = 0.1 * i;
    x[1] = 6.0 * sin(0.3 * t) + 3.0 * sin(1.1 * t);
    const double y = acceleration(x[0], x[1]);
    const double measured = y + 0.01 * sin(1e4 * t);  // what stands for noise here
    kelpie_decision decision;
    check(kelpie_update(model, x, 2, &measured, 1, t, &decision));
    learned += decision.verdict == KELPIE_ACCEPTED;
    x[0] += 0.1 * y;
  }
  printf("%d of 2000 samples were accepted\n", learned);

  const double place[] = {0.5, 6.0};
  double y = 0.0;
  double jacobian[2];
  check(kelpie_predict_with_jacobian(model, place, 2, &y, 1, jacobian));
  printf("udot %.3f m/s2 (true %.3f), by n %.3f (true %.3f)\n", y, acceleration(0.5, 6.0),
         jacobian[1], 1.2 * 6.0 / 60.0);
  kelpie_prediction known;
  check(kelpie_assess(model, place, 2, &known, 1, 0.0));
  printf("between %.3f and %.3f, novelty %.1f\n", known.lower, known.upper, known.novelty);

  unsigned char* bytes = NULL;
  size_t size = 0;
  check(kelpie_save(model, &bytes, &size));
  kelpie_free(model);
  check(kelpie_load(bytes, size, &model));
  kelpie_free_bytes(bytes);
  double again = 0.0;
  check(kelpie_predict(model, place, 2, &again, 1));
  printf("loaded, it says %s\n", fabs(again - y) < 1e-9 ? "the same" : "something else");

  const double lost[] = {NAN, 6.0};
  check(kelpie_assess(model, lost, 2, &known, 1, 0.0));
  printf("without u: %s, novelty %.1f\n", isnan(known.value) ? "nan" : "a number", known.novelty);
  const kelpie_status status = kelpie_predict(model, place, 1, &again, 1);
  printf("status %d: %s\n", (int)status, kelpie_last_error());
  kelpie_free(model);
  return 0;
}
