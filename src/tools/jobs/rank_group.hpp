// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace kelpie::jobs {

/// Processes started together (mpirun, srun), numbered by rank; rank 0 leads. All ranks make and
/// destroy the group together. Safe from several threads of a rank.
class RankGroup {
 public:
  /// Counters shared by all ranks, in the memory of rank 0; zero at the beginning.
  enum class Counter : std::size_t { next_job, stop, count };

  RankGroup() = default;
  virtual ~RankGroup() = default;
  RankGroup(const RankGroup&) = delete;
  RankGroup& operator=(const RankGroup&) = delete;

  virtual std::size_t rank() const = 0;
  virtual std::size_t size() const = 0;  ///< number of ranks
  virtual std::string host() const = 0;  ///< name of the machine

  /// Adds `amount` to a counter atomically and returns the value before. One-sided: works without
  /// the participation of further ranks.
  virtual std::uint64_t fetch_add(Counter counter, std::uint64_t amount) = 0;
  /// Sets a counter to zero.
  virtual void reset(Counter counter) = 0;

  /// Gives every rank the texts of all ranks, by rank. Returns when every rank has called
  /// exchange(); sleeps until then and calls `waiting` between sleeps. Requires texts of at most 2
  /// GB together.
  virtual std::vector<std::string> exchange(const std::string& text,
                                            const std::function<void()>& waiting) = 0;
  /// Gives every rank the text of rank 0. Called by every rank; sleeps until the text is there.
  /// Requires a text of at most 2 GB.
  virtual std::string broadcast(std::string text) = 0;
};

/// Function exported by the plug-in under the name kOpenRankGroup. Opens the group, once in a
/// process. Returns null without side effects unless `version` is the plug-in's version; `own`
/// returns the plug-in's version.
using OpenRankGroup = RankGroup* (*)(const char* version, const char** own);
inline constexpr const char* kOpenRankGroup = "kelpie_open_rank_group";

}  // namespace kelpie::jobs
