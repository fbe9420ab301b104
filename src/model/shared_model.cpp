// SPDX-License-Identifier: Apache-2.0
#include "kelpie/model/shared_model.hpp"

#include <utility>
#include <vector>

#include "kelpie/model/axis_gradient.hpp"
#include "model/answer.hpp"

namespace kelpie {

struct SharedModel::Picture {
  /// What a prediction of one axis needs.
  struct Axis {
    explicit Axis(const DynamicsAxis& axis)
        : function(axis.committee().function_mix()),
          known(axis.svr().champion().buffer().known_places()) {}

    void take(const DynamicsAxis& axis) {
      scaling = *axis.scaling();
      axis.committee().refresh(function);
      axis.svr().champion().buffer().refresh(known);
      around = axis.interval_state();
    }

    double value(const TermSet& terms, std::span<const double> x) const {
      return scaling.target.invert(function(as_span(scale_sample(scaling, terms, x))));
    }

    AxisScaling scaling;
    FunctionMix function;
    KnownPlaces known;
    IntervalState around;
  };

  /// A reader's hold on a picture, until its prediction ends, be it by an exception.
  struct Hold {
    explicit Hold(const Picture& held) : picture(held) { picture.readers.fetch_add(1); }
    ~Hold() { picture.readers.fetch_sub(1); }
    Hold(const Hold&) = delete;
    Hold(Hold&&) = delete;
    Hold& operator=(const Hold&) = delete;
    Hold& operator=(Hold&&) = delete;

    const Picture& picture;
  };

  std::vector<Axis> axes;
  std::int64_t number = 0;
  mutable std::atomic<int> readers{0};
};

SharedModel::SharedModel(DynamicsModel model, std::size_t pictures)
    : model_(std::move(model)),
      count_(pictures),
      pictures_(std::make_unique<Picture[]>(pictures)) {  // NOLINT(*-avoid-c-arrays)
  const std::size_t inputs = model_.inputs();
  for (std::size_t i = 0; i < count_; ++i) {
    pictures_[i].axes.reserve(model_.axes());
    for (std::size_t k = 0; k < model_.axes(); ++k) {
      Picture::Axis& axis = pictures_[i].axes.emplace_back(model_.axis(k));
      axis.scaling.input = {std::vector<double>(inputs), Matrix(inputs, inputs)};
      axis.scaling.term_scale.resize(model_.axis(k).terms().size());
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

// A picture that is neither the latest nor held by a reader may be written: whoever takes hold of
// it from now on finds that it isn't the latest, and lets go before looking.
void SharedModel::publish() {
  const std::ptrdiff_t latest = latest_.load();
  for (std::size_t i = 0; i < count_; ++i) {
    Picture& picture = pictures_[i];
    const auto place = static_cast<std::ptrdiff_t>(i);
    if (place != latest && picture.readers.load() == 0) {
      for (std::size_t k = 0; k < picture.axes.size(); ++k) {
        picture.axes[k].take(model_.axis(k));
      }
      picture.number = ++published_;
      latest_.store(place);
      return;
    }
  }
  ++passed_over_;
}

template <typename Use>
std::int64_t SharedModel::with_latest(Use use) const {
  std::ptrdiff_t latest = latest_.load();
  while (latest >= 0) {
    const Picture::Hold hold(pictures_[static_cast<std::size_t>(latest)]);
    const std::ptrdiff_t now = latest_.load();
    if (now == latest) {
      use(hold.picture);
      return hold.picture.number;
    }
    latest = now;
  }
  return 0;
}

std::int64_t SharedModel::predict(std::span<const double> x, std::span<double> y) const {
  return with_latest([&](const Picture& picture) {
    answer(x, model_.inputs(), y, model_.axes(),
           [&](std::size_t k) { return picture.axes[k].value(model_.axis(k).terms(), x); });
  });
}

std::int64_t SharedModel::predict(std::span<const double> x, std::span<Prediction> y,
                                  double ahead_s) const {
  return with_latest([&](const Picture& picture) {
    answer(x, model_.inputs(), y, model_.axes(), [&](std::size_t k) {
      const Picture::Axis& axis = picture.axes[k];
      const ScaledSample z = scale_sample(axis.scaling, model_.axis(k).terms(), x);
      return axis.around.prediction(axis.scaling.target.invert(axis.function(as_span(z))),
                                    axis.known.novelty(as_span(z).first(x.size())), ahead_s);
    });
  });
}

std::int64_t SharedModel::predict_with_jacobian(std::span<const double> x, std::span<double> y,
                                                std::span<double> jacobian) const {
  return with_latest([&](const Picture& picture) {
    answer(x, model_.inputs(), y, model_.axes(), jacobian,
           [&](std::size_t k, std::span<double> gradient) {
             const Picture::Axis& axis = picture.axes[k];
             return predict_with_gradient(axis.scaling, model_.axis(k).terms(), axis.function, x,
                                          gradient);
           });
  });
}

}  // namespace kelpie
