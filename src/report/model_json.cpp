// SPDX-License-Identifier: Apache-2.0
#include "kelpie/report/model_json.hpp"

#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <vector>

#include "kelpie/core/error.hpp"

namespace kelpie {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "kelpie-model";
constexpr int kVersion = 2;
constexpr std::size_t kMostAxes = 64;

// A key of the file, with the path to it for messages.
class Node {
 public:
  Node(const Json& json, std::string source, std::string path)
      : json_(&json), source_(std::move(source)), path_(std::move(path)) {}

  Node operator[](const std::string& key) const {
    require(json_->is_object() && json_->contains(key), "has no '" + key + "'");
    return {(*json_)[key], source_, path_.empty() ? key : path_ + "." + key};
  }

  std::vector<Node> items() const {
    require(json_->is_array(), "is not a list");
    std::vector<Node> list;
    for (std::size_t i = 0; i < json_->size(); ++i) {
      list.emplace_back((*json_)[i], source_, path_ + "[" + std::to_string(i) + "]");
    }
    return list;
  }

  const Json& json() const { return *json_; }

  std::string text() const {
    require(json_->is_string(), "is not a text");
    return json_->get<std::string>();
  }

  double number() const {
    require(json_->is_number(), "is not a number");
    const auto value = json_->get<double>();
    require(std::isfinite(value), "is not finite");
    return value;
  }

  double positive() const {
    const double value = number();
    require(value > 0.0, "has to be > 0");
    return value;
  }

  std::vector<double> numbers(std::size_t size) const {
    std::vector<double> values;
    for (const Node& item : items()) {
      values.push_back(item.number());
    }
    require(values.size() == size, "holds " + std::to_string(values.size()) + " numbers; " +
                                       std::to_string(size) + " are needed");
    return values;
  }

  void require(bool good, const std::string& otherwise) const {
    if (!good) {
      throw InputError({.file = source_, .line = 0, .field = path_.empty() ? "file" : path_},
                       otherwise);
    }
  }

 private:
  const Json* json_;
  std::string source_;
  std::string path_;
};

Json scaling_json(const AxisScaling& scaling) {
  const InputScaling& input = scaling.input;
  Json rows = Json::array();
  for (Eigen::Index row = 0; row < input.whitening.rows(); ++row) {
    const Eigen::VectorXd values = input.whitening.row(row);
    rows.push_back(std::vector<double>(values.begin(), values.end()));
  }
  return {{"input_mean", std::vector<double>(input.mean.begin(), input.mean.end())},
          {"whitening", rows},
          {"target_mean", scaling.target.mean},
          {"target_scale", scaling.target.scale},
          {"term_scale", scaling.term_scale}};
}

Json kernel_json(const MixedKernel& kernel) {
  return {{"type", "squared_exponential_and_terms"},
          {"gamma", kernel.local().gamma()},
          {"s", kernel.weights().s},
          {"fine", kernel.weights().fine},
          {"lambda", kernel.weights().lambda}};
}

Json axis_json(const TrainedModel::Axis& axis) {
  const SampleStore& samples = axis.function.support_vectors();
  Json vectors = Json::array();
  std::vector<double> z(samples.dimension());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples.get(i, z);
    vectors.push_back(z);
  }
  const std::span<const double> beta = axis.function.beta();
  return {{"target", axis.name},
          {"scaling", scaling_json(axis.scaling)},
          {"kernel", kernel_json(axis.function.kernel())},
          {"kkt_gap", axis.kkt_gap},
          {"bias", axis.function.bias()},
          {"beta", std::vector<double>(beta.begin(), beta.end())},
          {"support_vectors", vectors}};
}

AxisScaling read_scaling(const Node& node, std::size_t inputs, std::size_t terms) {
  const auto size = static_cast<Eigen::Index>(inputs);
  AxisScaling scaling;
  const std::vector<double> mean = node["input_mean"].numbers(inputs);
  scaling.input.mean = Eigen::Map<const Eigen::VectorXd>(mean.data(), size);
  scaling.input.whitening.resize(size, size);
  const std::vector<Node> rows = node["whitening"].items();
  node["whitening"].require(rows.size() == inputs, "needs one row per input");
  for (Eigen::Index row = 0; row < size; ++row) {
    const std::vector<double> values = rows[static_cast<std::size_t>(row)].numbers(inputs);
    scaling.input.whitening.row(row) = Eigen::Map<const Eigen::RowVectorXd>(values.data(), size);
  }
  scaling.target = {node["target_mean"].number(), node["target_scale"].positive()};
  scaling.term_scale = node["term_scale"].numbers(terms);
  for (const double scale : scaling.term_scale) {
    node["term_scale"].require(scale > 0.0, "has to hold numbers > 0");
  }
  return scaling;
}

