/* SPDX-License-Identifier: Apache-2.0
 * The evaluator of exported models (src/tools/format/model_eval.inc) by itself: a model of two inputs and
 * one target whose numbers were worked out by hand. check() returns 0, or the number of the first
 * check that fails. */
#include <math.h>

#define KELPIE_REAL double
#define KELPIE_EXP exp
#define KELPIE_SQRT sqrt
#define KELPIE_SIN sin
#define KELPIE_COS cos
#define KELPIE_POW pow
#define KELPIE_INPUTS 2
#define KELPIE_TARGETS 1
#define KELPIE_TERMS 4
#define KELPIE_SLOPES 5
#define KELPIE_STACK 3
#define KELPIE_ASSESS 1e-9
#define KELPIE_PAIRS 6
#include "model_eval.inc"
#include "model_curve.inc"

/* Two members: the first with one support vector at z = (1, 0), the second of terms alone. */
static const struct kelpie_axis axes[] = {{0, 2, -10, 10, 0, 1, {1, 0}, {{2, 0}, {1, 0.5}},
                                           {{-99, 99}, {-99, 99}, {-99, 99}, {-99, 99}}, {0, 0, 0, 0}}};
/* The same without limits, with terms that end at -0.25 (from below), at 1 and at 0. */
static const struct kelpie_axis narrow[] = {{0, 2, -999, 999, 0, 1, {1, 0}, {{2, 0}, {1, 0.5}},
                                             {{-99, 99}, {-0.25, 99}, {-99, 1}, {0, 99}}, {0, 0, 0, 0}}};
static const struct kelpie_member members[] = {
    {0.75, 0, 1, 0.5, 1, 0.25, 3, {0, 0, 0, 0}},
    {0.25, 1, 1, 0.5, 1, 0, 0, {1, 10, 100, 1000}},
};
static const double support_vectors[][2] = {{1, 0}};
static const double weights[] = {2};

static const struct kelpie_step steps[] = {
    /* max(-|x0|, x1 - 3) * 2 */
    {kelpie_column, 0, 0}, {kelpie_abs, 0, 0}, {kelpie_negate, 0, 0}, {kelpie_column, 1, 0},
    {kelpie_number, 0, 3}, {kelpie_subtract, 0, 0}, {kelpie_max, 0, 0}, {kelpie_number, 0, 2},
    {kelpie_multiply, 0, 0},
    /* x1^3 / (1 + 1) */
    {kelpie_column, 1, 0}, {kelpie_power, 3, 0}, {kelpie_number, 0, 1}, {kelpie_number, 0, 1},
    {kelpie_add, 0, 0}, {kelpie_divide, 0, 0},
    /* sqrt(x0), without a slope at 0 */
    {kelpie_column, 0, 0}, {kelpie_sqrt, 0, 0},
    /* 1 / x0 / -sign(x0): not finite at 0 */
    {kelpie_number, 0, 1}, {kelpie_column, 0, 0}, {kelpie_divide, 0, 0}, {kelpie_column, 0, 0},
    {kelpie_sign, 0, 0}, {kelpie_negate, 0, 0}, {kelpie_divide, 0, 0},
};
static const short ends[] = {9, 15, 17, 24};
static const short slopes[][2] = {{0, 0}, {0, 1}, {1, 1}, {2, 0}, {3, 0}};
/* Three members that disagree. */
static const struct kelpie_axis doubtful[] = {{0, 3, -10, 10, 2, 9, {1, 0}, {{2, 0}, {1, 0.5}},
                                               {{-99, 99}, {-99, 99}, {-99, 99}, {-99, 99}}, {0, 0, 0, 0}}};
static const struct kelpie_member opinions[] = {
    {0.5, 0, 1, 0.5, 1, 0.25, 3, {0, 0, 0, 0}},
    {0.25, 1, 1, 0.5, 1, 0, 1, {0, 0, 0, 0}},
    {0.25, 1, 1, 0.5, 1, 0, -2, {0, 0, 0, 0}},
};
static const struct kelpie_known known[] = {{0, 3, 0.25, 0.5}};
static const double places[][2] = {{0, 0}, {0, 0}, {6, 0}};
static const double densities[] = {1, 1, 0};
static const struct kelpie_tables tables = {axes,  members, support_vectors, weights, steps,
                                            ends,  slopes,  known,           places,  densities};

static const struct kelpie_tables within = {narrow, members, support_vectors, weights, steps,
                                            ends,   slopes,  known,           places,  densities};

static const struct kelpie_tables disagreeing = {doubtful, opinions, support_vectors, weights,
                                                 steps,    ends,     slopes,          known,
                                                 places,   densities};

static int near(double value, double expected) { return fabs(value - expected) <= 1e-14 * fabs(expected); }

