// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

// The parts of an exported model that hold its name. $NAME, $REAL, $INPUTS, $TARGETS, $ACTUATORS
// and $KEPT are replaced by model_c.cpp; everything else stands in model_eval.inc.
namespace kelpie::format {

/// model_eval.inc, model_curve.inc and model_block.inc, embedded by cmake/PageAssets.cmake.
extern const std::string_view kModelEvaluator;
extern const std::string_view kModelCurve;
extern const std::string_view kModelBlock;

inline constexpr std::string_view kLiveNote =
    R"( * The numbers are those of the latest publication in the block, which `kelpie live` renews. Where
 * there is none, y and jacobian are NaN, $NAME_renew() is 0, and $NAME_problem() tells why.
)";

inline constexpr std::string_view kLivePrototypes = R"(
/* The block at another path than the one that this file was written with; before the first call of
 * any function. 0: done. */
int $NAME_open(const char *file);
/* The block in memory of this process, by the same rule. */
int $NAME_attach(const void *memory, unsigned long long bytes);
/* Takes over the latest publication for the calling thread, as every other function does too.
 * Returns its number, 1, 2, 3 and so on; 0: there is none. */
unsigned long long $NAME_renew(void);
/* 1: the calling thread keeps its numbers, as an optimiser's iterations want; 0: no longer. */
void $NAME_hold(int on);
/* Why the last call of this thread had no numbers; "" where it had. */
const char *$NAME_problem(void);
/* The least and the greatest value of every input among the samples that the learner knows;
 * infinite: not known. 0: done. */
int $NAME_bounds(double low[$INPUTS], double high[$INPUTS]);
/* Predictions belong to the commands that the log has so many seconds later. */
double $NAME_shift(void);
)";

/// The functions of an exported model whose numbers are in a block.
inline constexpr std::string_view kLiveFunctions = R"(
static const struct kelpie_tables *$NAME_newest(void)
{
  struct kelpie_numbers *const own = kelpie_newest();
$POINT  return own ? &own->tables : 0;
}

static void $NAME_unknown(double *values, int count)
{
  int k;
  for (k = 0; k < count; ++k) {
    values[k] = NAN;
  }
}

int $NAME_open(const char *file) { return kelpie_open(file); }

int $NAME_attach(const void *memory, unsigned long long bytes)
{
  return kelpie_attach(memory, (size_t)bytes);
}

unsigned long long $NAME_renew(void) { return $NAME_newest() ? kelpie_own()->number : 0; }

void $NAME_hold(int on) { kelpie_own()->held = on; }

const char *$NAME_problem(void) 
{
  const char *const problem = kelpie_own()->problem;
  return problem ? problem : "";
}

int $NAME_bounds(double low[$INPUTS], double high[$INPUTS])
{
  const struct kelpie_numbers *const own = kelpie_newest();
  int k;
  for (k = 0; k < $INPUTS; ++k) {
    low[k] = own ? own->bounds[2 * k] : -HUGE_VAL;
    high[k] = own ? own->bounds[2 * k + 1] : HUGE_VAL;
  }
  return own == 0;
}

double $NAME_shift(void)
{
  const struct kelpie_numbers *const own = kelpie_newest();
  return own ? own->shift : 0;
}

void $NAME_predict(const double x[$INPUTS], double y[$TARGETS])
{
  const struct kelpie_tables *const tables = $NAME_newest();
  if (tables) {
    kelpie_evaluate(tables, x, y, 0);
  } else {
    $NAME_unknown(y, $TARGETS);
  }
}

void $NAME_predict_with_jacobian(const double x[$INPUTS], double y[$TARGETS],
                                double jacobian[$TARGETS * $INPUTS])
{
  const struct kelpie_tables *const tables = $NAME_newest();
  if (tables) {
    kelpie_evaluate(tables, x, y, jacobian);
  } else {
    $NAME_unknown(y, $TARGETS);
    $NAME_unknown(jacobian, $TARGETS * $INPUTS);
  }
}
)";

inline constexpr std::string_view kLiveAssess = R"(
void $NAME_assess(const double x[$INPUTS], double y[$TARGETS], double half_width[$TARGETS],
                  double novelty[$TARGETS])
{
  const struct kelpie_tables *const tables = $NAME_newest();
  if (tables) {
    kelpie_evaluate(tables, x, y, 0);
    kelpie_assess(tables, x, half_width, novelty);
  } else {
    $NAME_unknown(y, $TARGETS);
    $NAME_unknown(half_width, $TARGETS);
    $NAME_unknown(novelty, $TARGETS);
  }
}
)";

