// SPDX-License-Identifier: Apache-2.0
#include "study/stream_state.hpp"

#include <cstdint>
#include <limits>
#include <vector>

#include "study/result_fields.hpp"

namespace kelpie::study {
namespace {

// How a field stands in the state, and how many bytes it takes at least: a damaged file can't ask
// for more items than its bytes can hold.
struct SavedField {
  Archive& archive;
  bool finite;

  static constexpr std::size_t kNumber = 8;

  void visit(double& value) const { finite ? archive.number(value) : archive.any_number(value); }
  void visit(int& value) const {
    archive.whole(value, std::numeric_limits<int>::min(), std::numeric_limits<int>::max());
  }
  void visit(std::size_t& value) const { archive.whole(value); }
  void visit(std::int64_t& value) const { archive.whole(value); }
  void visit(Status& value) const { archive.part("status", value); }
  template <typename Number>
  void visit(std::vector<Number>& values) const {
    archive.list(values, Archive::kAnyLength, [this](Number& value) { visit(value); });
  }
};

template <typename Item>
void visit_fields(Archive& archive, Item& item) {
  for_each_field<Item>([&](const auto& field) {
    if constexpr (std::is_member_object_pointer_v<decltype(field.saved)>) {
      SavedField{archive, field.finite}.visit(item.*field.saved);
    }
  });
}

template <typename Item>
constexpr std::size_t least_bytes() {
  std::size_t bytes = 0;
  for_each_field<Item>([&](const auto& field) {
    if constexpr (std::is_member_object_pointer_v<decltype(field.saved)>) {
      const bool is_status = std::is_same_v<decltype(field.saved), Status ValidationPoint::*>;
      bytes += is_status ? sizeof(Tally) : SavedField::kNumber;
    }
  });
  return bytes;
}

// What one list holds has to fit the rest of the state.
void check(const Archive& archive, const ValidationPoint& point, std::size_t terms) {
  archive.require((point.coefficients.empty() || point.coefficients.size() == terms) &&
                      point.errors.size() == point.coefficients.size(),
                  "has coefficients of other terms");
}

void check(const Archive& archive, const StageEnd& stage, std::size_t /*terms*/) {
  archive.require(
      stage.truth.size() == stage.time_s.size() && stage.predicted.size() == stage.time_s.size(),
      "has a stage of uneven columns");
}

void check(const Archive& /*archive*/, const ChangeFound& /*change*/, std::size_t /*terms*/) {}
void check(const Archive& /*archive*/, const OutliersFound& /*found*/, std::size_t /*terms*/) {}

template <typename Item>
void visit_items(Archive& archive, std::vector<Item>& items, std::size_t most, std::size_t terms) {
  archive.list(
      items, most,
      [&](Item& item) {
        visit_fields(archive, item);
        check(archive, item, terms);
      },
      least_bytes<Item>());
}

void visit_one_step(Archive& archive, OneStep& steps, std::size_t shown) {
  const auto fits = [&](std::size_t size) {
    archive.require(size <= shown && size == steps.time_s.size(), "has uneven predictions");
  };
  const SavedField any{archive, false};
  for (std::vector<double>* values :
       {&steps.time_s, &steps.truth, &steps.predicted, &steps.lower, &steps.upper}) {
    any.visit(*values);
    fits(values->size());
  }
  archive.list(steps.configuration, shown, [&](int& configuration) { any.visit(configuration); });
  fits(steps.configuration.size());
  archive.list(steps.samples, shown, [&](std::size_t& samples) { any.visit(samples); });
  fits(steps.samples.size());
}

}  // namespace

void visit_so_far(Archive& archive, AxisResult& result, std::size_t shown, std::size_t terms) {
  visit_items(archive, result.validation, shown, terms);
  visit_items(archive, result.stages, shown, terms);
  visit_items(archive, result.changes, shown, terms);
  visit_items(archive, result.outliers, shown, terms);
  visit_one_step(archive, result.one_step, shown);
  visit_one_step(archive, result.corrected, shown);
  SavedField{archive, false}.visit(result.update_us);
  archive.require(result.update_us.size() == shown, "has times of more or fewer updates");
}

}  // namespace kelpie::study
