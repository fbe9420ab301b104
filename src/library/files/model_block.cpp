// SPDX-License-Identifier: Apache-2.0
#include "files/model_block.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <limits>
#include <string_view>

#include "core/hash.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie {
namespace {

constexpr std::size_t kNumbersOfSlot = 2;     // the publication, and the words in use
constexpr std::size_t kNumbersOnce = 4;       // shift, members, support vectors, places
constexpr std::size_t kNumbersOfMember = 7;   // beside the coefficients
constexpr std::size_t kNumbersOfTarget = 6;   // beside mean, whitening and terms
constexpr std::size_t kNumbersOfKnown = 4;    // per target
constexpr std::size_t kWordsOfCacheLine = 8;  // 64 bytes
constexpr std::size_t kLatest = 3;            // its place in the header

std::span<std::uint64_t> words_of(std::span<std::byte> memory) {
  return {reinterpret_cast<std::uint64_t*>(memory.data()),  // NOLINT: the format is words
          memory.size() / sizeof(std::uint64_t)};
}

void store(std::uint64_t& word, std::uint64_t value) {
  std::atomic_ref(word).store(value, std::memory_order_release);
}

std::uint64_t load(std::uint64_t& word) {
  return std::atomic_ref(word).load(std::memory_order_acquire);
}

// In whole groups of lanes.
std::size_t grouped(std::size_t vectors) {
  return (vectors + BlockLayout::kLanes - 1) / BlockLayout::kLanes * BlockLayout::kLanes;
}

/// Writes numbers one behind the other.
class NumberWriter {
 public:
  explicit NumberWriter(std::span<std::uint64_t> words) : words_(words) {}

  void put(double number) { store(words_[next_++], std::bit_cast<std::uint64_t>(number)); }
  void put(std::size_t count) { put(static_cast<double>(count)); }
  void put(std::span<const double> numbers) {
    std::ranges::for_each(numbers, [&](double number) { put(number); });
  }
  std::size_t written() const { return next_; }

 private:
  std::span<std::uint64_t> words_;
  std::size_t next_ = 0;
};

bool is_diagonal(const Matrix& whitening) {
  for (std::size_t row = 0; row < whitening.rows(); ++row) {
    for (std::size_t column = 0; column < row; ++column) {
      if (whitening(row, column) != 0.0) {
        return false;
      }
    }
  }
  return true;
}

/// A box around points.
struct Box {
  explicit Box(std::size_t inputs) : low(inputs), high(inputs) {
    std::ranges::fill(low, std::numeric_limits<double>::infinity());
    std::ranges::fill(high, -std::numeric_limits<double>::infinity());
  }
  void take(const ScaledInput& x) {
    for (std::size_t k = 0; k < low.size(); ++k) {
      low[k] = std::min(low[k], x[k]);
      high[k] = std::max(high[k], x[k]);
    }
  }

  ScaledInput low;
  ScaledInput high;
};

// Of scaled samples. Inputs that are scaled one by one keep their order: the corners suffice.
void take_samples(const InputScaling& scaling, const SampleStore& samples, Box& box) {
  ScaledInput z(samples.dimension());
  if (samples.size() > 0 && is_diagonal(scaling.whitening)) {
    ScaledInput most(samples.dimension());
    for (std::size_t k = 0; k < samples.dimension(); ++k) {
      const auto [least, greatest] = std::ranges::minmax(samples.coordinate(k));
      z[k] = least;
      most[k] = greatest;
    }
    box.take(scaling.invert(as_span(z)));
    box.take(scaling.invert(as_span(most)));
    return;
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples.get(i, z);
    box.take(scaling.invert(as_span(z)));
  }
}

// The box around the known samples of all targets: beyond it the model has seen nothing.
void put_bounds(std::span<const Snapshot> snapshots, NumberWriter& out) {
  Box box(snapshots.front().scaling.input.dimension());
  for (const Snapshot& axis : snapshots) {
    if (axis.known) {
      take_samples(axis.scaling.input, axis.known->samples, box);
    }
  }
  for (std::size_t k = 0; k < box.low.size(); ++k) {
    const bool known = box.low[k] <= box.high[k];
    out.put(known ? box.low[k] : -std::numeric_limits<double>::infinity());
    out.put(known ? box.high[k] : std::numeric_limits<double>::infinity());
  }
}

void put_actuators(std::span<const std::string> input_names, const Alignment& alignment,
                   NumberWriter& out) {
  for (const std::string& input : input_names) {
    const auto found = std::ranges::find(alignment.commands, input);
    const auto k = static_cast<std::size_t>(found - alignment.commands.begin());
    const Actuator actuator = k < alignment.actuators.size() ? alignment.actuators[k] : Actuator{};
    for (const Actuator::Field& field : Actuator::fields()) {
      out.put(actuator.*field.number);
    }
  }
}

void put_targets(std::span<const Snapshot> snapshots, NumberWriter& out) {
  std::size_t first = 0;
  for (const Snapshot& axis : snapshots) {
    const auto& [input, target, term_scale] = axis.scaling;
    out.put(first);
    first += axis.function.members.size();
    out.put(first);
    out.put(target.invert(axis.function.limits.low));
    out.put(target.invert(axis.function.limits.high));
    out.put(axis.function.limits.caution);
    out.put(target.scale * target.scale);
    out.put(std::span<const double>(input.mean));
    for (std::size_t row = 0; row < input.whitening.rows(); ++row) {
      for (std::size_t column = 0; column < input.whitening.columns(); ++column) {
        out.put(input.whitening(row, column));
      }
    }
    for (std::size_t k = 0; k < term_scale.size(); ++k) {
      const auto [low, high] = axis.function.term_range(k);
      out.put(low * term_scale[k]);
      out.put(high * term_scale[k]);
    }
    for (std::size_t k = 0; k < term_scale.size(); ++k) {
      out.put(target.scale * axis.function.nominal_weight(k) / term_scale[k]);
    }
  }
}

void put_members(std::span<const Snapshot> snapshots, NumberWriter& out) {
  std::size_t first = 0;
  for (const Snapshot& axis : snapshots) {
    const auto& [input, target, term_scale] = axis.scaling;
    for (const FunctionMix::Member& member : axis.function.members) {
      const SvrFunction& function = member.function;
      out.put(member.share);
      out.put(first);
      first += grouped(function.beta().size());
      out.put(first);
      out.put(function.kernel().local().gamma());
      out.put(function.kernel().weights().s);
      out.put(function.kernel().weights().fine);
      out.put(target.invert(function.bias()));
      for (std::size_t k = 0; k < term_scale.size(); ++k) {
        out.put(target.scale * function.term_weights()[k] / term_scale[k]);
      }
    }
  }
}

void put_samples(const SampleStore& samples, NumberWriter& out) {
  ScaledInput z(samples.dimension());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples.get(i, z);
    out.put(std::span<const double>(z));
  }
}