inline constexpr std::string_view kLiveHessian = R"(
void $NAME_hessian(const double x[$INPUTS], double hessian[$TARGETS * $INPUTS * $INPUTS])
{
  const struct kelpie_tables *const tables = $NAME_newest();
  if (tables) {
    kelpie_hessians(tables, x, hessian, 0, 0, 0);
  } else {
    $NAME_unknown(hessian, $TARGETS * $INPUTS * $INPUTS);
  }
}

void $NAME_hessian_vector(const double x[$INPUTS], const double v[$INPUTS],
                          const double lambda[$TARGETS], double product[$INPUTS])
{
  const struct kelpie_tables *const tables = $NAME_newest();
  if (tables) {
    kelpie_hessians(tables, x, 0, v, lambda, product);
  } else {
    $NAME_unknown(product, $INPUTS);
  }
}
)";

/// The numbers of an input's actuator in the block; without numbers, none.
inline constexpr std::string_view kLiveActuator = R"(
static struct $NAME_actuator $NAME_actuator_of(int input)
{
  struct $NAME_actuator actuator = {0, 0, 0, 1, 0, 0, 0};
  const struct kelpie_numbers *const own = kelpie_newest();
  actuator.input = input;
  if (own) {
    const double *const numbers = own->actuators + kelpie_actuator_numbers * input;
    actuator.neutral = numbers[0];
    actuator.dead_band = numbers[1];
    actuator.astern = numbers[2];
    actuator.lag = numbers[3];
    actuator.rate = numbers[4];
    actuator.delay = numbers[5];
  }
  return actuator;
}
)";

inline constexpr std::string_view kAssessNote =
    R"( * $NAME_assess also gives half the width of the interval around y[i] at the end of learning
 * (infinite: no interval), and the novelty of x from 0 to 1 (NaN: not known).
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
)";

inline constexpr std::string_view kAssessPrototype =
    R"(void $NAME_assess(const $REAL x[$INPUTS], $REAL y[$TARGETS], $REAL half_width[$TARGETS],
                  $REAL novelty[$TARGETS]);
)";

inline constexpr std::string_view kHessianNote =
    R"( * $NAME_hessian gives the second derivatives, hessian[(i * $INPUTS + j) * $INPUTS + k] of y[i] by
 * x[j] and x[k]; $NAME_hessian_vector gives their product with a vector, summed over all y[i] with
 * weights lambda[i]. Either call has the exponentials of one Jacobian.
)";

inline constexpr std::string_view kHessianPrototypes =
    R"(void $NAME_hessian(const $REAL x[$INPUTS], $REAL hessian[$TARGETS * $INPUTS * $INPUTS]);
void $NAME_hessian_vector(const $REAL x[$INPUTS], const $REAL v[$INPUTS],
                          const $REAL lambda[$TARGETS], $REAL product[$INPUTS]);
)";

inline constexpr std::string_view kActuatorNote =
    R"( * Actuators: predictions are of what actuators make of commands. Per vehicle:
 *
 *   struct $NAME_actuators state;
 *   $NAME_actuators_rest(&state);          before the first command
 *   $NAME_actuators_step(&state, dt, x);   each dt seconds: commands in x become their effects
 *
)";

inline constexpr std::string_view kActuatorPrototypes = R"(
/* State of the actuators. */
struct $NAME_actuators {
  $REAL value[$ACTUATORS];         /* effects of the last step, which a controller may read */
  $REAL effect[$ACTUATORS][$KEPT]; /* wanted by the commands given, the newest first */
  $REAL age[$ACTUATORS][$KEPT];    /* of these [s] */
  int kept[$ACTUATORS];
};

void $NAME_actuators_rest(struct $NAME_actuators *state);
void $NAME_actuators_step(struct $NAME_actuators *state, $REAL dt, $REAL x[$INPUTS]);
)";

/// kelpie::ActuatorState in C, with the ages of commands in place of times, so that floats do. Of a
/// delay at most kDelaySteps + some commands are kept, however fast the steps are.
inline constexpr int kDelaySteps = 64;
inline constexpr std::string_view kActuators = R"(
static $REAL $NAME_shaped(const struct $NAME_actuator *actuator, $REAL command)
{
  const $REAL off = command - actuator->neutral;
  const $REAL size = (off < 0 ? -off : off) - actuator->dead_band;
  return size <= 0 ? 0 : off < 0 ? -size * actuator->astern : size;
}

/* The newest takes the place of the one before where they come faster than a delay needs. */
static void $NAME_keep($REAL *effect, $REAL *age, int *kept, int most, $REAL apart, $REAL newest)
{
  int k = *kept > 1 && age[1] - age[0] < apart ? 0 : *kept < most ? (*kept)++ : most - 1;
  for (; k > 0; --k) {
    effect[k] = effect[k - 1];
    age[k] = age[k - 1];
  }
  effect[0] = newest;
  age[0] = 0;
}

