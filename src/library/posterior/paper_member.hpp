// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "kelpie/core/archive.hpp"
#include "kelpie/svr/online_svr.hpp"
#include "kelpie/svr/settings.hpp"
#include "learner/sample_map.hpp"
#include "svr/past_model.hpp"
#include "svr/svr_function.hpp"

namespace kelpie {

/// The paper's learner as a member of a Mixture, on scaled samples whose scale may move: the
/// learner then learns its samples anew, a slice per sample, without a model meanwhile. Allocates
/// in the constructor, and in move().
class PaperMember {
 public:
  PaperMember(std::size_t inputs, std::size_t terms, const OnlineSvrSettings& settings);

  void limit(const Budget& budget) { svr_.limit(budget); }

  /// Learns a sample, or goes on learning the samples of another scale.
  void update(std::span<const double> z, double y, double t);

  /// Samples are in another scale from now on, `map` of the scale so far.
  void move(const SampleMap& map);

  void clear() {  ///< Forgets all samples.
    svr_.clear();
    relearns_ = false;
  }

  bool ready() const { return !relearns_ && svr_.ready(); }  ///< Whether a model is in service.
  bool unfinished() const { return svr_.unfinished(); }
  const OnlineSvr& learner() const { return svr_; }

  void visit(Archive& archive);  ///< core/archive.hpp

  /// Memory in bytes. Requires settings that validate.
  static std::size_t bytes(std::size_t inputs, std::size_t terms,
                           const OnlineSvrSettings& settings);

 private:
  OnlineSvr svr_;
  PastModel moved_;  ///< the samples to learn anew
  bool relearns_ = false;
};

}  // namespace kelpie
