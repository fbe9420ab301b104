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
 * kelpie::DynamicsModel, SharedModel and TrainedModel for C and for languages that call C. A
 * program in C links the library kelpie, Highway and the library of C++ (howto/install.md).
 *
 * Names are UTF-8, times in seconds, all other numbers in the units of the log. Functions that can
 * fail return a kelpie_status; without KELPIE_OK, outputs keep their values and
 * kelpie_last_error() names the cause. No exception crosses this interface. A null pointer in place
 * of a required value and a wrong number of inputs or targets are KELPIE_BAD_INPUT. Bad data are no
 * error: a sample with a number that isn't finite is rejected (kelpie_verdict); a prediction at
 * such an x is NaN with a novelty of 1.
 *
 * Threads: several threads may predict with one model at a time; an update needs the model alone,
 * and any other call during an update is KELPIE_BAD_INPUT. With a kelpie_shared one thread learns
 * while others predict. Not guarded are functions that free, share or create, names, counts
 * and kelpie_ready().
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

/** The version of the linked library, such as "2.0.0". */
const char* kelpie_version(void);

/** A learning model of all axes of one vehicle. */
typedef struct kelpie_model kelpie_model;

/** The most inputs and targets of a model. */
enum { KELPIE_MOST_INPUTS = 64, KELPIE_MOST_TARGETS = 64 };

/**
 * Makes a model of the named columns, to be freed by kelpie_free(). Velocities are recognised by
 * their names: reference/settings.md, `states`. `settings` has lines `name = value` for settings
 * that differ from their defaults, with one value for all targets, or values for each target
 * separated by commas; the line `preset = name` gives the defaults. `settings` may be null.
 * Two inputs or two targets of one name are KELPIE_BAD_INPUT. Allocates all memory of the model,
 * except as update() of kelpie::DynamicsModel says.
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
  double predicted; /**< the prediction before the sample was learned; NaN: invalid */
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

/** A prediction with its uncertainty (docs/method/uncertainty.md). */
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

/* Changes of the vehicle with their causes (docs/howto/diagnosis.md) */

/** A possible cause of a change, with one number as its size. */
typedef enum kelpie_cause_kind {
  KELPIE_THRUSTER = 0,     /**< loss of thrust; size: share of the nominal thrust, 1: unchanged */
  KELPIE_DRAG = 1,         /**< damping of a target; size: factor on the damping */
  KELPIE_LOAD = 2,         /**< carried or dropped; size: factor on the inertia along x */
  KELPIE_FORCE = 3,        /**< constant in the body; size: acceleration of a target, in its unit */
  KELPIE_SENSOR_SCALE = 4, /**< scale error of a velocity; size: reading over truth */
  KELPIE_SENSOR_BIAS = 5,  /**< offset of a velocity; size: in its unit */
  KELPIE_FROZEN = 6,       /**< constant reading of a velocity; size: the reading */
  KELPIE_ALL_THRUSTERS = 7 /**< all thrusters by one factor; size: share of the thrust before */
} kelpie_cause_kind;

/** The state of the explanation of a change. */
typedef enum kelpie_finding_state {
  KELPIE_LOOKING = 0,    /**< a change is certain, its cause is not known yet */
  KELPIE_NAMED = 1,      /**< one cause explains the change, or two causes together */
  KELPIE_AMBIGUOUS = 2,  /**< two candidates explain the change nearly as well */
  KELPIE_UNEXPLAINED = 3 /**< no known cause explains the change */
} kelpie_finding_state;

/** A cause with a 90 % interval of its size. */
typedef struct kelpie_cause {
  int32_t kind;  /**< a kelpie_cause_kind */
  int32_t place; /**< number of the input (thruster, sensor) or target (drag, force); load: 0 */
  double size;   /**< best estimate */
  double lower;  /**< lower end of the interval */
  double upper;  /**< upper end */
} kelpie_cause;

/** A change of the vehicle and its explanation; times as given to kelpie_update() [s]. */
typedef struct kelpie_finding {
  double since_s;         /**< when the change began */
  double found_s;         /**< when the change was detected */
  double told_s;          /**< when `state` changed last */
  int32_t state;          /**< a kelpie_finding_state */
  int32_t settled;        /**< 1: the explanation is final */
  int32_t count;          /**< causes: 1 or 2; 0 without a name */
  int32_t reserved;       /**< 0 */
  kelpie_cause causes[2]; /**< the first `count` are valid */
  kelpie_cause rival;     /**< of an ambiguous change: the second candidate */
} kelpie_finding;

