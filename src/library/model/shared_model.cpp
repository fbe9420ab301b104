// SPDX-License-Identifier: Apache-2.0
#include "kelpie/model/shared_model.hpp"

#include <utility>
#include <vector>

#include "kelpie/core/error.hpp"
#include "model/answer.hpp"
#include "model/model_axis.hpp"
#include "model/snapshot.hpp"

namespace kelpie {

struct SharedModel::Publication {
  /// A reader's hold on a publication, until the prediction returns or throws.
  struct Hold {
    explicit Hold(const Publication& held) : publication(held) { publication.readers.fetch_add(1); }
    ~Hold() { publication.readers.fetch_sub(1); }
    Hold(const Hold&) = delete;
    Hold& operator=(const Hold&) = delete;

    const Publication& publication;
  };

  std::vector<Snapshot> axes;
  std::int64_t number = 0;
  mutable std::atomic<int> readers{0};
};

SharedModel::SharedModel(DynamicsModel model, std::size_t snapshots)
    : model_(std::move(model)),
      terms_(std::make_unique<TermSet>(model_.mechanisms(0).terms())),
      count_(snapshots),
      publications_(std::make_unique<Publication[]>(snapshots)) {  // NOLINT(*-avoid-c-arrays)
  require(snapshots >= 2, "snapshots",
          "has to be at least 2: one is read while another is written");
  for (std::size_t i = 0; i < count_; ++i) {
    for (std::size_t k = 0; k < model_.axes(); ++k) {
      publications_[i].axes.push_back(model_.mechanisms(k).snapshot());
    }
  }
  if (model_.ready()) {
    publish();
  }
}

SharedModel::~SharedModel() = default;

void SharedModel::update(std::span<const double> x, std::span<const double> y, double t) {
  model_.update(x, y, t);
  if (model_.ready()) {
    publish();
  }
}

void SharedModel::learn_held_back() {
  model_.learn_held_back();
  if (model_.ready()) {
    publish();
  }
}

std::span<const Snapshot> SharedModel::snapshots(std::size_t place) const {
  return publications_[place].axes;
}

// A publication that is neither the latest nor held by a reader may be written: a reader that takes
// hold of it from now on finds that it isn't the latest, and lets go before looking.
void SharedModel::publish() {
  const std::ptrdiff_t latest = latest_.load();
  for (std::size_t i = 0; i < count_; ++i) {
    Publication& publication = publications_[i];
    const auto place = static_cast<std::ptrdiff_t>(i);
    if (place != latest && publication.readers.load() == 0) {
      for (std::size_t k = 0; k < publication.axes.size(); ++k) {
        model_.mechanisms(k).refresh(publication.axes[k]);
      }
      publication.number = ++published_;
      latest_.store(place);
      if (renew_block_) {
        renew_block_(publication.axes);
      }
      return;
    }
  }
  ++passed_over_;
}

template <typename Use>
std::int64_t SharedModel::with_latest(Use use) const {
  std::ptrdiff_t latest = latest_.load();
  while (latest >= 0) {
    const Publication::Hold hold(publications_[static_cast<std::size_t>(latest)]);
    const std::ptrdiff_t now = latest_.load();
    if (now == latest) {
      use(hold.publication.axes);
      return hold.publication.number;
    }
    latest = now;
  }
  return 0;
}

std::int64_t SharedModel::predict(std::span<const double> x, std::span<double> y) const {
  return with_latest([&](const std::vector<Snapshot>& axes) {
    answer(x, model_.inputs(), y, axes.size(),
           [&](std::size_t k) { return axes[k].predict(*terms_, x); });
  });
}

std::int64_t SharedModel::predict(std::span<const double> x, std::span<Prediction> y,
                                  double ahead_s) const {
  return with_latest([&](const std::vector<Snapshot>& axes) {
    answer(x, model_.inputs(), y, axes.size(),
           [&](std::size_t k) { return axes[k].assess(*terms_, x, ahead_s); });
  });
}

std::int64_t SharedModel::predict_with_jacobian(std::span<const double> x, std::span<double> y,
                                                std::span<double> jacobian) const {
  return with_latest([&](const std::vector<Snapshot>& axes) {
    answer(x, model_.inputs(), y, axes.size(), jacobian,
           [&](std::size_t k, std::span<double> gradient) {
             return axes[k].predict_with_gradient(*terms_, x, gradient);
           });
  });
}

}  // namespace kelpie
