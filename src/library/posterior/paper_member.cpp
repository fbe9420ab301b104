// SPDX-License-Identifier: Apache-2.0
#include "posterior/paper_member.hpp"

#include <array>

#include "kelpie/core/scaling.hpp"
#include "svr/sample_collector.hpp"

namespace kelpie {

PaperMember::PaperMember(std::size_t inputs, std::size_t terms, const OnlineSvrSettings& settings)
    : svr_(inputs, settings, terms),
      moved_(svr_.buffer().kernel(), svr_.buffer().samples().capacity()) {}

void PaperMember::update(std::span<const double> z, double y, double t) {
  if (relearns_) {
    relearns_ = !svr_.relearn_slice(moved_, t);
  } else {
    svr_.update(z, y, t);
  }
}

void PaperMember::move(const SampleMap& map) {
  if (!relearns_) {
    moved_.keep(svr_.buffer(), svr_.model(), {.usual_error = 1.0});
    moved_.function.clear();
  }
  std::array<double, kMostInputs + kMostTerms> room{};
  const std::span<double> z = std::span(room).first(moved_.samples.dimension());
  for (std::size_t i = 0; i < moved_.size(); ++i) {
    moved_.samples.get(i, z);
    map(z, moved_.targets[i]);
    moved_.samples.set(i, z);
  }
  svr_.clear();
  relearns_ = moved_.size() > 0;
}

void PaperMember::visit(Archive& archive) {
  archive.part("learner", svr_);
  archive.flag(relearns_);
  if (relearns_) {
    archive.part("samples", moved_);
  }
}

std::size_t PaperMember::bytes(std::size_t inputs, std::size_t terms,
                               const OnlineSvrSettings& settings) {
  return sizeof(PaperMember) + OnlineSvr::bytes(inputs, settings, terms) +
         PastModel::bytes(inputs, terms, settings.places());
}

}  // namespace kelpie