/* In straight lines between the commands; the oldest before all of them. */
static $REAL $NAME_wanted(const $REAL *effect, const $REAL *age, int kept, $REAL at)
{
  int k = 0;
  while (k + 1 < kept && age[k] < at) {
    ++k;
  }
  return k == 0 || age[k] <= at
             ? effect[k]
             : effect[k] + (effect[k - 1] - effect[k]) * (age[k] - at) / (age[k] - age[k - 1]);
}

void $NAME_actuators_rest(struct $NAME_actuators *state)
{
  int i;
  for (i = 0; i < $ACTUATORS; ++i) {
    state->kept[i] = 0;
  }
}

void $NAME_actuators_step(struct $NAME_actuators *state, $REAL dt, $REAL x[$INPUTS])
{
  int i, k;
  for (i = 0; i < $ACTUATORS; ++i) {
    const struct $NAME_actuator row = $ROW;
    const struct $NAME_actuator *actuator = &row;
    const $REAL effect = $NAME_shaped(actuator, x[actuator->input]);
    const int begins = state->kept[i] == 0;
    for (k = 0; k < state->kept[i]; ++k) {
      state->age[i][k] += dt;
    }
    $NAME_keep(state->effect[i], state->age[i], &state->kept[i],
               actuator->delay > 0 ? $KEPT : 2, actuator->delay / $DELAY_STEPS, effect);
    if (begins || !(actuator->lag > 0 || actuator->rate > 0 || actuator->delay > 0)) {
      state->value[i] = effect;
    } else {
      const $REAL most = actuator->rate * dt;
      $REAL step = $NAME_wanted(state->effect[i], state->age[i], state->kept[i],
                                actuator->delay + dt / 2) - state->value[i];
      if (actuator->lag > 0) {
        step *= -KELPIE_EXPM1(-dt / actuator->lag);
      }
      state->value[i] += actuator->rate > 0 && step > most    ? most
                         : actuator->rate > 0 && step < -most ? -most
                                                              : step;
    }
    x[actuator->input] = state->value[i];
  }
}
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

inline constexpr std::string_view kFunctions = R"(
void $NAME_predict(const $REAL x[$INPUTS], $REAL y[$TARGETS])
{
  kelpie_evaluate(&$NAME_tables, x, y, 0);
}

void $NAME_predict_with_jacobian(const $REAL x[$INPUTS], $REAL y[$TARGETS],
                                $REAL jacobian[$TARGETS * $INPUTS])
{
  kelpie_evaluate(&$NAME_tables, x, y, jacobian);
}
)";

inline constexpr std::string_view kAssess = R"(
void $NAME_assess(const $REAL x[$INPUTS], $REAL y[$TARGETS], $REAL half_width[$TARGETS],
                  $REAL novelty[$TARGETS])
{
  kelpie_evaluate(&$NAME_tables, x, y, 0);
  kelpie_assess(&$NAME_tables, x, half_width, novelty);
}
)";

inline constexpr std::string_view kHessian = R"(
void $NAME_hessian(const $REAL x[$INPUTS], $REAL hessian[$TARGETS * $INPUTS * $INPUTS])
{
  kelpie_hessians(&$NAME_tables, x, hessian, 0, 0, 0);
}

void $NAME_hessian_vector(const $REAL x[$INPUTS], const $REAL v[$INPUTS],
                          const $REAL lambda[$TARGETS], $REAL product[$INPUTS])
{
  kelpie_hessians(&$NAME_tables, x, 0, v, lambda, product);
}
)";

/// The model as a function of one input x and one output y, by the convention of generated C that
/// CasADi's external() and acados call (howto/controller.md), with its Jacobian and the Jacobian of
/// that. Dense arrays have the sparsity {rows, columns, 1}; outputs that a derivative is given but
/// doesn't need have no entries, {rows, columns, 0, ...}. From these two functions CasADi makes
/// derivatives of either mode, one call for all directions; an adj1_ function would be called once
/// for each direction instead.
inline constexpr std::string_view kCasadi = R"(
/* For CasADi: external("$NAME", "./model.so"). acados wants -Dcasadi_int=int. */
#ifndef casadi_int
#define casadi_int long long int
#endif

static const casadi_int $NAME_dense_x[3] = {$INPUTS, 1, 1};
static const casadi_int $NAME_dense_y[3] = {$TARGETS, 1, 1};
static const casadi_int $NAME_dense_jacobian[3] = {$TARGETS, $INPUTS, 1};
static const casadi_int $NAME_dense_hessian[3] = {$TARGETS * $INPUTS, $INPUTS, 1};
static const casadi_int $NAME_unused_y[4] = {$TARGETS, 1, 0, 0};
static const casadi_int $NAME_unused_jacobian[$INPUTS + 3] = {$TARGETS, $INPUTS, 0};
static const casadi_int $NAME_none_by_y[$TARGETS + 3] = {$TARGETS * $INPUTS, $TARGETS, 0};

