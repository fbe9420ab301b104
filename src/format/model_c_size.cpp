// SPDX-License-Identifier: Apache-2.0
#include <cstdint>

#include "format/model_c.hpp"
#include "kelpie/model/trained_model.hpp"
#include "model/snapshot.hpp"

namespace kelpie::format {

std::size_t table_bytes(const TrainedModel& model, const CodeOptions& options) {
  constexpr std::size_t kIntegers = 2 * sizeof(std::int32_t);  // of an axis, and of a member
  const std::size_t real = options.single ? sizeof(float) : sizeof(double);
  const std::size_t inputs = model.input_names.size();
  std::size_t bytes = 0;
  for (const TrainedModel::Axis& axis : model.axes) {
    bytes += kIntegers + (2 + inputs + inputs * inputs) * real;
    for (const FunctionMix::Member& member : axis.function.members) {
      bytes += kIntegers + (5 + model.terms.size()) * real;
      bytes += member.function.beta().size() * (inputs + 1) * real;
    }
    if (options.assess) {
      bytes += kIntegers + 2 * real;
      bytes += (axis.known ? axis.known->samples.size() : 0) * (inputs + 1) * real;
    }
  }
  return bytes;
}

}  // namespace kelpie::format
