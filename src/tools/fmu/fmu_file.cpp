// SPDX-License-Identifier: Apache-2.0
#include "fmu/fmu_file.hpp"

#include <fmt/format.h>
#include <tinyxml2.h>
#include <zip.h>

#include <algorithm>
#include <initializer_list>
#include <set>
#include <utility>
#include <vector>

#include "file/content.hpp"
#include "file/plugin.hpp"
#include "file/tuning.hpp"
#include "fmu/guid.hpp"
#include "format/model_json.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/kelpie.h"
#include "kelpie/model/trained_model.hpp"

namespace kelpie::fmu {
namespace {

constexpr const char* kModelIdentifier = "kelpie_vehicle";  // name of the shared object
#if defined(__x86_64__)
constexpr const char* kPlatform = "linux64";  // FMI 2.0.4, chapter 2.3
#else
constexpr const char* kPlatform = "aarch64-linux";  // FMI 3.0, chapter 2.5.1.4: FMI 2.0 has none
#endif

// An archive in memory, so that the file appears whole or not at all. Entries have the same time
// everywhere: the same model gives the same bytes.
class ZipArchive {
 public:
  ZipArchive() {
    zip_error_t error;
    zip_error_init(&error);
    source_ = zip_source_buffer_create(nullptr, 0, 0, &error);
    archive_ = source_ == nullptr ? nullptr : zip_open_from_source(source_, ZIP_TRUNCATE, &error);
    zip_error_fini(&error);
    if (archive_ == nullptr) {
      throw Failure("no memory for an archive");
    }
    zip_source_keep(source_);  // zip_close() gives one reference back
  }
  ~ZipArchive() {
    if (archive_ != nullptr) {
      zip_discard(archive_);
    }
    zip_source_free(source_);
  }
  ZipArchive(const ZipArchive&) = delete;
  ZipArchive& operator=(const ZipArchive&) = delete;

  /// `content` has to live until bytes().
  void add(const std::string& name, const std::string& content) {
    constexpr zip_uint16_t kMidnight = 0;
    constexpr zip_uint16_t kFirstOfJanuary1980 = (1U << 5U) | 1U;
    zip_source_t* const entry = zip_source_buffer(archive_, content.data(), content.size(), 0);
    const zip_int64_t place =
        entry == nullptr ? -1 : zip_file_add(archive_, name.c_str(), entry, ZIP_FL_ENC_UTF_8);
    if (place < 0 || zip_file_set_dostime(archive_, static_cast<zip_uint64_t>(place), kMidnight,
                                          kFirstOfJanuary1980, 0) != 0) {
      zip_source_free(place < 0 ? entry : nullptr);
      throw Failure(fmt::format("{} cannot be archived", name));
    }
  }

  std::string bytes() {
    if (zip_close(std::exchange(archive_, nullptr)) != 0 || zip_source_open(source_) != 0) {
      throw Failure("no memory for an archive");
    }
    zip_source_seek(source_, 0, SEEK_END);
    std::string content(static_cast<std::size_t>(zip_source_tell(source_)), '\0');
    zip_source_seek(source_, 0, SEEK_SET);
    const zip_int64_t read = zip_source_read(source_, content.data(), content.size());
    zip_source_close(source_);
    if (read != static_cast<zip_int64_t>(content.size())) {
      throw Failure("no memory for an archive");
    }
    return content;
  }