/** The most findings that a model keeps. */
enum { KELPIE_MOST_FINDINGS = 64 };

/** The last findings, the oldest first: writes the first `room` of them, and how many there are to
 *  `count`. None where the model knows no equations of motion (howto/diagnosis.md). `findings` may
 * be null without room. Allocates. */
kelpie_status kelpie_findings(const kelpie_model* model, kelpie_finding* findings, size_t room,
                              size_t* count);

/** A finding in words, such as "th2 gives 48 % of its thrust (41 to 55 %)", cut to `size` bytes
 * with the final 0. `i` counts the findings from 0. Allocates. */
kelpie_status kelpie_finding_text(const kelpie_model* model, size_t i, char* text, size_t size);

/* A model that one thread teaches while others predict (kelpie::SharedModel) */

/** A model and its published snapshots. */
typedef struct kelpie_shared kelpie_shared;

/** Takes over a model: from KELPIE_OK on, `model` is freed with the result, by
 *  kelpie_free_shared(). Allocates all memory. */
kelpie_status kelpie_share(kelpie_model* model, kelpie_shared** shared);
void kelpie_free_shared(kelpie_shared* shared); /**< Frees model and snapshots; null: nothing. */

/** The model within, for the teaching thread between two updates: names, kelpie_save(),
 *  kelpie_findings(). Requires a shared model. */
const kelpie_model* kelpie_shared_model(const kelpie_shared* shared);

/** kelpie_update(), then a new snapshot. For one thread at a time. */
kelpie_status kelpie_shared_update(kelpie_shared* shared, const double* x, size_t inputs,
                                   const double* y, size_t targets, double t,
                                   kelpie_decision* decisions);

/** kelpie_assess() with the latest snapshot, from any thread, at any time: waits for nobody and
 *  allocates nothing. `snapshot`: null, or room for the number of the snapshot, 1, 2, 3 …; 0 before
 *  the first, and then `y` keeps its values. */
kelpie_status kelpie_shared_assess(const kelpie_shared* shared, const double* x, size_t inputs,
                                   kelpie_prediction* y, size_t targets, double ahead_s,
                                   int64_t* snapshot);

/** kelpie_predict_with_jacobian() with the latest snapshot, likewise. */
kelpie_status kelpie_shared_predict_with_jacobian(const kelpie_shared* shared, const double* x,
                                                  size_t inputs, double* y, size_t targets,
                                                  double* jacobian, int64_t* snapshot);

/** From now on every update also renews a block: the content of a file of `kelpie export --live`,
 *  mapped for writing, which the library beside the file reads (docs/howto/controller.md). A block of 0
 *  bytes ends the service. The memory has to outlive the model or the service. KELPIE_BAD_INPUT on
 *  memory that is no block of this model. For the teaching thread. Allocates. */
kelpie_status kelpie_shared_serve(kelpie_shared* shared, void* block, size_t bytes);

/* A model.json: a model that no longer learns (kelpie::TrainedModel) */

/** A model as `kelpie learn` and `kelpie live` write it. */
typedef struct kelpie_trained kelpie_trained;

/** Reads the text of a model.json of `size` bytes (reference/files.md); a program reads the file.
 *  Other texts are KELPIE_BAD_INPUT, and the message names the key. To be freed by
 *  kelpie_free_trained(). Allocates. */
kelpie_status kelpie_read_trained(const char* json, size_t size, kelpie_trained** model);
void kelpie_free_trained(kelpie_trained* model); /**< Frees a model; null does nothing. */

size_t kelpie_trained_input_count(const kelpie_trained* model);  /**< Requires a model. */
size_t kelpie_trained_target_count(const kelpie_trained* model); /**< Requires a model. */
/** The name of a column, counted from 0; null beyond the last. Valid as long as the model. */
const char* kelpie_trained_input_name(const kelpie_trained* model, size_t i);
const char* kelpie_trained_target_name(const kelpie_trained* model, size_t i); /**< Of a target. */

/** How commands were aligned before the model saw them, in words, such as "commands are taken 0.5 s
 *  later"; "" where commands are taken as they stand. Predictions take aligned commands
 *  (docs/reference/files.md). Valid as long as the model. */
const char* kelpie_trained_alignment(const kelpie_trained* model);

/** Predicts all targets at x, to the last bit as the program that wrote the model. Allocates
 *  nothing. */
