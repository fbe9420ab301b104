// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "study/certificate.hpp"

namespace kelpie::format {

/// certificate.json: docs/howto/identify.md, "Certificate". `source`: the log.
std::string certificate_json(const study::CertificateList& list, const std::string& source);

}  // namespace kelpie::format
