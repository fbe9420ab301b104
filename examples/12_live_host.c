/* SPDX-License-Identifier: Apache-2.0 */
/* A controller's program that asks a learned model a hundred times a second, while `kelpie live`
 * teaches it: the library of `kelpie export --live`, loaded and called as CasADi calls it
 * (docs/howto/controller.md). Tells how long a call with Jacobian takes.
 *
 *   kelpie export out/live/model.json --live vehicle.so
 *   kelpie live --config mission.toml --block vehicle.block &
 *   cc -std=c99 -O2 examples/12_live_host.c -o live_host -ldl
 *   ./live_host ./vehicle.so 600
 *
 * Prints, for instance:
 *   calls 6000, publications 487, median 33.3 us, 99 % 74.3 us, most 603 us, failed 0
 *   with new numbers: median 55.2 us, 99 % 99.2 us; others: median 32.8 us, 99 % 66.8 us */
#define _POSIX_C_SOURCE 200809L
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { most_columns = 64 };

typedef int casadi_call(const double **arg, double **res, long long *iw, double *w, int mem);
typedef unsigned long long renew_call(void);
typedef int bounds_call(double *low, double *high);
typedef const long long *sparsity_call(long long i);
typedef const char *problem_call(void);

static void *symbol(void *library, const char *name)
{
  void *const found = dlsym(library, name);
  if (!found) {
    fprintf(stderr, "no %s: is the file a library of kelpie export --live?\n", name);
    exit(2);
  }
  return found;
}

static double now_us(void)
{
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return 1e6 * (double)now.tv_sec + 1e-3 * (double)now.tv_nsec;
}

static int ascending(const void *a, const void *b)
{
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Sorts the times; the one that a share of them does not exceed. */
static double quantile(double *took_us, size_t count, double share)
{
  qsort(took_us, count, sizeof(double), ascending);
  return count > 0 ? took_us[(size_t)(share * (double)(count - 1))] : 0;
}

/* Somewhere among the samples that the learner knows. */
static void choose(const double *low, const double *high, long long inputs, double *x)
{
  long long k;
  for (k = 0; k < inputs; ++k) {
    x[k] = low[k] + (high[k] - low[k]) * rand() / RAND_MAX;
  }
}

int main(int argc, char **argv)
{
  const double seconds = argc > 2 ? atof(argv[2]) : 10;
  const double period_us = argc > 3 ? 1e6 / atof(argv[3]) : 1e4;
  void *const library = argc > 1 ? dlopen(argv[1], RTLD_NOW) : NULL;
  const size_t calls = (size_t)(1e6 * seconds / period_us);
  double *const took_us = calloc(calls + 1, sizeof(double));
  double *const took_new_us = calloc(calls + 1, sizeof(double));
  double low[most_columns], high[most_columns], x[most_columns];
  double y[most_columns], jacobian[most_columns * most_columns];
  const double *value_arguments[1] = {x}, *jacobian_arguments[2] = {x, NULL};
  double *value[1] = {y}, *slopes[1] = {jacobian};
  unsigned long long last = 0;
  size_t done, failed = 0, fresh = 0;
  double next_us;
  if (!library || !took_us || !took_new_us) {
    fprintf(stderr, "usage: live_host ./vehicle.so [SECONDS [HERTZ]]\n%s\n", dlerror());
    return 2;
  }
  casadi_call *const model = (casadi_call *)symbol(library, "kelpie_model");
  casadi_call *const jac_model = (casadi_call *)symbol(library, "jac_kelpie_model");
  renew_call *const renew = (renew_call *)symbol(library, "kelpie_model_renew");
  bounds_call *const bounds = (bounds_call *)symbol(library, "kelpie_model_bounds");
  problem_call *const problem = (problem_call *)symbol(library, "kelpie_model_problem");
  const long long inputs =
      ((sparsity_call *)symbol(library, "kelpie_model_sparsity_in"))(0)[0];
  if (renew() == 0) {
    fprintf(stderr, "%s\n", problem());
    return 1;
  }
  next_us = now_us();
  for (done = 0; done < calls; ++done) {
    struct timespec pause;
    double begin_us;
    unsigned long long number;
    bounds(low, high);
    choose(low, high, inputs, x);
    next_us += period_us;
    begin_us = now_us();
    if (next_us > begin_us) {
      pause.tv_sec = (time_t)((next_us - begin_us) / 1e6);
      pause.tv_nsec = (long)(1e3 * (next_us - begin_us - 1e6 * (double)pause.tv_sec));
      nanosleep(&pause, NULL);
    }
    begin_us = now_us();
    failed += jac_model(jacobian_arguments, slopes, NULL, NULL, 0) != 0;
    took_us[done] = now_us() - begin_us;
    failed += model(value_arguments, value, NULL, NULL, 0) != 0;
    number = renew();
    if (number != last) {
      took_new_us[fresh++] = took_us[done]; /* the call took the new numbers over */
    } else {
      took_new_us[calls - 1 - (done - fresh)] = took_us[done];
    }
    last = number;
  }
  printf("calls %zu, publications %zu, median %.1f us, 99 %% %.1f us, most %.0f us, failed %zu\n",
         calls, fresh, quantile(took_us, calls, 0.5), quantile(took_us, calls, 0.99),
         quantile(took_us, calls, 1.0), failed);
  printf("with new numbers: median %.1f us, 99 %% %.1f us; ", quantile(took_new_us, fresh, 0.5),
         quantile(took_new_us, fresh, 0.99));
  printf("others: median %.1f us, 99 %% %.1f us\n",
         quantile(took_new_us + fresh, calls - fresh, 0.5),
         quantile(took_new_us + fresh, calls - fresh, 0.99));
  free(took_us);
  free(took_new_us);
  return failed != 0;
}
