// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

// The parts of an exported model that don't depend on it but for words with a $ (model_c.cpp).
// Lines that begin with @TERMS, @SLOPES or @ASSESS are for models with terms, with slopes of these,
// and with what is known of their uncertainty.
namespace kelpie::format {

inline constexpr std::string_view kAssessNote =
    R"( * $NAME_assess also tells half the width of the interval around y[i], as it was when learning
 * ended (infinite: nothing is promised), and from 0 to 1 how new x is (NaN: not known).
)";

inline constexpr std::string_view kPrototypes = R"(
enum { $NAME_inputs = $INPUTS, $NAME_targets = $TARGETS };

extern const char *const $NAME_input_names[$INPUTS];
extern const char *const $NAME_input_units[$INPUTS]; /* "" where not known */
extern const char *const $NAME_target_names[$TARGETS];
extern const char *const $NAME_target_units[$TARGETS];

void $NAME_predict(const $REAL x[$INPUTS], $REAL y[$TARGETS]);
void $NAME_predict_with_jacobian(const $REAL x[$INPUTS], $REAL y[$TARGETS],
                                $REAL jacobian[$TARGETS * $INPUTS]);
@ASSESSvoid $NAME_assess(const $REAL x[$INPUTS], $REAL y[$TARGETS], $REAL half_width[$TARGETS],
@ASSESS                  $REAL novelty[$TARGETS]);
)";

inline constexpr std::string_view kHeader = R"(#ifndef $NAME_H
#define $NAME_H
#ifdef __cplusplus
extern "C" {
#endif
)";

inline constexpr std::string_view kHeaderEnd = R"(
#ifdef __cplusplus
}
#endif
#endif
)";

inline constexpr std::string_view kAxis = R"(
struct $NAME_axis {
  int first, last; /* of its members, and the one behind */
  $REAL low, high; /* no member says less or more */
  $REAL mean[$INPUTS];
  $REAL whitening[$INPUTS][$INPUTS]; /* z = whitening (x - mean), below the diagonal */
};

struct $NAME_member {
  $REAL share;     /* how much it is believed */
  int first, last; /* of its support vectors, and the one behind */
  $REAL gamma, s, fine;
  $REAL offset;
@TERMS  $REAL coefficients[$TERMS];
};

)";

inline constexpr std::string_view kKernel = R"(
/* What a member learned beside its terms; adds its slopes to `gradient` where that is not null. */
static $REAL $NAME_local(const struct $NAME_axis *axis, const struct $NAME_member *member,
                         const $REAL *z, $REAL *gradient)
{
  $REAL by_z[$INPUTS];
  $REAL sum = 0;
  int i, j, n;
  for (i = 0; i < $INPUTS; ++i) {
    by_z[i] = 0;
  }
  for (n = member->first; n < member->last; ++n) {
    const $REAL *const vector = $NAME_support_vectors[n];
    $REAL square = 0;
    $REAL coarse, fine;
    for (i = 0; i < $INPUTS; ++i) {
      square += (vector[i] - z[i]) * (vector[i] - z[i]);
    }
    coarse = $EXP(-member->gamma * square);
    fine = coarse * coarse;
    fine *= fine;
    fine *= fine;
    fine *= fine;
    fine *= fine;
    coarse *= member->s;
    fine *= member->fine;
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
        gradient[j] += 2 * member->gamma * axis->whitening[i][j] * by_z[i];
      }
    }
  }
  return sum;
}
)";

inline constexpr std::string_view kEvaluate = R"(
static void $NAME_scale(const struct $NAME_axis *axis, const $REAL *x, $REAL *z)
{
  int i, j;
  for (i = 0; i < $INPUTS; ++i) {
    z[i] = 0;
    for (j = 0; j <= i; ++j) {
      z[i] += axis->whitening[i][j] * (x[j] - axis->mean[j]);
    }
  }
}

static void $NAME_evaluate(const $REAL *x, $REAL *y, $REAL *jacobian)
{
  int k, m, n;
  $REAL doubt = 0; /* NaN where a number of x isn't finite */
@TERMS  $REAL phi[$TERMS];
@SLOPES  $REAL slope[$SLOPES];
@TERMS  $NAME_terms(x, phi, $SLOPE);
  for (k = 0; k < $INPUTS; ++k) {
    doubt += 0 * x[k];
  }
  for (m = 0; m < $TARGETS; ++m) {
    const struct $NAME_axis *const axis = &$NAME_axes[m];
    $REAL z[$INPUTS];
    $NAME_scale(axis, x, z);
    y[m] = doubt;
    for (k = 0; jacobian && k < $INPUTS; ++k) {
      jacobian[m * $INPUTS + k] = doubt;
    }
    for (n = axis->first; n < axis->last; ++n) {
      const struct $NAME_member *const member = &$NAME_members[n];
      $REAL own[$INPUTS];
      $REAL said;
      for (k = 0; k < $INPUTS; ++k) {
        own[k] = 0;
      }
      said = member->offset + $NAME_local(axis, member, z, jacobian ? own : 0);
@TERMS      for (k = 0; k < $TERMS; ++k) {
@TERMS        said += member->coefficients[k] * phi[k];
@TERMS      }
@SLOPES      for (k = 0; jacobian && k < $SLOPES; ++k) {
@SLOPES        own[$NAME_slope_column[k]] += member->coefficients[$NAME_slope_term[k]] * slope[k];
@SLOPES      }
      for (k = 0; jacobian && said > axis->low && said < axis->high && k < $INPUTS; ++k) {
        jacobian[m * $INPUTS + k] += member->share * own[k];
      }
      said = said < axis->low ? axis->low : said > axis->high ? axis->high : said;
      y[m] += member->share * said;
    }
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

// The densities that KernelDensity::novelty compares: nobody's own kernel value counts.
inline constexpr std::string_view kAssess = R"(
/* The share of the samples known that lie in a denser place; 1 where none is near. */
static $REAL $NAME_novelty(const struct $NAME_known *known, const $REAL *z)
{
  $REAL own = 0;
  int denser = 0;
  int pass, n, i;
  if (known->rate == 0) {
    return NAN; /* the model doesn't say */
  }
  for (pass = 0; pass < 2; ++pass) {
    for (n = known->first; n < known->last; ++n) {
      const $REAL *const place = $NAME_places[n];
      $REAL square = 0;
      $REAL closeness;
      for (i = 0; i < $INPUTS; ++i) {
        square += (place[i] - z[i]) * (place[i] - z[i]);
      }
      closeness = $EXP(-known->rate * square);
      if (pass == 0) {
        own += closeness;
      } else if ($NAME_densities[n] + closeness > own) {
        ++denser;
      }
    }
    if (!(own >= $NOBODY)) {
      return 1;
    }
  }
  return ($REAL)denser / ($REAL)(known->last - known->first);
}

void $NAME_assess(const $REAL x[$INPUTS], $REAL y[$TARGETS], $REAL half_width[$TARGETS],
                  $REAL novelty[$TARGETS])
{
  $REAL z[$INPUTS];
  int m;
  $NAME_evaluate(x, y, 0);
  for (m = 0; m < $TARGETS; ++m) {
    $NAME_scale(&$NAME_axes[m], x, z);
    half_width[m] = $NAME_known[m].half_width;
    novelty[m] = $NAME_novelty(&$NAME_known[m], z);
  }
}
)";

}  // namespace kelpie::format