MixedKernel read_kernel(const Node& node, std::size_t inputs, std::size_t terms) {
  const std::string type = node["type"].text();
  node["type"].require(type == "squared_exponential_and_terms",
                       "'" + type + "' is not known; 'squared_exponential_and_terms' is");
  const KernelWeights weights{node["s"].number(), node["fine"].number(), node["lambda"].number()};
  return {node["gamma"].positive(), weights, inputs, terms};
}

TrainedModel::Axis read_axis(const Node& node, std::size_t inputs, std::size_t terms) {
  const std::vector<Node> vectors = node["support_vectors"].items();
  SampleStore samples(inputs + terms, vectors.size());
  for (const Node& vector : vectors) {
    samples.push_back(vector.numbers(inputs + terms));
  }
  const std::vector<double> beta = node["beta"].numbers(vectors.size());
  SvrFunction function(read_kernel(node["kernel"], inputs, terms), vectors.size());
  function.assign(samples, beta, node["bias"].number());
  return {node["target"].text(), read_scaling(node["scaling"], inputs, terms), std::move(function),
          node["kkt_gap"].number()};
}

ModelSettings read_settings(const Node& node, std::size_t axes) {
  ModelSettings settings = ModelSettings::from_preset("default", axes);
  node.require(node.json().is_object(), "is not an object");
  for (const auto& [name, value] : node.json().items()) {
    const std::string text = node[name].text();
    if (name == "preset") {
      settings.preset = text;
    } else {
      settings.assign(name, text);
    }
  }
  settings.validate();
  return settings;
}

}  // namespace

std::string model_json(const TrainedModel& model) {
  Json json{{"format", kFormat}, {"version", kVersion}, {"inputs", model.input_names}};
  json["settings"] = Json::object();
  for (const auto& [name, value] : model.settings.values()) {
    json["settings"][name] = value;
  }
  json["axes"] = Json::array();
  for (const TrainedModel::Axis& axis : model.axes) {
    json["axes"].push_back(axis_json(axis));
  }
  return json.dump(1) + "\n";
}

TrainedModel parse_model_json(const std::string& text, const std::string& source) {
  Json json;
  try {
    json = Json::parse(text);
  } catch (const Json::parse_error& error) {
    throw InputError({.file = source, .line = 0, .field = "file"},
                     std::string("is not JSON: ") + error.what());
  }
  const Node root(json, source, "");
  root["format"].require(root["format"].text() == kFormat,
                         std::string("has to be '") + kFormat + "'");
  root["version"].require(root["version"].number() == kVersion,
                          "this kelpie reads version " + std::to_string(kVersion));
  TrainedModel model;
  for (const Node& name : root["inputs"].items()) {
    model.input_names.push_back(name.text());
  }
  root["inputs"].require(!model.input_names.empty() && model.input_names.size() <= kMostInputs,
                         "needs 1 to " + std::to_string(kMostInputs) + " names");
  const std::vector<Node> axes = root["axes"].items();
  root["axes"].require(!axes.empty() && axes.size() <= kMostAxes,
                       "needs 1 to " + std::to_string(kMostAxes) + " axes");
  try {
    model.settings = read_settings(root["settings"], axes.size());
    model.terms = TermSet::from(model.settings.shared.terms, model.input_names, axes.size());
  } catch (const InputError& error) {
    if (!error.place().file.empty()) {
      throw;
    }
    throw InputError({.file = source, .line = 0, .field = "settings"}, error.what());
  }
  for (const Node& axis : axes) {
    model.axes.push_back(read_axis(axis, model.input_names.size(), model.terms.size()));
  }
  return model;
}

TrainedModel read_model(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (!stream.is_open() || stream.bad() || std::filesystem::is_directory(file)) {
    throw InputError({.file = file.string(), .line = 0, .field = {}},
                     "cannot be read; a model.json as `kelpie learn` writes it is needed");
  }
  return parse_model_json(text, file.string());
}

}  // namespace kelpie
