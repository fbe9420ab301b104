/* SPDX-License-Identifier: Apache-2.0 */
#ifndef KELPIE_KELPIE_H
#define KELPIE_KELPIE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * @file
 * kelpie::DynamicsModel for C and for languages that call C. A program in C links the library
 * kelpie, Highway and the standard library of C++ (docs/install.md).
 *
 * Names are UTF-8, times in seconds, all other numbers in the units of the log. Functions that can
 * fail return a kelpie_status; without KELPIE_OK, outputs keep their values and
 * kelpie_last_error() names the cause. No exception crosses this interface. A null pointer in place
 * of a required value and a wrong number of inputs or targets are KELPIE_BAD_INPUT. Bad data are no
 * error: a sample with a number that isn't finite is rejected (kelpie_verdict); a prediction at
 * such an x is NaN with a novelty of 1.
 *
 * Threads: several threads may predict with one model at a time; an update needs the model alone,
 * and any other call during an update is KELPIE_BAD_INPUT. Only kelpie_free(), names and counts are
 * not guarded.
 */

/** How a call ended; the numbers equal the exit codes of the commands. */
typedef enum kelpie_status {
  KELPIE_OK = 0,
  KELPIE_FAILED = 1,   /**< not the caller's fault: out of memory */
  KELPIE_BAD_INPUT = 2 /**< the message names what is wrong and what would be right */
} kelpie_status;

/** The cause of the last failed call of this thread; "" before the first failure. Valid until the
 *  next failed call of this thread. */
const char* kelpie_last_error(void);

/** The version of the linked library, such as "0.2.0". */
const char* kelpie_version(void);

/** A learning model of all axes of one vehicle. */
typedef struct kelpie_model kelpie_model;

/** The most inputs and targets of a model. */
enum { KELPIE_MOST_INPUTS = 64, KELPIE_MOST_TARGETS = 64 };

/**
 * Makes a model of the named columns, to be freed by kelpie_free(). Velocities are recognised by
 * their names: docs/settings.md, `states`. `settings` has a line `name = value` for every setting
 * that differs from its default, with one value for all targets, or values for each target
 * separated by commas; the line `preset = name` gives the defaults. `settings` may be null.
 * Allocates all memory of the model, except as update() of kelpie::DynamicsModel says.
 */
kelpie_status kelpie_create(const char* const* inputs, size_t input_count,
                            const char* const* targets, size_t target_count, const char* settings,
                            kelpie_model** model);

/** Frees a model; null does nothing. */
void kelpie_free(kelpie_model* model);

size_t kelpie_input_count(const kelpie_model* model);  /**< Requires a model. */
size_t kelpie_target_count(const kelpie_model* model); /**< Requires a model. */

/** The name of a column, counted from 0; null beyond the last. Valid as long as the model. */
const char* kelpie_input_name(const kelpie_model* model, size_t i);
const char* kelpie_target_name(const kelpie_model* model, size_t i); /**< Of a target. */

/** The outcome of a sample. */
typedef enum kelpie_verdict {
  KELPIE_ACCEPTED = 0,    /**< learned */
  KELPIE_EXPLAINED = 1,   /**< rejected: the model already predicts the target */
  KELPIE_DUPLICATE = 2,   /**< rejected: equal to a sample in the buffer */
  KELPIE_INVALID = 3,     /**< rejected: a number that isn't finite, or beyond ±1e50 */
  KELPIE_HELD_BACK = 4,   /**< learned as soon as the scale of the data is known */
  KELPIE_IMPLAUSIBLE = 5, /**< rejected: too far from all earlier samples */
  KELPIE_CROWDED_OUT = 6  /**< rejected: the budget was spent on earlier samples */
} kelpie_verdict;

/** The outcome of a sample for one axis; kelpie::Decision has further fields. */
typedef struct kelpie_decision {
  double predicted; /**< the prediction before the sample was learned */
  double lower;     /**< the interval around the prediction; infinite without a promised share */
  double upper;     /**< the upper end */
  double changed_since; /**< with `changed`: when errors began to grow */
  int64_t recalled;     /**< the number of the recalled past model, or 0 */
  int32_t verdict;      /**< a kelpie_verdict */
  int32_t had_model;    /**< whether a model was in service; without, `predicted` is a mean */
  int32_t served;       /**< whether the newly trained model went into service */
  int32_t changed;      /**< whether a change of the vehicle was found */
} kelpie_decision;

/**
 * Learns one sample. Bad data are no error: the decision reports the outcome. Requires a value for
 * every input and every target. Where time steps back, the clock of the model stands still for this
 * step. `decisions`: null, or room for one decision per target. Cost and allocation as of
 * kelpie::DynamicsModel.
 */
kelpie_status kelpie_update(kelpie_model* model, const double* x, size_t inputs, const double* y,
                            size_t targets, double t, kelpie_decision* decisions);

/** 1 once every axis has a model in service, before 0. Requires a model. */
int kelpie_ready(const kelpie_model* model);

/** Predicts all targets at x; before a model is in service, their means. Allocates nothing. */
kelpie_status kelpie_predict(const kelpie_model* model, const double* x, size_t inputs, double* y,
                             size_t targets);

/** Predictions with derivatives: ∂y_i/∂x_j at jacobian[i · inputs + j], of targets · inputs
 *  values. Allocates nothing. */
kelpie_status kelpie_predict_with_jacobian(const kelpie_model* model, const double* x,
                                           size_t inputs, double* y, size_t targets,
                                           double* jacobian);

/** A prediction with its uncertainty (docs/uncertainty.md, docs/disturbance.md). */
typedef struct kelpie_prediction {
  double value;
  double lower;       /**< the interval that holds the truth with the promised share; infinite */
  double upper;       /**< without a promised share */
  double novelty;     /**< novelty of x against the buffer, 0 to 1; NaN: unknown */
  double disturbance; /**< the present disturbance, to be added to `value` */
  double corrected_lower; /**< the interval around value + disturbance */
  double corrected_upper; /**< the upper end */
} kelpie_prediction;

/** Predictions of all targets at x, for a sample `ahead_s` [s] after the last learned sample (0:
 *  the next). Allocates nothing. */
kelpie_status kelpie_assess(const kelpie_model* model, const double* x, size_t inputs,
                            kelpie_prediction* y, size_t targets, double ahead_s);

/** The whole model as bytes: names, settings, learned state, checksum; to be freed by
 *  kelpie_free_bytes(). Allocates. */
kelpie_status kelpie_save(const kelpie_model* model, unsigned char** bytes, size_t* size);

void kelpie_free_bytes(unsigned char* bytes); /**< Frees bytes of kelpie_save(), or null. */

/** The model saved by this version of the library; continues to the last bit as if never stopped
 *  (to rounding on a machine with other vector instructions). Bytes that are cut short, damaged or
 *  of another version are KELPIE_BAD_INPUT. */
kelpie_status kelpie_load(const unsigned char* bytes, size_t size, kelpie_model** model);

#ifdef __cplusplus
}
#endif

#endif