// Vectors and weights of a filled-up group are 0.
void put_group(std::span<const double> numbers, std::size_t first, double factor,
               NumberWriter& out) {
  for (std::size_t i = first; i < first + BlockLayout::kLanes; ++i) {
    out.put(i < numbers.size() ? factor * numbers[i] : 0.0);
  }
}

void put_vectors(std::span<const Snapshot> snapshots, NumberWriter& out) {
  for (const Snapshot& axis : snapshots) {
    for (const FunctionMix::Member& member : axis.function.members) {
      const SampleStore& vectors = member.function.support_vectors();
      for (std::size_t first = 0; first < vectors.size(); first += BlockLayout::kLanes) {
        for (std::size_t k = 0; k < vectors.dimension(); ++k) {
          put_group(vectors.coordinate(k), first, 1.0, out);
        }
      }
    }
  }
  for (const Snapshot& axis : snapshots) {
    for (const FunctionMix::Member& member : axis.function.members) {
      const std::span<const double> beta = member.function.beta();
      for (std::size_t first = 0; first < beta.size(); first += BlockLayout::kLanes) {
        put_group(beta, first, axis.scaling.target.scale, out);
      }
    }
  }
}

std::size_t known_samples(const Snapshot& axis) {
  return axis.known ? axis.known->samples.size() : 0;
}

void put_known(std::span<const Snapshot> snapshots, NumberWriter& out) {
  std::size_t first = 0;
  for (const Snapshot& axis : snapshots) {
    const double h = axis.known ? axis.known->density.bandwidth() : 0.0;
    out.put(first);
    first += known_samples(axis);
    out.put(first);
    out.put(axis.half_width);
    out.put(h > 0.0 ? 0.5 / (h * h) : 0.0);
  }
  for (const Snapshot& axis : snapshots) {
    if (axis.known) {
      put_samples(axis.known->samples, out);
    }
  }
  for (const Snapshot& axis : snapshots) {
    for (std::size_t i = 0; i < known_samples(axis); ++i) {
      out.put(axis.known->density.sums()[i] - 1.0);
    }
  }
}

struct Counts {
  std::size_t members = 0;
  std::size_t vectors = 0;
  std::size_t places = 0;
};

Counts counts_of(std::span<const Snapshot> snapshots) {
  Counts counts;
  for (const Snapshot& axis : snapshots) {
    counts.members += axis.function.members.size();
    counts.places += known_samples(axis);
    for (const FunctionMix::Member& member : axis.function.members) {
      counts.vectors += grouped(member.function.beta().size());
    }
  }
  return counts;
}

std::array<std::size_t, 6> sizes_of(const BlockLayout& layout) {
  return {layout.inputs,  layout.targets, layout.terms,
          layout.members, layout.vectors, layout.places};
}

constexpr std::size_t kSizesAt = 4;

void require_block(bool holds, const std::string& what) {
  if (!holds) {
    throw InputError("block", what + "; `kelpie export --live` writes another");
  }
}

}  // namespace

