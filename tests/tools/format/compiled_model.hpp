// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "format/model_c.hpp"
#include "kelpie/model/trained_model.hpp"
#include "support.hpp"

namespace kelpie::testing {

inline const std::string kCompiler =
    KELPIE_C_COMPILER " -std=c99 -Wall -Wextra -pedantic -Werror -Wmissing-prototypes ";

/// An exported model, compiled and loaded.
class Compiled {
 public:
  Compiled(const TrainedModel& model, const format::CodeOptions& options,
           const TemporaryFolder& folder)
      : Compiled(format::model_c(model, options), options.name, folder) {}

  /// The text of an exported file.
  Compiled(const std::string& code, std::string name, const TemporaryFolder& folder)
      : name_(std::move(name)), library_(nullptr, &dlclose) {
    static int files = 0;
    const std::string stem = folder / ("model" + std::to_string(++files));
    std::ofstream(stem + ".c") << code;
    const std::string command =
        kCompiler + "-O1 -fPIC -shared -o " + stem + ".so " + stem + ".c -lm 2>" + stem + ".txt";
    if (std::system(command.c_str()) != 0) {  // NOLINT: the command is the test's own
      ADD_FAILURE() << std::ifstream(stem + ".txt").rdbuf();
      return;
    }
    load(stem + ".so");
  }

  /// A library that was compiled by others.
  Compiled(const std::filesystem::path& library, std::string name)
      : name_(std::move(name)), library_(nullptr, &dlclose) {
    load(library.string());
  }

  explicit operator bool() const { return library_ != nullptr; }

  template <typename Real>
  void run(const std::vector<double>& x, std::vector<double>& y, std::vector<double>& jacobian) {
    const std::vector<Real> in(x.begin(), x.end());
    std::vector<Real> out(y.size());
    std::vector<Real> alone(y.size());
    std::vector<Real> slopes(jacobian.size());
    find<void (*)(const Real*, Real*)>("_predict")(in.data(), alone.data());
    find<void (*)(const Real*, Real*, Real*)>("_predict_with_jacobian")(in.data(), out.data(),
                                                                        slopes.data());
    EXPECT_TRUE(out == alone || std::isnan(out.front()));
    y.assign(out.begin(), out.end());
    jacobian.assign(slopes.begin(), slopes.end());
  }

  // Half widths and novelties.
  template <typename Real>
  std::pair<std::vector<double>, std::vector<double>> assess(const std::vector<double>& x,
                                                             std::size_t targets) {
    const std::vector<Real> in(x.begin(), x.end());
    std::vector<Real> y(targets);
    std::vector<Real> half_width(targets);
    std::vector<Real> novelty(targets);
    find<void (*)(const Real*, Real*, Real*, Real*)>("_assess")(in.data(), y.data(),
                                                                half_width.data(), novelty.data());
    return {{half_width.begin(), half_width.end()}, {novelty.begin(), novelty.end()}};
  }

  // Second derivatives of every target, one matrix by rows after the other.
  template <typename Real>
  std::vector<double> hessian(const std::vector<double>& x, std::size_t targets) {
    const std::vector<Real> in(x.begin(), x.end());
    std::vector<Real> out(targets * x.size() * x.size());
    find<void (*)(const Real*, Real*)>("_hessian")(in.data(), out.data());
    return {out.begin(), out.end()};
  }

  std::vector<double> hessian_vector(const std::vector<double>& x, const std::vector<double>& v,
                                     const std::vector<double>& lambda) {
    std::vector<double> product(x.size());
    find<void (*)(const double*, const double*, const double*, double*)>("_hessian_vector")(
        x.data(), v.data(), lambda.data(), product.data());
    return product;
  }

  std::string text(const std::string& array, std::size_t i) {
    return find<const char* const*>(array)[i];
  }

  // A symbol by its whole name.
  template <typename Symbol>
  Symbol named(const std::string& name) {
    void* const symbol = dlsym(library_.get(), name.c_str());
    EXPECT_NE(symbol, nullptr) << name;
    return reinterpret_cast<Symbol>(symbol);  // NOLINT: how dlsym is used
  }

 private:
  void load(const std::string& file) {
    library_.reset(dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL));
    EXPECT_TRUE(library_) << dlerror();  // NOLINT(concurrency-mt-unsafe): before threads
  }

  template <typename Symbol>
  Symbol find(const std::string& ending) {
    return named<Symbol>(name_ + ending);
  }

  std::string name_;
  std::unique_ptr<void, int (*)(void*)> library_;
};

