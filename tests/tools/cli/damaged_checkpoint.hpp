// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "cli/command.hpp"
#include "format/checkpoint_file.hpp"

namespace kelpie::testing {

/// Overwrites eight bytes of the state in the checkpoint `folder`/`file` at many places, one at a
/// time, each under a right checksum. `command` has to go on, or to refuse the file by name.
inline void expect_refused_by_name(const std::filesystem::path& folder, const std::string& file,
                                   const std::function<Outcome()>& command) {
  const format::Checkpoint whole = format::read_checkpoint(folder / file).checkpoint;
  constexpr std::size_t kPlaces = 24;
  std::size_t refused = 0;
  for (std::size_t place = 1; place <= kPlaces; ++place) {
    format::Checkpoint damaged = whole;
    damaged.state.replace((whole.state.size() - 8) * place / kPlaces, 8, 8, '\xff');
    write_text(folder / file, format::checkpoint_bytes(damaged));
    const Outcome outcome = command();
    if (outcome.exit_code != 0) {
      expect_refused(outcome, "kelpie: " + file + ": state");
      ++refused;
    }
  }
  EXPECT_GE(refused, kPlaces / 4);
}

}  // namespace kelpie::testing
