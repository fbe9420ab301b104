// SPDX-License-Identifier: Apache-2.0
#include "format/certificate_json.hpp"

#include <array>
#include <cmath>

#include "file/json.hpp"

namespace kelpie::format {
namespace {

file::Json driven_json(const study::DrivenHorizon& horizon, const std::array<bool, 6>& free) {
  file::Json r2 = file::Json::object();
  for (std::size_t axis = 0; axis < free.size(); ++axis) {
    if (free[axis]) {
      r2[simulator::axis_text(axis)] = file::number(horizon.r2[axis]);
    }
  }
  return {{"seconds", horizon.seconds}, {"starts", horizon.starts}, {"r2", r2}};
}

file::Json engine_json(const study::Certificate& certificate, const std::array<bool, 6>& free) {
  const simulator::StepLimit& limit = certificate.limit;
  file::Json horizons = file::Json::array();
  for (const study::DrivenHorizon& horizon : certificate.horizons) {
    horizons.push_back(driven_json(horizon, free));
  }
  return {{"engine", certificate.engine.name},
          {"title", certificate.engine.title},
          {"step_s", certificate.engine.step_s},
          {"horizons", horizons},
          {"stable", limit.stable},
          {"largest_stable_step_s",
           limit.largest_s ? file::Json(*limit.largest_s) : file::Json(nullptr)},
          {"limited_by", limit.term ? file::Json(simulator::term_text(*limit.term)) : nullptr},
          {"axis", limit.term ? file::Json(simulator::axis_text(limit.axis)) : nullptr}};
}

}  // namespace

std::string certificate_json(const study::CertificateList& list, const std::string& source) {
  file::Json engines = file::Json::array();
  for (const study::Certificate& certificate : list.engines) {
    engines.push_back(engine_json(certificate, list.free));
  }
  return file::json_text({{"format", "kelpie-certificate"},
                          {"version", 1},
                          {"log", source},
                          {"rows", list.rows},
                          {"engines", engines}});
}

}  // namespace kelpie::format
