// SPDX-License-Identifier: Apache-2.0
#include <pybind11/pybind11.h>

#include <exception>
#include <utility>

#include "bindings.hpp"
#include "kelpie/core/error.hpp"

namespace {

// Failure is a runtime_error, and becomes a RuntimeError by itself.
void raise_input_errors(std::exception_ptr thrown) {
  try {
    std::rethrow_exception(std::move(thrown));
  } catch (const kelpie::InputError& error) {
    PyErr_SetString(PyExc_ValueError, error.what());
  }
}

}  // namespace

PYBIND11_MODULE(_kelpie, module) {
  module.doc() = "The library behind the package kelpie: arrays in, arrays out.";
  module.attr("__version__") = KELPIE_VERSION;
  pybind11::register_local_exception_translator(raise_input_errors);
  kelpie::python::bind_settings(module);
  kelpie::python::bind_live_model(module);
  kelpie::python::bind_trained_model(module);
  kelpie::python::bind_authority(module);
  kelpie::python::bind_dead_reckoning(module);
  kelpie::python::bind_alignment(module);
  kelpie::python::bind_log(module);
  kelpie::python::bind_studies(module);
}
