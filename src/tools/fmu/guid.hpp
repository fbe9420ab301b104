// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace kelpie::fmu {

/// The identity that modelDescription.xml and the shared object have in common: of the text of a
/// model.json.
std::string guid_of(std::string_view model_json);

}  // namespace kelpie::fmu