int check(void);
int check(void)
{
  const double at_kink[2] = {0, 2}, nowhere[2] = {0, NAN}, vector[2] = {1.5, -1};
  const double one[1] = {1}, ahead[2] = {1, 0};
  double y[1], jacobian[2], hessian[4], product[2], slope, half_width, novelty;
  /* Terms at the kink: max(-0, -1) * 2 falls to the right, 2^3 / 2, 0, and one that counts 0. */
  if (!(kelpie_term(&tables, 0, at_kink, 0, &slope) == 0 && slope == -2)) return 1;
  if (!(kelpie_term(&tables, 0, at_kink, 1, &slope) == 0 && slope == 0)) return 2;
  if (!(kelpie_term(&tables, 1, at_kink, 1, &slope) == 4 && slope == 6)) return 3;
  if (!(kelpie_term(&tables, 2, at_kink, 0, &slope) == 0 && slope == 0)) return 4;
  if (!(kelpie_term(&tables, 3, at_kink, 0, &slope) == 0 && slope == 0)) return 5;
  /* z of (1.5, -1) is (1, 0), the support vector: 3 + 2 (1 + 0.25) of the first member; the terms
   * are -3, -0.5, sqrt(1.5) and -1/1.5, whose sum leaves the limits: the second member says -10. */
  kelpie_evaluate(&tables, vector, y, jacobian);
  if (!near(y[0], 0.75 * 5.5 - 0.25 * 10)) return 6;
  if (!(jacobian[0] == 0 && jacobian[1] == 0)) return 7;
  kelpie_evaluate(&tables, nowhere, y, jacobian);
  if (!(isnan(y[0]) && isnan(jacobian[0]) && isnan(jacobian[1]))) return 8;
  /* At z = 0 two samples lie close, the third six bandwidths off; at z = (6, 1) it is the only one. */
  kelpie_assess(&tables, (const double[2]){1, 0}, &half_width, &novelty);
  if (!(half_width == 0.25 && novelty == 0)) return 9;
  kelpie_assess(&tables, (const double[2]){4, -4}, &half_width, &novelty);
  if (!near(novelty, 2.0 / 3.0)) return 10;
  kelpie_assess(&tables, (const double[2]){100, 0}, &half_width, &novelty);
  if (novelty != 1) return 11;
  /* 5.5, 1 and -2: the mean is 2.5, the variance of the first two 4.5, g = 4.5. */
  kelpie_evaluate(&disagreeing, vector, y, jacobian);
  if (!near(y[0], 2.5 - 4.5 * 9 / (4.5 * 4.5 + 9 + 9))) return 12;
  /* Within their ranges the terms are -3, -0.25, 1 and 0, and only the first has a slope. */
  kelpie_evaluate(&within, vector, y, jacobian);
  if (!near(y[0], 0.75 * 5.5 + 0.25 * (-3 - 2.5 + 100))) return 13;
  if (!(near(jacobian[0], 0.25 * -2) && jacobian[1] == 0)) return 14;
  /* At the kink of max(-|x0|, x1 - 3), and of x1^3 / 2 at 2: 3 x1. */
  if (kelpie_term_curve(&tables, 0, at_kink, 0, 0) != 0) return 15;
  if (kelpie_term_curve(&tables, 1, at_kink, 1, 1) != 6) return 16;
  if (!near(kelpie_term_curve(&tables, 2, vector, 0, 0), -0.25 / (1.5 * sqrt(1.5)))) return 17;
  /* At its support vector the kernel part bends by -2 gamma weight (s + 32 fine) in z, by W' W in x:
   * {{5, 0.5}, {0.5, 0.25}}. Of the terms in their ranges the first has no bend. */
  kelpie_hessians(&within, vector, hessian, 0, 0, 0);
  if (!near(hessian[0], 0.75 * -18 * 5)) return 18;
  if (!(near(hessian[1], 0.75 * -18 * 0.5) && hessian[2] == hessian[1])) return 19;
  if (!near(hessian[3], 0.75 * -18 * 0.25)) return 20;
  kelpie_hessians(&within, vector, 0, ahead, one, product);
  if (!(product[0] == hessian[0] && product[1] == hessian[1])) return 21;
  /* g = 4.5 bends by 0.5 of that, the mean too, and d2 = 2 * 4.5 by 2 * 2 * 1.5 (0.5 times that), as
   * none has a slope; shrunk is g d2 / 38.25. */
  kelpie_hessians(&disagreeing, vector, hessian, 0, 0, 0);
  return near(hessian[0], 0.5 * -18 * 5 * (1 - 9 * (38.25 - 40.5) / (38.25 * 38.25) -
                                           4.5 * 29.25 / (38.25 * 38.25) * 4 / 0.75 * 1.5))
             ? 0
             : 22;
}
