// SPDX-License-Identifier: Apache-2.0
#include "model/model_block.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <limits>
#include <string_view>

#include "kelpie/core/error.hpp"

namespace kelpie {
namespace {

constexpr std::size_t kNumbersOfSlot = 2;     // the publication, and the words in use
constexpr std::size_t kNumbersOnce = 4;       // shift, members, support vectors, places
constexpr std::size_t kNumbersOfMember = 7;   // beside the coefficients
constexpr std::size_t kNumbersOfTarget = 4;   // beside mean and whitening
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

// The box around the known samples of all targets: beyond it the model has seen nothing.
void put_bounds(std::span<const Snapshot> snapshots, NumberWriter& out) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::size_t inputs = snapshots.front().scaling.input.dimension();
  ScaledInput low(inputs);
  ScaledInput high(inputs);
  std::ranges::fill(low, kInfinity);
  std::ranges::fill(high, -kInfinity);
  ScaledInput z(inputs);
  for (const Snapshot& axis : snapshots) {
    for (std::size_t i = 0; axis.known && i < axis.known->samples.size(); ++i) {
      axis.known->samples.get(i, z);
      const ScaledInput x = axis.scaling.input.invert(as_span(z));
      for (std::size_t k = 0; k < inputs; ++k) {
        low[k] = std::min(low[k], x[k]);
        high[k] = std::max(high[k], x[k]);
      }
    }
  }
  for (std::size_t k = 0; k < inputs; ++k) {
    const bool known = low[k] <= high[k];
    out.put(known ? low[k] : -kInfinity);
    out.put(known ? high[k] : kInfinity);
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
    out.put(std::span<const double>(input.mean));
    for (std::size_t row = 0; row < input.whitening.rows(); ++row) {
      out.put(std::span<const double>(input.whitening.row(row)));
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
      first += function.beta().size();
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

void put_vectors(std::span<const Snapshot> snapshots, NumberWriter& out) {
  for (const Snapshot& axis : snapshots) {
    for (const FunctionMix::Member& member : axis.function.members) {
      put_samples(member.function.support_vectors(), out);
    }
  }
  for (const Snapshot& axis : snapshots) {
    for (const FunctionMix::Member& member : axis.function.members) {
      for (const double beta : member.function.beta()) {
        out.put(axis.scaling.target.scale * beta);
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
      counts.vectors += member.function.beta().size();
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
      layout.vectors += member.function.support_vectors().capacity();
    }
    layout.places += assess && axis.known ? axis.known->samples.capacity() : 0;
  }
  return layout;
}

std::size_t BlockLayout::slot_words() const {
  const std::size_t numbers = kNumbersOfSlot + kNumbersOnce +
                              inputs * (2 + Actuator::fields().size()) +
                              targets * (kNumbersOfTarget + inputs + inputs * inputs) +
                              members * (kNumbersOfMember + terms) + vectors * (inputs + 1) +
                              (places > 0 ? targets * kNumbersOfKnown + places * (inputs + 1) : 0);
  return (numbers + kWordsOfCacheLine - 1) / kWordsOfCacheLine * kWordsOfCacheLine;
}

std::uint64_t block_identity(std::span<const std::string> input_names,
                             std::span<const std::string> target_names, const TermSet& term_set) {
  std::uint64_t hash = 0xcbf2'9ce4'8422'2325;
  const auto add = [&](std::string_view text) {
    for (const char letter : text) {
      hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100'0000'01b3;
    }
    hash = (hash ^ 0xffU) * 0x100'0000'01b3;  // no byte of UTF-8: ends the text
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
