// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "kelpie/stream/signal_history.hpp"
#include "log/read_log.hpp"

namespace kelpie::report {

/// The faults of a signal in words; empty without faults.
std::string faults_text(const SignalFaults& faults);

/// The processing of a log's signals, for a terminal: a line per signal and derivative, the lags,
/// the rows. Empty without signals.
std::string sampling_table(const log::SamplingReport& report);

/// The same without the table: the lags, the rows, how many signals have faults.
std::string sampling_notes(const log::SamplingReport& report);

}  // namespace kelpie::report
