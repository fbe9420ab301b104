// SPDX-License-Identifier: Apache-2.0
#include "format/c_known.hpp"
#include "kelpie/model/trained_model.hpp"
#include "model/snapshot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace kelpie::format {

std::string known_tables(const TrainedModel& model, const CText& text) {
  std::string axes;
  std::string places;
  std::string densities;
  std::size_t count = 0;
  std::vector<double> z(model.input_names.size());
  for (const TrainedModel::Axis& axis : model.axes) {
    const std::size_t samples = axis.known ? axis.known->samples.size() : 0;
    for (std::size_t i = 0; i < samples; ++i) {
      axis.known->samples.get(i, z);
      places += "  " + text.list(z) + ",\n";
      densities += "  " + text.number(axis.known->density.sums()[i] - 1.0) + ",\n";
    }
    const double h = axis.known ? axis.known->density.bandwidth() : 0.0;
    axes += fmt::format("  {{ {}, {}, {}, {} }},\n", count, count + samples,
                        text.bound(axis.half_width), text.number(h > 0.0 ? 0.5 / (h * h) : 0.0));
    count += samples;
  }
  if (count == 0) {  // C has no empty arrays
    std::ranges::fill(z, 0.0);
    places = "  " + text.list(z) + ",\n";
    densities = "  " + text.number(0.0) + ",\n";
    count = 1;
  }
  return fmt::format(R"(
struct $NAME_known {{
  int first, last; /* of the places of its samples, and the one behind */
  $REAL half_width;
  $REAL rate; /* closeness = exp(-rate |z - z'|^2); 0: not known */
}};

static const struct $NAME_known $NAME_known[$TARGETS] = {{
{}}};

static const $REAL $NAME_places[{}][$INPUTS] = {{
{}}};

/* How close the other samples are to each, in all. */
static const $REAL $NAME_densities[{}] = {{
{}}};
)",
                     axes, count, places, count, densities);
}

}  // namespace kelpie::format
