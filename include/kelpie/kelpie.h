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
 * kelpie::DynamicsModel for C, and for whatever calls C. A program in C links the library
 * kelpie, Highway and the standard library of C++ (docs/install.md).
 *
 * Names are UTF-8, times in seconds, all other numbers in the units of the log. Functions that can
 * fail return a kelpie_status, and leave what they were to write as it was where that isn't
 * KELPIE_OK; kelpie_last_error() says why. Nothing is thrown across this interface. A null pointer
 * where none may be is KELPIE_BAD_INPUT, and so is a wrong number of inputs or targets. Data are no
 * error: a sample with a number that isn't finite is turned away (kelpie_verdict), and where a
 * number of x isn't, a prediction is NaN with a novelty of 1.
 *
 * Threads: several may predict with one model at a time; an update needs the model for itself.
 * Where it hasn't, the call that came in between is KELPIE_BAD_INPUT. Only kelpie_free(), names and
 * counts aren't watched.
 */

/** How a call ended; the numbers are those of the commands' exit codes. */
typedef enum kelpie_status {
  KELPIE_OK = 0,
  KELPIE_FAILED = 1,   /**< not the caller's fault: out of memory */
  KELPIE_BAD_INPUT = 2 /**< the message names what is wrong and what would be right */
} kelpie_status;

/** Why the last call of this thread that failed did so; "" before the first. Valid until the next
 *  call that fails in this thread. */
const char* kelpie_last_error(void);

/** "0.2.0": of the library that is linked. */
const char* kelpie_version(void);

/** A model of all axes of one vehicle, that learns. */
typedef struct kelpie_model kelpie_model;

/** The most inputs and targets of a model. */
enum { KELPIE_MOST_INPUTS = 64, KELPIE_MOST_TARGETS = 64 };

/**
 * Makes a model of the named columns; kelpie_free() ends it. The names tell which inputs are
 * velocities: docs/settings.md, `states`. `settings` has a line `name = value` for every setting
 * that isn't to have its default, with a value for all targets or one per target separated by
 * commas; the line `preset = name` says where the others start from. It may be null. Allocates all
 * that the model ever needs but what update() of kelpie::DynamicsModel names.
 */
kelpie_status kelpie_create(const char* const* inputs, size_t input_count,
                            const char* const* targets, size_t target_count, const char* settings,
                            kelpie_model** model);

/** Ends a model; null does nothing. */
void kelpie_free(kelpie_model* model);

size_t kelpie_input_count(const kelpie_model* model);  /**< Requires a model. */
size_t kelpie_target_count(const kelpie_model* model); /**< Requires a model. */

/** The name of a column, counted from 0; null where there are fewer. Valid as long as the model. */
const char* kelpie_input_name(const kelpie_model* model, size_t i);
const char* kelpie_target_name(const kelpie_model* model, size_t i); /**< The same of a target. */

/** What became of a sample when it came. */
typedef enum kelpie_verdict {
  KELPIE_ACCEPTED = 0,    /**< learned */
  KELPIE_EXPLAINED = 1,   /**< turned away: the model says it already */
  KELPIE_DUPLICATE = 2,   /**< turned away: there is a sample like it */
  KELPIE_INVALID = 3,     /**< turned away: a number that isn't finite, or beyond ±1e50 */
  KELPIE_HELD_BACK = 4,   /**< learned as soon as the scale of the data is known */
  KELPIE_IMPLAUSIBLE = 5, /**< turned away: too far from all samples before to be believed */
  KELPIE_CROWDED_OUT = 6  /**< turned away: what is allowed went on earlier samples */
} kelpie_verdict;

/** What one axis made of a sample; more of it in kelpie/online/decision.hpp. */
typedef struct kelpie_decision {
  double predicted; /**< what the model said before it learned the sample */
  double lower;     /**< the interval around it that was in force then; infinite where nothing */
  double upper;     /**< was promised */
  double changed_since; /**< when errors began to grow, where `changed` */
  int64_t recalled;     /**< the number of the past model taken up, or 0 */
  int32_t verdict;      /**< a kelpie_verdict */
  int32_t had_model;    /**< whether a model was in service; else `predicted` is a mean */
  int32_t served;       /**< whether the model trained now went into service */
  int32_t changed;      /**< whether the vehicle was found to have changed */
} kelpie_decision;

/**
 * Learns one sample. Bad data are no error: the decision says what became of them. Requires a value
 * for every input and every target. A time that goes back stops the clock of the model for that
 * step, no more. `decisions`: null, or room for
 * one per target. Cost and allocation are those of kelpie::DynamicsModel.
 */
kelpie_status kelpie_update(kelpie_model* model, const double* x, size_t inputs, const double* y,
                            size_t targets, double t, kelpie_decision* decisions);

/** 1 as soon as every axis has a model in service, else 0. Requires a model. */
int kelpie_ready(const kelpie_model* model);

/** Predicts all targets at x. Before there is a model, the means so far. Allocates nothing. */
kelpie_status kelpie_predict(const kelpie_model* model, const double* x, size_t inputs, double* y,
                             size_t targets);

/** The same with the derivatives: ∂y_i/∂x_j at jacobian[i · inputs + j], of targets · inputs
 *  values. Allocates nothing. */
kelpie_status kelpie_predict_with_jacobian(const kelpie_model* model, const double* x,
                                           size_t inputs, double* y, size_t targets,
                                           double* jacobian);

/** A prediction with what is known of its uncertainty (docs/uncertainty.md, disturbance.md). */
typedef struct kelpie_prediction {
  double value;
  double lower;   /**< the interval that holds the truth with the promised share; infinite where */
  double upper;   /**< nothing is promised */
  double novelty; /**< how new the place is, 0 to 1; NaN where the learner can't tell */
  double disturbance;     /**< what the disturbance now present adds to `value` */
  double corrected_lower; /**< the interval around the sum */
  double corrected_upper;
} kelpie_prediction;

/** Predictions of all targets at x, of a sample that comes `ahead_s` after the last one learned
 *  (0: the next). Allocates nothing. */
kelpie_status kelpie_assess(const kelpie_model* model, const double* x, size_t inputs,
                            kelpie_prediction* y, size_t targets, double ahead_s);

/** The whole model as bytes: names, settings, all that was learned, a checksum. kelpie_free_bytes()
 *  frees them. Allocates. */
kelpie_status kelpie_save(const kelpie_model* model, unsigned char** bytes, size_t* size);

void kelpie_free_bytes(unsigned char* bytes); /**< Frees what kelpie_save() gave; null is fine. */

/** The model that was saved, by this version of the library: it goes on to the last bit as if it
 *  had never stopped (on a machine with other vector instructions, to rounding). Bytes that are cut
 *  short, damaged or of another version are KELPIE_BAD_INPUT. */
kelpie_status kelpie_load(const unsigned char* bytes, size_t size, kelpie_model** model);

#ifdef __cplusplus
}
#endif

#endif
