// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

// The parts of an exported model that don't depend on it but for words with a $ (model_c.cpp).
// Lines that begin with @TERMS or @SLOPES are for models with terms, and with slopes of these.
namespace kelpie::format {

inline constexpr std::string_view kPrototypes = R"(
#include <math.h>

enum { $NAME_inputs = $INPUTS, $NAME_targets = $TARGETS };

extern const char *const $NAME_input_names[$INPUTS];
extern const char *const $NAME_input_units[$INPUTS]; /* "" where not known */
extern const char *const $NAME_target_names[$TARGETS];
extern const char *const $NAME_target_units[$TARGETS];

void $NAME_predict(const $REAL x[$INPUTS], $REAL y[$TARGETS]);
void $NAME_predict_with_jacobian(const $REAL x[$INPUTS], $REAL y[$TARGETS],
                                $REAL jacobian[$TARGETS * $INPUTS]);
)";

inline constexpr std::string_view kAxis = R"(
struct $NAME_axis {
  int first, last; /* of its support vectors, and the one behind */
  $REAL gamma, s, fine;
  $REAL offset;
  $REAL mean[$INPUTS];
  $REAL whitening[$INPUTS][$INPUTS]; /* z = whitening (x - mean), below the diagonal */
@TERMS  $REAL coefficients[$TERMS];
};

)";

inline constexpr std::string_view kKernel = R"(
/* What an axis learned beside its terms; adds its slopes to `gradient` where that is not null. */
static $REAL $NAME_local(const struct $NAME_axis *axis, const $REAL *x, $REAL *gradient)
{
  $REAL z[$INPUTS];
  $REAL by_z[$INPUTS];
  $REAL sum = 0;
  int i, j, n;
  for (i = 0; i < $INPUTS; ++i) {
    by_z[i] = 0;
    z[i] = 0;
    for (j = 0; j <= i; ++j) {
      z[i] += axis->whitening[i][j] * (x[j] - axis->mean[j]);
    }
  }
  for (n = axis->first; n < axis->last; ++n) {
    const $REAL *const vector = $NAME_support_vectors[n];
    $REAL square = 0;
    $REAL coarse, fine;
    for (i = 0; i < $INPUTS; ++i) {
      square += (vector[i] - z[i]) * (vector[i] - z[i]);
    }
    coarse = $EXP(-axis->gamma * square);
    fine = coarse * coarse;
    fine *= fine;
    fine *= fine;
    fine *= fine;
    fine *= fine;
    coarse *= axis->s;
    fine *= axis->fine;
    sum += $NAME_weights[n] * (coarse + fine);
    if (gradient) {
      const $REAL factor = $NAME_weights[n] * (coarse + 32 * fine);
      for (i = 0; i < $INPUTS; ++i) {
        by_z[i] += factor * (vector[i] - z[i]);
      }
    }
  }
  if (gradient) {
    for (i = 0; i < $INPUTS; ++i) {
      for (j = 0; j <= i; ++j) {
        gradient[j] += 2 * axis->gamma * axis->whitening[i][j] * by_z[i];
      }
    }
  }
  return sum;
}
)";

inline constexpr std::string_view kEvaluate = R"(
static void $NAME_evaluate(const $REAL *x, $REAL *y, $REAL *jacobian)
{
  int m;
@TERMS  $REAL phi[$TERMS];
@SLOPES  $REAL slope[$SLOPES];
@TERMS  $NAME_terms(x, phi, $SLOPE);
  for (m = 0; m < $TARGETS; ++m) {
    const struct $NAME_axis *const axis = &$NAME_axes[m];
    $REAL *const gradient = jacobian ? jacobian + m * $INPUTS : 0;
    int k;
    for (k = 0; gradient && k < $INPUTS; ++k) {
      gradient[k] = 0;
    }
    y[m] = axis->offset + $NAME_local(axis, x, gradient);
@TERMS    for (k = 0; k < $TERMS; ++k) {
@TERMS      y[m] += axis->coefficients[k] * phi[k];
@TERMS    }
@SLOPES    for (k = 0; gradient && k < $SLOPES; ++k) {
@SLOPES      gradient[$NAME_slope_column[k]] += axis->coefficients[$NAME_slope_term[k]] * slope[k];
@SLOPES    }
  }
}

void $NAME_predict(const $REAL x[$INPUTS], $REAL y[$TARGETS])
{
  $NAME_evaluate(x, y, 0);
}

void $NAME_predict_with_jacobian(const $REAL x[$INPUTS], $REAL y[$TARGETS],
                                $REAL jacobian[$TARGETS * $INPUTS])
{
  $NAME_evaluate(x, y, jacobian);
}
)";

}  // namespace kelpie::format
