// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace kelpie::format {

/// The model as a function of one input x and one output y, by the convention that CasADi's
/// external() and acados call generated C by (docs/controller.md), with its Jacobian. Dense vectors
/// have the sparsity {rows, 1, 1}; the output that a Jacobian is given but doesn't need has no
/// entries. Words with a $ are those of model_c.cpp.
inline constexpr std::string_view kCasadi = R"(
/* For CasADi: external("$NAME", "./model.so"). acados wants -Dcasadi_int=int. */
#ifndef casadi_int
#define casadi_int long long int
#endif

static const casadi_int $NAME_dense_x[3] = {$INPUTS, 1, 1};
static const casadi_int $NAME_dense_y[3] = {$TARGETS, 1, 1};
static const casadi_int $NAME_dense_jacobian[3] = {$TARGETS, $INPUTS, 1};
static const casadi_int $NAME_unused_y[4] = {$TARGETS, 1, 0, 0};

int $NAME(const double **arg, double **res, casadi_int *iw, double *w, int mem);
void $NAME_incref(void);
void $NAME_decref(void);
casadi_int $NAME_n_in(void);
casadi_int $NAME_n_out(void);
const char *$NAME_name_in(casadi_int i);
const char *$NAME_name_out(casadi_int i);
const casadi_int *$NAME_sparsity_in(casadi_int i);
const casadi_int *$NAME_sparsity_out(casadi_int i);
int $NAME_work(casadi_int *sz_arg, casadi_int *sz_res, casadi_int *sz_iw, casadi_int *sz_w);
int jac_$NAME(const double **arg, double **res, casadi_int *iw, double *w, int mem);
void jac_$NAME_incref(void);
void jac_$NAME_decref(void);
casadi_int jac_$NAME_n_in(void);
casadi_int jac_$NAME_n_out(void);
const char *jac_$NAME_name_in(casadi_int i);
const char *jac_$NAME_name_out(casadi_int i);
const casadi_int *jac_$NAME_sparsity_in(casadi_int i);
const casadi_int *jac_$NAME_sparsity_out(casadi_int i);
int jac_$NAME_work(casadi_int *sz_arg, casadi_int *sz_res, casadi_int *sz_iw, casadi_int *sz_w);

/* An argument that isn't given counts as zeros; a result that isn't wanted is left out. */
static const double *$NAME_given(const double **arg, double *zeros)
{
  int k;
  for (k = 0; k < $INPUTS; ++k) {
    zeros[k] = 0;
  }
  return arg[0] ? arg[0] : zeros;
}

int $NAME(const double **arg, double **res, casadi_int *iw, double *w, int mem)
{
  double zeros[$INPUTS];
  (void)iw;
  (void)w;
  (void)mem;
  if (res[0]) {
    $NAME_evaluate($NAME_given(arg, zeros), res[0], 0);
  }
  return 0;
}

void $NAME_incref(void) {}
void $NAME_decref(void) {}
casadi_int $NAME_n_in(void) { return 1; }
casadi_int $NAME_n_out(void) { return 1; }
const char *$NAME_name_in(casadi_int i) { return i == 0 ? "x" : 0; }
const char *$NAME_name_out(casadi_int i) { return i == 0 ? "y" : 0; }
const casadi_int *$NAME_sparsity_in(casadi_int i) { return i == 0 ? $NAME_dense_x : 0; }
const casadi_int *$NAME_sparsity_out(casadi_int i) { return i == 0 ? $NAME_dense_y : 0; }

int $NAME_work(casadi_int *sz_arg, casadi_int *sz_res, casadi_int *sz_iw, casadi_int *sz_w)
{
  if (sz_arg) *sz_arg = 1;
  if (sz_res) *sz_res = 1;
  if (sz_iw) *sz_iw = 0;
  if (sz_w) *sz_w = 0;
  return 0;
}

/* Arguments x and y, result dy/dx by columns. */
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
    $NAME_evaluate($NAME_given(arg, zeros), y, rows);
    for (k = 0; k < $INPUTS; ++k) {
      for (i = 0; i < $TARGETS; ++i) {
        res[0][k * $TARGETS + i] = rows[i * $INPUTS + k];
      }
    }
  }
  return 0;
}

void jac_$NAME_incref(void) {}
void jac_$NAME_decref(void) {}
casadi_int jac_$NAME_n_in(void) { return 2; }
casadi_int jac_$NAME_n_out(void) { return 1; }
const char *jac_$NAME_name_in(casadi_int i) { return i == 0 ? "x" : i == 1 ? "out_y" : 0; }
const char *jac_$NAME_name_out(casadi_int i) { return i == 0 ? "jac_y_x" : 0; }

const casadi_int *jac_$NAME_sparsity_in(casadi_int i)
{
  return i == 0 ? $NAME_dense_x : i == 1 ? $NAME_unused_y : 0;
}

const casadi_int *jac_$NAME_sparsity_out(casadi_int i)
{
  return i == 0 ? $NAME_dense_jacobian : 0;
}

int jac_$NAME_work(casadi_int *sz_arg, casadi_int *sz_res, casadi_int *sz_iw, casadi_int *sz_w)
{
  if (sz_arg) *sz_arg = 2;
  if (sz_res) *sz_res = 1;
  if (sz_iw) *sz_iw = 0;
  if (sz_w) *sz_w = 0;
  return 0;
}
)";

}  // namespace kelpie::format