/// That the second derivatives at x are central differences of the Jacobian, `step` of the inputs
/// to either side; and that the product with a vector is that of these matrices.
inline void expect_bends_of_slopes(Compiled& compiled, const std::vector<double>& x,
                                   std::size_t targets, const std::vector<double>& step) {
  const std::size_t size = x.size();
  const std::vector<double> hessian = compiled.hessian<double>(x, targets);
  const auto bend = [&](std::size_t i, std::size_t j, std::size_t k) {
    return hessian[(i * size + j) * size + k] * step[j] * step[k];
  };
  double largest = 0.0;
  std::vector<double> y(targets);
  std::vector<double> after(targets * size);
  std::vector<double> before(targets * size);
  std::vector<double> expected;
  std::vector<double> said;
  for (std::size_t k = 0; k < size; ++k) {
    std::vector<double> moved = x;
    moved[k] = x[k] + step[k];
    compiled.run<double>(moved, y, after);
    moved[k] = x[k] - step[k];
    compiled.run<double>(moved, y, before);
    for (std::size_t i = 0; i < targets; ++i) {
      for (std::size_t j = 0; j < size; ++j) {
        expected.push_back((after[i * size + j] - before[i * size + j]) / 2.0 * step[j]);
        said.push_back(bend(i, j, k));
        largest = std::max(largest, std::abs(said.back()));
        ASSERT_EQ(bend(i, j, k), bend(i, k, j));
      }
    }
  }
  for (std::size_t n = 0; n < said.size(); ++n) {
    ASSERT_NEAR(said[n], expected[n], 1e-5 * largest) << n;
  }
  std::vector<double> lambda(targets);
  for (std::size_t i = 0; i < targets; ++i) {
    lambda[i] = 2.0 * static_cast<double>(i) - 1.0;
  }
  const std::vector<double> product = compiled.hessian_vector(x, step, lambda);
  for (std::size_t j = 0; j < size; ++j) {
    double sum = 0.0;
    for (std::size_t i = 0; i < targets; ++i) {
      for (std::size_t k = 0; k < size; ++k) {
        sum += lambda[i] * bend(i, j, k);
      }
    }
    ASSERT_NEAR(product[j] * step[j], sum, 1e-12 * largest);
  }
}

/// A function of a library as CasADi's external() asks for it and calls it.
class CasadiFunction {
 public:
  using Integer = long long;  // casadi_int

  CasadiFunction(Compiled& library, std::string name) : library_(library), name_(std::move(name)) {
    library_.named<void (*)()>(name_ + "_incref")();
    Integer arguments = 0;
    Integer results = 0;
    Integer integers = 0;
    Integer reals = 0;
    using Work = int (*)(Integer*, Integer*, Integer*, Integer*);
    EXPECT_EQ(library_.named<Work>(name_ + "_work")(&arguments, &results, &integers, &reals), 0);
    arguments_.resize(static_cast<std::size_t>(arguments), nullptr);
    results_.resize(static_cast<std::size_t>(results), nullptr);
    EXPECT_GE(arguments, count("_n_in"));
    EXPECT_GE(results, count("_n_out"));
    EXPECT_EQ(integers + reals, 0);  // no work space is given below
  }
  CasadiFunction(const CasadiFunction&) = delete;
  CasadiFunction& operator=(const CasadiFunction&) = delete;
  ~CasadiFunction() { library_.named<void (*)()>(name_ + "_decref")(); }

  Integer count(const std::string& ending) {
    return library_.named<Integer (*)()>(name_ + ending)();
  }

  std::string name_of(const std::string& ending, Integer i) {
    return library_.named<const char* (*)(Integer)>(name_ + ending)(i);
  }

  // Rows, columns and entries of an argument or a result, by columns as CasADi stores them.
  std::array<Integer, 3> shape(const std::string& ending, Integer i) {
    const Integer* const sparsity = library_.named<const Integer* (*)(Integer)>(name_ + ending)(i);
    const bool dense = sparsity[2] == 1;
    return {sparsity[0], sparsity[1],
            dense ? sparsity[0] * sparsity[1] : sparsity[2 + sparsity[1]]};
  }

  std::vector<double> call(const double* x) {
    const std::array<Integer, 3> to = shape("_sparsity_out", 0);
    std::vector<double> result(static_cast<std::size_t>(to[2]));
    arguments_[0] = x;
    results_[0] = result.data();
    using Call = int (*)(const double**, double**, Integer*, double*, int);
    EXPECT_EQ(library_.named<Call>(name_)(arguments_.data(), results_.data(), nullptr, nullptr, 0),
              0);
    results_[0] = nullptr;  // not wanted
    EXPECT_EQ(library_.named<Call>(name_)(arguments_.data(), results_.data(), nullptr, nullptr, 0),
              0);
    return result;
  }

 private:
  Compiled& library_;
  std::string name_;
  std::vector<const double*> arguments_;
  std::vector<double*> results_;
};

}  // namespace kelpie::testing