BlockLayout BlockLayout::of(std::span<const std::string> input_names,
                            std::span<const std::string> target_names, const TermSet& term_set,
                            std::span<const Snapshot> capacity, bool assess) {
  BlockLayout layout{.identity = block_identity(input_names, target_names, term_set),
                     .inputs = input_names.size(),
                     .targets = target_names.size(),
                     .terms = term_set.size()};
  for (const Snapshot& axis : capacity) {
    layout.members += axis.function.members.size();
    for (const FunctionMix::Member& member : axis.function.members) {
      layout.vectors += grouped(member.function.support_vectors().capacity());
    }
    layout.places += assess && axis.known ? axis.known->samples.capacity() : 0;
  }
  return layout;
}

std::size_t BlockLayout::slot_words() const {
  const std::size_t numbers = kNumbersOfSlot + kNumbersOnce +
                              inputs * (2 + Actuator::fields().size()) +
                              targets * (kNumbersOfTarget + inputs + inputs * inputs + 3 * terms) +
                              members * (kNumbersOfMember + terms) + vectors * (inputs + 1) +
                              (places > 0 ? targets * kNumbersOfKnown + places * (inputs + 1) : 0);
  return (numbers + kWordsOfCacheLine - 1) / kWordsOfCacheLine * kWordsOfCacheLine;
}

std::uint64_t block_identity(std::span<const std::string> input_names,
                             std::span<const std::string> target_names, const TermSet& term_set) {
  std::uint64_t hash = fnv1a("");
  const auto add = [&](std::string_view text) {
    hash = fnv1a("\xff", fnv1a(text, hash));  // no byte of UTF-8: ends the text
  };
  std::ranges::for_each(input_names, add);
  add("");
  std::ranges::for_each(target_names, add);
  add("");
  for (std::size_t k = 0; k < term_set.size(); ++k) {
    add(term_set.text(k));
  }
  return hash;
}

void ModelBlock::clear(std::span<std::byte> memory, const BlockLayout& layout) {
  const std::span<std::uint64_t> words = words_of(memory);
  std::ranges::fill(words, 0);
  words[0] = BlockLayout::kMark;
  words[1] = layout.identity;
  words[2] = layout.slot_words();
  std::ranges::copy(sizes_of(layout), words.subspan(kSizesAt).begin());
}

bool ModelBlock::assesses(std::span<const std::byte> memory) {
  constexpr std::size_t kPlaces = kSizesAt + 5;
  std::uint64_t places = 0;
  if (memory.size() >= BlockLayout::kHeaderWords * sizeof(places)) {
    std::ranges::copy(memory.subspan(kPlaces * sizeof(places), sizeof(places)),
                      std::as_writable_bytes(std::span(&places, 1)).begin());
  }
  return places > 0;
}

ModelBlock::ModelBlock(std::span<std::byte> memory, const BlockLayout& needed)
    : words_(words_of(memory)) {
  require_block(words_.size() >= BlockLayout::kHeaderWords && words_[0] == BlockLayout::kMark,
                "is no block of this version");
  require_block(words_[1] == needed.identity,
                "belongs to a model with other inputs, targets or terms");
  layout_ = {.identity = words_[1],
             .inputs = words_[kSizesAt],
             .targets = words_[kSizesAt + 1],
             .terms = words_[kSizesAt + 2],
             .members = words_[kSizesAt + 3],
             .vectors = words_[kSizesAt + 4],
             .places = words_[kSizesAt + 5]};
  require_block(layout_.inputs == needed.inputs && layout_.targets == needed.targets &&
                    layout_.terms == needed.terms && words_[2] == layout_.slot_words() &&
                    memory.size() == layout_.bytes(),
                "is damaged");
  require_block(layout_.members >= needed.members && layout_.vectors >= needed.vectors &&
                    layout_.places >= needed.places,
                "has room for " + std::to_string(layout_.vectors) +
                    " support vectors, the settings of the learner allow " +
                    std::to_string(needed.vectors));
}

std::uint64_t ModelBlock::publish(std::span<const std::string> input_names,
                                  std::span<const Snapshot> snapshots, const Alignment& alignment) {
  const std::uint64_t number = load(words_[kLatest]) + 1;
  const std::size_t words = layout_.slot_words();
  const std::span<std::uint64_t> slot =
      words_.subspan(BlockLayout::kHeaderWords + (number % 2) * words, words);
  store(slot[0], 0);
  NumberWriter out(slot.subspan(kNumbersOfSlot));
  put_bounds(snapshots, out);
  put_actuators(input_names, alignment, out);
  const Counts counts = counts_of(snapshots);
  out.put(alignment.lag_s);
  out.put(counts.members);
  out.put(counts.vectors);
  out.put(layout_.places > 0 ? counts.places : 0);
  put_targets(snapshots, out);
  put_members(snapshots, out);
  put_vectors(snapshots, out);
  if (layout_.places > 0) {
    put_known(snapshots, out);
  }
  store(slot[1], out.written());
  store(slot[0], number);
  store(words_[kLatest], number);
  return number;
}

}  // namespace kelpie
