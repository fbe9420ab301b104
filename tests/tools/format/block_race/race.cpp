// SPDX-License-Identifier: Apache-2.0
// One thread renews a block without a pause, others predict by the exported C file in the same
// process: scripts/block_race.sh compiles both, with ThreadSanitizer or without.
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "files/model_block.hpp"
#include "kelpie/model/trained_model.hpp"
#include "model/snapshot.hpp"

extern "C" {
int kelpie_model_attach(const void* memory, unsigned long long bytes);
void kelpie_model_predict_with_jacobian(const double* x, double* y, double* jacobian);
void kelpie_model_hessian_vector(const double* x, const double* v, const double* lambda,
                                 double* product);
unsigned long long kelpie_model_renew(void);
void kelpie_model_hold(int on);
}

namespace {

constexpr std::size_t kModels = 3;  // a slot has another model in every publication
constexpr int kReaders = 2;

std::string content_of(const char* file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The answer of a model: values, then the Jacobian.
using Answer = std::vector<double>;

bool same(const Answer& a, const Answer& b) {
  double largest = 1.0;
  double apart = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest = std::max(largest, std::abs(b[i]));
    apart = std::isfinite(a[i]) ? std::max(apart, std::abs(a[i] - b[i])) : HUGE_VAL;
  }
  return apart < 1e-9 * largest;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) {
    std::fprintf(stderr, "usage: race MODEL.json BLOCK SECONDS HERTZ (0: without a pause)\n");
    return 2;
  }
  std::array<kelpie::TrainedModel, kModels> models;
  models.fill(kelpie::read_trained_model(content_of(argv[1])));
  const kelpie::TrainedModel& first = models[0];
  const std::size_t targets = first.axes.size();
  const std::vector<double> x = first.axes[0].scaling.input.mean;
  std::array<Answer, kModels> expected;
  for (std::size_t k = 0; k < kModels; ++k) {
    for (kelpie::TrainedModel::Axis& axis : models[k].axes) {
      axis.scaling.target.scale *= 1.0 + static_cast<double>(k);
    }
    expected[k].resize(targets * (1 + x.size()));
    models[k].predict_with_jacobian(x, std::span(expected[k]).first(targets),
                                    std::span(expected[k]).subspan(targets));
  }
  const std::string file = content_of(argv[2]);
  std::vector<std::uint64_t> words(file.size() / sizeof(std::uint64_t));
  const std::span<std::byte> memory = std::as_writable_bytes(std::span(words));
  std::ranges::copy(std::as_bytes(std::span(file)), memory.begin());
  kelpie::ModelBlock block(
      memory, kelpie::BlockLayout::of(first.input_names, first.target_names(), first.terms,
                                      first.axes, kelpie::ModelBlock::assesses(memory)));
  if (kelpie_model_attach(memory.data(), memory.size()) != 0) {
    std::fprintf(stderr, "the C file and the block do not belong together\n");
    return 2;
  }
  const auto publish = [&] {
    const std::size_t next = words[3] + 1;  // written by this thread alone
    block.publish(first.input_names, models[next % kModels].axes, {});
  };
  const std::vector<double> ones(std::max(x.size(), targets), 1.0);
  std::array<Answer, kModels> products;
  products.fill(Answer(x.size()));
  for (std::size_t k = 0; k < kModels; ++k) {
    publish();
    kelpie_model_hessian_vector(x.data(), ones.data(), ones.data(),
                                products[words[3] % kModels].data());
  }
  std::atomic<bool> going{true};
  std::atomic<long> calls{0};
  std::atomic<long> renewals{0};
  std::atomic<long> wrong{0};
  std::thread writer([&] {
    while (going) {
      publish();
    }
  });
  const double hertz = std::atof(argv[4]);
  const auto read = [&] {
    unsigned long long last = 0;
    while (going) {
      Answer said(expected[0].size());
      kelpie_model_predict_with_jacobian(x.data(), said.data(), said.data() + targets);
      kelpie_model_hold(1);
      Answer product(x.size());
      kelpie_model_hessian_vector(x.data(), ones.data(), ones.data(), product.data());
      const unsigned long long number = kelpie_model_renew();
      kelpie_model_hold(0);
      ++calls;
      const std::size_t model = number % kModels;
      wrong += number > 1 && !(same(said, expected[model]) && same(product, products[model]));
      renewals += number != last ? 1 : 0;
      last = number;
      if (hertz > 0.0) {
        std::this_thread::sleep_for(std::chrono::duration<double>(1.0 / hertz));
      }
    }
  };
  std::vector<std::thread> readers;
  for (int k = 0; k < kReaders; ++k) {
    readers.emplace_back(read);
  }
  std::this_thread::sleep_for(std::chrono::duration<double>(std::atof(argv[3])));
  going = false;
  writer.join();
  for (std::thread& reader : readers) {
    reader.join();
  }
  std::printf("publications %llu, calls %ld, with another publication %ld, wrong %ld\n",
              static_cast<unsigned long long>(words[3]), calls.load(), renewals.load(),
              wrong.load());
  return wrong > 0 || calls == 0 ? 1 : 0;
}
