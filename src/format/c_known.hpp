// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "format/c_text.hpp"
#include "kelpie/model/trained_model.hpp"

namespace kelpie::format {

/// What an exported model knows of its uncertainty, as tables in C: of every axis the half width of
/// its interval and where it has samples. $NAME, $REAL and $INPUTS are still to be replaced.
std::string known_tables(const TrainedModel& model, const CText& text);

}  // namespace kelpie::format