/* A missing argument counts as zeros; an unwanted result is left out. */
static const double *$NAME_given(const double **arg, double *zeros)
{
  int k;
  for (k = 0; k < $INPUTS; ++k) {
    zeros[k] = 0;
  }
  return arg[0] ? arg[0] : zeros;
}

int $NAME(const double **arg, double **res, casadi_int *iw, double *w, int mem);
int $NAME(const double **arg, double **res, casadi_int *iw, double *w, int mem)
{
  double zeros[$INPUTS];
  (void)iw;
  (void)w;
  (void)mem;
  if (res[0]) {
    $NAME_predict($NAME_given(arg, zeros), res[0]);
  }
  return $FAILED;
}

/* Arguments x and y, result dy/dx by columns. */
int jac_$NAME(const double **arg, double **res, casadi_int *iw, double *w, int mem);
int jac_$NAME(const double **arg, double **res, casadi_int *iw, double *w, int mem)
{
  double zeros[$INPUTS];
  double y[$TARGETS];
  double rows[$TARGETS * $INPUTS];
  int i, k;
  (void)iw;
  (void)w;
  (void)mem;
  if (res[0]) {
    $NAME_predict_with_jacobian($NAME_given(arg, zeros), y, rows);
    for (k = 0; k < $INPUTS; ++k) {
      for (i = 0; i < $TARGETS; ++i) {
        res[0][k * $TARGETS + i] = rows[i * $INPUTS + k];
      }
    }
  }
  return $FAILED;
}

/* Arguments x, y and dy/dx; results the derivatives of dy/dx, taken by columns, by x, and by y: none. */
int jac_jac_$NAME(const double **arg, double **res, casadi_int *iw, double *w, int mem);
int jac_jac_$NAME(const double **arg, double **res, casadi_int *iw, double *w, int mem)
{
  double zeros[$INPUTS];
  double hessian[$TARGETS * $INPUTS * $INPUTS];
  int i, j, k;
  (void)iw;
  (void)w;
  (void)mem;
  if (res[0]) {
    $NAME_hessian($NAME_given(arg, zeros), hessian);
    for (k = 0; k < $INPUTS; ++k) {
      for (j = 0; j < $INPUTS; ++j) {
        for (i = 0; i < $TARGETS; ++i) {
          res[0][(k * $INPUTS + j) * $TARGETS + i] = hessian[(i * $INPUTS + j) * $INPUTS + k];
        }
      }
    }
  }
  return $FAILED;
}
)";

/// What CasADi asks of a function $F before its first call: $ARGUMENTS and $RESULTS, with names and
/// shapes.
inline constexpr std::string_view kCasadiShape = R"(
void $F_incref(void);
void $F_decref(void);
casadi_int $F_n_in(void);
casadi_int $F_n_out(void);
const char *$F_name_in(casadi_int i);
const char *$F_name_out(casadi_int i);
const casadi_int *$F_sparsity_in(casadi_int i);
const casadi_int *$F_sparsity_out(casadi_int i);
int $F_work(casadi_int *sz_arg, casadi_int *sz_res, casadi_int *sz_iw, casadi_int *sz_w);

void $F_incref(void) {}
void $F_decref(void) {}
casadi_int $F_n_in(void) { return $ARGUMENTS; }
casadi_int $F_n_out(void) { return $RESULTS; }

const char *$F_name_in(casadi_int i)
{
  static const char *const names[] = {"x", "out_y", "out_jac_y_x"};
  return i >= 0 && i < $ARGUMENTS ? names[i] : 0;
}

const char *$F_name_out(casadi_int i)
{
  static const char *const names[] = {"$RESULT_NAME", "$RESULT_NONE"};
  return i >= 0 && i < $RESULTS ? names[i] : 0;
}

const casadi_int *$F_sparsity_in(casadi_int i)
{
  return i < 0 || i >= $ARGUMENTS ? 0
         : i == 0                 ? $NAME_dense_x
         : i == 1                 ? $NAME_unused_y
                                  : $NAME_unused_jacobian;
}

const casadi_int *$F_sparsity_out(casadi_int i)
{
  return i < 0 || i >= $RESULTS ? 0 : i == 0 ? $NAME_dense_$SHAPE : $NAME_none_by_y;
}

int $F_work(casadi_int *sz_arg, casadi_int *sz_res, casadi_int *sz_iw, casadi_int *sz_w)
{
  if (sz_arg) *sz_arg = $ARGUMENTS;
  if (sz_res) *sz_res = $RESULTS;
  if (sz_iw) *sz_iw = 0;
  if (sz_w) *sz_w = 0;
  return 0;
}
)";

}  // namespace kelpie::format