 private:
  zip_source_t* source_ = nullptr;
  zip_t* archive_ = nullptr;
};

std::string unit_of(const Variable& variable, const FmuOptions& options) {
  const auto found = options.units.find(variable.name);
  return found == options.units.end() ? std::string() : found->second.text();
}

void check_units(const Vehicle& vehicle, const FmuOptions& options) {
  for (const auto& [column, unit] : options.units) {
    require(std::ranges::any_of(vehicle.variables(),
                                [&](const Variable& variable) { return variable.name == column; }),
            "--units", fmt::format("there is no column '{}' in the model", column));
  }
}

using Attributes = std::vector<std::pair<const char*, std::string>>;

void print_element(tinyxml2::XMLPrinter& xml, const char* name, const Attributes& attributes) {
  xml.OpenElement(name);
  for (const auto& [attribute, value] : attributes) {
    xml.PushAttribute(attribute, value.c_str());
  }
  xml.CloseElement();
}

void print_units(tinyxml2::XMLPrinter& xml, const Vehicle& vehicle, const FmuOptions& options) {
  std::set<std::string> units;
  for (const Variable& variable : vehicle.variables()) {
    units.insert(unit_of(variable, options));
  }
  units.erase("");
  if (units.empty()) {
    return;  // the standard wants at least one in the list
  }
  xml.OpenElement("UnitDefinitions");
  for (const std::string& unit : units) {
    print_element(xml, "Unit", {{"name", unit}});
  }
  xml.CloseElement();
}

void print_variables(tinyxml2::XMLPrinter& xml, const Vehicle& vehicle, const FmuOptions& options) {
  xml.OpenElement("ModelVariables");
  for (std::size_t i = 0; i < vehicle.variables().size(); ++i) {
    const Variable& variable = vehicle.variables()[i];
    const bool is_input = variable.role == Role::input;
    xml.OpenElement("ScalarVariable");
    xml.PushAttribute("name", variable.name.c_str());
    xml.PushAttribute("valueReference", fmt::format("{}", i).c_str());
    xml.PushAttribute("causality", is_input ? "input" : "output");
    xml.PushAttribute("variability", "continuous");
    if (!is_input) {
      xml.PushAttribute("initial", variable.role == Role::state ? "exact" : "calculated");
    }
    Attributes real;
    if (const std::string unit = unit_of(variable, options); !unit.empty()) {
      real.emplace_back("unit", unit);
    }
    if (variable.role != Role::acceleration) {
      real.emplace_back("start", fmt::format("{}", variable.start));
    }
    print_element(xml, "Real", real);
    xml.CloseElement();
  }
  xml.CloseElement();
}

void print_unknowns(tinyxml2::XMLPrinter& xml, const char* list, const Vehicle& vehicle,
                    std::initializer_list<Role> roles) {
  xml.OpenElement(list);
  for (std::size_t i = 0; i < vehicle.variables().size(); ++i) {
    if (std::ranges::find(roles, vehicle.variables()[i].role) != roles.end()) {
      print_element(xml, "Unknown", {{"index", fmt::format("{}", i + 1)}});
    }
  }
  xml.CloseElement();
}

}  // namespace

std::string model_description(const Vehicle& vehicle, const std::string& guid,
                              const FmuOptions& options) {
  check_units(vehicle, options);
  tinyxml2::XMLPrinter xml;
  xml.PushDeclaration("xml version=\"1.0\" encoding=\"UTF-8\"");
  xml.OpenElement("fmiModelDescription");
  xml.PushAttribute("fmiVersion", "2.0");
  xml.PushAttribute("modelName", options.name.c_str());
  xml.PushAttribute("guid", guid.c_str());
  xml.PushAttribute("description", "a vehicle whose dynamics kelpie learned from a log");
  xml.PushAttribute("generationTool", ("kelpie " + std::string(kelpie_version())).c_str());
  xml.PushAttribute("variableNamingConvention", "flat");
  print_element(xml, "CoSimulation",
                {{"modelIdentifier", kModelIdentifier},
                 {"canHandleVariableCommunicationStepSize", "true"},
                 {"canGetAndSetFMUstate", "true"}});
  print_units(xml, vehicle, options);
  xml.OpenElement("LogCategories");
  print_element(xml, "Category", {{"name", "logStatusError"}});
  xml.CloseElement();
  print_element(xml, "DefaultExperiment",
                {{"startTime", "0"}, {"stepSize", fmt::format("{}", Vehicle::kStepS)}});
  print_variables(xml, vehicle, options);
  xml.OpenElement("ModelStructure");
  print_unknowns(xml, "Outputs", vehicle, {Role::state, Role::acceleration});
  print_unknowns(xml, "InitialUnknowns", vehicle, {Role::acceleration});
  xml.CloseElement();
  xml.CloseElement();
  return xml.CStr();
}

std::string fmu_content(const TrainedModel& model, const FmuOptions& options) {
  const std::string text = format::model_json(model);
  const std::string description = model_description(Vehicle(model), guid_of(text), options);
  const std::string shared_object =
      file::read_content(file::find_plugin(fmt::format("{}.so", kModelIdentifier)),
                         "the shared object of units of FMI", file::kTuning.document_bytes);
  ZipArchive archive;
  archive.add("modelDescription.xml", description);
  archive.add("resources/model.json", text);
  archive.add(fmt::format("binaries/{}/{}.so", kPlatform, kModelIdentifier), shared_object);
  return archive.bytes();
}

}  // namespace kelpie::fmu