kelpie_status kelpie_trained_predict(const kelpie_trained* model, const double* x, size_t inputs,
                                     double* y, size_t targets);

/** Predictions with interval and novelty; `disturbance` is 0. Allocates nothing. */
kelpie_status kelpie_trained_assess(const kelpie_trained* model, const double* x, size_t inputs,
                                    kelpie_prediction* y, size_t targets);

/** Predictions with derivatives, as kelpie_predict_with_jacobian(). Allocates nothing. */
kelpie_status kelpie_trained_predict_with_jacobian(const kelpie_trained* model, const double* x,
                                                   size_t inputs, double* y, size_t targets,
                                                   double* jacobian);

/** Velocities through outages of the velocity log: kelpie::DeadReckoning
 * (method/open_loop.md). One thread at a time. */
typedef struct kelpie_reckoning kelpie_reckoning;

/** Why a velocity of the last sample doesn't count as measured; 0: measured. */
typedef enum kelpie_velocity_fault {
  KELPIE_VELOCITY_MISSING = 1,    /**< NaN */
  KELPIE_VELOCITY_REPEATED = 2,   /**< equal to the last bit: no new measurement */
  KELPIE_VELOCITY_ZERO = 3,       /**< exactly 0 while the vehicle moves */
  KELPIE_VELOCITY_FROZEN = 4,     /**< one value for too long while the vehicle moves */
  KELPIE_VELOCITY_IMPLAUSIBLE = 5 /**< beyond three standard deviations */
} kelpie_velocity_fault;

/** Makes an estimator with a copy of the model so far, to be freed by kelpie_reckoning_free().
 *  `planar`: not 0 where the first three velocities are surge, sway and yaw rate. Roll, pitch and
 *  yaw rate, by their names, are a gyro's, all other velocities the velocity log's.
 *  KELPIE_BAD_INPUT where the model isn't ready or doesn't know its velocities, and on `planar`
 *  where their names say otherwise. */
kelpie_status kelpie_reckoning_create(const kelpie_model* model, int planar,
                                      kelpie_reckoning** reckoning);

void kelpie_reckoning_free(kelpie_reckoning* reckoning); /**< Frees an estimator, or null. */

/** Goes on with the model as it is now; the estimate stays. */
kelpie_status kelpie_reckoning_use(kelpie_reckoning* reckoning, const kelpie_model* model);

/** The number of velocities. Requires an estimator. */
size_t kelpie_reckoning_states(const kelpie_reckoning* reckoning);

/** Advances to the time t [s] and the inputs x of the model; NaN: velocity not measured.
 *  `covariance` of the measured velocities, row-major over all velocities; null: the noise known to
 *  the model. Allocates nothing. */
kelpie_status kelpie_reckoning_update(kelpie_reckoning* reckoning, const double* x, size_t inputs,
                                      double t, const double* covariance);

/** The velocities, NaN before all were measured once. `covariance`: null, or room for
 *  states · states values; `faults`: null, or room for a kelpie_velocity_fault per velocity. */
kelpie_status kelpie_reckoning_velocity(const kelpie_reckoning* reckoning, double* velocity,
                                        double* covariance, int32_t* faults, size_t states);

/** Time since the velocity log measured a velocity [s]. Requires an estimator. */
double kelpie_reckoning_silent_s(const kelpie_reckoning* reckoning);

/** What the thrusters of a vehicle can still do: kelpie::Authority (howto/diagnosis.md), as the
 * model knows it at the moment of the creation. */
typedef struct kelpie_authority kelpie_authority;

/** The greatest accelerations of an axis at rest, in the target's unit. */
typedef struct kelpie_axis_authority {
  double most;          /**< whatever the other axes do */
  double least;         /**< in the other direction, < 0 */
  double nominal_most;  /**< before any change of the vehicle */
  double nominal_least; /**< the same */
  double alone_most;    /**< while the other axes are held at 0 */
  double alone_least;   /**< the same */
  double left;          /**< share of the nominal range, 1: all */
} kelpie_axis_authority;

/** Makes an authority for thrusters (names of inputs) with commands from `least` to `most`, to be
 *  freed by kelpie_authority_free(). KELPIE_BAD_INPUT before the model has learned for some
 *  minutes, on an input that is no thruster or named twice, and on a range without 0. */
kelpie_status kelpie_authority_create(const kelpie_model* model, const char* const* thrusters,
                                      const double* least, const double* most, size_t count,
                                      kelpie_authority** authority);

