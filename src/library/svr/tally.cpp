// SPDX-License-Identifier: Apache-2.0
#include "kelpie/svr/decision.hpp"

#include <array>

namespace kelpie {
namespace {

template <Verdict kVerdict>
std::int64_t verdict(const Decision& decision) {
  return decision.verdict == kVerdict ? 1 : 0;
}

template <auto kMember>
std::int64_t sum(const Decision& decision) {
  return static_cast<std::int64_t>(decision.*kMember);
}

std::int64_t recalled(const Decision& decision) {
  return decision.recalled > 0 ? 1 : 0;
}

using enum TallyKind;

constexpr std::array kTotals = std::to_array<TallyField>({
    {"accepted", "accepted", "accepted", "taken into the buffer and trained on", arrival,
     &Tally::accepted, verdict<Verdict::accepted>},
    {"gate_duplicate", "duplicate", "duplicate, eq. (10)",
     "turned away: close to a support vector with the same target", arrival, &Tally::duplicate,
     verdict<Verdict::duplicate>},
    {"gate_explained", "explained", "explained, eq. (9)",
     "turned away: close to a support vector and within the tube", arrival, &Tally::explained,
     verdict<Verdict::explained>},
    {"invalid", "invalid", "invalid",
     "turned away: a NaN, beyond ±1e50, or the wrong number of inputs", arrival, &Tally::invalid,
     verdict<Verdict::invalid>},
    {"implausible", "implausible", "implausible",
     "turned away: too far from all samples before to be believed", arrival, &Tally::implausible,
     verdict<Verdict::implausible>},
    {"outliers", "outliers", "outliers", "left the buffer as outliers", departure, &Tally::outliers,
     sum<&Decision::outliers>},
    {"forgotten", "forgotten", "forgotten",
     "left because the buffer was full, or were of a vehicle that is no more", departure,
     &Tally::forgotten, sum<&Decision::forgotten>},
    {"released", "released", "released", "left because they had lost their weight", departure,
     &Tally::released, sum<&Decision::released>},
    {"unserved", "unserved", "not served",
     "steps whose training ended out of tolerance; the model before stayed in service", trouble,
     &Tally::rejected_by_tolerance, sum<&Decision::rejected_by_tolerance>},
    {"crowded_out", "crowded_out", "crowded out",
     "turned away because all an update may do went on work that earlier samples had left", arrival,
     &Tally::crowded_out, verdict<Verdict::crowded_out>},
    {"unfinished", "unfinished", "unfinished", "steps that reached what an update may do", trouble,
     &Tally::unfinished, sum<&Decision::unfinished>},
    {"fallbacks", "fallbacks", "solved by SMO", "solves in which the path solver gave up", trouble,
     &Tally::fallbacks, sum<&Decision::fallbacks>},
    {"changes", "changes", "changes", "the vehicle had changed, and the model followed", change,
     &Tally::changes, sum<&Decision::changed>},
    {"recalls", "recalls", "recalls", "those of the changes in which a past vehicle returned",
     change, &Tally::recalls, recalled},
    {"withdrawn", "withdrawn", "withdrawn", "those of the changes that were taken back", change,
     &Tally::withdrawn, sum<&Decision::withdrawn>},
});

static_assert(kTotals.size() * sizeof(std::int64_t) == sizeof(Tally), "a total lacks its line");

}  // namespace

std::span<const TallyField> tally_fields() {
  return kTotals;
}

void Tally::add(const Decision& decision) {
  for (const TallyField& field : kTotals) {
    this->*field.total += field.count(decision);
  }
}

void Tally::add(const Tally& other) {
  for (const TallyField& field : kTotals) {
    this->*field.total += other.*field.total;
  }
}

void Tally::subtract(const Tally& earlier) {
  for (const TallyField& field : kTotals) {
    this->*field.total -= earlier.*field.total;
  }
}

void Tally::visit(Archive& archive) {
  constexpr std::int64_t kMostCount = std::int64_t{1} << 53;
  for (const TallyField& field : kTotals) {
    archive.whole(this->*field.total, 0, kMostCount);
  }
}

}  // namespace kelpie
