// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>

namespace kelpie::ros {

/// Behavioural constants of the ROS 2 node, chosen by hand; no measurement is recorded.
inline constexpr struct Tuning {
  // Subscriptions
  std::chrono::milliseconds between_searches{200};  ///< while a topic lacks its publisher
  std::chrono::seconds between_checks{2};           ///< once all topics have publishers
  std::chrono::seconds longest_check{3};            ///< for `--check` to find all publishers
  std::chrono::milliseconds check_step{20};         ///< between two searches of `--check`
  std::size_t most_topics = 10'000;     ///< subscriptions ever, with former types; bounds a flood
  std::size_t command_bytes = 256;      ///< of a command; the longest word has 6 letters
  std::size_t wanted_bytes = 1024;      ///< of wanted accelerations: a header and six numbers
  std::size_t command_letters = 40;     ///< quoted of an unknown command
  std::size_t most_coefficients = 200;  ///< in ~/coefficients; a model has some hundred

  // kelpie play
  std::chrono::seconds longest_wait{3};     ///< for the first subscriber
  std::chrono::milliseconds settling{500};  ///< for discovery before, for delivery afterwards
  std::chrono::milliseconds play_step{50};  ///< between two checks for a stop
} kTuning;

}  // namespace kelpie::ros