void kelpie_authority_free(kelpie_authority* authority); /**< Frees an authority, or null. */

/** In words; valid until the authority is freed. Requires an authority. */
const char* kelpie_authority_text(const kelpie_authority* authority);

/** The greatest accelerations of an axis, in the order of the model's targets. */
kelpie_status kelpie_authority_axis(const kelpie_authority* authority, size_t axis,
                                    kelpie_axis_authority* values);

/** Commands, one per thruster, for wanted accelerations, one per target, at rest. `missing`: null,
 *  or the largest part that isn't reached, of the nominal range. */
kelpie_status kelpie_authority_allocate(const kelpie_authority* authority, const double* wanted,
                                        size_t targets, double* commands, size_t count,
                                        double* missing);

/** Adds a measured heading [rad] with its standard deviation [rad], with the sign of the yaw rate.
 *  Without one, the heading starts at 0; the first is taken as it is, and current and position turn
 *  with it. KELPIE_BAD_INPUT on an estimator that isn't planar, a heading that isn't finite, and a
 *  deviation <= 0. */
kelpie_status kelpie_reckoning_measured_heading(kelpie_reckoning* reckoning, double heading,
                                                double deviation);

/** The heading [rad]; 0 where the estimator isn't planar. Requires an estimator. */
double kelpie_reckoning_heading(const kelpie_reckoning* reckoning);

/** The current [m/s] of the water along surge and sway at heading 0: room for 2 values; 0 where the
 *  estimator isn't planar. */
kelpie_status kelpie_reckoning_current(const kelpie_reckoning* reckoning, double* current);

/** The way [m] since the start of an outage along surge and sway at heading 0: room for 2 values; 0
 *  while velocities are measured, and where the estimator isn't planar. `covariance`: null, or room
 *  for the 2 · 2 values [m²] of the position's error, row-major. */
kelpie_status kelpie_reckoning_drift(const kelpie_reckoning* reckoning, double* position,
                                     double* covariance);

/** The largest change of a velocity by the last sample's measurement, in standard deviations
 *  before. Requires an estimator. */
double kelpie_reckoning_step(const kelpie_reckoning* reckoning);

/** The factor on the variance of the model's errors one step ahead, of the practised outages.
 *  Requires an estimator. */
double kelpie_reckoning_noise_factor(const kelpie_reckoning* reckoning);

/** How commands go from one sample to the next. */
typedef enum kelpie_command_path {
  KELPIE_COMMANDS_HELD = 0,  /**< constant, then a step */
  KELPIE_COMMANDS_LINEAR = 1 /**< a straight line, as from kelpie_reckoning_create() on */
} kelpie_command_path;

/** After kelpie_reckoning_use(), where the model has its commands in other units: the last sample
 *  had the commands of `x` (NaN: unknown; velocities are not looked at), and commands go on as
 *  `path`, a kelpie_command_path, says. KELPIE_BAD_INPUT on another path, and on a wrong number of
 *  inputs. Allocates nothing. */
kelpie_status kelpie_reckoning_restate(kelpie_reckoning* reckoning, const double* x, size_t inputs,
                                       int32_t path);

/** What a thruster does to an axis at rest, in the target's unit: an entry of the effectiveness
 *  matrix, with the half widths of 90 % intervals. */
typedef struct kelpie_thruster_effect {
  double ahead;          /**< acceleration at full ahead, the `most` of the thruster */
  double astern;         /**< at full astern, the `least` */
  double ahead_width;    /**< half width of the interval around `ahead` */
  double astern_width;   /**< and around `astern` */
  double nominal_ahead;  /**< before any change of the vehicle */
  double nominal_astern; /**< the same */
  double share;          /**< of the thruster's nominal thrust, over all axes; 0: dead */
} kelpie_thruster_effect;

/** The effect of a thruster, in the order of kelpie_authority_create(), on an axis, in the order of
 *  the model's targets. */
kelpie_status kelpie_authority_thruster(const kelpie_authority* authority, size_t thruster,
                                        size_t axis, kelpie_thruster_effect* effect);

/** A singular value, from 0, the greatest, to one less than the number of targets, of the
 *  effectiveness matrix whose rows are divided by the nominal ranges of the axes. `nominal`: null,
 *  or the value before any change of the vehicle. */
kelpie_status kelpie_authority_singular_value(const kelpie_authority* authority, size_t i,
                                              double* value, double* nominal);

#ifdef __cplusplus
}
#endif

#endif
