// SPDX-License-Identifier: Apache-2.0
#include "dds/quality.hpp"

#include <dds/dds.h>

namespace kelpie::dds {

QosPointer qos_of(const Quality& quality) {
  QosPointer qos(dds_create_qos(), dds_delete_qos);
  // Without waiting for slow subscribers: the oldest message is dropped.
  dds_qset_reliability(
      qos.get(), quality.reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT, 0);
  dds_qset_durability(qos.get(), quality.transient_local ? DDS_DURABILITY_TRANSIENT_LOCAL
                                                         : DDS_DURABILITY_VOLATILE);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, quality.depth);
  if (!quality.partition.empty()) {
    dds_qset_partition1(qos.get(), quality.partition.c_str());
  }
  return qos;
}

Quality quality_of(const dds_qos* qos) {
  Quality quality;
  dds_reliability_kind_t reliability = DDS_RELIABILITY_BEST_EFFORT;
  dds_durability_kind_t durability = DDS_DURABILITY_VOLATILE;
  dds_history_kind_t history = DDS_HISTORY_KEEP_LAST;
  std::uint32_t partitions = 0;
  char** names = nullptr;
  dds_qget_reliability(qos, &reliability, nullptr);
  dds_qget_durability(qos, &durability);
  dds_qget_history(qos, &history, &quality.depth);
  quality.reliable = reliability == DDS_RELIABILITY_RELIABLE;
  quality.transient_local = durability != DDS_DURABILITY_VOLATILE;
  if (dds_qget_partition(qos, &partitions, &names)) {
    for (std::uint32_t i = 0; i < partitions; ++i) {
      quality.partition += (i == 0 ? "" : ",") + std::string(names[i]);
      dds_free(names[i]);
    }
    dds_free(names);
  }
  return quality;
}

std::string policy_name(std::uint32_t policy) {
  switch (policy) {
    case DDS_DURABILITY_QOS_POLICY_ID:
      return "durability";
    case DDS_PRESENTATION_QOS_POLICY_ID:
      return "presentation";
    case DDS_DEADLINE_QOS_POLICY_ID:
      return "deadline";
    case DDS_LATENCYBUDGET_QOS_POLICY_ID:
      return "latency budget";
    case DDS_OWNERSHIP_QOS_POLICY_ID:
      return "ownership";
    case DDS_LIVELINESS_QOS_POLICY_ID:
      return "liveliness";
    case DDS_RELIABILITY_QOS_POLICY_ID:
      return "reliability";
    case DDS_DESTINATIONORDER_QOS_POLICY_ID:
      return "destination order";
    case DDS_DATA_REPRESENTATION_QOS_POLICY_ID:
      return "data representation";
    default:
      return "policy " + std::to_string(policy);
  }
}

}  // namespace kelpie::dds
