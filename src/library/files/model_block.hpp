// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kelpie/alignment/alignment.hpp"
#include "kelpie/motion/term_set.hpp"
#include "model/snapshot.hpp"

namespace kelpie {

/// What a block has room for, in words of 64 bits in the machine's order:
///
///     0       kMark, which names format and version
///     1       identity: columns and terms
///     2       words of a slot
///     3       number of the latest publication, from 1 on; 0: none yet
///     4 … 9   inputs, targets, terms, members, support vectors, places
///     10 … 15 reserved, 0
///     16      slot 0, then slot 1
///
/// Publication n is in slot n mod 2. A slot begins with n, 0 while the slot is written, and the
/// number of words in use; then come doubles, counts as doubles too:
///
///     per input    least and greatest known value; the numbers of the actuator (Actuator::fields)
///     once         shift of the commands [s]; members, support vectors, places
///     per target   first and last member; lower and upper limit, caution, square of the target's
///                  scale; mean of the inputs, whitening (row-major), least and greatest value of
///                  every term, ±infinity without a limit; every term's coefficient of a vehicle
///                  known beforehand
///     per member   share, first and last support vector, γ, s, fine, offset, coefficients
///     vectors      all support vectors, scaled; all weights, in target units; in groups of
///                  kLanes of one member, of which first comes the first input of all, and so on;
///                  the last group of a member is filled up with weights 0
///     per target   first and last place, half width, 1 / (2 bandwidth²); 0: not known
///     places       all places, scaled; all densities
///
/// The last two parts only where there is room for places. src/tools/format/model_block.inc reads
/// the same.
struct BlockLayout {
  static constexpr std::uint64_t kMark = 0x3430'6b6c'656b'6c62;  // "blkelk04"
  static constexpr std::size_t kHeaderWords = 16;
  static constexpr std::size_t kLanes = 4;  ///< support vectors that are evaluated together

  std::uint64_t identity = 0;
  std::size_t inputs = 0;
  std::size_t targets = 0;
  std::size_t terms = 0;
  std::size_t members = 0;  ///< of all targets
  std::size_t vectors = 0;  ///< of all members, in whole groups
  std::size_t places = 0;   ///< of all targets; 0: without novelty

  /// Room for every later snapshot of a model with snapshots of this capacity. `assess`: room for
  /// the places. Requires a snapshot per target.
  static BlockLayout of(std::span<const std::string> input_names,
                        std::span<const std::string> target_names, const TermSet& term_set,
                        std::span<const Snapshot> capacity, bool assess);

  std::size_t slot_words() const;  ///< a whole number of cache lines
  std::size_t bytes() const { return (kHeaderWords + 2 * slot_words()) * sizeof(std::uint64_t); }
};

/// FNV-1a over the names of columns and the texts of terms: a library and a block with the same
/// identity take the same numbers (Fowler, Noll, Vo: draft-eastlake-fnv).
std::uint64_t block_identity(std::span<const std::string> input_names,
                             std::span<const std::string> target_names, const TermSet& term_set);

/// The numbers of a model in memory that other programs map and read while a learner renews them.
/// One writer, any number of readers, nobody waits. A reader takes the slot of the latest
/// publication, copies the words, and looks once more at the number of the slot: equal numbers tell
/// that no word was written meanwhile (Boehm: Can seqlocks get along with programming language
/// memory models?, MSPC 2012). Every word is stored with release order and read with acquire order,
/// which needs no fence. With two slots a reader has to look again only if two publications come
/// while it copies.
class ModelBlock {
 public:
  /// Makes `memory` an empty block. Requires layout.bytes() bytes at an address of whole words.
  static void clear(std::span<std::byte> memory, const BlockLayout& layout);

  /// Takes an existing block for writing; publications go on from the last number. Throws
  /// InputError where `memory` is no block of this version, belongs to other columns or terms, or
  /// has less room than `needed`.
  ModelBlock(std::span<std::byte> memory, const BlockLayout& needed);

  /// Whether `memory` was made with room for places.
  static bool assesses(std::span<const std::byte> memory);

  /// Publishes the models of all targets and the alignment of the commands; returns the number.
  /// Requires snapshots within the layout. Cost O(support vectors · inputs). Allocates
  /// nothing.
  std::uint64_t publish(std::span<const std::string> input_names,
                        std::span<const Snapshot> snapshots, const Alignment& alignment);

 private:
  std::span<std::uint64_t> words_;
  BlockLayout layout_;
};

}  // namespace kelpie
